//! A mesh together with what follows from it: what every station works on.

use super::{Adjacency, Geometry, Mesh};

/// A mesh, its per-face quantities and its neighbourhoods, computed once.
#[derive(Debug, Clone, Default)]
pub struct Working {
    /// Positions and faces.
    pub mesh: Mesh,
    /// Barycentres, normals and areas of the faces.
    pub geometry: Geometry,
    /// Which faces share an edge.
    pub adjacency: Adjacency,
}

impl Working {
    /// Computes what follows from a mesh whose indices are in range.
    pub fn new(mesh: Mesh) -> Self {
        let (geometry, adjacency) = rayon::join(
            || Geometry::new(&mesh),
            || Adjacency::new(&mesh.faces, mesh.positions.len()),
        );
        Self { mesh, geometry, adjacency }
    }

    /// Number of faces.
    pub fn len(&self) -> usize {
        self.mesh.faces.len()
    }

    /// Whether there is no face.
    pub fn is_empty(&self) -> bool {
        self.mesh.faces.is_empty()
    }
}
