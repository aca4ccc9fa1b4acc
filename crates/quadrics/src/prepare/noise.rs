//! How noisy a mesh is, from the mesh alone.
//!
//! Residuals of height fields of second degree over small neighbourhoods. Creases inflate most of
//! them, so a low quantile speaks for the mesh; on a clean mesh it is zero.

use rayon::prelude::*;

use crate::math::Point;
use crate::mesh::{Adjacency, Mesh, Working};
use crate::surface::height_field::HeightField;

/// Neighbourhoods that are looked at.
const NEIGHBOURHOODS: usize = 600;
/// Vertices of a neighbourhood: about three rings.
const VERTICES: usize = 30;
/// The quantile of their residuals that speaks for the mesh, and its expectation for pure noise.
const QUANTILE: f64 = 0.2;
const QUANTILE_OF_NOISE: f64 = 0.88;

/// Standard deviation of the vertices across the surface, at the scale of a few edges, in the unit
/// of the mesh.
pub fn position(mesh: &Mesh, adjacency: &Adjacency) -> f64 {
    let step = (mesh.positions.len() / NEIGHBOURHOODS).max(1);
    let mut residuals: Vec<f64> = (0..mesh.positions.len())
        .step_by(step)
        .collect::<Vec<_>>()
        .into_par_iter()
        .filter_map(|vertex| residual(&neighbourhood(mesh, adjacency, vertex as u32)))
        .collect();
    if residuals.is_empty() {
        return 0.0;
    }
    residuals.sort_unstable_by(f64::total_cmp);
    residuals[(residuals.len() as f64 * QUANTILE) as usize] / QUANTILE_OF_NOISE
}

/// Rounding of the input's coordinates, in sizes: no sigma is smaller. Files carry five to seven digits.
pub const ROUNDING: f64 = 1e-5;
/// Faces whose neighbours are asked how far they turn.
const TURNS: usize = 10_000;

/// Median angle between a face and the next, in radians: near zero on a clean mesh, 0.6 where vertices
/// err by a third of an edge.
pub fn turn(mesh: &Working) -> f64 {
    let normals = &mesh.geometry.normals;
    let faces = (0..mesh.len()).step_by(mesh.len().div_ceil(TURNS).max(1));
    let angle = |face: usize, other: usize| normals[face].angle(&normals[other]);
    let mut angles: Vec<f64> = faces
        .flat_map(|face| mesh.adjacency.across(face).map(move |other| angle(face, other)))
        .collect();
    let middle = angles.len() / 2;
    if angles.is_empty() { 0.0 } else { *angles.select_nth_unstable_by(middle, f64::total_cmp).1 }
}

/// The nearest vertices over the mesh, breadth first.
fn neighbourhood(mesh: &Mesh, adjacency: &Adjacency, vertex: u32) -> Vec<Point> {
    let mut found = vec![vertex];
    let mut next = 0;
    while next < found.len() && found.len() < VERTICES {
        for &face in adjacency.around(found[next]) {
            for &other in &mesh.faces[face as usize] {
                if !found.contains(&other) {
                    found.push(other);
                }
            }
        }
        next += 1;
    }
    found.into_iter().map(|v| mesh.positions[v as usize]).collect()
}

/// Root mean square distance from a height field of second degree, corrected for its six unknowns.
fn residual(points: &[Point]) -> Option<f64> {
    if points.len() < 12 {
        return None;
    }
    let field = HeightField::fit(points)?;
    let cost: f64 = points.iter().map(|p| field.above(*p).powi(2)).sum();
    Some((cost / (points.len() - HeightField::PARAMETERS) as f64).sqrt())
}
