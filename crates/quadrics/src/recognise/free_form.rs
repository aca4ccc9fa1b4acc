//! Free-form patches: what no surface explains, and where many surfaces continue each other, curvature
//! and all, so that none of them is the surface.

use std::collections::BTreeMap;

use super::assign::Model;
use super::moves::{LABEL, tidy};
use super::scene::Scene;
use super::seams::{Seam, pieces, seams};
use crate::mesh::NONE;
use crate::partition::{Regions, UNLABELLED, join, root};
use crate::surface::Surface;
use crate::surface::select;

/// Coefficients of a free-form patch, as a bicubic one of four by four control points. What parts are
/// designed from meets where curvature jumps: that it does not is itself evidence of one patch.
const COEFFICIENTS: f64 = 16.0;
/// Surfaces whose normals differ by less along their border, on the mean, continue each other.
const TANGENT_DEG: f64 = 6.0;
/// Their curvatures across it differ by less than this share of the larger one,
const JUMP: f64 = 0.5;
/// or by less than this, per size: shares say nothing of what is flat (1 is the same; with 2.5 pipe bends are
/// kept apart by the next limit alone).
const FLAT: f64 = 1.5;
/// Curvatures of two pieces of a patch differ by less than so many sigmas over the area of the smaller:
/// what a quadric of length `h` leaves of a third derivative `t` is `t h³ / 192`, and the two differ by
/// `t h`. Measured on three free-form patches: at most 410, and 1300 on a few pieces of 20 faces; tori
/// and the cylinders that continue them 21,000 and more.
const PIECE: f64 = 500.0;

/// A typed surface with more than this share of the area of a patch is no piece of it.
const MOST: f64 = 0.5;

/// Share of a patch that a region within it may have to be a spot of it.
const CRUMB: f64 = 0.05;

/// A scan rounds its edges over so many faces on either side: a ribbon that is no wider is no patch
/// (3 leaves some, 10 is the same).
const RIBBON: usize = 5;

/// Unlabelled faces that may be a patch: on scans those of what is wider than a ribbon, that is what
/// erosion leaves, grown again.
pub fn rest(scene: &Scene, labels: &[u32]) -> Vec<bool> {
    let rest: Vec<bool> = labels.iter().map(|&label| label == UNLABELLED).collect();
    if !scene.correlated() {
        return rest;
    }
    let mut wide = rest.clone();
    for _ in 0..RIBBON {
        let before = wide.clone();
        let stays = |face: usize| scene.adjacency.across(face).all(|other| before[other]);
        (0..wide.len()).filter(|&face| before[face]).for_each(|face| wide[face] = stays(face));
    }
    for _ in 0..RIBBON {
        let before = wide.clone();
        let comes = |face: usize| scene.adjacency.across(face).any(|other| before[other]);
        (0..wide.len()).filter(|&face| rest[face]).for_each(|face| wide[face] |= comes(face));
    }
    wide
}

