//! Which faces share an edge, and which share a vertex. By sorting, not by hashing.

use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

use rayon::prelude::*;

use super::edges::fold_edges;

/// Marks an edge without a neighbour: a border, or an edge that is not manifold.
pub const NONE: u32 = u32::MAX;

/// Neighbours of faces, flat.
#[derive(Debug, Clone, Default)]
pub struct Adjacency {
    /// The face across edge `i` of a face, from its corner `i` to corner `i + 1`; [`NONE`] at a border.
    pub neighbours: Vec<[u32; 3]>,
    /// Faces around vertex `v`: `incident[offsets[v]..offsets[v + 1]]`.
    offsets: Vec<u32>,
    incident: Vec<u32>,
}

impl Adjacency {
    /// Adjacency of `faces` over `vertices` vertices. Edges of more than two faces have no neighbours.
    pub fn new(faces: &[[u32; 3]], vertices: usize) -> Self {
        let (neighbours, (offsets, incident)) = rayon::join(
            || face_neighbours(faces, vertices),
            || faces_around_vertices(faces, vertices),
        );
        Self { neighbours, offsets, incident }
    }

    /// The faces at a vertex, in ascending order.
    pub fn around(&self, vertex: u32) -> &[u32] {
        let v = vertex as usize;
        &self.incident[self.offsets[v] as usize..self.offsets[v + 1] as usize]
    }

    /// The faces across the edges of `face`.
    pub fn across(&self, face: usize) -> impl Iterator<Item = usize> {
        self.neighbours[face].into_iter().filter(|&n| n != NONE).map(|n| n as usize)
    }
}

fn face_neighbours(faces: &[[u32; 3]], vertices: usize) -> Vec<[u32; 3]> {
    let (twins, _) = twins(faces, vertices, |(), _| ());
    let face_of = |half_edge: u32| if half_edge == NONE { NONE } else { half_edge / 3 };
    twins.into_par_iter().map(|twins| twins.map(face_of)).collect()
}

/// The half-edge on the other side of every half-edge, [`NONE`] at borders and non-manifold edges; and
/// what `count` gathers from the edges.
pub(super) fn twins<T: Default + Send>(
    faces: &[[u32; 3]],
    vertices: usize,
    count: impl Fn(&mut T, &[u32]) + Sync,
) -> (Vec<[u32; 3]>, Vec<T>) {
    // Each is written once at most, by whichever thread has its edge.
    let none = |_: &[u32; 3]| [0; 3].map(|_| AtomicU32::new(NONE));
    let twins: Vec<[AtomicU32; 3]> = faces.par_iter().map(none).collect();
    let put = |half_edge: u32, twin: u32| {
        twins[half_edge as usize / 3][half_edge as usize % 3].store(twin, Relaxed);
    };
    let counts = fold_edges(faces, vertices, |counts, edge| {
        count(counts, edge);
        if let &[one, other] = edge {
            put(one, other);
            put(other, one);
        }
    });
    (twins.into_par_iter().map(|twins| twins.map(AtomicU32::into_inner)).collect(), counts)
}

fn faces_around_vertices(faces: &[[u32; 3]], vertices: usize) -> (Vec<u32>, Vec<u32>) {
    let mut offsets = vec![0u32; vertices + 1];
    for &vertex in faces.iter().flatten() {
        offsets[vertex as usize + 1] += 1;
    }
    for v in 0..vertices {
        offsets[v + 1] += offsets[v];
    }
    let mut next = offsets.clone();
    let mut incident = vec![0; 3 * faces.len()];
    for (face, corners) in faces.iter().enumerate() {
        for &vertex in corners {
            incident[next[vertex as usize] as usize] = face as u32;
            next[vertex as usize] += 1;
        }
    }
    (offsets, incident)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_triangles_of_a_square_see_each_other_across_the_diagonal() {
        let adjacency = Adjacency::new(&[[0, 1, 2], [0, 2, 3]], 4);
        assert_eq!(adjacency.neighbours, [[NONE, NONE, 1], [0, NONE, NONE]]);
        assert_eq!(adjacency.around(2), [0, 1]);
    }

    #[test]
    fn an_edge_of_three_faces_has_no_neighbours() {
        let adjacency = Adjacency::new(&[[0, 1, 2], [1, 0, 3], [0, 1, 4]], 5);
        assert!(adjacency.neighbours.iter().flatten().all(|&n| n == NONE));
    }
}
