//! Whether a mesh is exact and uneven: what CAD programs write, and what decimation leaves of a clean mesh.

use super::noise::ROUNDING;
use crate::math::{Point, Vector};
use crate::mesh::{Adjacency, Mesh, NONE};

/// Faces that are asked.
const HEARD: usize = 10_000;
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
    let step = (mesh.faces.len() / HEARD).max(1);
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
