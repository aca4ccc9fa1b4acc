//! New triangles on an old surface, which know nothing of its edges: what a scanner sees.
//!
//! Random points at a least distance from each other (Poisson discs) are linked where their
//! Voronoi cells on the surface meet. Everything happens along the surface, so that the two sides
//! of a thin wall do not see each other, and an open surface stays open.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use rand::RngExt;
use rand::seq::SliceRandom;

use super::discs::Discs;
use super::field::Field;
use super::part::Part;
use crate::context::Context;
use crate::error::Result;
use crate::math::Point;
use crate::mesh::{Adjacency, Geometry, Mesh};
use crate::partition::UNLABELLED;

/// Faces of the old mesh to one of the new: fewer, and cells of the Voronoi diagram fray.
const FINENESS: usize = 10;

/// Random discs of diameter r pack a surface to 0.547 of its area: r² is 0.696 of it a point, and
/// there are two faces to a point. That would be 1.39; with discs beside the vertices of a mesh
/// 12 % of the points are missing (measured, on every part).
const DISC_AREA: f64 = 1.22;

/// However the spacing varies, it stays above this fraction of its mean.
const LEAST_STRETCH: f64 = 0.3;

/// Vertices at which the mean density is measured, to a percent.
const SAMPLE: usize = 10_000;

/// Correlation length of the spacing, in spacings.
const DENSITY_LENGTH: f64 = 12.0;

/// About `faces` new faces on a part, their spacing varying by the fraction `density`.
///
/// Vertices lie on the surfaces of the part; a face has the label that it and its corners have
/// most.
pub(super) fn resample(
    context: &mut Context,
    part: &Part,
    faces: usize,
    density: f64,
) -> Result<Part> {
    let mut fine = (part.mesh.clone(), part.labels.clone());
    while fine.0.faces.len() < FINENESS * faces {
        fine = quartered(&fine.0, &fine.1);
    }
    context.step("scan", 0.1)?;
    let (mesh, labels) = fine;
    let area: f64 = Geometry::new(&mesh).areas.iter().sum();
    let radius = (DISC_AREA * area / faces as f64).sqrt();
    let cells = Cells::grow(context, &mesh, radius, density)?;
    context.step("scan", 0.8)?;
    Ok(cells.dual(&mesh, &labels, part))
}

