//! The distance of a triangle to a proxy (paper, eq. 2 and 3); eq. 1 is its sum.

use std::array::from_fn;

use pulp::{Arch, NullaryFnOnce};

use crate::math::lanes::{LANES, Lanes, Packet};
use crate::math::triangle::{Triangle, Triangles};
use crate::math::{Point, Vector};
use crate::surface::quadrature::{self, POINTS};
use crate::surface::{Plane, Quadric, Surface};

/// What a region is approximated by; its gradient points to the side of the region's normals.
#[derive(Debug, Clone, PartialEq)]
pub enum Proxy {
    /// A plane: a quadric whose gradient is a constant unit vector.
    Plane(Plane),
    /// A general quadric.
    Quadric(Quadric),
}

/// Below this squared gradient a quadric has no direction (an apex, an axis, a centre). Its
/// coefficients are of the order of one in the unit cube.
const NO_GRADIENT: f64 = 1e-24;
/// What a point without direction counts: no distance in the unit cube is larger than √3, and no
/// two unit vectors are further apart than 2.
const LARGEST: (f64, f64) = (3.0, 4.0);

impl Proxy {
    /// As a surface.
    pub fn surface(&self) -> Surface {
        match self {
            Self::Plane(plane) => Surface::Plane(plane.clone()),
            Self::Quadric(quadric) => Surface::Quadric(quadric.clone()),
        }
    }

    /// `E(t, f)` of eq. 2 for a triangle.
    pub fn error(&self, triangle: &Triangle, beta: f64) -> f64 {
        match self {
            Self::Plane(plane) => plane_error(plane, triangle, beta),
            Self::Quadric(quadric) => quadric_error(quadric, triangle, beta),
        }
    }

    /// `E(t, f)` of several triangles.
    pub fn errors(&self, triangles: &[Triangle], beta: f64) -> Vec<f64> {
        match self {
            Self::Plane(plane) => triangles.iter().map(|t| plane_error(plane, t, beta)).collect(),
            Self::Quadric(quadric) => Arch::new().dispatch(Errors { quadric, triangles, beta }),
        }
    }
}

/// In closed form: `f` is linear on the triangle and the deviation constant.
fn plane_error(plane: &Plane, triangle: &Triangle, beta: f64) -> f64 {
    let [a, b, c] = triangle.corners.map(|p| plane.normal.dot(&p.coords) - plane.offset);
    // The mean of a squared linear function by its values at the corners.
    let distance = (a * a + b * b + c * c + a * b + b * c + c * a) / 6.0;
    let deviation = (plane.normal.into_inner() - triangle.normal).norm_squared();
    (distance.max(0.0) + beta * deviation) * triangle.area
}

/// By the rule of degree four: `f²` has that degree, and the gradient changes little over a face.
///
/// All points at once, so that roots and quotients are taken side by side.
fn quadric_error(quadric: &Quadric, triangle: &Triangle, beta: f64) -> f64 {
    let points = quadrature::points(triangle.corners);
    let (mut values, mut steep, mut along) = ([0.0; POINTS], [0.0; POINTS], [0.0; POINTS]);
    for i in 0..POINTS {
        let (value, gradient) = value_and_gradient(&quadric.coefficients, points[i]);
        (values[i], steep[i], along[i]) =
            (value, gradient.norm_squared(), gradient.dot(&triangle.normal));
    }
    let mut sum = 0.0;
    for i in 0..POINTS {
        let (distance, deviation) = if steep[i] > NO_GRADIENT {
            // |g/|g| - n|² = 2 - 2 g·n/|g| for a unit n.
            (values[i] * values[i] / steep[i], 2.0 - 2.0 * along[i] / steep[i].sqrt())
        } else {
            LARGEST
        };
        sum += quadrature::WEIGHTS[i] * (distance + beta * deviation.max(0.0));
    }
    sum * triangle.area
}

/// [`quadric_error`] of four triangles at a time, in the vector instructions of the machine that runs it.
struct Errors<'a> {
    quadric: &'a Quadric,
    triangles: &'a [Triangle],
    beta: f64,
}

impl NullaryFnOnce for Errors<'_> {
    type Output = Vec<f64>;

    #[inline(always)]
    fn call(self) -> Vec<f64> {
        let mut errors = Vec::with_capacity(self.triangles.len());
        for chunk in self.triangles.chunks(LANES) {
            let four = Triangles::new(chunk);
            let mut sum = Lanes::splat(0.0);
            quadrature::each_of_packet(four.corners, |weight, point| {
                let (value, gradient) = values_and_gradients(&self.quadric.coefficients, point);
                let steep = gradient.times(gradient);
                let distance = value * value / steep;
                let deviation = 2.0 - 2.0 * gradient.times(four.normals) / steep.sqrt();
                let none = |regular: Lanes, least: f64| {
                    Lanes(from_fn(|i| if steep.0[i] > NO_GRADIENT { regular.0[i] } else { least }))
                };
                let (far, opposed) = LARGEST;
                sum += weight
                    * (none(distance, far) + self.beta * none(deviation, opposed).at_least(0.0));
            });
            errors.extend(&(sum * four.areas).0[..chunk.len()]);
        }
        errors
    }
}

