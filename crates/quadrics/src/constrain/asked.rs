//! What the user asks for, as proposals, and whether the surfaces can have it.

use super::contact;
use super::demands::{Demand, Demands, Fixed, of_pairs};
use super::equation::Equation;
use super::measure::{has_axis, radius};
use super::pattern;
use super::proposal::{Part, Proposal};
use crate::math::{Point, Unit, Vector};
use crate::surface::{Condensed, Surface, direction};

/// Relations and values that the user wants and that are no classes of equal things, and the
/// demands that the directions do not allow.
pub fn proposals<'a>(part: &Part<'a>) -> (Vec<Proposal>, Vec<&'a Demand>) {
    let demands = part.view.demands;
    let (mut found, mut vain) = (Vec::new(), Vec::new());
    for demand in demands.forced().filter(|demand| demand.kind != "orthogonal") {
        match relation(part, &demand.kind, &demand.regions) {
            Some(proposal) => found.push(Proposal { forced: true, ..proposal }),
            None => vain.push(demand),
        }
    }
    for fixed in &demands.fixed {
        let equations = equations(&part.items[fixed.region].surface, fixed);
        let proposal = Proposal::new("fixed", vec![fixed.region], equations, 1.0);
        found.push(Proposal { forced: true, ..proposal });
    }
    (found, vain)
}

/// A relation by its name; `None` where the directions do not allow it.
fn relation(part: &Part, kind: &str, surfaces: &[usize]) -> Option<Proposal> {
    let equal = |kind, of: fn([usize; 4]) -> Equation| {
        let first = &surfaces[..2];
        let each = |pair: &[usize]| of([first[0], first[1], pair[0], pair[1]]);
        let equations = surfaces[2..].chunks_exact(2).map(each).collect();
        Some(Proposal::new(kind, surfaces.to_vec(), equations, 1.0))
    };
    match kind {
        "tangent" => contact::tangent(part, surfaces[0], surfaces[1]),
        "center_on_axis" => contact::center_on_axis(part, surfaces[0], surfaces[1]),
        "axis_in_plane" => contact::axis_in_plane(part, surfaces[0], surfaces[1]),
        "pattern" => pattern::among(part, surfaces),
        "equal_distance" => equal("equal_distance", Equation::EqualDistance),
        "equal_dihedral" => equal("equal_dihedral", Equation::EqualAngle),
        "symmetric" => super::mirror::among(part, surfaces),
        _ => None,
    }
}

fn equations(surface: &Surface, fixed: &Fixed) -> Vec<Equation> {
    let i = fixed.region;
    if let Some(size) = fixed.size() {
        return vec![Equation::Size { surface: i, size, value: fixed.value[0] }];
    }
    let vector = Vector::from_row_slice(&fixed.value);
    if ["axis", "normal"].contains(&&*fixed.parameter) {
        let direction = Unit::new_normalize(vector);
        return [0, 1].map(|part| Equation::Towards { surface: i, direction, part }).to_vec();
    }
    let parts = if matches!(surface, Surface::Cylinder(_)) { 2 } else { 3 };
    let point = Point::from(vector);
    (0..parts).map(|part| Equation::Through { surface: i, point, part }).collect()
}

/// Whether the surfaces can have what the user asks for.
///
/// # Errors
/// The first demand that they cannot, in words.
pub fn check(items: &[Condensed], demands: &Demands) -> Result<(), String> {
    demands.relations.iter().try_for_each(|demand| of_right_type(items, demand))?;
    demands.fixed.iter().try_for_each(|fixed| has(&items[fixed.region].surface, fixed))
}

fn of_right_type(items: &[Condensed], demand: &Demand) -> Result<(), String> {
    let kind = demand.kind.as_str();
    let count = demand.regions.len();
    let takes = |count: usize, what: &str| Err(format!("{kind} takes {what}, not {count} regions"));
    let exactly_two = ["orthogonal", "tangent", "center_on_axis", "axis_in_plane"].contains(&kind);
    if exactly_two && count != 2 {
        return takes(count, "two regions");
    }
    if of_pairs(kind) && (count < 4 || count % 2 == 1) {
        return takes(count, "two or more pairs");
    }
    if count < if kind == "pattern" { 3 } else { 2 } {
        return takes(count, if kind == "pattern" { "three or more" } else { "two or more" });
    }
    for (at, &i) in demand.regions.iter().enumerate() {
        let surface = &items[i].surface;
        let (fits, wanted) = fits(kind, at, surface);
        if !fits {
            let name = surface.class_name(1.0);
            return Err(format!("{kind} takes {wanted}, but region {{{i}}} is a {name}"));
        }
    }
    Ok(())
}

/// Whether a surface may stand at that place of a relation, and what may.
fn fits(kind: &str, at: usize, surface: &Surface) -> (bool, &'static str) {
    let plane = matches!(surface, Surface::Plane(_));
    let sphere = matches!(surface, Surface::Sphere(_));
    let cone = matches!(surface, Surface::Cone(_));
    let axis = has_axis(surface);
    match kind {
        "parallel" | "orthogonal" | "equal_dihedral" => {
            (direction(surface).is_some(), "surfaces with a normal or an axis")
        }
        "coaxial" | "pattern" => (axis, "surfaces with an axis"),
        "concentric" => (sphere || matches!(surface, Surface::Torus(_)), "spheres and tori"),
        "coplanar" | "equal_distance" => (plane, "planes"),
        "equal_radius" => (radius(surface).is_some(), "cylinders, spheres and tori"),
        "equal_angle" => (cone, "cones"),
        "center_on_axis" if at == 0 => (sphere, "a sphere, then a surface with an axis"),
        "center_on_axis" => (axis, "a sphere, then a surface with an axis"),
        "axis_in_plane" if at == 0 => (axis, "a surface with an axis, then a plane"),
        "axis_in_plane" => (plane, "a surface with an axis, then a plane"),
        _ => (true, "any"),
    }
}

fn has(surface: &Surface, fixed: &Fixed) -> Result<(), String> {
    let known = match (fixed.parameter.as_str(), surface) {
        ("axis", surface) => has_axis(surface),
        ("normal", Surface::Plane(_))
        | ("center", Surface::Sphere(_) | Surface::Torus(_))
        | ("point", Surface::Cylinder(_)) => true,
        _ => fixed.size().is_some_and(|size| size.of(surface).is_some()),
    };
    let (region, name) = (fixed.region, surface.class_name(1.0));
    let parameter = &fixed.parameter;
    if known {
        Ok(())
    } else {
        Err(format!("region {{{region}}} is a {name}: it has no {parameter}"))
    }
}