/// Every face cut into four, at the middles of its edges.
fn quartered(mesh: &Mesh, labels: &[u32]) -> (Mesh, Vec<u32>) {
    let mut edges: Vec<(u64, u32)> = Vec::with_capacity(3 * mesh.faces.len());
    for (corners, face) in mesh.faces.iter().zip(0..) {
        for i in 0..3 {
            let (a, b) = (corners[i], corners[(i + 1) % 3]);
            edges.push((u64::from(a.min(b)) << 32 | u64::from(a.max(b)), 3 * face + i as u32));
        }
    }
    edges.sort_unstable();
    let mut positions = mesh.positions.clone();
    let mut middles = vec![[0; 3]; mesh.faces.len()];
    for same in edges.chunk_by(|one, other| one.0 == other.0) {
        let ends = [same[0].0 >> 32, same[0].0 & u64::from(u32::MAX)];
        let [a, b] = ends.map(|v| mesh.positions[v as usize]);
        for &(_, edge) in same {
            middles[edge as usize / 3][edge as usize % 3] = positions.len() as u32;
        }
        positions.push(nalgebra::center(&a, &b));
    }
    let cut = |(&[a, b, c], &[ab, bc, ca]): (&[u32; 3], &[u32; 3])| {
        [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
    };
    let faces = mesh.faces.iter().zip(&middles).flat_map(cut).collect();
    let labels = labels.iter().flat_map(|&label| [label; 4]).collect();
    (Mesh { positions, faces }, labels)
}

/// Points on a surface, and the vertices nearest to each.
#[derive(Default)]
struct Cells {
    points: Vec<Point>,
    /// The vertex at which each was found.
    start: Vec<u32>,
    /// The face in which each point lies.
    home: Vec<u32>,
    /// The point nearest to each vertex.
    owner: Vec<u32>,
}

impl Cells {
    fn grow(context: &mut Context, mesh: &Mesh, radius: f64, density: f64) -> Result<Self> {
        let adjacency = Adjacency::new(&mesh.faces, mesh.positions.len());
        let field = Field::new(context, DENSITY_LENGTH * radius);
        let stretch = |point: Point| (1.0 + density * field.at(point)).max(LEAST_STRETCH);
        // Points per area go by its inverse square, whose mean is not 1.
        let sample = mesh.positions.iter().step_by(mesh.positions.len().div_ceil(SAMPLE));
        let (sum, points) =
            sample.fold((0.0, 0.0), |(sum, n), &point| (sum + stretch(point).powi(-2), n + 1.0));
        let radius = radius * (sum / points).sqrt();
        let count = mesh.positions.len();
        let mut cells = Self::default();
        let mut discs = Discs::new(count);
        let mut order: Vec<u32> = (0..count as u32).collect();
        order.shuffle(&mut context.rng);
        for (done, &vertex) in order.iter().enumerate() {
            if done % 65_536 == 0 {
                context.step("scan", 0.1 + 0.7 * done as f64 / count as f64)?;
            }
            let around = adjacency.around(vertex);
            if discs.covered[vertex as usize] || around.is_empty() {
                continue;
            }
            // Beside the vertex: those of the edges would else be hit too often.
            let home = around[context.rng.random_range(0..around.len())];
            let point = random_point(context, mesh.corners(home as usize));
            let reach = radius * stretch(point);
            discs.cover(mesh, &adjacency, vertex, point, reach);
            cells.points.push(point);
            cells.start.push(vertex);
            cells.home.push(home);
        }
        cells.owner = cells.flood(mesh, &adjacency);
        Ok(cells)
    }

    /// The point nearest to every vertex, as far as it can be reached through vertices that it is
    /// nearest to as well: a cell in two pieces would tear the new mesh.
    fn flood(&self, mesh: &Mesh, adjacency: &Adjacency) -> Vec<u32> {
        let mut owner = vec![UNLABELLED; mesh.positions.len()];
        // The bits of a non-negative f64 sort like the number itself; ties go to the lower vertex.
        let entry = |vertex: u32, point: u32| {
            let square =
                (mesh.positions[vertex as usize] - self.points[point as usize]).norm_squared();
            Reverse((square.to_bits(), vertex, point))
        };
        let starts = self.start.iter().zip(0..).map(|(&vertex, point)| entry(vertex, point));
        let mut queue: BinaryHeap<_> = starts.collect();
        while let Some(Reverse((_, vertex, point))) = queue.pop() {
            if owner[vertex as usize] != UNLABELLED {
                continue;
            }
            owner[vertex as usize] = point;
            for &face in adjacency.around(vertex) {
                let [a, b, c] = mesh.faces[face as usize];
                // Every neighbour is the next corner of one of the faces around, but at a border.
                let next = if a == vertex {
                    b
                } else if b == vertex {
                    c
                } else {
                    a
                };
                if owner[next as usize] == UNLABELLED {
                    queue.push(entry(next, point));
                }
            }
        }
        owner
    }

    /// One face wherever three cells meet.
    fn dual(self, mesh: &Mesh, labels: &[u32], part: &Part) -> Part {
        let label = |point: u32| labels[self.home[point as usize] as usize];
        let project = |(point, &home): (&Point, &u32)| {
            let surface = &part.surfaces[labels[home as usize] as usize];
            surface.project(*point).unwrap_or(*point)
        };
        let positions = self.points.iter().zip(&self.home).map(project).collect();
        let mut made = Part { surfaces: part.surfaces.clone(), ..Part::default() };
        made.mesh.positions = positions;
        for (face, corners) in mesh.faces.iter().enumerate() {
            let corners = corners.map(|v| self.owner[v as usize]);
            let [a, b, c] = corners;
            if a != b && b != c && c != a && !corners.contains(&UNLABELLED) {
                made.mesh.faces.push(corners);
                made.labels.push(vote(labels[face], corners.map(label)));
            }
        }
        drop_doubled(&mut made);
        made
    }
}

fn random_point(context: &mut Context, [a, b, c]: [Point; 3]) -> Point {
    let (mut u, mut v): (f64, f64) = (context.rng.random(), context.rng.random());
    if u + v > 1.0 {
        (u, v) = (1.0 - u, 1.0 - v);
    }
    a + (b - a) * u + (c - a) * v
}

/// The label that most have, a face and its corners; in doubt that of the face.
fn vote(face: u32, corners: [u32; 3]) -> u32 {
    let count = |label: u32| corners.iter().filter(|&&corner| corner == label).count();
    let most = corners.into_iter().max_by_key(|&label| count(label)).unwrap_or(face);
    if count(most) > count(face) + 1 { most } else { face }
}

/// Where a cell is not a disc, faces would meet three to an edge: the later ones go.
fn drop_doubled(part: &mut Part) {
    let mut edges: Vec<([u32; 2], usize)> = Vec::with_capacity(3 * part.labels.len());
    for (face, &[a, b, c]) in part.mesh.faces.iter().enumerate() {
        edges.extend([([a, b], face), ([b, c], face), ([c, a], face)]);
    }
    edges.sort_unstable();
    let mut keep = vec![true; part.labels.len()];
    for same in edges.chunk_by(|one, other| one.0 == other.0) {
        same[1..].iter().for_each(|&(_, face)| keep[face] = false);
    }
    super::scan::select(part, &keep);
}

#[cfg(test)]
mod tests {
    use super::super::part;
    use super::*;

    #[test]
    fn a_face_is_labelled_by_majority_and_a_tie_is_its_own() {
        assert_eq!(vote(1, [2, 2, 3]), 2);
        assert_eq!(vote(1, [1, 2, 2]), 1);
        assert_eq!(vote(1, [2, 2, 2]), 2);
        assert_eq!(vote(1, [2, 3, 4]), 1);
    }

    #[test]
    fn the_new_mesh_is_closed_and_its_edges_ignore_those_of_the_part() {
        let part = part("shaft", 8_000).unwrap();
        let new = resample(&mut Context::new(5), &part, 12_000, 0.15).unwrap();
        let faces = new.mesh.faces.len();
        assert!((0.9..1.1).contains(&(faces as f64 / 12e3)), "{faces}");
        let adjacency = Adjacency::new(&new.mesh.faces, new.mesh.positions.len());
        let open = adjacency.neighbours.iter().flatten().filter(|&&n| n == crate::mesh::NONE);
        assert_eq!(open.count(), 0);
        let size = part.mesh.size();
        let far = |face: usize| {
            let surface = &new.surfaces[new.labels[face] as usize];
            let far = new.mesh.corners(face).map(|p| surface.distance(p).unwrap().abs());
            far.into_iter().fold(0.0, f64::max) / size
        };
        // Faces across an edge of the part have a corner beyond it.
        let across = (0..faces).filter(|&face| far(face) > 1e-3).count();
        assert!(across > faces / 50, "{across} of {faces}");
    }
}
