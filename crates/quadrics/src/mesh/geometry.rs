//! Areas, normals and barycentres of all faces, once for everybody.

use rayon::prelude::*;

use super::Mesh;
use crate::math::triangle::Triangle;
use crate::math::{Point, Vector};

/// Per-face quantities as flat arrays.
#[derive(Debug, Clone, Default)]
pub struct Geometry {
    /// Barycentre of every face.
    pub barycentres: Vec<Point>,
    /// Unit normal of every face; zero where the face has no area.
    pub normals: Vec<Vector>,
    /// Area of every face.
    pub areas: Vec<f64>,
}

impl Geometry {
    /// Computes all of it in one parallel pass.
    pub fn new(mesh: &Mesh) -> Self {
        let (barycentres, (normals, areas)) = (0..mesh.faces.len())
            .into_par_iter()
            .with_min_len(1024)
            .map(|face| {
                let triangle = Triangle::new(mesh.corners(face));
                (triangle.barycentre(), (triangle.normal, triangle.area))
            })
            .unzip();
        Self { barycentres, normals, areas }
    }
}
