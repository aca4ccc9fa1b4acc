//! Relations as the result tells them, with what they were before and after.

use super::admit::Verdict;
use super::equation::Equation;
use super::system::Classes;
use crate::math::{Point, Unit, Vector};
use crate::surface::{Condensed, Surface, direction};

/// A relation between surfaces, by their positions.
#[derive(Debug, Clone, PartialEq)]
pub struct Link {
    /// Its name in the result files.
    pub kind: &'static str,
    /// Positions of the surfaces.
    pub surfaces: Vec<usize>,
    /// `accepted`, `implied` or `refused`.
    pub status: &'static str,
    /// What is equal: a radius, an angle in degrees.
    pub value: Option<f64>,
    /// Largest deviation of the free fits; degrees, or the unit of the surfaces.
    pub before: f64,
    /// And of the constrained ones.
    pub after: f64,
    /// Whether the deviations and the value are angles.
    pub angular: bool,
    /// Why.
    pub reason: String,
}

/// Everything that holds, in the order of the stages.
pub fn links(
    items: &[Condensed],
    classes: &Classes,
    equations: &[(Equation, Verdict)],
    fitted: &[Surface],
) -> Vec<Link> {
    let free: Vec<&Surface> = items.iter().map(|item| &item.surface).collect();
    let fitted: Vec<&Surface> = fitted.iter().collect();
    let mut links = Vec::new();
    let mut class = |kind, members: Vec<usize>, angular, of: &dyn Fn(&Surface, &Surface) -> f64| {
        let worst = |surfaces: &[&Surface]| {
            let pairs = members.iter().flat_map(|&i| members.iter().map(move |&j| (i, j)));
            pairs.map(|(i, j)| of(surfaces[i], surfaces[j])).fold(0.0, f64::max)
        };
        let (before, after) = (worst(&free), worst(&fitted));
        links.push(Link {
            kind,
            status: "accepted",
            value: value(kind, fitted[members[0]]),
            before,
            after,
            angular,
            reason: format!("one unknown for {} surfaces", members.len()),
            surfaces: members,
        });
    };
    let known = &free;
    let has = |test: fn(&Surface) -> bool| move |i: &usize| test(known[*i]);
    let directed = has(|s| direction(s).is_some());
    let lined = has(|s| matches!(s, Surface::Cylinder(_) | Surface::Cone(_) | Surface::Torus(_)));
    let centred = has(|s| matches!(s, Surface::Sphere(_) | Surface::Torus(_)));
    let flat = has(|s| matches!(s, Surface::Plane(_)));
    let round = has(|s| radius(s).is_some());
    let conical = has(|s| matches!(s, Surface::Cone(_)));
    for members in groups(&classes.direction, directed) {
        class("parallel", members, true, &tilt);
    }
    for members in groups(&classes.line, lined) {
        class("coaxial", members, false, &off_axis);
    }
    for members in groups(&classes.center, centred) {
        class("concentric", members, false, &off_center);
    }
    for members in groups(&classes.offset, flat) {
        class("coplanar", members, false, &off_plane);
    }
    for members in groups(&classes.radius, round) {
        class("equal_radius", members, false, &|a, b| {
            (radius(a).unwrap_or(0.0) - radius(b).unwrap_or(0.0)).abs()
        });
    }
    for members in groups(&classes.angle, conical) {
        class("equal_angle", members, true, &|a, b| (angle(a) - angle(b)).abs());
    }
    for (equation, verdict) in equations {
        let Equation::Orthogonal(a, b) = equation;
        let (status, reason) = match verdict {
            Verdict::Accepted(chi) => ("accepted", format!("chi-squared rises by {chi:.2}")),
            Verdict::Implied => ("implied", "follows from the other relations".to_owned()),
            Verdict::Refused(_) => continue,
        };
        let (one, other) = (surest(items, classes, *a), surest(items, classes, *b));
        if one.is_empty() || other.is_empty() {
            continue;
        }
        // Every member of both is named: the surest of each first, whose equation it is.
        for k in 0..one.len().max(other.len()) {
            let (i, j) = (one[k % one.len()], other[k % other.len()]);
            let (status, reason) = match k {
                0 => (status, reason.clone()),
                _ => ("implied", "follows from parallel and one right angle".to_owned()),
            };
            links.push(Link {
                kind: "orthogonal",
                surfaces: vec![i, j],
                status,
                value: None,
                before: lean(free[i], free[j]),
                after: lean(fitted[i], fitted[j]),
                angular: true,
                reason,
            });
        }
    }
    links
}