/// Unites curved surfaces that continue each other where one free-form patch costs less than all
/// of them, and what such a patch encloses. On a clean mesh, where curvatures are known.
pub fn unite(scene: &Scene, models: &mut Vec<Model>, labels: &mut [u32]) {
    let regions = Regions::new(labels);
    let seams = seams(scene, models, labels);
    let area = |faces: &[u32]| faces.iter().map(|&f| scene.geometry.areas[f as usize]).sum();
    let areas: Vec<f64> = regions.iter().map(area).collect();
    let smooth = |seam: &Seam| {
        let area = areas[seam.one as usize].min(areas[seam.other as usize]);
        seam.is_smooth(TANGENT_DEG)
            && seam.jump < (JUMP * seam.bend).max(FLAT)
            && seam.jump * area < PIECE * scene.evidence.sigma
    };
    let joined = |piece: &[bool]| -> Vec<u32> {
        let may_join = |seam: &&Seam| piece[seam.one as usize] && piece[seam.other as usize];
        let mut patch: Vec<u32> = (0..models.len() as u32).collect();
        for seam in seams.iter().filter(may_join).filter(|seam| smooth(seam)) {
            join(&mut patch, 0, seam.one, seam.other);
        }
        (0..models.len() as u32).map(|id| root(&mut patch, 0, id)).collect()
    };
    let mut piece = pieces(scene, models, &regions);
    let patch = joined(&piece);
    let mut whole = vec![0.0; models.len()];
    patch.iter().zip(&areas).for_each(|(&patch, area)| whole[patch as usize] += area);
    // A fillet that a blend of the same radius continues is no piece of the blend.
    for id in 0..models.len() {
        let most = areas[id] > MOST * whole[patch[id] as usize];
        piece[id] &= !most || matches!(models[id].surface, Surface::Quadric(_));
    }
    let patch = joined(&piece);
    let mut price = vec![0.0; models.len()];
    let mut faces = vec![0usize; models.len()];
    for (id, &patch) in patch.iter().enumerate() {
        let own = regions.faces(id).len();
        price[patch as usize] += LABEL + coding(select::cost(&models[id].surface), own);
        faces[patch as usize] += own;
    }
    let mut free: Vec<bool> = patch
        .iter()
        .map(|&p| price[p as usize] > LABEL + coding(COEFFICIENTS, faces[p as usize]))
        .collect();
    let mut touching: Vec<Vec<&Seam>> = vec![Vec::new(); models.len()];
    for seam in &seams {
        touching[seam.one as usize].push(seam);
        touching[seam.other as usize].push(seam);
    }
    // What lies mostly within a patch and continues it is a piece of it.
    let mut into = patch;
    for id in (0..models.len() as u32).filter(|&id| !free[id as usize]).collect::<Vec<_>>() {
        let (mut around, mut within, mut host) = (0.0, 0.0, None);
        for seam in &touching[id as usize] {
            let other = seam.one + seam.other - id;
            around += seam.length;
            if smooth(seam) && free[other as usize] && into[other as usize] != id {
                within += seam.length;
                host = Some(into[other as usize]);
            }
        }
        if let (Some(host), true) = (host, 2.0 * within > around) {
            into[id as usize] = host;
        }
    }
    for id in 0..models.len() {
        let host = into[id] as usize;
        free[id] |= free[host];
        if free[id] {
            models[id].surface = Surface::FreeForm;
        }
    }
    labels.iter_mut().filter(|label| free[**label as usize]).for_each(|label| {
        *label = into[*label as usize];
    });
    tidy(models, labels);
    take_crumbs(scene, models, labels);
}

/// Hands small regions that a free-form one mostly surrounds, without a crease, to it: a curved patch has
/// spots that a surface of some type explains.
fn take_crumbs(scene: &Scene, models: &mut Vec<Model>, labels: &mut [u32]) {
    let free = |id: u32| matches!(models[id as usize].surface, Surface::FreeForm);
    if !(0..models.len() as u32).any(free) {
        return;
    }
    let mut areas = vec![0.0; models.len()];
    let mut around = vec![0.0; models.len()];
    let mut shared: BTreeMap<(u32, u32), (f64, f64)> = BTreeMap::new();
    for (face, &id) in labels.iter().enumerate() {
        areas[id as usize] += scene.geometry.areas[face];
        let corners = scene.mesh.corners(face);
        for (edge, &next) in scene.adjacency.neighbours[face].iter().enumerate() {
            if next == NONE || labels[next as usize] == id {
                continue;
            }
            let length = (corners[(edge + 1) % 3] - corners[edge]).norm();
            around[id as usize] += length;
            let host = labels[next as usize];
            if free(host) {
                let normals = &scene.geometry.normals;
                let turn = (normals[face] - normals[next as usize]).norm_squared();
                let border = shared.entry((id, host)).or_default();
                *border = (border.0 + length, border.1 + length * turn);
            }
        }
    }
    let smooth = 2.0 - 2.0 * TANGENT_DEG.to_radians().cos();
    let mut into: Vec<u32> = (0..models.len() as u32).collect();
    for ((id, host), (length, turn)) in shared {
        let small = areas[id as usize] < CRUMB * areas[host as usize];
        if small && 2.0 * length > around[id as usize] && turn < smooth * length {
            into[id as usize] = host;
        }
    }
    labels.iter_mut().for_each(|label| *label = into[*label as usize]);
    tidy(models, labels);
}

/// Nats that so many coefficients cost a region of so many faces, as in the choice of types.
fn coding(coefficients: f64, faces: usize) -> f64 {
    coefficients * (faces as f64 / 2.0).max(2.0).ln()
}
