//! A mesh together with what follows from it: what every station works on.

use super::{Adjacency, Geometry, Mesh};
use crate::math::triangle::Triangle;

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

    /// A face on its own.
    #[inline]
    pub fn triangle(&self, face: u32) -> Triangle {
        let (face, Geometry { normals, areas, .. }) = (face as usize, &self.geometry);
        Triangle { corners: self.mesh.corners(face), normal: normals[face], area: areas[face] }
    }

    /// Some faces.
    pub fn triangles<'f>(&self, faces: impl IntoIterator<Item = &'f u32>) -> Vec<Triangle> {
        faces.into_iter().map(|&face| self.triangle(face)).collect()
    }

    /// Visits the vertices at the other ends of a vertex's edges, each once or twice.
    pub fn for_each_neighbour(&self, vertex: u32, mut visit: impl FnMut(u32)) {
        for &face in self.adjacency.around(vertex) {
            self.mesh.faces[face as usize]
                .into_iter()
                .filter(|&v| v != vertex)
                .for_each(&mut visit);
        }
    }

    /// Whether there is no face.
    pub fn is_empty(&self) -> bool {
        self.mesh.faces.is_empty()
    }
}
