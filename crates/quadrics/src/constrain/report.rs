//! Relations as the result tells them, with what they were before and after.

use super::admit::Verdict;
use super::classes::Classes;
use super::demands::Demand;
use super::equation::{Equation, place};
use super::gate;
use super::measure::{angle, lean, off_axis, off_center, off_plane, radius, tilt};
use super::proposal::{Part, Proposal};
use super::refusals::NEAR;
use super::system::System;
use super::weigh::Outcome;
use crate::math::{Point, Unit, Vector};
use crate::surface::{Condensed, Surface, direction};

/// A relation between surfaces, by their positions.
#[derive(Debug, Clone, PartialEq)]
pub struct Link {
    /// Its name in the result files.
    pub kind: &'static str,
    /// Positions of the surfaces; pairs one after the other where the relation is one of pairs.
    pub surfaces: Vec<usize>,
    /// `accepted`, `implied` or `refused`.
    pub status: &'static str,
    /// What is equal: a radius, an angle in degrees.
    pub value: Option<f64>,
    /// What describes a pattern or a mirror.
    pub parameters: Vec<(&'static str, Value)>,
    /// Largest deviation of the free fits; degrees, or the unit of the surfaces.
    pub before: f64,
    /// And of the constrained ones.
    pub after: f64,
    /// Whether the deviations and the value are angles.
    pub angular: bool,
    /// Why.
    pub reason: String,
}

/// A parameter of a relation, in the frame of the surfaces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Value {
    /// A number of things.
    Count(usize),
    /// A length.
    Length(f64),
    /// A place.
    Point(Point),
    /// A direction.
    Direction(Unit),
    /// Offset of the plane whose normal stands before it.
    Offset(f64),
}

/// A class of equal things: its kind, members and measure.
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
    let directed: fn(&Surface) -> bool = |s| direction(s).is_some();
    let lined: fn(&Surface) -> bool =
        |s| matches!(s, Surface::Cylinder(_) | Surface::Cone(_) | Surface::Torus(_));
    let centred: fn(&Surface) -> bool = |s| matches!(s, Surface::Sphere(_) | Surface::Torus(_));
    let flat: fn(&Surface) -> bool = |s| matches!(s, Surface::Plane(_));
    let round: fn(&Surface) -> bool = |s| radius(s).is_some();
    let conical: fn(&Surface) -> bool = |s| matches!(s, Surface::Cone(_));
    let in_radius: Measure = |a, b| (radius(a).unwrap_or(0.0) - radius(b).unwrap_or(0.0)).abs();
    let in_angle: Measure = |a, b| (angle(a) - angle(b)).abs();
    let kinds = [
        ("parallel", directions, directed, tilt as Measure),
        ("coaxial", line, lined, off_axis),
        ("concentric", center, centred, off_center),
        ("coplanar", offset, flat, off_plane),
        ("equal_radius", radii, round, in_radius),
        ("equal_angle", angles, conical, in_angle),
    ];
    let of = |(kind, class, member, measure): (
        &'static str,
        &Vec<usize>,
        fn(&Surface) -> bool,
        Measure,
    )| {
        let has = |i: &usize| member(&part.items[*i].surface);
        let link = move |members| shared(part, kind, members, measure);
        groups(class, has).into_iter().map(link).collect::<Vec<_>>()
    };
    kinds.into_iter().flat_map(of).collect()
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

