//! Triangle meshes: positions and faces, and what follows from them alone.

mod adjacency;
mod caps;
mod edges;
mod geometry;
mod inspect;
mod orient;
mod repair;
#[cfg(test)]
pub(crate) mod samples;
mod substitute;
mod validate;
pub(crate) mod weld;
mod windings;
mod working;

pub use adjacency::{Adjacency, NONE};
pub use geometry::Geometry;
pub use inspect::{Inspection, inspect};
pub use repair::{Repaired, repair};
pub use validate::{LARGEST_COORDINATE, check_indices, validate};
pub use working::Working;

use rayon::prelude::*;

use crate::math::Point;

/// An indexed triangle mesh. Faces are counter-clockwise seen from outside.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Mesh {
    /// Where the vertices are, in the unit of the input.
    pub positions: Vec<Point>,
    /// Three vertices a face, counted from 0.
    pub faces: Vec<[u32; 3]>,
}

impl Mesh {
    /// The three corners of a face.
    #[inline]
    pub fn corners(&self, face: usize) -> [Point; 3] {
        let [a, b, c] = self.faces[face];
        [self.positions[a as usize], self.positions[b as usize], self.positions[c as usize]]
    }

    /// Least and greatest coordinates of the vertices that faces use; `None` without faces.
    pub fn bounds(&self) -> Option<(Point, Point)> {
        let of_face = |face| {
            let [a, b, c] = self.corners(face);
            (a.inf(&b).inf(&c), a.sup(&b).sup(&c))
        };
        let faces = (0..self.faces.len()).into_par_iter().with_min_len(4096);
        faces.map(of_face).reduce_with(|one, other| (one.0.inf(&other.0), one.1.sup(&other.1)))
    }

    /// The longest side of the bounding box: the *size* that relative lengths refer to.
    pub fn size(&self) -> f64 {
        self.bounds().map_or(0.0, |(low, high)| (high - low).max())
    }
}
