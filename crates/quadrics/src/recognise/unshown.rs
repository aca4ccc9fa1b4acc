//! Regions that the vertices of a noisy mesh do not show.
//!
//! On a coarser mesh faces run across creases, and strips of them look like chamfers. The vertices of
//! the finer mesh tell: each says by how much it lies off a surface, whatever the normals are.

use super::assign::Model;
use super::moves;
use super::scene::Scene;
use crate::math::Point;
use crate::partition::Regions;
use crate::surface::{Surface, select};

/// What a region must save beside the price of its surface, in nats over its vertices: half of what it
/// must save over faces, which count every vertex twice. Not scanned.
const KEEP: f64 = 30.0;
/// A region that saves so much is not counted to its end.
const PLENTY: f64 = 1000.0;

/// Rounds over all regions: the second and third drop what grew in the first.
const ROUNDS: usize = 3;

/// Hands regions to the surfaces around them that explain their vertices as well.
pub fn drop_unshown(scene: &Scene, models: &mut Vec<Model>, labels: &mut [u32]) {
    for _ in 0..ROUNDS {
        let regions = Regions::new(labels);
        let mut order: Vec<usize> = (0..regions.len()).collect();
        order.sort_by_key(|&id| regions.faces(id).len());
        let mut dropped = false;
        for id in order {
            if let Some(moved) = explained(scene, models, labels, id as u32, regions.faces(id)) {
                regions.faces(id).iter().zip(moved).for_each(|(&f, to)| labels[f as usize] = to);
                dropped = true;
            }
        }
        if !dropped {
            return;
        }
        moves::tidy(models, labels);
    }
}

/// The neighbour of every face, if they explain a region as well as its own surface does.
fn explained(
    scene: &Scene,
    models: &[Model],
    labels: &[u32],
    id: u32,
    faces: &[u32],
) -> Option<Vec<u32>> {
    let own = &models[id as usize].surface;
    let free = |id: u32| matches!(models[id as usize].surface, Surface::FreeForm);
    let mut around: Vec<u32> = scene.beside(id, faces, labels).filter(|&n| !free(n)).collect();
    around.sort_unstable();
    around.dedup();
    if free(id) || around.is_empty() {
        return None;
    }
    let vertices = (faces.len() as f64 / 2.0).max(2.0);
    let price = KEEP + (select::cost(own) - scene.shown.held(own).0) * vertices.ln();
    let mut saved = 0.0;
    let mut moved = Vec::with_capacity(faces.len());
    for &face in faces {
        // Which one is nearer to the surface, not to a vertex that errs.
        let middle = scene.geometry.barycentres[face as usize];
        let below = own.project(middle).unwrap_or(middle);
        let off = |id: u32| models[id as usize].surface.distance(below).map_or(FAR, f64::abs);
        let to = *around.iter().min_by(|&&a, &&b| off(a).total_cmp(&off(b)))?;
        saved += misfit(scene, &models[to as usize].surface, face) - misfit(scene, own, face);
        if saved > price + PLENTY {
            return None;
        }
        moved.push(to);
    }
    (saved < price).then_some(moved)
}

/// A distance beyond all others in the unit cube, where there is none.
const FAR: f64 = 1e3;

/// Minus the log-likelihood of a face's share of the vertices: two faces have one.
fn misfit(scene: &Scene, surface: &Surface, face: u32) -> f64 {
    let away = |p: &Point| surface.distance(*p).unwrap_or(FAR).powi(2);
    let squared = scene.mesh.corners(face as usize).iter().map(away).sum::<f64>() / 3.0;
    squared / (4.0 * scene.evidence.sigma.powi(2))
}
