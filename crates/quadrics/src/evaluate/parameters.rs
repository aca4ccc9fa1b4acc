//! Errors of the parameters of a surface of the right type.

use crate::math::{Point, Unit, Vector};
use crate::surface::Surface;
use crate::surface::kind::{Class, Kind, kind};

/// Errors by name; `middle` is the centroid of the true region.
///
/// | name | is |
/// | --- | --- |
/// | `axis_deg` | angle between normals or axes, the sign aside |
/// | `flipped` | 1 where the sign of a plane's normal or a cone's axis is wrong |
/// | `radius` | relative error, the worst of several radii or semi-axes |
/// | `half_angle_deg` | difference of half angles |
/// | `position` | in sizes of the part: of centre or apex, or of axis or plane at the region |
pub fn parameter_errors(
    found: &Surface,
    truth: &Surface,
    middle: Vector,
    size: f64,
) -> Vec<(&'static str, f64)> {
    match (found, truth) {
        (Surface::Plane(f), Surface::Plane(t)) => {
            let off = (f.normal.dot(&middle) - f.offset).abs();
            vec![angle(&f.normal, &t.normal), flip(&f.normal, &t.normal), ("position", off / size)]
        }
        (Surface::Sphere(f), Surface::Sphere(t)) => {
            vec![("radius", relative(f.radius, t.radius)), apart(f.center, t.center, size)]
        }
        (Surface::Cylinder(f), Surface::Cylinder(t)) => {
            let foot = t.point + t.axis.into_inner() * t.axis.dot(&(Point::from(middle) - t.point));
            let off = (foot - f.point).cross(&f.axis).norm();
            let radius = relative(f.radius, t.radius);
            vec![angle(&f.axis, &t.axis), ("radius", radius), ("position", off / size)]
        }
        (Surface::Cone(f), Surface::Cone(t)) => {
            let half = (f.half_angle - t.half_angle).to_degrees().abs();
            let direction = [angle(&f.axis, &t.axis), flip(&f.axis, &t.axis)];
            [&direction[..], &[("half_angle_deg", half), apart(f.apex, t.apex, size)]].concat()
        }
        (Surface::Torus(f), Surface::Torus(t)) => {
            let major = relative(f.major_radius.abs(), t.major_radius.abs());
            let radius = major.max(relative(f.minor_radius, t.minor_radius));
            vec![angle(&f.axis, &t.axis), ("radius", radius), apart(f.center, t.center, size)]
        }
        (Surface::Quadric(f), Surface::Quadric(t)) => {
            of_quadrics(&kind(f, size), &kind(t, size), size)
        }
        _ => Vec::new(),
    }
}

/// Semi-axes, sorted, and centres; what a class has not is left out.
fn of_quadrics(found: &Kind, truth: &Kind, size: f64) -> Vec<(&'static str, f64)> {
    let mut errors = Vec::new();
    let sorted = |kind: &Kind| {
        let mut axes = kind.semi_axes.clone();
        axes.sort_by(f64::total_cmp);
        axes
    };
    let (one, two) = (sorted(found), sorted(truth));
    if !one.is_empty() && one.len() == two.len() {
        let each = one.iter().zip(&two).map(|(f, t)| relative(*f, *t));
        errors.push(("radius", each.fold(0.0, f64::max)));
    }
    if let (Some(f), Some(t)) = (found.center, truth.center) {
        let mut offset = f - t;
        if matches!(truth.class, Class::EllipticCylinder | Class::HyperbolicCylinder) {
            // Any point of the axis is a centre.
            let along = truth.axes[2].into_inner();
            offset -= along * along.dot(&offset);
        }
        errors.push(("position", offset.norm() / size));
    }
    errors
}

fn angle(found: &Unit, truth: &Unit) -> (&'static str, f64) {
    let (sine, cosine) = (found.cross(truth).norm(), found.dot(truth).abs());
    ("axis_deg", sine.atan2(cosine).to_degrees())
}

fn flip(found: &Unit, truth: &Unit) -> (&'static str, f64) {
    ("flipped", f64::from(u8::from(found.dot(truth) < 0.0)))
}

fn relative(found: f64, truth: f64) -> f64 {
    (found / truth - 1.0).abs()
}

fn apart(found: Point, truth: Point, size: f64) -> (&'static str, f64) {
    ("position", (found - truth).norm() / size)
}
