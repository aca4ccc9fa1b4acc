//! Relations as the result tells them, with what they were before and after.

use super::admit::Verdict;
use super::classes::Classes;
use super::demands::Demand;
use super::equation::{Equation, place};
use super::gate;
use super::proposal::{Part, Proposal};
use super::refusals::NEAR;
use super::system::System;
use super::weigh::Outcome;
use crate::math::{Point, Unit, Vector};
use crate::surface::direction;

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
pub fn told(verdict: &Verdict, count: usize, forced: bool) -> (&'static str, String) {
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
            // A chord and the angle that it is seen at have one centre.
            let chord = flat(at(proposal.surfaces[1]) - first);
            let middle = chord / 2.0 + axis.cross(&chord) / (2.0 * (turn / 2.0).tan());
            let center = if around { at(from[0]) } else { first + middle };
            let places = (std::f64::consts::TAU / turn).round() as usize;
            vec![
                count,
                ("places", Value::Count(places)),
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
