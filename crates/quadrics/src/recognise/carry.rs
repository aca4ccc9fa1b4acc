//! From the surfaces of a coarser mesh to the faces of the finer one.

use rayon::prelude::*;

use super::assign::{self, Model, face_cost};
use super::moves;
use super::scene::Scene;
use crate::math::Vector;
use crate::mesh::Adjacency;
use crate::partition::{Labels, UNLABELLED};

/// Labels of the faces of a mesh, from those of the coarser one that surfaces were found on.
///
/// `site` names the vertex of the coarser mesh that stands for each vertex. Only where cells of
/// several regions meet does a face choose, by what it costs.
pub fn carry(
    scene: &Scene,
    coarse: &Adjacency,
    site: &[u32],
    labels: &[u32],
    models: &mut Vec<Model>,
) -> Labels {
    let around = Around::new(coarse, labels, site);
    let choose = |face: usize| {
        let [a, b, c] = scene.mesh.faces[face].map(|v| around.of(site[v as usize]));
        if let ([one], [other], [third]) = (a, b, c)
            && one == other
            && other == third
        {
            return *one;
        }
        let cost = |&label: &u32| (face_cost(scene, &models[label as usize], face), label);
        let costs = a.iter().chain(b).chain(c).map(cost);
        let least = costs.min_by(|p, q| p.0.total_cmp(&q.0).then(p.1.cmp(&q.1)));
        least.map_or(UNLABELLED, |(_, label)| label)
    };
    let faces = (0..scene.mesh.faces.len()).into_par_iter().with_min_len(4096);
    let mut labels: Labels = faces.map(choose).collect();
    assign::flood(scene, models, &mut labels);
    assign::name_the_rest(scene, models, &mut labels);
    labels
}

/// Cuts between the surfaces that were carried up, where they compete.
pub fn settle(scene: &Scene, models: &mut Vec<Model>, labels: &mut Labels) {
    assign::expand(scene, models, labels);
    assign::connect(scene, models, labels);
    moves::tidy(models, labels);
}

/// Normals for the faces of a mesh from the filtered ones of the coarser mesh: where the noise is as
/// large as the edges, its own say nothing.
pub fn normals(scene: &Scene, coarse: &Scene, site: &[u32]) -> Vec<Vector> {
    let at = |&vertex: &u32| {
        let faces = coarse.adjacency.around(vertex).iter().map(|&face| face as usize);
        faces.map(|face| coarse.normals[face] * coarse.geometry.areas[face]).sum::<Vector>()
    };
    let sites: Vec<u32> = (0..coarse.mesh.positions.len() as u32).collect();
    let of_site: Vec<Vector> = sites.par_iter().map(at).collect();
    let of_face = |corners: &[u32; 3]| {
        let sum: Vector = corners.iter().map(|&v| of_site[site[v as usize] as usize]).sum();
        sum.try_normalize(f64::MIN_POSITIVE).unwrap_or_else(Vector::zeros)
    };
    scene.mesh.faces.par_iter().with_min_len(4096).map(of_face).collect()
}

/// The regions that meet at every vertex of the coarser mesh, flat.
struct Around {
    offsets: Vec<u32>,
    labels: Vec<u32>,
}

impl Around {
    fn new(coarse: &Adjacency, of_face: &[u32], site: &[u32]) -> Self {
        let count = site.iter().max().map_or(0, |&last| last as usize + 1);
        let mut around = Self { offsets: vec![0], labels: Vec::with_capacity(count) };
        let mut own = Vec::new();
        for vertex in 0..count as u32 {
            own.clear();
            own.extend(coarse.around(vertex).iter().map(|&face| of_face[face as usize]));
            own.sort_unstable();
            own.dedup();
            around.labels.extend_from_slice(&own);
            around.offsets.push(around.labels.len() as u32);
        }
        around
    }

    fn of(&self, vertex: u32) -> &[u32] {
        let at = |i: u32| self.offsets[i as usize] as usize;
        &self.labels[at(vertex)..at(vertex + 1)]
    }
}
