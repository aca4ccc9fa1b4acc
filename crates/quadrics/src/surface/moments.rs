//! Moments of a region up to degree four: all that an algebraic fit of a quadric needs.
//!
//! They add up: the moments of two regions together are a sum, not a pass over their faces. They
//! are taken about a point near the region; about a distant one, fourth powers would cancel.

use nalgebra::{Matrix3, SMatrix};
use pulp::{Arch, NullaryFnOnce};

use super::quadrature;
use crate::math::lanes::{LANES, Lanes};
use crate::math::triangle::{Triangle, Triangles};
use crate::math::{Point, Vector};

/// Monomials `xⁱyʲzᵏ` with `i + j + k ≤ 4`.
const COUNT: usize = 35;

/// Exponents of the paper's vector F of section 3.1: 1, x, y, z, x², xy, xz, y², yz, z².
const BASIS: [[usize; 3]; 10] = [
    [0, 0, 0],
    [1, 0, 0],
    [0, 1, 0],
    [0, 0, 1],
    [2, 0, 0],
    [1, 1, 0],
    [1, 0, 1],
    [0, 2, 0],
    [0, 1, 1],
    [0, 0, 2],
];

/// Every monomial: its exponents, and two members of F whose product it is.
const MONOMIALS: ([[usize; 3]; COUNT], [[usize; 2]; COUNT]) = {
    let mut exponents = [[0; 3]; COUNT];
    let mut factors = [[0; 2]; COUNT];
    let mut found = 0;
    let mut a = 0;
    while a < 10 {
        let mut b = a;
        while b < 10 {
            let (p, q) = (BASIS[a], BASIS[b]);
            let sum = [p[0] + q[0], p[1] + q[1], p[2] + q[2]];
            let mut known = 0;
            while known < found
                && !(exponents[known][0] == sum[0]
                    && exponents[known][1] == sum[1]
                    && exponents[known][2] == sum[2])
            {
                known += 1;
            }
            if known == found {
                exponents[found] = sum;
                factors[found] = [a, b];
                found += 1;
            }
            b += 1;
        }
        a += 1;
    }
    assert!(found == COUNT);
    (exponents, factors)
};

/// Where `xⁱyʲzᵏ` stands.
const INDEX: [[[usize; 5]; 5]; 5] = {
    let mut index = [[[usize::MAX; 5]; 5]; 5];
    let mut m = 0;
    while m < COUNT {
        let [i, j, k] = MONOMIALS.0[m];
        index[i][j][k] = m;
        m += 1;
    }
    index
};

/// Integrals over the faces of a region, about a point.
#[derive(Debug, Clone, PartialEq)]
pub struct Moments {
    /// The point that coordinates are relative to.
    origin: Point,
    /// `∫ xⁱyʲzᵏ`.
    sums: [f64; COUNT],
    /// `∫ n`: the oriented area.
    oriented: Vector,
    /// `∫ x nᵀ`.
    oriented_first: Matrix3<f64>,
}

impl Moments {
    /// Nothing yet, about `origin`: a point near the faces to come.
    pub fn about(origin: Point) -> Self {
        let (oriented, oriented_first) = (Vector::zeros(), Matrix3::zeros());
        Self { origin, sums: [0.0; COUNT], oriented, oriented_first }
    }

    /// Adds triangles.
    pub fn add(&mut self, triangles: &[Triangle]) {
        let sums = Arch::new().dispatch(Sums { origin: &self.origin, triangles });
        for (sum, more) in self.sums.iter_mut().zip(sums) {
            *sum += more.sum();
        }
        for Triangle { corners, normal, area } in triangles {
            let centre = corners.iter().map(|corner| corner - self.origin).sum::<Vector>() / 3.0;
            self.oriented += normal * *area;
            self.oriented_first += centre * normal.transpose() * *area;
        }
    }

    /// The two regions together, about their common centroid.
    pub fn joined(&self, other: &Self) -> Self {
        let share = other.area() / (self.area() + other.area());
        let apart = other.centroid() - self.centroid();
        let origin = self.centroid() + apart * if share.is_finite() { share } else { 0.0 };
        let (mut whole, part) = (self.moved(origin), other.moved(origin));
        for (sum, more) in whole.sums.iter_mut().zip(part.sums) {
            *sum += more;
        }
        whole.oriented += part.oriented;
        whole.oriented_first += part.oriented_first;
        whole
    }