/// Members of a direction class, the one whose direction is known best first.
fn surest(items: &[Condensed], classes: &Classes, class: usize) -> Vec<usize> {
    let spread = |i: usize| Some((items[i].direction()?.1.trace(), i));
    let members = (0..items.len()).filter(|i| classes.direction[*i] == class);
    let mut known: Vec<(f64, usize)> = members.filter_map(spread).collect();
    known.sort_by(|a, b| a.0.total_cmp(&b.0));
    known.into_iter().map(|(_, i)| i).collect()
}

/// Classes of more than one surface, of those that can be in one.
fn groups(class: &[usize], member: impl Fn(&usize) -> bool) -> Vec<Vec<usize>> {
    let mut groups: std::collections::BTreeMap<usize, Vec<usize>> = Default::default();
    (0..class.len()).filter(member).for_each(|i| groups.entry(class[i]).or_default().push(i));
    groups.into_values().filter(|members| members.len() > 1).collect()
}

fn value(kind: &str, surface: &Surface) -> Option<f64> {
    match kind {
        "equal_radius" => radius(surface),
        "equal_angle" => Some(angle(surface)),
        _ => None,
    }
}

fn radius(surface: &Surface) -> Option<f64> {
    match surface {
        Surface::Cylinder(s) => Some(s.radius),
        Surface::Sphere(s) => Some(s.radius),
        Surface::Torus(s) => Some(s.minor_radius),
        _ => None,
    }
}

fn angle(surface: &Surface) -> f64 {
    if let Surface::Cone(s) = surface { s.half_angle.to_degrees() } else { 0.0 }
}

/// Angle between directions in degrees, exact for small ones.
fn tilt(a: &Surface, b: &Surface) -> f64 {
    let (Some(a), Some(b)) = (direction(a), direction(b)) else { return 0.0 };
    a.cross(&b).norm().atan2(a.dot(&b).abs()).to_degrees()
}

/// Deviation from a right angle, in degrees.
fn lean(a: &Surface, b: &Surface) -> f64 {
    let (Some(a), Some(b)) = (direction(a), direction(b)) else { return 0.0 };
    a.dot(&b).abs().min(1.0).asin().to_degrees()
}

fn on_axis(surface: &Surface) -> Option<(Point, Unit)> {
    match surface {
        Surface::Cylinder(s) => Some((s.point, s.axis)),
        Surface::Cone(s) => Some((s.apex, s.axis)),
        Surface::Torus(s) => Some((s.center, s.axis)),
        _ => None,
    }
}

/// Distance of one axis' point from the other axis.
fn off_axis(a: &Surface, b: &Surface) -> f64 {
    let (Some((p, _)), Some((q, axis))) = (on_axis(a), on_axis(b)) else { return 0.0 };
    let between: Vector = p - q;
    between.cross(&axis).norm()
}

fn center(surface: &Surface) -> Option<Point> {
    match surface {
        Surface::Sphere(s) => Some(s.center),
        Surface::Torus(s) => Some(s.center),
        _ => None,
    }
}

fn off_center(a: &Surface, b: &Surface) -> f64 {
    center(a).zip(center(b)).map_or(0.0, |(p, q)| (p - q).norm())
}

fn off_plane(a: &Surface, b: &Surface) -> f64 {
    let (Surface::Plane(a), Surface::Plane(b)) = (a, b) else { return 0.0 };
    (a.offset - b.offset * a.normal.dot(&b.normal).signum()).abs()
}
