//! From the surfaces of a coarser mesh to the faces of the finer one.

use rayon::prelude::*;

use super::assign::{self, Model, face_cost};
use super::detect::{self, Candidate, Growth};
use super::scene::Scene;
use super::{evidence, expand, merge, moves};
use crate::context::Context;
use crate::error::Result;
use crate::math::Vector;
use crate::mesh::Adjacency;
use crate::partition::{Labels, UNLABELLED, components};
use crate::surface::{Shape, Surface};

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

/// Seeks surfaces where none that was carried up explains the faces: what is too small for the
/// coarser mesh to show. The faces of a mesh that is `faceted` lie off their surfaces, as most others
/// of their region do.
///
/// # Errors
/// Cancellation.
pub fn complete(
    context: &mut Context,
    scene: &Scene,
    models: &mut Vec<Model>,
    labels: &mut Labels,
    faceted: bool,
) -> Result<()> {
    let surfaces: Vec<Surface> = models.iter().map(|model| model.surface.clone()).collect();
    let most = if faceted {
        evidence::distances(scene, &surfaces, labels, MOST)
    } else {
        vec![0.0; surfaces.len()]
    };
    let turn = 2.0 - 2.0 * detect::CREASE.cos();
    let strange = |(face, &label): (usize, &u32)| {
        let (model, most) = (&models[label as usize], most[label as usize]);
        let reach = STRANGE * most.max(scene.evidence.sigma);
        !explains(scene, model, face, reach * reach, turn)
    };
    let strange: Vec<bool> =
        labels.par_iter().with_min_len(4096).enumerate().map(strange).collect();
    let marks: Vec<u32> = strange.iter().map(|&strange| u32::from(strange)).collect();
    let (component, sizes) = components(&marks, scene.adjacency);
    for (face, label) in labels.iter_mut().enumerate().filter(|(face, _)| strange[*face]) {
        if sizes[component[face] as usize] as usize >= detect::FEWEST {
            *label = UNLABELLED;
        }
    }
    let found = detect::explain(context, scene, labels, Growth::Within, models.len() as u32, 1.0)?;
    let found = found.unwrap_or_default();
    let nothing = found.is_empty();
    models.extend(found.into_iter().map(Candidate::into_model));
    assign::flood(scene, models, labels);
    assign::name_the_rest(scene, models, labels);
    if nothing {
        return Ok(());
    }
    // What was found may be a piece of a region beside it.
    moves::drop_needless(scene, models, labels);
    moves::tidy(models, labels);
    merge::merge(context, scene, models, labels)
}

/// A face is not explained when it is so many times farther than this share of its region.
const STRANGE: f64 = 3.0;
const MOST: f64 = 0.8;

/// Whether a face is near enough, and turned as the surface is.
fn explains(scene: &Scene, model: &Model, face: usize, near: f64, turn: f64) -> bool {
    fn of<S: Shape>(
        scene: &Scene,
        shape: &S,
        side: f64,
        face: usize,
        near: f64,
        turn: f64,
    ) -> bool {
        scene.squared_distance(shape, face) < near
            && scene.normal_deviation(shape, face, side) < turn
    }
    match &model.surface {
        Surface::Plane(s) => of(scene, s, model.side, face, near, turn),
        Surface::Sphere(s) => of(scene, s, model.side, face, near, turn),
        Surface::Cylinder(s) => of(scene, s, model.side, face, near, turn),
        Surface::Cone(s) => of(scene, s, model.side, face, near, turn),
        Surface::Torus(s) => of(scene, s, model.side, face, near, turn),
        Surface::Quadric(s) => of(scene, &s.principal(), model.side, face, near, turn),
        Surface::FreeForm => true,
    }
}

/// Cuts between surfaces where they compete.
pub fn settle(scene: &Scene, models: &mut Vec<Model>, labels: &mut Labels) {
    expand::expand(scene, models, labels);
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
