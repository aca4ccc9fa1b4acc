//! Patterns: holes and bosses around an axis, or along a line, at equal steps.

use std::f64::consts::TAU;

use nalgebra::{Matrix3, Vector2, Vector3};

use super::equation::Equation;
use super::proposal::{Part, Proposal};
use crate::math::Unit;
use crate::surface::Surface;

/// Fewest members of a pattern.
const FEWEST: usize = 3;
/// Radii within this fraction of each other may be one drill's: scans round the edges of holes.
const ALIKE: f64 = 0.15;
/// Most of the places of a circle, all in a row, that may be empty: a hole may be missing.
const EMPTY: f64 = 0.25;
/// Fewest holes that show the middle of a circle of which places may be empty.
const RIM: usize = 4;
/// A place may be this many standard deviations, and this fraction of the pitch, off.
const REACH: (f64, f64) = (4.0, 0.03);

/// A cylinder and where its axis passes the plane across.
#[derive(Clone, Copy)]
struct Hole {
    surface: usize,
    at: Vector2<f64>,
    unsure: f64,
}

/// Circles first, then rows of what is left; every hole belongs to one pattern at most.
pub fn proposals(part: &Part) -> Vec<Proposal> {
    let mut found: Vec<Proposal> = Vec::new();
    let mut taken: Vec<usize> = Vec::new();
    for (direction, holes) in groups(part) {
        let mut left: Vec<Hole> = holes;
        left.retain(|hole| !taken.contains(&part.classes.line[hole.surface]));
        while let Some(pattern) = circle(part, &direction, &left).or_else(|| row(&left)) {
            let lines: Vec<usize> =
                pattern.surfaces.iter().map(|&i| part.classes.line[i]).collect();
            left.retain(|hole| !lines.contains(&part.classes.line[hole.surface]));
            taken.extend(lines);
            found.push(pattern);
        }
    }
    found
}

/// The pattern that some cylinders make.
pub fn among(part: &Part, members: &[usize]) -> Option<Proposal> {
    let direction = part.way(*members.first()?)?;
    if !members.iter().all(|&i| part.parallel(i, members[0]) && part.view.line_of(i).is_some()) {
        return None;
    }
    let hole =
        |&i: &usize| Hole { surface: i, at: part.pierced(i, &direction), unsure: f64::INFINITY };
    let holes: Vec<Hole> = members.iter().map(hole).collect();
    let of_all = |found: &Proposal| found.surfaces.len() == members.len();
    circle(part, &direction, &holes).filter(of_all).or_else(|| row(&holes).filter(of_all))
}

/// Cylinders of one direction and like radius, one a line; the largest groups first.
fn groups(part: &Part) -> Vec<(Unit, Vec<Hole>)> {
    let radius = |i: usize| match &part.surfaces[i] {
        Surface::Cylinder(s) => Some(s.radius),
        _ => None,
    };
    let mut all: Vec<(usize, f64, usize)> = (0..part.surfaces.len())
        .filter_map(|i| Some((part.classes.direction[i], radius(i)?, i)))
        .collect();
    all.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let alike =
        |a: &(usize, f64, usize), b: &(usize, f64, usize)| a.0 == b.0 && b.1 - a.1 < ALIKE * b.1;
    let mut groups = Vec::new();
    for chunk in all.chunk_by(alike) {
        let Some(direction) = part.way(chunk[0].2) else { continue };
        let mut holes: Vec<Hole> = Vec::new();
        for &(_, _, i) in chunk {
            let line = part.classes.line[i];
            if holes.iter().all(|hole| part.classes.line[hole.surface] != line) {
                let (at, unsure) = (part.pierced(i, &direction), part.unsure(i));
                holes.push(Hole { surface: i, at, unsure });
            }
        }
        // The frame across is that of the first.
        if holes.len() >= FEWEST {
            groups.push((direction, holes));
        }
    }
    groups.sort_by_key(|(_, holes)| std::cmp::Reverse(holes.len()));
    groups
}

/// The circle of the most holes: around an axis that is there, or around their middle.
fn circle(part: &Part, direction: &Unit, holes: &[Hole]) -> Option<Proposal> {
    if holes.len() < FEWEST {
        return None;
    }
    let own: Vec<usize> = holes.iter().map(|hole| part.classes.line[hole.surface]).collect();
    let beside =
        |&i: &usize| part.parallel(i, holes[0].surface) && !own.contains(&part.classes.line[i]);
    let middle = holes.iter().map(|hole| hole.at).sum::<Vector2<f64>>() / holes.len() as f64;
    let axes = part.lines().into_iter().filter(beside);
    let centers = axes.map(|i| (Some(i), part.pierced(i, direction), part.unsure(i)));
    centers
        .chain([(None, middle, 0.0)])
        .chain(rim(holes).map(|center| (None, center, 0.0)))
        .filter_map(|(axis, at, unsure)| around(holes, axis, at, unsure))
        .max_by_key(|found| (found.surfaces.len(), std::cmp::Reverse(found.equations.len())))
}

