//! Circular cones.

use nalgebra::Matrix3;

use super::{Quadric, Shape};
use crate::math::{Point, Similarity, Unit, Vector};

/// One nappe of a circular cone.
#[derive(Debug, Clone, PartialEq)]
pub struct Cone {
    /// Where the nappe ends.
    pub apex: Point,
    /// From the apex into the nappe.
    pub axis: Unit,
    /// Angle between axis and surface, in radians, between 0 and π/2.
    pub half_angle: f64,
}

impl Cone {
    /// As ten coefficients (of both nappes).
    pub fn quadric(&self) -> Quadric {
        let axis = self.axis.into_inner();
        let cosine = self.half_angle.cos();
        // r² cos² = h² sin², with r² + h² = |x|².
        let form = Matrix3::identity() * (cosine * cosine) - axis * axis.transpose();
        Quadric::about(self.apex, 0.0, form)
    }

    /// The same cone in another frame.
    pub fn transformed(&self, by: &Similarity) -> Self {
        Self { apex: by * self.apex, axis: by.isometry.rotation * self.axis, ..*self }
    }

    /// Height above the apex, and the way from the axis to the point.
    fn height_and_radial(&self, point: Point) -> (f64, Vector) {
        let offset = point - self.apex;
        let height = self.axis.dot(&offset);
        (height, offset - self.axis.into_inner() * height)
    }
}

impl Shape for Cone {
    const PARAMETERS: usize = 6;

    fn distance(&self, point: Point) -> f64 {
        let (height, radial) = self.height_and_radial(point);
        let (sine, cosine) = self.half_angle.sin_cos();
        let radius = radial.norm();
        // Behind the apex, where no generator is at right angles, the apex is nearest.
        if height * cosine + radius * sine < 0.0 {
            return height.hypot(radius);
        }
        radius * cosine - height * sine
    }

    fn normal(&self, point: Point) -> Option<Unit> {
        let (height, radial) = self.height_and_radial(point);
        let (sine, cosine) = self.half_angle.sin_cos();
        if height * cosine + radial.norm() * sine < 0.0 {
            return Unit::try_new(point - self.apex, f64::MIN_POSITIVE);
        }
        let radial = Unit::try_new(radial, f64::MIN_POSITIVE)?;
        Some(Unit::new_unchecked(radial.into_inner() * cosine - self.axis.into_inner() * sine))
    }
}
