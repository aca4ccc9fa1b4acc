//! What the vertices around one say of it, whatever surface it was given.
//!
//! A smooth piece of the region, fitted without the vertex, errs by the noise of few; a surface that is
//! wrong errs by more. So a way that ends further off the piece than that is cut short.

use rayon::prelude::*;

use super::Task;
use crate::math::Point;
use crate::surface::height_field::HeightField;

/// Vertices that the piece is fitted to: the more, the less noise is left, and the less detail.
const NEIGHBOURS: usize = 40;
/// Fewer determine it badly.
const FEWEST: usize = 2 * HeightField::PARAMETERS;
/// Standard errors of the piece that a vertex may end off it.
const DEVIATIONS: f64 = 2.5;

/// The positions with the ways of vertices inside regions cut where they leave what their
/// neighbours allow.
pub fn hold(task: &Task, moved: Vec<Point>, regions: &[Vec<u32>]) -> Vec<Point> {
    let held = |(vertex, to): (usize, Point)| match regions[vertex][..] {
        [only] => held(task, vertex as u32, only, to),
        _ => to,
    };
    moved.into_par_iter().enumerate().map(held).collect()
}

fn held(task: &Task, vertex: u32, region: u32, to: Point) -> Point {
    let points = around(task, vertex, region);
    let Some(field) = piece(&points[1..]) else { return to };
    let allowed = DEVIATIONS * task.sigma * field.variance(to).sqrt();
    let [start, end] = [points[0], to].map(|point| field.above(point));
    let held = end.clamp(-allowed, allowed).clamp(start.min(end), start.max(end));
    to + field.up().into_inner() * (held - end)
}

/// A smooth piece through some points; `None` where they are too few.
pub fn piece(points: &[Point]) -> Option<HeightField> {
    if points.len() < FEWEST { None } else { HeightField::fit(points) }
}

/// Vertices of a region around one, itself first, ring by ring.
pub fn around(task: &Task, vertex: u32, region: u32) -> Vec<Point> {
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
