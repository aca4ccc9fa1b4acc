//! Equal distances between parallel planes, equal angles between directions.

use super::equation::{Equation, apart};
use super::places::{LENGTH, RIGHT_ANGLE};
use super::proposal::{Part, Proposal};
use crate::surface::Surface;

/// A distance or an angle, and the two surfaces that it lies between.
type Gap = (f64, [usize; 2]);
/// Angles this close to 0 or 90 degrees are parallel or right, or nearly so: in radians.
const PLAIN: f64 = 0.1;

/// Distances between planes that are next to each other, and angles, each with the next larger one.
pub fn proposals(part: &Part) -> Vec<Proposal> {
    let equal = |kind, gaps: Vec<Gap>, range: f64, of: fn([usize; 4]) -> Equation| {
        // One value among so many is by chance as near as this to the next.
        let near = range / gaps.len().max(1) as f64;
        let next = move |pair: &[Gap]| {
            let four = [pair[0].1[0], pair[0].1[1], pair[1].1[0], pair[1].1[1]];
            Proposal::new(kind, four.to_vec(), vec![of(four)], near)
        };
        gaps.windows(2).map(next).collect::<Vec<_>>()
    };
    let mut found = equal("equal_distance", distances(part), LENGTH, Equation::EqualDistance);
    found.extend(equal("equal_dihedral", angles(part), RIGHT_ANGLE, Equation::EqualAngle));
    found
}

/// Distances between neighbouring planes of every direction, ascending.
pub fn distances(part: &Part) -> Vec<Gap> {
    let planes = part.planes();
    let mut gaps = Vec::new();
    let mut directions: Vec<usize> = planes.iter().map(|&i| part.classes.direction[i]).collect();
    directions.sort_unstable();
    directions.dedup();
    for direction in directions {
        let mut along: Vec<Gap> = planes
            .iter()
            .filter(|&&i| part.classes.direction[i] == direction)
            .map(|&i| (height(part, i), [i, i]))
            .collect();
        along.sort_by(|a, b| a.0.total_cmp(&b.0));
        for pair in along.windows(2) {
            let ends = [pair[0].1[0], pair[1].1[0]];
            gaps.push((apart(&part.surfaces[ends[0]], &part.surfaces[ends[1]]), ends));
        }
    }
    gaps.sort_by(|a, b| a.0.total_cmp(&b.0));
    gaps
}

/// Offset of a plane along its class, in the sign of the class.
fn height(part: &Part, i: usize) -> f64 {
    let Surface::Plane(plane) = &part.surfaces[i] else { return 0.0 };
    let shared = part.view.solution.state.directions[part.classes.direction[i]];
    plane.offset * plane.normal.dot(&shared).signum()
}

/// Angles between directions that are neither parallel nor at right angles, ascending.
pub fn angles(part: &Part) -> Vec<Gap> {
    let speakers = part.speakers(&part.classes.direction, |_| true);
    let pairs = speakers.iter().enumerate();
    let mut gaps: Vec<Gap> = pairs
        .flat_map(|(at, &i)| speakers[at + 1..].iter().map(move |&j| [i, j]))
        .filter_map(|[i, j]| {
            let angle = part.way(i)?.dot(&part.way(j)?.into_inner()).abs().min(1.0).acos();
            (angle > PLAIN && angle < RIGHT_ANGLE - PLAIN).then_some((angle, [i, j]))
        })
        .collect();
    gaps.sort_by(|a, b| a.0.total_cmp(&b.0));
    gaps
}
