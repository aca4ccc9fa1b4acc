//! Which faces share an edge, and which share a vertex. By counting, not by hashing.

use rayon::prelude::*;

use super::edges::{Across, Edges, Stars};

/// Marks an edge without a neighbour: a border, or an edge that is not manifold.
pub const NONE: u32 = u32::MAX;

/// Neighbours of faces, flat.
#[derive(Debug, Clone, Default)]
pub struct Adjacency {
    /// The face across edge `i` of a face, from its corner `i` to corner `i + 1`; [`NONE`] at a border.
    pub neighbours: Vec<[u32; 3]>,
    stars: Stars,
}

impl Adjacency {
    /// Adjacency of `faces` over `vertices` vertices. Edges of more than two faces have no neighbours.
    pub fn new(faces: &[[u32; 3]], vertices: usize) -> Self {
        let stars = Stars::new(faces, vertices);
        let edges = Edges::new(faces, &stars);
        let neighbour = |half_edge: u32| match edges.across(half_edge) {
            Across::One(other) => other / 3,
            Across::Nothing | Across::Many => NONE,
        };
        let all = (0..faces.len() as u32).into_par_iter().with_min_len(4096);
        let neighbours = all.map(|face| [0, 1, 2].map(|i| neighbour(3 * face + i))).collect();
        Self { neighbours, stars }
    }

    /// The faces at a vertex, in ascending order.
    pub fn around(&self, vertex: u32) -> &[u32] {
        self.stars.of(vertex)
    }

    /// The faces across the edges of `face`.
    pub fn across(&self, face: usize) -> impl Iterator<Item = usize> {
        self.neighbours[face].into_iter().filter(|&n| n != NONE).map(|n| n as usize)
    }
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
