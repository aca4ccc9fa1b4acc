//! A height field of second degree over the plane of some points: a small piece of any smooth surface.

use nalgebra::{Cholesky, Const, SMatrix, SVector};

use super::start::{self, Samples};
use super::{Surface, centroid};
use crate::math::{Point, Unit, Vector, frame};

/// Heights over a plane as a polynomial of second degree.
pub struct HeightField {
    base: Base,
    coefficients: SVector<f64, 6>,
    normal_matrix: Cholesky<f64, Const<6>>,
}

/// The plane under the heights.
struct Base {
    center: Point,
    axes: [Unit; 2],
    up: Unit,
    /// Root mean square extent of the points: coordinates are divided by it.
    scale: f64,
}

impl HeightField {
    /// Unknowns of a fit.
    pub const PARAMETERS: usize = 6;

    /// By least squares; `None` without points. A dozen or more are wanted.
    pub fn fit(points: &[Point]) -> Option<Self> {
        let base = Base::of(points)?;
        let mut matrix = SMatrix::<f64, 6, 6>::zeros();
        let mut right = SVector::<f64, 6>::zeros();
        for p in points {
            let d = p - base.center;
            let row = base.row(d);
            matrix += row * row.transpose();
            right += row * base.up.dot(&d);
        }
        let normal_matrix = matrix.cholesky()?;
        Some(Self { base, coefficients: normal_matrix.solve(&right), normal_matrix })
    }

    /// How far a point is above the field, along [`Self::up`].
    pub fn above(&self, point: Point) -> f64 {
        let d = point - self.base.center;
        self.base.up.dot(&d) - self.coefficients.dot(&self.base.row(d))
    }

    /// Variance of the height below a point, where that of the heights which were fitted is 1.
    pub fn variance(&self, point: Point) -> f64 {
        let row = self.base.row(point - self.base.center);
        row.dot(&self.normal_matrix.solve(&row))
    }

    /// The direction of heights.
    pub fn up(&self) -> Unit {
        self.base.up
    }
}

impl Base {
    fn of(points: &[Point]) -> Option<Self> {
        let Surface::Plane(plane) =
            start::plane(Samples { points, barycentres: &[], normals: &[] })?
        else {
            return None;
        };
        let center = centroid(points)?;
        let spread = points.iter().map(|p| (p - center).norm_squared()).sum::<f64>();
        let (u, v) = frame(&plane.normal);
        let scale = (spread / points.len() as f64).sqrt();
        Some(Self { center, axes: [u, v], up: plane.normal, scale })
    }

    fn row(&self, d: Vector) -> SVector<f64, 6> {
        let [x, y] = self.axes.map(|axis| axis.dot(&d) / self.scale);
        SVector::from([1.0, x, y, x * x, x * y, y * y])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_saddle_is_found_wherever_it_lies() {
        let at = |x: f64, y: f64| Point::new(100.0 + x, y, 7.0 + 0.1 * x * x - 0.2 * x * y);
        let points: Vec<Point> =
            (0..36).map(|i| at(f64::from(i % 6) - 2.5, f64::from(i / 6) - 2.5)).collect();
        let field = HeightField::fit(&points).unwrap();
        assert!(points.iter().all(|p| field.above(*p).abs() < 0.02));
        let lifted = points[14] + field.up().into_inner();
        assert!((field.above(lifted) - field.above(points[14]) - 1.0).abs() < 1e-9);
        assert!(HeightField::fit(&[]).is_none());
    }

    #[test]
    fn the_variance_at_the_points_sums_to_the_number_of_unknowns() {
        let at = |i: i32| Point::new(f64::from(i % 7), f64::from(i / 7), f64::from(i * i % 11));
        let points: Vec<Point> = (0..49).map(at).collect();
        let field = HeightField::fit(&points).unwrap();
        let sum: f64 = points.iter().map(|&p| field.variance(p)).sum();
        assert!((sum - HeightField::PARAMETERS as f64).abs() < 1e-9, "{sum}");
        assert!(field.variance(Point::new(40.0, 0.0, 0.0)) > 1.0);
    }
}
