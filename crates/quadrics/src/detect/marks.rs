//! Which faces and vertices a search has seen: many searches, and none of them clears anything.

use crate::mesh::Working;

/// The number of the search that was last at each face and vertex.
pub struct Marks {
    faces: Vec<u32>,
    vertices: Vec<u32>,
    search: u32,
}

impl Marks {
    /// Nothing seen yet.
    pub fn new(working: &Working) -> Self {
        let (faces, vertices) = (vec![0; working.len()], vec![0; working.mesh.positions.len()]);
        Self { faces, vertices, search: 0 }
    }

    /// Begins a search, which has seen nothing.
    pub fn begin(&mut self) {
        self.search += 1;
    }

    /// Comes to a face; whether this search had not been there.
    #[inline]
    pub fn visit_face(&mut self, face: u32) -> bool {
        std::mem::replace(&mut self.faces[face as usize], self.search) != self.search
    }

    /// Comes to a vertex; whether this search had not been there.
    #[inline]
    pub fn visit_vertex(&mut self, vertex: u32) -> bool {
        std::mem::replace(&mut self.vertices[vertex as usize], self.search) != self.search
    }
}
