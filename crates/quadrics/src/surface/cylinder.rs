//! Circular cylinders.

use nalgebra::Matrix3;

use super::{Quadric, Shape};
use crate::math::{Point, Similarity, Unit, Vector};

/// The points at one distance from a line.
#[derive(Debug, Clone, PartialEq)]
pub struct Cylinder {
    /// A point on the axis.
    pub point: Point,
    /// Direction of the axis.
    pub axis: Unit,
    /// The radius, positive.
    pub radius: f64,
}

impl Cylinder {
    /// As ten coefficients.
    pub fn quadric(&self) -> Quadric {
        let axis = self.axis.into_inner();
        let form = Matrix3::identity() - axis * axis.transpose();
        Quadric::about(self.point, -self.radius * self.radius, form)
    }

    /// The same cylinder in another frame.
    pub fn transformed(&self, by: &Similarity) -> Self {
        Self {
            point: by * self.point,
            axis: by.isometry.rotation * self.axis,
            radius: by.scaling() * self.radius,
        }
    }

    /// From the axis to a point, at right angles.
    fn radial(&self, point: Point) -> Vector {
        let offset = point - self.point;
        offset - self.axis.into_inner() * self.axis.dot(&offset)
    }
}

impl Shape for Cylinder {
    const PARAMETERS: usize = 5;

    fn distance(&self, point: Point) -> f64 {
        self.radial(point).norm() - self.radius
    }

    fn normal(&self, point: Point) -> Option<Unit> {
        Unit::try_new(self.radial(point), f64::MIN_POSITIVE)
    }
}
