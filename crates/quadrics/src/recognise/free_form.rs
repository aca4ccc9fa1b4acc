//! Free-form patches: what no surface explains, and where many general surfaces touch smoothly, so that
//! none of them is the surface.

use super::assign::Model;
use super::moves::{LABEL, tidy};
use super::scene::Scene;
use super::seams::{Seam, seams};
use crate::partition::{Regions, UNLABELLED, join, root};
use crate::surface::Surface;
use crate::surface::select;

/// Coefficients of a free-form patch, as a spline of about nine by nine control points.
const COEFFICIENTS: f64 = 80.0;
/// Surfaces whose normals differ by less along their border, on the mean, continue each other.
const TANGENT_DEG: f64 = 6.0;

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

/// Unites general surfaces that continue each other where one free-form patch costs less than all
/// of them, and what such a patch encloses.
pub fn unite(scene: &Scene, models: &mut Vec<Model>, labels: &mut [u32]) {
    let regions = Regions::new(labels);
    let seams = seams(scene, models, labels);
    let general =
        |id: u32| matches!(models[id as usize].surface, Surface::Quadric(_) | Surface::Torus(_));
    let mut patch: Vec<u32> = (0..models.len() as u32).collect();
    let smooth = |seam: &Seam| seam.is_smooth(TANGENT_DEG);
    for seam in seams.iter().filter(|s| smooth(s) && general(s.one) && general(s.other)) {
        join(&mut patch, 0, seam.one, seam.other);
    }
    let patch: Vec<u32> = (0..models.len() as u32).map(|id| root(&mut patch, 0, id)).collect();
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
}

/// Nats that so many coefficients cost a region of so many faces, as in the choice of types.
fn coding(coefficients: f64, faces: usize) -> f64 {
    coefficients * (faces as f64 / 2.0).max(2.0).ln()
}
