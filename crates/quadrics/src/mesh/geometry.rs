//! Areas, normals and barycentres of all faces, once for everybody.

use rayon::prelude::*;

use super::Mesh;
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
                let [a, b, c] = mesh.corners(face);
                let cross = (b - a).cross(&(c - a));
                let length = cross.norm();
                let normal = if length > 0.0 { cross / length } else { Vector::zeros() };
                let barycentre = Point::from((a.coords + b.coords + c.coords) / 3.0);
                (barycentre, (normal, length / 2.0))
            })
            .unzip();
        Self { barycentres, normals, areas }
    }
}
