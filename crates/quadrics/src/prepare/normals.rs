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
        let count = mesh.faces.len();
        // Chunks of faces, so that no list is made for a single one.
        let chunks: Vec<(Vec<u32>, Vec<u32>)> = (0..count.div_ceil(CHUNK))
            .into_par_iter()
            .map(|chunk| {
                let (mut sizes, mut faces) = (Vec::with_capacity(CHUNK), Vec::new());
                for face in chunk * CHUNK..count.min((chunk + 1) * CHUNK) {
                    let from = faces.len();
                    append(mesh, adjacency, face, &mut faces);
                    sizes.push((faces.len() - from) as u32);
                }
                (sizes, faces)
            })
            .collect();
        let mut offsets = Vec::with_capacity(count + 1);
        let mut faces = Vec::with_capacity(chunks.iter().map(|chunk| chunk.1.len()).sum());
        let mut end = 0;
        offsets.push(0);
        for (sizes, ring) in chunks {
            faces.extend(ring);
            for size in sizes {
                end += size;
                offsets.push(end);
            }
        }
        Self { offsets, faces }
    }

    /// A face and those that share a vertex with it.
    pub fn of(&self, face: usize) -> &[u32] {
        &self.faces[self.offsets[face] as usize..self.offsets[face + 1] as usize]
    }
}

/// Faces whose rings are gathered together.
const CHUNK: usize = 4096;

/// Appends a face, then those that share a vertex with it, ascending.
fn append(mesh: &Mesh, adjacency: &Adjacency, face: usize, ring: &mut Vec<u32>) {
    ring.push(face as u32);
    let from = ring.len();
    for &vertex in &mesh.faces[face] {
        ring.extend(adjacency.around(vertex).iter().filter(|&&f| f != face as u32));
    }
    ring[from..].sort_unstable();
    let mut last = from;
    for i in from + 1..ring.len() {
        if ring[i] != ring[last] {
            last += 1;
            ring[last] = ring[i];
        }
    }
    ring.truncate(ring.len().min(last + 1));
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