/// Relations that equations say.
pub fn equations(part: &Part, related: &[(Proposal, Outcome)]) -> Vec<Link> {
    let free: Vec<Unit> = part
        .items
        .iter()
        .map(|item| direction(&item.surface).unwrap_or(Vector::z_axis()))
        .collect();
    let apart = System::new(part.items, &Classes::apart(part.items.len()), &free);
    let link = |(proposal, outcome): &(Proposal, Outcome)| {
        let angular = proposal.angular();
        let scale = if angular { 1f64.to_degrees() } else { 1.0 };
        let worst = |system: &System, state| {
            let values = proposal.equations.iter().map(|e| e.value(system, state).abs());
            values.fold(0.0, f64::max) * scale
        };
        let after = worst(part.view.system, &part.view.solution.state);
        let refused = matches!(outcome.verdict, Verdict::Refused(_));
        let near = if angular { NEAR.to_degrees() } else { NEAR };
        // That the next larger distance is another one is no news.
        let told_always = !["equal_distance", "equal_dihedral", "rounded"].contains(&proposal.kind);
        if refused && !proposal.forced && (after > near || !told_always) {
            return None;
        }
        let (status, reason) = told(&outcome.verdict, proposal.equations.len(), proposal.forced);
        Some(Link {
            kind: proposal.kind,
            surfaces: proposal.surfaces.clone(),
            status,
            value: None,
            parameters: parameters(part, proposal),
            before: worst(&apart, &apart.state),
            after,
            angular,
            reason,
        })
    };
    let shown = |(p, _): &&(Proposal, Outcome)| p.kind != "rounded";
    related.iter().filter(shown).filter_map(link).collect()
}

/// A demand that the directions do not allow.
pub fn vain(demand: &Demand) -> Link {
    let kind = super::KINDS.into_iter().find(|kind| *kind == demand.kind).unwrap_or("fixed");
    let reason = "the directions of the surfaces do not allow it".to_owned();
    Link {
        kind,
        surfaces: demand.regions.clone(),
        status: "refused",
        value: None,
        parameters: Vec::new(),
        before: 0.0,
        after: 0.0,
        angular: false,
        reason,
    }
}

/// Status and reason.
fn told(verdict: &Verdict, count: usize, forced: bool) -> (&'static str, String) {
    let limit = gate::limit(count);
    match *verdict {
        Verdict::Accepted(chi) if forced && chi > limit => {
            let against = "the user wants it, the data refuse it";
            ("accepted", format!("{against}: chi-squared rises by {chi:.1}, at most {limit:.1}"))
        }
        Verdict::Accepted(chi) => ("accepted", format!("chi-squared rises by {chi:.2}")),
        Verdict::Implied => ("implied", "follows from the other relations".to_owned()),
        Verdict::Refused(chi) if chi.is_infinite() => {
            ("refused", "contradicts the other relations".to_owned())
        }
        Verdict::Refused(chi) if chi > limit => {
            ("refused", format!("chi-squared would rise by {chi:.1}, at most {limit:.1}"))
        }
        Verdict::Refused(chi) => {
            ("refused", format!("chi-squared {chi:.2} allows it, but chance explains it as well"))
        }
    }
}

fn parameters(part: &Part, proposal: &Proposal) -> Vec<(&'static str, Value)> {
    let at = |i: usize| place(&part.surfaces[i]);
    match (proposal.kind, proposal.equations.first()) {
        ("pattern", Some(Equation::Turned { about, from, turn, .. })) => {
            let count = ("count", Value::Count(proposal.surfaces.len()));
            let Some(axis) = part.way(*about) else { return vec![count] };
            let flat = |way: Vector| way - axis.into_inner() * axis.dot(&way);
            let first = at(proposal.surfaces[0]);
            if *turn == 0.0 {
                let step = flat(at(proposal.surfaces[1]) - first);
                let along = ("axis", Value::Direction(Unit::new_normalize(step)));
                return vec![
                    count,
                    along,
                    ("point", Value::Point(first)),
                    ("pitch", Value::Length(step.norm())),
                ];
            }
            let around = !proposal.surfaces.contains(&from[0]);
            let members = proposal.surfaces.iter().map(|&i| flat(at(i) - first));
            let middle = members.sum::<Vector>() / proposal.surfaces.len() as f64;
            let center = if around { at(from[0]) } else { first + middle };
            vec![
                count,
                ("axis", Value::Direction(axis)),
                ("point", Value::Point(center)),
                ("pitch_radius", Value::Length(flat(first - center).norm())),
            ]
        }
        ("symmetric", Some(Equation::Heights { along, .. })) => {
            let Some(normal) = part.way(*along) else { return Vec::new() };
            let height = |i: usize| normal.dot(&at(i).coords);
            let offset = (height(proposal.surfaces[0]) + height(proposal.surfaces[1])) / 2.0;
            vec![("normal", Value::Direction(normal)), ("offset", Value::Offset(offset))]
        }
        _ => Vec::new(),
    }
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
