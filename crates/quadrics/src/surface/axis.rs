//! What of a surface says a direction: normals of planes and axes.

use super::{Revolved, Surface};
use crate::math::{Point, Unit};

/// A plane's normal, or the axis of a cylinder, cone, torus or quadric of revolution.
pub fn direction(surface: &Surface) -> Option<Unit> {
    match surface {
        Surface::Plane(s) => Some(s.normal),
        _ => axis(surface).map(|(_, direction)| direction),
    }
}

/// A point and the direction of the axis of a cylinder, cone, torus or quadric of revolution.
pub fn axis(surface: &Surface) -> Option<(Point, Unit)> {
    match surface {
        Surface::Cylinder(s) => Some((s.point, s.axis)),
        Surface::Cone(s) => Some((s.apex, s.axis)),
        Surface::Torus(s) => Some((s.center, s.axis)),
        Surface::Quadric(s) => Revolved::of(s).map(|own| (own.point, own.axis)),
        Surface::Plane(_) | Surface::Sphere(_) | Surface::FreeForm => None,
    }
}
