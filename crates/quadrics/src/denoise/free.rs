//! Vertices of free-form regions: no surface, but smooth, so a piece of one stands for it.

use super::Task;
use crate::math::Point;
use crate::partition::UNLABELLED;
use crate::surface::height_field::HeightField;

/// Vertices that the piece is fitted to: the more, the less noise is left, and the less detail.
const NEIGHBOURS: usize = 40;
/// Fewer determine it badly.
const FEWEST: usize = 2 * HeightField::PARAMETERS;

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
    let points = near(task, vertex, region);
    let field = if points.len() < FEWEST { None } else { HeightField::fit(&points) };
    field.map_or(here, |field| {
        here - field.up().into_inner() * field.above(here).clamp(-reach, reach)
    })
}

/// Vertices of a region around one, ring by ring.
fn near(task: &Task, vertex: u32, region: u32) -> Vec<Point> {
    let mut found = vec![vertex];
    let mut next = 0;
    while next < found.len() && found.len() < NEIGHBOURS {
        let around = task.working.adjacency.around(found[next]).iter();
        for &face in around.filter(|&&face| task.labels[face as usize] == region) {
            for corner in task.working.mesh.faces[face as usize] {
                if !found.contains(&corner) {
                    found.push(corner);
                }
            }
        }
        next += 1;
    }
    found.into_iter().map(|v| task.working.mesh.positions[v as usize]).collect()
}
