//! No face turns over: vertices that would do it go back part of their way.

use super::Task;
use crate::math::{Point, Vector};
use crate::surface::Surface;

/// Rounds of halving; what is still folded then keeps its noise.
const ROUNDS: usize = 6;

/// The positions with the moves of folded faces taken back, by halves, at last altogether.
pub fn unfold(task: &Task, moved: Vec<Point>) -> Vec<Point> {
    let before = &task.working.mesh.positions;
    let mut after = moved;
    for round in 0..=ROUNDS {
        let folded: Vec<usize> =
            (0..task.labels.len()).filter(|&face| is_folded(task, &after, face)).collect();
        if folded.is_empty() {
            break;
        }
        let mut vertices: Vec<u32> =
            folded.iter().flat_map(|&face| task.working.mesh.faces[face]).collect();
        vertices.sort_unstable();
        vertices.dedup();
        for vertex in vertices.into_iter().map(|v| v as usize) {
            let back = if round == ROUNDS { 1.0 } else { 0.5 };
            let way = before[vertex] - after[vertex];
            after[vertex] += way * back;
        }
    }
    after
}

/// Whether a face looks away from its surface now, and did not before.
fn is_folded(task: &Task, positions: &[Point], face: usize) -> bool {
    let corners = task.working.mesh.faces[face];
    let [a, b, c] = corners.map(|vertex| positions[vertex as usize]);
    let normal = (b - a).cross(&(c - a));
    let old = task.working.geometry.normals[face];
    let expected = expected(task, face).unwrap_or(old);
    normal.dot(&expected) < 0.0 && old.dot(&expected) >= 0.0
}

/// The normal of the face's surface on the side of the region; `None` where it has none.
fn expected(task: &Task, face: usize) -> Option<Vector> {
    let region = task.labels[face] as usize;
    let surface = task.surfaces.get(region).filter(|s| !matches!(s, Surface::FreeForm))?;
    let normal = surface.normal(task.working.geometry.barycentres[face])?;
    Some(normal.into_inner() * task.sides[region])
}
