//! Normals at a scale above the noise, stopping at edges.
//!
//! Bilateral filtering of face normals (Zheng et al., TVCG 2011): a face's normal becomes the mean of
//! its neighbours', weighted by area and by how alike they are. Raw normals of noisy meshes err by 10
//! to 30 degrees, which no decision about surfaces survives.

use rayon::prelude::*;

use crate::math::Vector;
use crate::mesh::{Adjacency, Geometry, Mesh};

/// Faces that share a vertex with each face, flat, the face itself first.
pub struct Rings {
    offsets: Vec<u32>,
    faces: Vec<u32>,
}

impl Rings {
    /// Gathers the ring of every face.
    pub fn new(mesh: &Mesh, adjacency: &Adjacency) -> Self {
        let rings: Vec<Vec<u32>> = (0..mesh.faces.len())
            .into_par_iter()
            .with_min_len(1024)
            .map(|face| {
                let mut ring = vec![face as u32];
                for &vertex in &mesh.faces[face] {
                    ring.extend(adjacency.around(vertex).iter().filter(|&&f| f != face as u32));
                }
                ring[1..].sort_unstable();
                ring.dedup();
                ring
            })
            .collect();
        let mut offsets = vec![0];
        let mut faces = Vec::with_capacity(rings.iter().map(Vec::len).sum());
        for ring in rings {
            faces.extend(ring);
            offsets.push(faces.len() as u32);
        }
        Self { offsets, faces }
    }

    /// A face and those that share a vertex with it.
    pub fn of(&self, face: usize) -> &[u32] {
        &self.faces[self.offsets[face] as usize..self.offsets[face + 1] as usize]
    }
}

/// Filters the face normals `rounds` times; normals further apart than about `reach` (radians) do
/// not influence each other.
pub fn filter(geometry: &Geometry, rings: &Rings, rounds: usize, reach: f64) -> Vec<Vector> {
    let mut normals = geometry.normals.clone();
    for _ in 0..rounds {
        normals = (0..normals.len())
            .into_par_iter()
            .with_min_len(1024)
            .map(|face| {
                let own = normals[face];
                let sum: Vector = rings
                    .of(face)
                    .iter()
                    .map(|&other| {
                        let normal = normals[other as usize];
                        let apart = (normal - own).norm_squared() / (reach * reach);
                        // A rational kernel: as good as the Gaussian, and no exponential per pair.
                        let alike = 1.0 / (1.0 + apart * apart);
                        normal * (geometry.areas[other as usize] * alike)
                    })
                    .sum();
                sum.try_normalize(f64::MIN_POSITIVE).unwrap_or(own)
            })
            .collect();
    }
    normals
}