    /// The same moments about another point.
    fn moved(&self, origin: Point) -> Self {
        let shift = self.origin - origin;
        let mut powers = [[1.0; 5]; 3];
        for (axis, power) in powers.iter_mut().enumerate() {
            for n in 1..5 {
                power[n] = power[n - 1] * shift[axis];
            }
        }
        let sums = MONOMIALS.0.map(|[i, j, k]| {
            // (x + s)ⁱ (y + t)ʲ (z + u)ᵏ, multiplied out.
            let mut sum = 0.0;
            for a in 0..=i {
                for b in 0..=j {
                    for c in 0..=k {
                        let times = BINOMIAL[i][a] * BINOMIAL[j][b] * BINOMIAL[k][c];
                        let rest = powers[0][i - a] * powers[1][j - b] * powers[2][k - c];
                        sum += times * rest * self.sums[INDEX[a][b][c]];
                    }
                }
            }
            sum
        });
        let oriented_first = self.oriented_first + shift * self.oriented.transpose();
        Self { origin, sums, oriented: self.oriented, oriented_first }
    }

    /// Total area.
    pub fn area(&self) -> f64 {
        self.sums[0]
    }

    /// `∫ n`: for a flat region its normal times its area.
    pub fn oriented_area(&self) -> Vector {
        self.oriented
    }

    /// Centroid; the origin where there is no area.
    pub fn centroid(&self) -> Point {
        let first = Vector::new(self.sums[1], self.sums[2], self.sums[3]);
        if self.area() > 0.0 { self.origin + first / self.area() } else { self.origin }
    }

    /// Covariance of the area about its centroid.
    pub fn covariance(&self) -> Matrix3<f64> {
        let mean = self.centroid() - self.origin;
        let sum = |m: usize| self.sums[m] / self.area();
        let second =
            Matrix3::new(sum(4), sum(5), sum(6), sum(5), sum(7), sum(8), sum(6), sum(8), sum(9));
        second - mean * mean.transpose()
    }

    /// What [`super::taubin`] works on: means over the area in coordinates about the centroid,
    /// divided by the root mean square extent, so that a fit sees numbers near one.
    pub(super) fn normalised(&self) -> Option<Normalised> {
        let centre = self.centroid();
        let extent = self.covariance().trace().sqrt();
        // Written so that NaN is refused too.
        if !(self.area() > 0.0 && extent > 0.0) {
            return None;
        }
        let about = self.moved(centre);
        let mean = |[i, j, k]: [usize; 3]| {
            about.sums[INDEX[i][j][k]] / self.area() / extent.powi((i + j + k) as i32)
        };
        let normal = about.oriented / self.area();
        let first = about.oriented_first / (self.area() * extent);
        Some(Normalised {
            centre,
            extent,
            values: SMatrix::from_fn(|a, b| mean(sum(BASIS[a], BASIS[b]))),
            gradients: SMatrix::from_fn(|a, b| {
                (0..3).map(|axis| mean_of_slopes(a, b, axis, mean)).sum()
            }),
            along_normals: SMatrix::from_fn(|a, _| mean_along_normals(a, normal, first)),
        })
    }
}

/// `∫ xⁱyʲzᵏ` over triangles, four at a time in the vector instructions of the machine that runs it.
struct Sums<'a> {
    origin: &'a Point,
    triangles: &'a [Triangle],
}

impl NullaryFnOnce for Sums<'_> {
    type Output = [Lanes; COUNT];

    #[inline(always)]
    fn call(self) -> Self::Output {
        let mut sums = [Lanes::splat(0.0); COUNT];
        for chunk in self.triangles.chunks(LANES) {
            let Triangles { corners, areas, .. } = Triangles::new(chunk);
            quadrature::each_of_packet(corners.map(|c| c.from(self.origin)), |weight, p| {
                let one = Lanes::splat(1.0);
                let (x, y, z) = (p.x, p.y, p.z);
                let f = [one, x, y, z, x * x, x * y, x * z, y * y, y * z, z * z];
                let weighted = f.map(|value| value * areas * weight);
                for (sum, [a, b]) in sums.iter_mut().zip(MONOMIALS.1) {
                    *sum += weighted[a] * f[b];
                }
            });
        }
        sums
    }
}

