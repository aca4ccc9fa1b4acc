//! Planes of few faces on a clean mesh: the side of a plate that CAD programs write as two triangles, the
//! bottom of a small bore.
//!
//! A fit to so few vertices means nothing. That all of them lie in one plane does where creases, or
//! smaller faces of other surfaces, surround them.

use super::assign::Model;
use super::scene::Scene;
use crate::math::Unit;
use crate::partition::UNLABELLED;
use crate::surface::{Plane, Shape, Surface};

/// Vertices of a facet lie off the plane of its largest face by less than so many sigmas.
const REACH: f64 = 2.5;
/// Its faces turn by less than this, in radians.
const FLAT: f64 = 0.02;
/// Faces that turn by more lie across a crease: those of a curved surface turn by less against each other.
const CREASE: f64 = 0.35;
/// What is so many times as large as the faces of a curved surface beside it is none of them.
const LARGE: f64 = 3.0;
/// A single face beside so many others of which each is a facet is of something round.
const ROUND: usize = 2;

/// Makes a plane of every facet without a label.
pub fn add(scene: &Scene, models: &mut Vec<Model>, labels: &mut [u32]) {
    let areas = &scene.geometry.areas;
    let mut waiting: Vec<usize> = (0..labels.len()).filter(|&f| labels[f] == UNLABELLED).collect();
    waiting.sort_by(|&a, &b| areas[b].total_cmp(&areas[a]));
    let mut facet = vec![NONE; labels.len()];
    let mut found: Vec<(Plane, Vec<usize>)> = Vec::new();
    for seed in waiting {
        let normal = Unit::try_new(scene.geometry.normals[seed], 0.5);
        let Some(normal) = normal.filter(|_| facet[seed] == NONE) else { continue };
        let plane = Plane::through(scene.geometry.barycentres[seed], normal);
        let faces = flood(scene, &plane, seed, labels, &mut facet, found.len());
        found.push((plane, faces));
    }
    let is_single = |other: &usize| facet[*other] != NONE && found[facet[*other]].1.len() == 1;
    let is_plane = |(plane, faces): &(Plane, Vec<usize>)| {
        let round = faces.len() == 1
            && scene.adjacency.across(faces[0]).filter(is_single).count() >= ROUND;
        !round && is_bounded(scene, plane, faces, labels, &facet)
    };
    let planes: Vec<bool> = found.iter().map(is_plane).collect();
    for ((plane, faces), _) in found.into_iter().zip(planes).filter(|(_, is_plane)| *is_plane) {
        faces.iter().for_each(|&face| labels[face] = models.len() as u32);
        models.push(Model { surface: Surface::Plane(plane), side: 1.0 });
    }
}

/// A face in no facet.
const NONE: usize = usize::MAX;

/// The faces without a label that lie in a plane and hang together with `seed`; they get the number of their
/// facet.
fn flood(
    scene: &Scene,
    plane: &Plane,
    seed: usize,
    labels: &[u32],
    facet: &mut [usize],
    number: usize,
) -> Vec<usize> {
    let near = REACH * scene.evidence.sigma;
    let lies_in = |face: usize| {
        plane.normal.dot(&scene.geometry.normals[face]) > FLAT.cos()
            && scene.mesh.corners(face).iter().all(|p| plane.distance(*p).abs() < near)
    };
    facet[seed] = number;
    let mut faces = vec![seed];
    let mut next = 0;
    while next < faces.len() {
        for other in scene.adjacency.across(faces[next]) {
            if labels[other] == UNLABELLED && facet[other] == NONE && lies_in(other) {
                facet[other] = number;
                faces.push(other);
            }
        }
        next += 1;
    }
    faces
}

/// Whether all that lies beside a facet is across a crease, or a much smaller face of another surface.
fn is_bounded(
    scene: &Scene,
    plane: &Plane,
    faces: &[usize],
    labels: &[u32],
    facet: &[usize],
) -> bool {
    let areas = &scene.geometry.areas;
    let area: f64 = faces.iter().map(|&face| areas[face]).sum();
    let mut beside = faces.iter().flat_map(|&face| scene.adjacency.across(face));
    beside.all(|other| {
        facet[other] == facet[faces[0]]
            || plane.normal.dot(&scene.geometry.normals[other]) < CREASE.cos()
            || (labels[other] != UNLABELLED && LARGE * areas[other] < area)
    })
}