#[inline(always)]
fn values_and_gradients(c: &[f64; 10], p: Packet) -> (Lanes, Packet) {
    let gradient = Packet {
        x: c[1] + 2.0 * c[4] * p.x + c[5] * p.y + c[6] * p.z,
        y: c[2] + c[5] * p.x + 2.0 * c[7] * p.y + c[8] * p.z,
        z: c[3] + c[6] * p.x + c[8] * p.y + 2.0 * c[9] * p.z,
    };
    let linear = c[1] * p.x + c[2] * p.y + c[3] * p.z;
    (c[0] + 0.5 * (gradient.times(p) + linear), gradient)
}

#[inline]
fn value_and_gradient(c: &[f64; 10], p: Point) -> (f64, Vector) {
    let gradient = Vector::new(
        c[1] + 2.0 * c[4] * p.x + c[5] * p.y + c[6] * p.z,
        c[2] + c[5] * p.x + 2.0 * c[7] * p.y + c[8] * p.z,
        c[3] + c[6] * p.x + c[8] * p.y + 2.0 * c[9] * p.z,
    );
    // Euler: x·∇f is twice the quadratic part plus the linear one.
    let value = c[0] + (gradient.dot(&p.coords) + c[1] * p.x + c[2] * p.y + c[3] * p.z) / 2.0;
    (value, gradient)
}

#[cfg(test)]
mod tests {
    use nalgebra::Matrix3;
    use rand::RngExt;

    use super::*;
    use crate::context::Context;
    use crate::math::Unit;

    fn triangle(rng: &mut impl rand::Rng, size: f64) -> Triangle {
        let mut draw = |far: f64| Vector::from_fn(|_, _| rng.random_range(-far..far));
        let middle = Point::new(0.5, 0.5, 0.5) + draw(0.4);
        Triangle::new([middle + draw(size), middle + draw(size), middle + draw(size)])
    }

    /// Eq. 3 by the midpoint rule on 64² small triangles.
    fn slowly(
        f: &Quadric,
        Triangle { corners: [a, b, c], normal, area }: &Triangle,
        beta: f64,
    ) -> f64 {
        let n = 64;
        let mut sum = 0.0;
        let mut add = |u: f64, v: f64| {
            let p = a + (b - a) * (u / f64::from(n)) + (c - a) * (v / f64::from(n));
            let gradient = f.gradient(p);
            let deviation = gradient.normalize() - normal;
            sum += f.value(p).powi(2) / gradient.norm_squared() + beta * deviation.norm_squared();
        };
        for i in 0..n {
            for j in 0..n - i {
                let (i, j) = (f64::from(i), f64::from(j));
                add(i + 1.0 / 3.0, j + 1.0 / 3.0);
                if i + j < f64::from(n) - 1.5 {
                    add(i + 2.0 / 3.0, j + 2.0 / 3.0);
                }
            }
        }
        sum * area / f64::from(n * n)
    }

    /// By one and by four at a time.
    fn both(proxy: &Proxy, triangle: &Triangle, beta: f64) -> f64 {
        let (one, many) = (proxy.error(triangle, beta), proxy.errors(&[*triangle; 5], beta));
        assert!(many.iter().all(|error| (error - one).abs() <= 1e-12 * one), "{one} {many:?}");
        one
    }

    #[test]
    fn the_rule_agrees_with_slow_quadrature() {
        let mut rng = Context::new(1).rng;
        let centre = Point::new(-0.7, -0.6, -0.5);
        let forms = [Vector::new(1.0, 1.0, 1.0), Vector::new(1.0, 2.0, 0.0)];
        for form in forms.map(|values| Matrix3::from_diagonal(&values)) {
            let quadric = Quadric::about(centre, -2.0, form);
            for _ in 0..50 {
                let triangle = triangle(&mut rng, 0.03);
                let fast = both(&Proxy::Quadric(quadric.clone()), &triangle, 0.1);
                let slow = slowly(&quadric, &triangle, 0.1);
                assert!((fast - slow).abs() < 1e-3 * slow, "{fast} {slow}");
            }
        }
    }

    #[test]
    fn a_plane_costs_what_its_ten_coefficients_cost() {
        let mut rng = Context::new(2).rng;
        for _ in 0..200 {
            let face = triangle(&mut rng, 0.2);
            let other = triangle(&mut rng, 0.2).normal;
            let plane = Plane::through(face.corners[1], Unit::new_normalize(other));
            let general = Proxy::Quadric(plane.quadric());
            let exact = both(&Proxy::Plane(plane), &face, 0.3);
            let by_rule = both(&general, &face, 0.3);
            assert!((exact - by_rule).abs() < 1e-12, "{exact} {by_rule}");
        }
    }

    #[test]
    fn at_an_apex_the_error_is_large_but_finite() {
        let cone = Quadric::about(Point::origin(), 0.0, Matrix3::identity());
        let apex = Triangle { corners: [Point::origin(); 3], normal: Vector::z(), area: 1.0 };
        let error = both(&Proxy::Quadric(cone), &apex, 1.0);
        assert!((error - 7.0).abs() < 1e-12);
    }
}
