//! Symmetry: planes that mirror what lies across them.

use super::equation::{Equation, place};
use super::places::LENGTH;
use super::proposal::{Part, Proposal};
use crate::math::Unit;
use crate::surface::{Surface, direction};

/// Fewest pairs, and the part of all candidates that must have an image.
const FEWEST: usize = 3;
const MOST: f64 = 0.8;
/// Images may lie this many standard deviations, and this part of the size, off.
const REACH: (f64, f64) = (4.0, 2e-3);
/// Radii of images may differ by this fraction: each is judged apart from this.
const ALIKE: f64 = 0.1;

/// Something at a height along the normal of the mirror.
struct Thing {
    surface: usize,
    height: f64,
    unsure: f64,
}

/// The mirror across every direction that has one.
pub fn proposals(part: &Part) -> Vec<Proposal> {
    let mut directions = part.speakers(&part.classes.direction, |s| matches!(s, Surface::Plane(_)));
    directions.sort_unstable();
    directions.into_iter().filter_map(|along| mirror(part, along)).collect()
}

/// The pairs that the user names are images of each other across one plane.
pub fn among(part: &Part, surfaces: &[usize]) -> Option<Proposal> {
    let normal = part.way(surfaces[0])?;
    let first = surfaces[0];
    let planes = matches!(part.surfaces[first], Surface::Plane(_));
    // The normal of the mirror is that of the planes, or leads from one axis to the other.
    let along = if planes {
        first
    } else {
        let way = place(&part.surfaces[surfaces[1]]) - place(&part.surfaces[first]);
        let across = way - normal.into_inner() * normal.dot(&way);
        let across = Unit::try_new(across, 1e-9)?;
        (0..part.surfaces.len()).find(|&i| {
            part.way(i).is_some_and(|d| d.cross(&across).norm() < 0.1) && part.right(i, first)
        })?
    };
    let pairs: Vec<[usize; 2]> = surfaces.chunks_exact(2).map(|p| [p[0], p[1]]).collect();
    Some(proposal(along, part, pairs))
}

fn mirror(part: &Part, along: usize) -> Option<Proposal> {
    let normal = part.way(along)?;
    let things = things(part, along, &normal);
    let mut best: Option<Vec<[usize; 2]>> = None;
    for (at, one) in things.iter().enumerate() {
        for other in &things[at + 1..] {
            if !images(part, &normal, one, other) {
                continue;
            }
            let middle = (one.height + other.height) / 2.0;
            let pairs = pairs(part, &normal, &things, middle);
            if best.as_ref().is_none_or(|known| pairs.len() > known.len()) {
                best = Some(pairs);
            }
        }
    }
    let pairs = best?;
    let all = things.len() as f64;
    (pairs.len() >= FEWEST && 2.0 * pairs.len() as f64 >= MOST * all)
        .then(|| proposal(along, part, pairs))
}

/// Planes across the normal and axes along the mirror, one of every class.
fn things(part: &Part, along: usize, normal: &Unit) -> Vec<Thing> {
    let planes = part.planes().into_iter().filter(|&i| part.parallel(i, along));
    let lines = part.lines().into_iter().filter(|&i| part.right(i, along));
    let mut things: Vec<Thing> = planes
        .chain(lines)
        .map(|surface| Thing {
            surface,
            height: normal.dot(&place(&part.surfaces[surface]).coords),
            unsure: part.unsure(surface),
        })
        .collect();
    things.sort_by(|a, b| a.height.total_cmp(&b.height));
    things
}

fn reach(one: &Thing, other: &Thing) -> f64 {
    REACH.0 * (one.unsure + other.unsure) + REACH.1
}

/// Whether two things could be images of each other: alike, and straight across.
fn images(part: &Part, normal: &Unit, one: &Thing, other: &Thing) -> bool {
    let (a, b) = (&part.surfaces[one.surface], &part.surfaces[other.surface]);
    if other.height - one.height < reach(one, other) {
        return false;
    }
    let alike = |r: f64, s: f64| (r - s).abs() < ALIKE * r.max(s);
    let level = || {
        let Some(axis) = direction(a) else { return false };
        let across = normal.cross(&axis).dot(&(place(b) - place(a)));
        part.parallel(one.surface, other.surface) && across.abs() < reach(one, other)
    };
    match (a, b) {
        // Their outer sides look away from each other.
        (Surface::Plane(s), Surface::Plane(t)) => s.normal.dot(&t.normal) < 0.0,
        (Surface::Cylinder(s), Surface::Cylinder(t)) => alike(s.radius, t.radius) && level(),
        (Surface::Cone(s), Surface::Cone(t)) => alike(s.half_angle, t.half_angle) && level(),
        (Surface::Torus(s), Surface::Torus(t)) => alike(s.minor_radius, t.minor_radius) && level(),
        _ => false,
    }
}

/// Pairs of images across a plane, each thing in one of them at most.
fn pairs(part: &Part, normal: &Unit, things: &[Thing], middle: f64) -> Vec<[usize; 2]> {
    let mut taken = vec![false; things.len()];
    let mut found = Vec::new();
    for (i, one) in things.iter().enumerate() {
        let fits = |&j: &usize| {
            let off = (one.height + things[j].height) / 2.0 - middle;
            !taken[j] && off.abs() < reach(one, &things[j]) && images(part, normal, one, &things[j])
        };
        if !taken[i]
            && let Some(j) = (i + 1..things.len()).rev().find(fits)
        {
            (taken[i], taken[j]) = (true, true);
            found.push([one.surface, things[j].surface]);
        }
    }
    found
}

/// All pairs have one middle, and axes lie straight across from each other.
fn proposal(along: usize, part: &Part, pairs: Vec<[usize; 2]>) -> Proposal {
    let [i, j] = pairs[0];
    let middle = |&[k, l]: &[usize; 2]| Equation::Heights {
        along,
        terms: vec![(i, 1.0), (j, 1.0), (k, -1.0), (l, -1.0)],
        sum: 0.0,
    };
    let axes = pairs.iter().filter(|[k, _]| !matches!(part.surfaces[*k], Surface::Plane(_)));
    let level = axes.map(|&axes| Equation::Level { along, axes });
    let equations = pairs[1..].iter().map(middle).chain(level).collect();
    Proposal::new("symmetric", pairs.concat(), equations, LENGTH)
}
