//! Tori.

use super::Shape;
use crate::math::{Point, Similarity, Unit, Vector};

/// The points at one distance from a circle, the spine. A torus whose spine is narrower than that cuts
/// itself and has two sheets: the outer one is told by a positive radius of the spine, the inner one, a
/// lemon about the axis (barrel rollers, crowned pulleys), by a negative one.
#[derive(Debug, Clone, PartialEq)]
pub struct Torus {
    /// Centre of the spine.
    pub center: Point,
    /// Normal of the spine's plane.
    pub axis: Unit,
    /// Radius of the spine; negative for the inner sheet.
    pub major_radius: f64,
    /// Distance of the surface from the spine, positive.
    pub minor_radius: f64,
}

impl Torus {
    /// Whether it cuts itself, by more than what the fit of a ring that closes its hole may do.
    pub fn cuts_itself(&self) -> bool {
        self.minor_radius > self.major_radius * 1.02
    }

    /// The same torus in another frame.
    pub fn transformed(&self, by: &Similarity) -> Self {
        Self {
            center: by * self.center,
            axis: by.isometry.rotation * self.axis,
            major_radius: by.scaling() * self.major_radius,
            minor_radius: by.scaling() * self.minor_radius,
        }
    }

    /// From the nearest point of the spine to a point; `None` on the axis.
    fn off_spine(&self, point: Point) -> Option<Vector> {
        let offset = point - self.center;
        let radial = offset - self.axis.into_inner() * self.axis.dot(&offset);
        let outward = Unit::try_new(radial, f64::MIN_POSITIVE)?;
        Some(offset - outward.into_inner() * self.major_radius)
    }
}

impl Shape for Torus {
    const PARAMETERS: usize = 7;

    fn distance(&self, point: Point) -> f64 {
        let offset = point - self.center;
        let height = self.axis.dot(&offset);
        let radius = (offset.norm_squared() - height * height).max(0.0).sqrt();
        from_spine(radius - self.major_radius, height) - self.minor_radius
    }

    fn normal(&self, point: Point) -> Option<Unit> {
        Unit::try_new(self.off_spine(point)?, f64::MIN_POSITIVE)
    }
}

/// Distance from the spine, across and along the axis. `hypot` would guard against an overflow that
/// lengths do not reach, for more than all the rest costs.
fn from_spine(across: f64, along: f64) -> f64 {
    (across * across + along * along).sqrt()
}
