//! Planes.

use super::{Quadric, Shape};
use crate::math::{Point, Similarity, Unit};

/// The points `x` with `normal · x = offset`.
#[derive(Debug, Clone, PartialEq)]
pub struct Plane {
    /// Unit normal, outward.
    pub normal: Unit,
    /// Signed distance of the plane from the origin along its normal.
    pub offset: f64,
}

impl Plane {
    /// The plane through a point.
    pub fn through(point: Point, normal: Unit) -> Self {
        Self { normal, offset: normal.dot(&point.coords) }
    }

    /// As ten coefficients.
    pub fn quadric(&self) -> Quadric {
        Quadric::from_parts(-self.offset, self.normal.into_inner(), nalgebra::Matrix3::zeros())
    }

    /// The same plane in another frame.
    pub fn transformed(&self, by: &Similarity) -> Self {
        let foot = by * Point::from(self.normal.into_inner() * self.offset);
        Self::through(foot, by.isometry.rotation * self.normal)
    }
}

impl Shape for Plane {
    const PARAMETERS: usize = 3;

    fn distance(&self, point: Point) -> f64 {
        self.normal.dot(&point.coords) - self.offset
    }

    fn normal(&self, _point: Point) -> Option<Unit> {
        Some(self.normal)
    }
}
