//! How far surfaces are from a relation, in degrees or lengths.

use crate::math::Point;
use crate::surface::{Surface, axis, direction};

/// Radius of a cylinder or sphere, minor radius of a torus.
pub fn radius(surface: &Surface) -> Option<f64> {
    match surface {
        Surface::Cylinder(s) => Some(s.radius),
        Surface::Sphere(s) => Some(s.radius),
        Surface::Torus(s) => Some(s.minor_radius),
        _ => None,
    }
}

/// Half angle of a cone, in degrees.
pub fn angle(surface: &Surface) -> f64 {
    if let Surface::Cone(s) = surface { s.half_angle.to_degrees() } else { 0.0 }
}

/// Angle between directions in degrees, exact for small ones.
pub fn tilt(a: &Surface, b: &Surface) -> f64 {
    let (Some(a), Some(b)) = (direction(a), direction(b)) else { return 0.0 };
    a.cross(&b).norm().atan2(a.dot(&b).abs()).to_degrees()
}

/// Deviation from a right angle, in degrees.
pub fn lean(a: &Surface, b: &Surface) -> f64 {
    let (Some(a), Some(b)) = (direction(a), direction(b)) else { return 0.0 };
    a.dot(&b).abs().min(1.0).asin().to_degrees()
}

/// Distance of one axis' point from the other axis.
pub fn off_axis(a: &Surface, b: &Surface) -> f64 {
    let (Some((p, _)), Some((q, along))) = (axis(a), axis(b)) else { return 0.0 };
    (p - q).cross(&along).norm()
}

fn center(surface: &Surface) -> Option<Point> {
    match surface {
        Surface::Sphere(s) => Some(s.center),
        Surface::Torus(s) => Some(s.center),
        _ => None,
    }
}

/// Distance of two centres.
pub fn off_center(a: &Surface, b: &Surface) -> f64 {
    center(a).zip(center(b)).map_or(0.0, |(p, q)| (p - q).norm())
}

/// Distance of two planes, whichever way they face.
pub fn off_plane(a: &Surface, b: &Surface) -> f64 {
    let (Surface::Plane(a), Surface::Plane(b)) = (a, b) else { return 0.0 };
    (a.offset - b.offset * a.normal.dot(&b.normal).signum()).abs()
}

/// Difference of two radii.
pub fn off_radius(a: &Surface, b: &Surface) -> f64 {
    radius(a).zip(radius(b)).map_or(0.0, |(a, b)| (a - b).abs())
}

/// Difference of two half angles, in degrees.
pub fn off_angle(a: &Surface, b: &Surface) -> f64 {
    (angle(a) - angle(b)).abs()
}

/// Whether a surface has an axis line.
pub fn has_axis(surface: &Surface) -> bool {
    axis(surface).is_some()
}
