//! General quadrics: `c · [1, x, y, z, x², xy, xz, y², yz, z²] = 0` (paper, section 3.1).

use nalgebra::Matrix3;

use super::Shape;
use crate::math::{Point, Similarity, Unit, Vector};

/// A quadric by its ten coefficients.
#[derive(Debug, Clone, PartialEq)]
pub struct Quadric {
    /// `c`, in the paper's order.
    pub coefficients: [f64; 10],
}

/// Newton steps of the orthogonal projection; it stops earlier when it has converged.
const PROJECTION_STEPS: usize = 60;

impl Quadric {
    /// `constant + linear · x + x · form x = 0`, with a symmetric form.
    pub fn from_parts(constant: f64, linear: Vector, form: Matrix3<f64>) -> Self {
        let mixed = |i, j| form[(i, j)] + form[(j, i)];
        Self {
            coefficients: [
                constant,
                linear.x,
                linear.y,
                linear.z,
                form[(0, 0)],
                mixed(0, 1),
                mixed(0, 2),
                form[(1, 1)],
                mixed(1, 2),
                form[(2, 2)],
            ],
        }
    }

    /// `(x - center) · form (x - center) + level = 0`.
    pub fn about(center: Point, level: f64, form: Matrix3<f64>) -> Self {
        let pull = form * center.coords;
        Self::from_parts(level + center.coords.dot(&pull), pull * -2.0, form)
    }

    /// Constant, linear vector and symmetric form.
    pub fn parts(&self) -> (f64, Vector, Matrix3<f64>) {
        let c = &self.coefficients;
        let form = Matrix3::new(
            c[4],
            c[5] / 2.0,
            c[6] / 2.0,
            c[5] / 2.0,
            c[7],
            c[8] / 2.0,
            c[6] / 2.0,
            c[8] / 2.0,
            c[9],
        );
        (c[0], Vector::new(c[1], c[2], c[3]), form)
    }

    /// `f(x)`.
    pub fn value(&self, point: Point) -> f64 {
        let (constant, linear, form) = self.parts();
        constant + point.coords.dot(&(linear + form * point.coords))
    }

    /// `∇f(x)`.
    pub fn gradient(&self, point: Point) -> Vector {
        let (_, linear, form) = self.parts();
        linear + form * point.coords * 2.0
    }

    /// The same surface with the opposite side outside.
    pub fn flipped(&self) -> Self {
        Self { coefficients: self.coefficients.map(|c| -c) }
    }

    /// The same quadric in another frame.
    pub fn transformed(&self, by: &Similarity) -> Self {
        let (constant, linear, form) = self.parts();
        let back = by.inverse();
        let turn = back.isometry.rotation.to_rotation_matrix();
        let turn = turn.matrix() * back.scaling();
        let shift = back.isometry.translation.vector;
        let form_there = turn.transpose() * form * turn;
        let linear_there = turn.transpose() * (linear + form * shift * 2.0);
        let constant_there = constant + shift.dot(&(linear + form * shift));
        Self::from_parts(constant_there, linear_there, form_there)
    }

    /// Ready to be asked about many points.
    pub fn principal(&self) -> Principal<'_> {
        let eigen = self.parts().2.symmetric_eigen();
        Principal { quadric: self, curvatures: eigen.eigenvalues, axes: eigen.eigenvectors }
    }
}

/// A quadric with the principal axes of its form, which the way to the nearest point goes along.
pub struct Principal<'a> {
    quadric: &'a Quadric,
    curvatures: Vector,
    axes: Matrix3<f64>,
}

impl Principal<'_> {
    /// The nearest point, by Newton's method on the multiplier inside a shrinking bracket.
    ///
    /// `x(t) = (I + tA)⁻¹ (p - t b/2)`; where `I + tA` is positive definite `f(x(t))` falls with
    /// `t`, and its root is the globally nearest point.
    fn foot(&self, point: Point) -> Option<Point> {
        let (values, axes) = (self.curvatures, self.axes);
        // Seen from the point itself, so that parts far from the origin lose no digits.
        let level = self.quadric.value(point);
        let half = axes.transpose() * self.quadric.gradient(point) / 2.0;
        let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
        for &value in values.iter() {
            if value > 1e-300 {
                low = low.max(-1.0 / value);
            } else if value < -1e-300 {
                high = high.min(-1.0 / value);
            }
        }
        let mut t = 0.0;
        let mut foot = Vector::zeros();
        for _ in 0..PROJECTION_STEPS {
            let mut f = level;
            let mut rate = 0.0;
            let mut steepness = 0.0;
            for i in 0..3 {
                let stretch = 1.0 + t * values[i];
                foot[i] = -t * half[i] / stretch;
                let slope = foot[i] * values[i] + half[i];
                f += foot[i] * (slope + half[i]);
                rate -= 2.0 * slope * slope / stretch;
                steepness += slope * slope;
            }
            if f.abs() <= 1e-14 * level.abs() || steepness == 0.0 {
                break;
            }
            if f > 0.0 {
                low = t
            } else {
                high = t
            }
            let newton = t - f / rate;
            let next = if newton > low && newton < high {
                newton
            } else if low.is_finite() && high.is_finite() {
                (low + high) / 2.0
            } else {
                2.0 * t + (f / steepness).signum() * f64::MIN_POSITIVE
            };
            if (next - t).abs() <= 1e-15 * t.abs() || !next.is_finite() {
                break;
            }
            t = next;
        }
        let foot = point + axes * foot;
        foot.coords.iter().all(|c| c.is_finite()).then_some(foot)
    }
}

impl Shape for Principal<'_> {
    const PARAMETERS: usize = Quadric::PARAMETERS;

    fn distance(&self, point: Point) -> f64 {
        let far = self.foot(point).map_or(0.0, |foot| (point - foot).norm());
        far.copysign(self.quadric.value(point))
    }

    fn normal(&self, point: Point) -> Option<Unit> {
        Unit::try_new(self.quadric.gradient(self.foot(point)?), f64::MIN_POSITIVE)
    }

    fn project(&self, point: Point) -> Option<Point> {
        self.foot(point)
    }
}

impl Shape for Quadric {
    const PARAMETERS: usize = 9;

    fn distance(&self, point: Point) -> f64 {
        self.principal().distance(point)
    }

    fn normal(&self, point: Point) -> Option<Unit> {
        self.principal().normal(point)
    }

    fn project(&self, point: Point) -> Option<Point> {
        self.principal().project(point)
    }
}