/// The largest set of holes at one distance from a centre that divides the circle evenly.
fn around(holes: &[Hole], axis: Option<usize>, center: Vector2<f64>, off: f64) -> Option<Proposal> {
    let mut by_distance: Vec<(f64, Hole)> =
        holes.iter().map(|hole| ((hole.at - center).norm(), *hole)).collect();
    by_distance.sort_by(|a, b| a.0.total_cmp(&b.0));
    let reach = |pitch: f64, hole: &Hole| REACH.0 * (hole.unsure + off) + REACH.1 * pitch;
    let near = |a: &(f64, Hole), b: &(f64, Hole)| b.0 - a.0 < reach(b.0, &a.1);
    let rings = by_distance.chunk_by(near).filter(|ring| ring.len() >= FEWEST);
    let even = |ring: &[(f64, Hole)]| {
        let turned = in_order(ring, center);
        let pitch = ring[0].0;
        let turn = turn(&turned, |hole| 2.0 * reach(pitch, hole) / pitch)?;
        let members: Vec<usize> = turned.iter().map(|(_, hole)| hole.surface).collect();
        let equations = steps_of(holes[0].surface, &members, axis, turn);
        Some(Proposal::new("pattern", members, equations, pitch))
    };
    rings.filter_map(even).max_by_key(|found| found.surfaces.len())
}

/// The middle of the circle through holes, by least squares (Kåsa, 1976).
fn rim(holes: &[Hole]) -> Option<Vector2<f64>> {
    if holes.len() < RIM {
        return None;
    }
    // |p|² = 2 c · p + k is linear in the centre c and in k.
    let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
    for Hole { at, .. } in holes {
        let row = Vector3::new(2.0 * at.x, 2.0 * at.y, 1.0);
        normal += row * row.transpose();
        right += row * at.norm_squared();
    }
    Some((normal.try_inverse()? * right).xy())
}

/// The holes of a ring by their angles around the centre, the widest step between last and first.
fn in_order(ring: &[(f64, Hole)], center: Vector2<f64>) -> Vec<(f64, Hole)> {
    let angle = |hole: &Hole| (hole.at - center).y.atan2((hole.at - center).x);
    let mut turned: Vec<(f64, Hole)> = ring.iter().map(|(_, hole)| (angle(hole), *hole)).collect();
    turned.sort_by(|a, b| a.0.total_cmp(&b.0));
    let count = turned.len();
    let step = |k: usize| (turned[k].0 - turned[(k + count - 1) % count].0).rem_euclid(TAU);
    let first = (0..count).max_by(|&a, &b| step(a).total_cmp(&step(b))).unwrap_or(0);
    turned.rotate_left(first);
    turned
}

/// The step from hole to hole that divides the circle evenly, up to places that are empty between
/// the last and the first; `within` says how far a hole may be off, in radians.
fn turn(turned: &[(f64, Hole)], within: impl Fn(&Hole) -> f64) -> Option<f64> {
    let count = turned.len();
    let most = (count as f64 / (1.0 - EMPTY)) as usize;
    let even = |places: &usize| {
        let turn = TAU / *places as f64;
        (0..count).all(|k| {
            let next = (turned[(k + 1) % count].0 - turned[k].0).rem_euclid(TAU);
            let wanted = if k + 1 < count { turn } else { turn * (places - count + 1) as f64 };
            (next - wanted).abs() < within(&turned[k].1)
        })
    };
    (count..=most).find(even).map(|places| TAU / places as f64)
}

/// The longest row of holes at equal steps.
fn row(holes: &[Hole]) -> Option<Proposal> {
    let mut best: Option<(Vec<usize>, f64)> = None;
    for (a, b) in pairs(holes.len()) {
        let step = holes[b].at - holes[a].at;
        let mut members = vec![holes[a].surface, holes[b].surface];
        let mut last = holes[b];
        let follows = |last: &Hole, hole: &Hole| {
            let reach = REACH.0 * (hole.unsure + last.unsure) + REACH.1 * step.norm();
            (hole.at - last.at - step).norm() < reach
        };
        let new = |members: &[usize], hole: &Hole| !members.contains(&hole.surface);
        while let Some(next) = holes.iter().find(|hole| new(&members, hole) && follows(&last, hole))
        {
            members.push(next.surface);
            last = *next;
        }
        let longer = best
            .as_ref()
            .is_none_or(|(known, pitch)| (members.len(), -step.norm()) > (known.len(), -pitch));
        if members.len() >= FEWEST && longer {
            best = Some((members, step.norm()));
        }
    }
    let (members, pitch) = best?;
    Some(Proposal::new(
        "pattern",
        members.clone(),
        steps_of(holes[0].surface, &members, None, 0.0),
        pitch,
    ))
}

fn pairs(count: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..count).flat_map(move |a| (0..count).filter(move |b| *b != a).map(move |b| (a, b)))
}

/// The steps from each member to the next: radii around an axis, or ways between members.
fn steps_of(about: usize, members: &[usize], axis: Option<usize>, turn: f64) -> Vec<Equation> {
    let both = |from: [usize; 2], to: [usize; 2]| {
        [0, 1].map(|part| Equation::Turned { about, from, to, turn, part })
    };
    match axis {
        Some(axis) => members.windows(2).flat_map(|m| both([axis, m[0]], [axis, m[1]])).collect(),
        None => members.windows(3).flat_map(|m| both([m[0], m[1]], [m[1], m[2]])).collect(),
    }
}
