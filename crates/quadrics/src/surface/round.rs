//! Spheres and cylinders from moments, by linear least squares (Kasa's fit).
//!
//! `f = |x|² + b · x + c` (for a cylinder across its axis) is linear in `b` and `c`, and about `2 r` times
//! the distance near the surface.

use nalgebra::{DMatrix, DVector, SVector};

use super::moments::{Moments, Normalised};
use super::{Cylinder, Quadric, Sphere};
use crate::math::{Point, Unit, Vector, frame};

/// The sphere of least `∫ f²` with its mean squared distance; `None` without area or radius.
pub fn sphere(moments: &Moments) -> Option<(f64, Quadric)> {
    let region = moments.normalised()?;
    let axes = [Vector::x(), Vector::y(), Vector::z()];
    let (center, radius, error) = fit(&region, &axes)?;
    Some((error, Sphere { center, radius }.quadric()))
}

/// The cylinder along `axis` of least `∫ f²` with its mean squared distance.
pub fn cylinder(moments: &Moments, axis: &Unit) -> Option<(f64, Quadric)> {
    let region = moments.normalised()?;
    let (u, v) = frame(axis);
    let (point, radius, error) = fit(&region, &[u.into_inner(), v.into_inner()])?;
    Some((error, Cylinder { point, axis: *axis, radius }.quadric()))
}

/// Centre, radius and mean squared distance of the circle or sphere in the span of `axes`.
fn fit(region: &Normalised, axes: &[Vector]) -> Option<(Point, f64, f64)> {
    let mut square = SVector::<f64, 10>::zeros();
    for axis in axes {
        let twice = [axis.x * axis.x, axis.y * axis.y, axis.z * axis.z];
        let mixed = [axis.x * axis.y, axis.x * axis.z, axis.y * axis.z].map(|m| 2.0 * m);
        let form = [twice[0], mixed[0], mixed[1], twice[1], mixed[2], twice[2]];
        form.iter().enumerate().for_each(|(i, value)| square[4 + i] += value);
    }
    let linear = |axis: &Vector| {
        let mut row = SVector::<f64, 10>::zeros();
        row.fixed_rows_mut::<3>(1).copy_from(axis);
        row
    };
    let mut basis: Vec<SVector<f64, 10>> = axes.iter().map(linear).collect();
    let mut one = SVector::<f64, 10>::zeros();
    one[0] = 1.0;
    basis.push(one);
    let m = &region.values;
    let n = basis.len();
    let normal = DMatrix::from_fn(n, n, |i, j| basis[i].dot(&(m * basis[j])));
    let right = DVector::from_fn(n, |i, _| -basis[i].dot(&(m * square)));
    let solution = normal.cholesky()?.solve(&right);
    let constant = solution[n - 1];
    let middle: Vector = axes.iter().zip(solution.iter()).map(|(a, b)| a * (-b / 2.0)).sum();
    let squared_radius = middle.norm_squared() - constant;
    if squared_radius.is_nan() || squared_radius <= 0.0 {
        return None;
    }
    let f = square + basis.iter().zip(solution.iter()).map(|(b, s)| b * *s).sum::<SVector<_, 10>>();
    let error = f.dot(&(m * f)).max(0.0) / (4.0 * squared_radius);
    let scale = region.extent;
    Some((region.centre + middle * scale, squared_radius.sqrt() * scale, error * scale * scale))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::triangle::Triangle;
    use crate::surface::Shape;

    /// Moments of small triangles on a quarter of a surface about the z axis.
    fn patch(at: impl Fn(f64, f64) -> Point) -> Moments {
        let mut moments = Moments::about(at(0.5, 0.5));
        let n = 40;
        for i in 0..n {
            for j in 0..n {
                let p = |a: i32, b: i32| {
                    at(f64::from(i + a) / f64::from(n), f64::from(j + b) / f64::from(n))
                };
                for corners in [[p(0, 0), p(1, 0), p(1, 1)], [p(0, 0), p(1, 1), p(0, 1)]] {
                    moments.add(&[Triangle::new(corners)]);
                }
            }
        }
        moments
    }

    #[test]
    fn a_quarter_of_a_sphere_and_of_a_cylinder_are_found() {
        let shift = Vector::new(0.3, 0.2, 0.4);
        let ball = patch(|u, v| {
            let (a, b) = (1.5 * u, 0.3 + v);
            Point::from(Vector::new(a.cos() * b.sin(), a.sin() * b.sin(), b.cos()) * 0.2 + shift)
        });
        let (error, quadric) = sphere(&ball).unwrap();
        assert!(
            error < 1e-8 && quadric.distance(Point::from(shift + Vector::x() * 0.2)).abs() < 1e-4
        );
        let tube = patch(|u, v| {
            let a = 1.5 * u;
            Point::from(Vector::new(0.2 * a.cos(), 0.2 * a.sin(), 0.5 * v) + shift)
        });
        let (error, quadric) = cylinder(&tube, &Vector::z_axis()).unwrap();
        assert!(
            error < 1e-8 && quadric.distance(Point::from(shift - Vector::y() * 0.2)).abs() < 1e-4
        );
        assert!(sphere(&tube).unwrap().0 > 100.0 * error);
    }
}
