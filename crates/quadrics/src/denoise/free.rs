//! Vertices of free-form regions: no surface, but smooth, so a piece of one stands for it.

use super::{Task, local};
use crate::math::Point;
use crate::partition::UNLABELLED;

/// Where a vertex inside a free-form region goes, at most `reach` away.
///
/// Only vertices of that region are looked at: nothing is smoothed across its border.
pub fn place(task: &Task, vertex: u32, reach: f64) -> Point {
    let here = task.working.mesh.positions[vertex as usize];
    let around = task.working.adjacency.around(vertex);
    let Some(&face) = around.first() else { return here };
    let region = task.labels[face as usize];
    if region == UNLABELLED || around.iter().any(|&f| task.labels[f as usize] != region) {
        return here;
    }
    let field = local::piece(&local::around(task, vertex, region));
    field.map_or(here, |field| {
        here - field.up().into_inner() * field.above(here).clamp(-reach, reach)
    })
}
