//! Classes of equal things and right angles, as the result tells them.

use super::admit::Verdict;
use super::classes::Classes;
use super::equation::Equation;
use super::measure::{
    angle, has_axis, lean, off_angle, off_axis, off_center, off_plane, off_radius, radius, tilt,
};
use super::proposal::Part;
use super::refusals::NEAR;
use super::report::{Link, told};
use crate::surface::{Condensed, Surface, direction};

/// Which surfaces can be in a class, and how far two of them are from being in it together.
type Member = fn(&Surface) -> bool;
type Measure = fn(&Surface, &Surface) -> f64;

/// Classes of equal things and right angles, in the order of the stages.
pub fn links(part: &Part, angles: &[(Equation, Verdict)]) -> Vec<Link> {
    let mut links = classes(part);
    for (equation, verdict) in angles {
        let Equation::Orthogonal(a, b) = equation else { continue };
        links.extend(right_angle(part, *a, *b, verdict));
    }
    links
}

fn classes(part: &Part) -> Vec<Link> {
    let Classes { direction: directions, line, center, offset, radius: radii, angle: angles } =
        part.classes;
    let kinds: [(&'static str, &Vec<usize>, Member, Measure); 6] = [
        ("parallel", directions, |s| direction(s).is_some(), tilt),
        ("coaxial", line, has_axis, off_axis),
        ("concentric", center, |s| matches!(s, Surface::Sphere(_) | Surface::Torus(_)), off_center),
        ("coplanar", offset, |s| matches!(s, Surface::Plane(_)), off_plane),
        ("equal_radius", radii, |s| radius(s).is_some(), off_radius),
        ("equal_angle", angles, |s| matches!(s, Surface::Cone(_)), off_angle),
    ];
    let mut links = Vec::new();
    for (kind, class, member, measure) in kinds {
        let groups = groups(class, |i| member(&part.items[*i].surface));
        links.extend(groups.into_iter().map(|members| shared(part, kind, members, measure)));
    }
    links
}

/// One class of equal things.
fn shared(part: &Part, kind: &'static str, surfaces: Vec<usize>, of: Measure) -> Link {
    let worst = |surface: &dyn Fn(usize) -> Surface| {
        let all: Vec<Surface> = surfaces.iter().map(|&i| surface(i)).collect();
        let pairs = all.iter().flat_map(|a| all.iter().map(move |b| (a, b)));
        pairs.map(|(a, b)| of(a, b)).fold(0.0, f64::max)
    };
    let wanted = part.view.demands.joins(kind, &surfaces);
    let most = surfaces.iter().map(|&i| part.view.solution.increase[i]).fold(0.0, f64::max);
    let by = if wanted { "; the user wants it" } else { "" };
    Link {
        kind,
        status: "accepted",
        value: value(kind, &part.surfaces[surfaces[0]]),
        parameters: Vec::new(),
        before: worst(&|i| part.items[i].surface.clone()),
        after: worst(&|i| part.surfaces[i].clone()),
        angular: ["parallel", "equal_angle"].contains(&kind),
        reason: format!(
            "one unknown for {} surfaces; chi-squared of the worst rises by {most:.1} in all{by}",
            surfaces.len()
        ),
        surfaces,
    }
}

/// A right angle between two direction classes: every member of both is named, the surest of each
/// first, whose equation it is.
fn right_angle(part: &Part, a: usize, b: usize, verdict: &Verdict) -> Vec<Link> {
    let (one, other) = (surest(part.items, part.classes, a), surest(part.items, part.classes, b));
    let (Some(&first), Some(&second)) = (one.first(), other.first()) else { return Vec::new() };
    let free = |i: usize| &part.items[i].surface;
    let class = &part.classes.direction;
    let forced = part.view.demands.forced().any(|demand| {
        let ends = [class[demand.regions[0]], class[demand.regions[1]]];
        demand.kind == "orthogonal" && (ends == [a, b] || ends == [b, a])
    });
    let link = |i: usize, j: usize, status, reason| Link {
        kind: "orthogonal",
        surfaces: vec![i, j],
        status,
        value: None,
        parameters: Vec::new(),
        before: lean(free(i), free(j)),
        after: lean(&part.surfaces[i], &part.surfaces[j]),
        angular: true,
        reason,
    };
    let (status, reason) = match verdict {
        Verdict::Refused(_) if lean(free(first), free(second)) > NEAR.to_degrees() => {
            return Vec::new();
        }
        verdict => told(verdict, 1, forced),
    };
    let mut links = vec![link(first, second, status, reason)];
    if status != "refused" {
        for k in 1..one.len().max(other.len()) {
            let (i, j) = (one[k % one.len()], other[k % other.len()]);
            let reason = "follows from parallel and one right angle".to_owned();
            links.push(link(i, j, "implied", reason));
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
