//! Noise of neighbours is independent: a way that they all go the same is no noise.
//!
//! It shows a surface that is wrong there, such as two planes where a fillet was overlooked. That
//! way is taken back.

use rayon::prelude::*;

use super::Task;
use crate::math::{Point, Vector};

/// Vertices that are compared, at most: about two rings, then one.
const SCALES: [usize; 2] = [19, 7];
/// A mean of so many standard errors is no chance.
const SIGNIFICANT: f64 = 3.0;

/// The positions without what the moves of neighbours have in common.
///
/// Between regions the vertices of the same regions are compared as well: where a wrong curve pulls
/// them aside, those inside the regions stay.
pub fn take_back(task: &Task, moved: Vec<Point>, regions: &[Vec<u32>], reach: f64) -> Vec<Point> {
    let before = &task.working.mesh.positions;
    let mut ways: Vec<Vector> = moved.iter().zip(before).map(|(to, from)| to - from).collect();
    for scale in SCALES {
        let own = |vertex: usize| {
            let at = &regions[vertex];
            if at.is_empty() {
                return ways[vertex];
            }
            let mut near = near(task, vertex as u32, scale, regions);
            let common = |near: &[u32]| {
                let count = near.len() as f64;
                let mean = near.iter().map(|&v| ways[v as usize]).sum::<Vector>() / count;
                beyond(mean, SIGNIFICANT * task.sigma / count.sqrt())
            };
            let mut back = common(&near);
            if at.len() > 1 {
                near.retain(|&other| regions[other as usize] == *at);
                back = longer(back, common(&near));
            }
            (ways[vertex] - back).cap_magnitude(reach)
        };
        ways = (0..before.len()).into_par_iter().map(own).collect();
    }
    before.iter().zip(ways).map(|(from, way)| from + way).collect()
}

fn longer(one: Vector, other: Vector) -> Vector {
    if one.norm_squared() >= other.norm_squared() { one } else { other }
}

/// Breiman's garrote: nothing below the threshold, nearly all far above it, no jump between.
fn beyond(mean: Vector, chance: f64) -> Vector {
    let length = mean.norm();
    if length > chance { mean * (1.0 - (chance / length).powi(2)) } else { Vector::zeros() }
}

/// Some vertices around one, itself first, ring by ring, without those that have no region.
fn near(task: &Task, vertex: u32, count: usize, regions: &[Vec<u32>]) -> Vec<u32> {
    let mut found = vec![vertex];
    let mut next = 0;
    while next < found.len() && found.len() < count {
        for &face in task.working.adjacency.around(found[next]) {
            for corner in task.working.mesh.faces[face as usize] {
                if !found.contains(&corner) && !regions[corner as usize].is_empty() {
                    found.push(corner);
                }
            }
        }
        next += 1;
    }
    found.truncate(count);
    found
}