/// Mean products over a region, in its own coordinates `(x - centre) / extent`.
pub(super) struct Normalised {
    pub centre: Point,
    pub extent: f64,
    /// `mean F Fᵀ`.
    pub values: SMatrix<f64, 10, 10>,
    /// `mean ∇F ∇Fᵀ`.
    pub gradients: SMatrix<f64, 10, 10>,
    /// `mean ∇F · n`.
    pub along_normals: SMatrix<f64, 10, 1>,
}

const BINOMIAL: [[f64; 5]; 5] = [
    [1.0, 0.0, 0.0, 0.0, 0.0],
    [1.0, 1.0, 0.0, 0.0, 0.0],
    [1.0, 2.0, 1.0, 0.0, 0.0],
    [1.0, 3.0, 3.0, 1.0, 0.0],
    [1.0, 4.0, 6.0, 4.0, 1.0],
];

fn sum(a: [usize; 3], b: [usize; 3]) -> [usize; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// `∂/∂axis` of a member of F: factor and exponents; `None` where it vanishes.
fn slope(a: usize, axis: usize) -> Option<(f64, [usize; 3])> {
    let mut exponents = BASIS[a];
    let factor = exponents[axis];
    exponents[axis] = factor.checked_sub(1)?;
    Some((factor as f64, exponents))
}

fn mean_of_slopes(a: usize, b: usize, axis: usize, mean: impl Fn([usize; 3]) -> f64) -> f64 {
    match (slope(a, axis), slope(b, axis)) {
        (Some((s, p)), Some((t, q))) => s * t * mean(sum(p, q)),
        _ => 0.0,
    }
}

fn mean_along_normals(a: usize, normal: Vector, first: Matrix3<f64>) -> f64 {
    let along = |axis: usize| match slope(a, axis) {
        None => 0.0,
        Some((factor, exponents)) => match exponents.iter().position(|&e| e == 1) {
            Some(variable) => factor * first[(variable, axis)],
            None => factor * normal[axis],
        },
    };
    (0..3).map(along).sum()
}

#[cfg(test)]
mod tests {
    use rand::RngExt;

    use super::*;
    use crate::context::Context;

    fn triangles(count: usize, offset: f64) -> Vec<Triangle> {
        let mut rng = Context::new(5).rng;
        let mut draw = || Point::from(Vector::from_fn(|_, _| offset + rng.random_range(-1.0..1.0)));
        let mut triangle = || Triangle::new([draw(), draw(), draw()]);
        (0..count).map(|_| triangle()).collect()
    }

    fn moments(of: &[Triangle], origin: Point) -> Moments {
        let mut moments = Moments::about(origin);
        moments.add(of);
        moments
    }

    #[test]
    fn parts_add_up_to_the_whole_wherever_they_were_taken() {
        let all = triangles(20, 0.5);
        let one = moments(&all[..7], Point::new(0.5, 0.4, 0.3));
        let joined = one.joined(&moments(&all[7..], Point::origin()));
        let whole = moments(&all, joined.origin);
        for (here, there) in joined.sums.iter().zip(whole.sums) {
            assert!((here - there).abs() < 1e-12 * whole.area(), "{here} {there}");
        }
        assert!((joined.oriented_first - whole.oriented_first).norm() < 1e-12);
        assert!((joined.centroid() - joined.origin).norm() < 1e-13);
    }

    #[test]
    fn the_mean_square_of_a_quadric_and_its_gradient_are_quadratic_forms() {
        let all = triangles(10, 3.0);
        let region = moments(&all, Point::new(3.0, 3.0, 3.0)).normalised().unwrap();
        let c = SMatrix::<f64, 10, 1>::from_fn(|i, _| ((i * 7 + 3) % 5) as f64 - 1.7);
        let quadric = crate::surface::Quadric { coefficients: c.into() };
        let (mut area, mut value, mut steep, mut along) = (0.0, 0.0, 0.0, 0.0);
        for &Triangle { corners, normal, area: size } in &all {
            area += size;
            quadrature::each(corners, |weight, point| {
                let point = Point::from((point - region.centre) / region.extent);
                let gradient = quadric.gradient(point);
                value += weight * size * quadric.value(point).powi(2);
                steep += weight * size * gradient.norm_squared();
                along += weight * size * gradient.dot(&normal);
            });
        }
        let close = |here: f64, there: f64| (here - there / area).abs() < 1e-10 * here.abs();
        assert!(close((c.transpose() * region.values * c)[0], value));
        assert!(close((c.transpose() * region.gradients * c)[0], steep));
        assert!(close(c.dot(&region.along_normals), along));
    }
}
