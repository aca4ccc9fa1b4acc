//! Planes of few faces on a clean mesh: the side of a plate that CAD programs write as two triangles, the
//! bottom of a small bore.
//!
//! A fit to so few vertices means nothing. That all of them lie in one plane does where what lies beside it
//! is across a crease, or much smaller: the facets of a curved surface are about as large as each other.

use super::assign::Model;
use super::scene::Scene;
use crate::math::Unit;
use crate::partition::UNLABELLED;
use crate::surface::{Plane, Shape, Surface};

/// Vertices of a facet lie off the plane of its largest face by less than so many sigmas.
const REACH: f64 = 2.5;
/// Its faces turn by less than this, in radians.
const FLAT: f64 = 0.02;
/// Facets of a curved surface turn by less than this against each other, in radians: the coarsest that is
/// recognised, and what curved surfaces leave when they were found.
const COARSEST: f64 = 1.0;
const CREASE: f64 = 0.35;
/// What is so many times as large as the facets beside it is no facet of the curved surface that they are of.
const LARGE: f64 = 3.0;
/// A single face beside so many others of which each is a facet is of something round.
const ROUND: usize = 2;

/// Faces without a label that lie in one plane and hang together.
struct Facet {
    plane: Plane,
    faces: Vec<usize>,
    area: f64,
}

/// All facets of the faces that have no label.
struct Facets<'s, 'm> {
    scene: &'s Scene<'m>,
    facets: Vec<Facet>,
    /// The one of each face, or [`NONE`].
    of: Vec<usize>,
}

/// A face in no facet.
const NONE: usize = usize::MAX;

/// Makes planes of the facets that are larger than any of a curved surface would be.
pub fn large(scene: &Scene, models: &mut Vec<Model>, labels: &mut [u32]) {
    let facets = Facets::new(scene, labels);
    let planes: Vec<usize> = (0..facets.facets.len()).filter(|&i| facets.is_large(i)).collect();
    facets.hand_out(&planes, models, labels);
}

/// Makes planes of what curved surfaces have left.
pub fn left(scene: &Scene, models: &mut Vec<Model>, labels: &mut [u32]) {
    let facets = Facets::new(scene, labels);
    let is_plane = |&i: &usize| facets.is_plane(i, labels);
    let planes: Vec<usize> = (0..facets.facets.len()).filter(is_plane).collect();
    facets.hand_out(&planes, models, labels);
}

impl<'s, 'm> Facets<'s, 'm> {
    fn new(scene: &'s Scene<'m>, labels: &[u32]) -> Self {
        let areas = &scene.geometry.areas;
        let free = |&face: &usize| labels[face] == UNLABELLED;
        let mut seeds: Vec<usize> = (0..labels.len()).filter(free).collect();
        // The plane of a large face is known best.
        seeds.sort_by(|&a, &b| areas[b].total_cmp(&areas[a]));
        let mut facets = Self { scene, facets: Vec::new(), of: vec![NONE; labels.len()] };
        for seed in seeds {
            let normal = Unit::try_new(scene.geometry.normals[seed], 0.5);
            if let Some(normal) = normal.filter(|_| facets.of[seed] == NONE) {
                let plane = Plane::through(scene.geometry.barycentres[seed], normal);
                facets.flood(plane, seed, labels);
            }
        }
        facets
    }

    /// Adds the facet of a face.
    fn flood(&mut self, plane: Plane, seed: usize, labels: &[u32]) {
        let Scene { geometry, mesh, adjacency, .. } = self.scene;
        let near = REACH * self.scene.evidence.sigma;
        let lies_in = |face: usize| {
            plane.normal.dot(&geometry.normals[face]) > FLAT.cos()
                && mesh.corners(face).iter().all(|p| plane.distance(*p).abs() < near)
        };
        let number = self.facets.len();
        self.of[seed] = number;
        let mut faces = vec![seed];
        let mut next = 0;
        while next < faces.len() {
            for other in adjacency.across(faces[next]) {
                if labels[other] == UNLABELLED && self.of[other] == NONE && lies_in(other) {
                    self.of[other] = number;
                    faces.push(other);
                }
            }
            next += 1;
        }
        let area = faces.iter().map(|&face| geometry.areas[face]).sum();
        self.facets.push(Facet { plane, faces, area });
    }

    /// The faces beside a facet that turn against it by less than `crease`.
    fn smoothly_beside(&self, facet: usize, crease: f64) -> impl Iterator<Item = usize> {
        let Facet { plane, faces, .. } = &self.facets[facet];
        let across = faces.iter().flat_map(|&face| self.scene.adjacency.across(face));
        across.filter(move |&other| {
            let turn = plane.normal.dot(&self.scene.geometry.normals[other]);
            self.of[other] != facet && turn > crease.cos()
        })
    }

    fn is_large(&self, facet: usize) -> bool {
        let area = |other: usize| self.facets.get(self.of[other]).map_or(0.0, |facet| facet.area);
        let most = self.facets[facet].area / LARGE;
        self.smoothly_beside(facet, COARSEST).all(|other| area(other) < most)
    }

    fn is_plane(&self, facet: usize, labels: &[u32]) -> bool {
        let Facet { faces, area, .. } = &self.facets[facet];
        let size =
            |face: usize| self.facets.get(self.of[face]).map_or(0, |facet| facet.faces.len());
        if faces.len() == 1 {
            let across = self.scene.adjacency.across(faces[0]);
            if across.filter(|&other| size(other) == 1).count() >= ROUND {
                return false;
            }
        }
        let areas = &self.scene.geometry.areas;
        self.smoothly_beside(facet, CREASE).all(|other| {
            if labels[other] == UNLABELLED {
                self.scene.tessellated && faces.len() > 1 && size(other) > 1
            } else {
                LARGE * areas[other] < *area
            }
        })
    }

    fn hand_out(self, planes: &[usize], models: &mut Vec<Model>, labels: &mut [u32]) {
        for &i in planes {
            let Facet { plane, faces, .. } = &self.facets[i];
            faces.iter().for_each(|&face| labels[face] = models.len() as u32);
            models.push(Model { surface: Surface::Plane(plane.clone()), side: 1.0 });
        }
    }
}
