//! Contact: tangent surfaces, centres on axes, axes in planes.

use super::equation::{Equation, spine};
use super::places::{AREA, LENGTH};
use super::proposal::{Part, Proposal};
use crate::surface::Surface;

/// All that neighbours and chance suggest.
pub fn proposals(part: &Part) -> Vec<Proposal> {
    let mut found = Vec::new();
    for (i, neighbours) in part.neighbours.iter().enumerate() {
        found.extend(neighbours.iter().filter(|&&j| i < j).filter_map(|&j| tangent(part, i, j)));
    }
    let is_sphere = |i: &usize| matches!(part.surfaces[*i], Surface::Sphere(_));
    let (lines, planes) = (part.lines(), part.planes());
    let mut seen = Vec::new();
    for i in (0..part.surfaces.len()).filter(is_sphere) {
        let class = part.classes.center[i];
        if !seen.contains(&class) {
            seen.push(class);
            found.extend(lines.iter().filter_map(|&j| center_on_axis(part, i, j)));
        }
    }
    let pairs = lines.iter().flat_map(|&i| planes.iter().map(move |&j| (i, j)));
    let held: Vec<Proposal> = pairs.filter_map(|(i, j)| axis_in_plane(part, i, j)).collect();
    // Among so many pairs some agree by chance.
    let chance = -(held.len().max(1) as f64).ln();
    found.extend(held.into_iter().map(|p| Proposal { before: chance, ..p }));
    found
}

/// Two surfaces that touch along their border; which rolls along which does not matter.
pub fn tangent(part: &Part, i: usize, j: usize) -> Option<Proposal> {
    let (rolling, other) = if rolls(part, i, j) {
        (i, j)
    } else if rolls(part, j, i) {
        (j, i)
    } else {
        return None;
    };
    let (point, radius) = spine(&part.surfaces[rolling])?;
    let side = part.surfaces[other].distance(point)?.signum();
    let equation = Equation::Touch { spine: rolling, other, side };
    Some(Proposal::new("tangent", vec![i, j], vec![equation], radius))
}

/// Whether the distance of the spine of the first from the second is the same all along.
fn rolls(part: &Part, i: usize, j: usize) -> bool {
    let same_line = part.classes.line[i] == part.classes.line[j];
    match (&part.surfaces[i], &part.surfaces[j]) {
        (Surface::Cylinder(_), Surface::Plane(_)) => part.right(i, j),
        (Surface::Cylinder(_), Surface::Cylinder(_)) => part.parallel(i, j) && !same_line,
        (Surface::Torus(_), Surface::Plane(_)) => part.parallel(i, j),
        (Surface::Torus(_), Surface::Cylinder(_) | Surface::Cone(_)) => {
            part.parallel(i, j) && same_line
        }
        (Surface::Sphere(_), Surface::Plane(_)) => true,
        _ => false,
    }
}

/// A sphere's centre on an axis.
pub fn center_on_axis(part: &Part, sphere: usize, axis: usize) -> Option<Proposal> {
    let Surface::Sphere(_) = part.surfaces[sphere] else { return None };
    part.view.line_of(axis)?;
    let on = |part| Equation::OnAxis { center: sphere, axis, part };
    Some(Proposal::new("center_on_axis", vec![sphere, axis], vec![on(0), on(1)], AREA.sqrt()))
}

/// An axis in a plane.
pub fn axis_in_plane(part: &Part, axis: usize, plane: usize) -> Option<Proposal> {
    let Surface::Plane(_) = part.surfaces[plane] else { return None };
    part.view.line_of(axis)?;
    if !part.right(axis, plane) {
        return None;
    }
    let terms = vec![(axis, 1.0), (plane, -1.0)];
    let equation = Equation::Heights { along: plane, terms, sum: 0.0 };
    Some(Proposal::new("axis_in_plane", vec![axis, plane], vec![equation], LENGTH))
}
