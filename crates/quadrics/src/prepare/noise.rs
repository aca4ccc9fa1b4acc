//! How noisy a mesh is, from the mesh alone.
//!
//! Residuals of height fields of second degree over small neighbourhoods. Creases inflate most of
//! them, so a low quantile speaks for the mesh; on a clean mesh it is zero.

use rayon::prelude::*;

use crate::math::{Point, Vector};
use crate::mesh::{Adjacency, Mesh, NONE, Working};
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
/// In an exact mesh of uneven faces more than this share of the edges, by length, are within planes (0.04 to 0.6
/// in what CAD programs write; at most 0.055 where half of the vertices err),
const EDGES: f64 = 0.12;
/// and either fewer than this share of the vertices (none in what CAD programs write; where noise leaves no
/// more, it leaves a tenth of the edges),
const VERTICES_WITHIN: f64 = 0.02;
/// or, after decimation, half of the faces are less than this share of an equilateral triangle with their
/// longest edge (0.26 to 0.53; 0.8 and more where meshes were made to be computed on), and fewer than this share
/// of the vertices are alone off the plane of those around them (0.0033 at most; 0.017 and more where a twentieth
/// to a third of the vertices err).
const UNEVEN: f64 = 0.6;
const BUMPS: f64 = 0.006;
/// Fewer vertices around one often lie in a plane by themselves: three always do.
const RING: usize = 5;

/// Whether a mesh in the unit cube is exact and uneven, as CAD programs and decimation make it: without enough
/// vertices within planes and smooth surfaces for neighbourhoods to show that it is exact.
pub fn is_tessellated(mesh: &Mesh, adjacency: &Adjacency) -> bool {
    let step = (mesh.faces.len() / TURNS).max(1);
    let (mut within, mut edges) = (0.0, 0.0);
    let (mut inner, mut bumps, mut vertices) = (0.0, 0.0, 0.0);
    let mut shapes: Vec<f64> = Vec::new();
    for face in (0..mesh.faces.len()).step_by(step) {
        let corners = mesh.corners(face);
        let lengths = [0, 1, 2].map(|k| (corners[(k + 1) % 3] - corners[k]).norm());
        for (other, length) in adjacency.neighbours[face].into_iter().zip(lengths) {
            if other != NONE {
                edges += length;
                within += if are_coplanar(mesh, face, other as usize) { length } else { 0.0 };
            }
        }
        let longest = lengths.into_iter().fold(f64::MIN_POSITIVE, f64::max);
        let [a, b, c] = corners;
        let equilateral = 3f64.sqrt() / 2.0 * longest * longest;
        shapes.push((b - a).cross(&(c - a)).norm() / equilateral);
        let vertex = mesh.faces[face][0];
        let around = adjacency.around(vertex);
        // Where the mesh ends, the faces of one plane are often all there is.
        if around.iter().all(|&other| adjacency.across(other as usize).count() == 3) {
            vertices += 1.0;
            if around.iter().all(|&other| are_coplanar(mesh, face, other as usize)) {
                inner += 1.0;
            } else if around.len() >= RING && is_bump(mesh, around, vertex) {
                bumps += 1.0;
            }
        }
    }
    if shapes.is_empty() || within <= EDGES * edges {
        return false;
    }
    let middle = shapes.len() / 2;
    let shape = *shapes.select_nth_unstable_by(middle, f64::total_cmp).1;
    inner < VERTICES_WITHIN * vertices || (shape < UNEVEN && bumps < BUMPS * vertices)
}

/// Whether all vertices around one lie in a plane, which it is not in.
fn is_bump(mesh: &Mesh, around: &[u32], vertex: u32) -> bool {
    // The edge of each face across from the vertex: every vertex of the ring stands there twice.
    let across = |&face: &u32| {
        let corners = mesh.faces[face as usize];
        let at = corners.iter().position(|&v| v == vertex).unwrap_or_default();
        [1, 2].map(|k| mesh.positions[corners[(at + k) % 3] as usize])
    };
    let ring: Vec<[Point; 2]> = around.iter().map(across).collect();
    let sum: Vector = ring.iter().flatten().map(|p| p.coords).sum();
    let center = Point::from(sum / (2 * ring.len()) as f64);
    let normal: Vector = ring.iter().map(|[a, b]| (a - center).cross(&(b - center))).sum();
    let reach = ROUNDING * normal.norm();
    let apart = |p: &Point| normal.dot(&(p - center)).abs();
    ring.iter().flatten().all(|p| apart(p) <= reach)
        && apart(&mesh.positions[vertex as usize]) > reach
}

/// Whether the corners of one face lie in the plane of another.
fn are_coplanar(mesh: &Mesh, face: usize, other: usize) -> bool {
    let [a, b, c] = mesh.corners(face);
    let normal = (b - a).cross(&(c - a));
    let reach = ROUNDING * normal.norm();
    mesh.corners(other).iter().all(|p| normal.dot(&(p - a)).abs() <= reach)
}

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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::context::Context;
    use crate::synth::{self, Noise};

    fn passes(mesh: &Mesh) -> bool {
        is_tessellated(mesh, &Adjacency::new(&mesh.faces, mesh.positions.len()))
    }

    #[test]
    fn noise_on_some_of_the_vertices_does_not_pass_for_a_tessellation() {
        let mut plate = synth::part("plate:6", 6_000).unwrap().mesh;
        let size = plate.size();
        plate.positions.iter_mut().for_each(|p| *p /= size);
        // Slivers, as if it were decimated.
        plate.positions.iter_mut().for_each(|p| p.x *= 0.2);
        assert!(passes(&plate));
        for ratio in [0.05, 0.1, 0.3, 0.5, 0.9] {
            let noise = Noise::uniform(0.01, ratio);
            let noisy = synth::add_noise(&mut Context::new(1), &plate, &noise).unwrap();
            assert!(!passes(&noisy), "{ratio}");
        }
    }
}
