//! Free-form patches: what no surface explains, and where many general surfaces touch smoothly, so that
//! none of them is the surface.

use super::assign::Model;
use super::moves::{LABEL, tidy};
use super::scene::Scene;
use crate::math::Point;
use crate::mesh::NONE;
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
    let borders = borders(scene, models, labels);
    let general =
        |id: u32| matches!(models[id as usize].surface, Surface::Quadric(_) | Surface::Torus(_));
    let mut patch: Vec<u32> = (0..models.len() as u32).collect();
    for border in borders.iter().filter(|b| b.smooth && general(b.one) && general(b.other)) {
        join(&mut patch, 0, border.one, border.other);
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
    let mut touching: Vec<Vec<&Border>> = vec![Vec::new(); models.len()];
    for border in &borders {
        touching[border.one as usize].push(border);
        touching[border.other as usize].push(border);
    }
    // What lies mostly within a patch and continues it is a piece of it.
    let mut into = patch;
    for id in (0..models.len() as u32).filter(|&id| !free[id as usize]).collect::<Vec<_>>() {
        let (mut around, mut within, mut host) = (0.0, 0.0, None);
        for border in &touching[id as usize] {
            let other = border.one + border.other - id;
            around += border.length;
            if border.smooth && free[other as usize] && into[other as usize] != id {
                within += border.length;
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

/// Where two regions touch.
struct Border {
    one: u32,
    other: u32,
    length: f64,
    /// Whether one surface continues the other.
    smooth: bool,
}

fn borders(scene: &Scene, models: &[Model], labels: &[u32]) -> Vec<Border> {
    let mut edges: Vec<(u32, u32, f64, f64)> = Vec::new();
    for (face, &label) in labels.iter().enumerate() {
        for (edge, &next) in scene.adjacency.neighbours[face].iter().enumerate() {
            if next == NONE || labels[next as usize] <= label {
                continue;
            }
            let other = labels[next as usize];
            let [a, b] = [edge, (edge + 1) % 3]
                .map(|k| scene.mesh.positions[scene.mesh.faces[face][k] as usize]);
            let middle = nalgebra::center(&a, &b);
            let turn = turn(&models[label as usize], &models[other as usize], middle);
            edges.push((label, other, (a - b).norm(), turn));
        }
    }
    edges.sort_by_key(|edge| (edge.0, edge.1));
    let limit = 2.0 - 2.0 * TANGENT_DEG.to_radians().cos();
    let border = |same: &[(u32, u32, f64, f64)]| {
        let length: f64 = same.iter().map(|e| e.2).sum();
        let turn: f64 = same.iter().map(|e| e.2 * e.3).sum();
        Border { one: same[0].0, other: same[0].1, length, smooth: turn < limit * length }
    };
    edges.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)).map(border).collect()
}

/// Squared difference of two surfaces' normals at a point; a free-form one has none to differ.
fn turn(one: &Model, other: &Model, at: Point) -> f64 {
    match (one.surface.normal(at), other.surface.normal(at)) {
        (Some(a), Some(b)) => 2.0 - 2.0 * one.side * other.side * a.dot(&b),
        _ => 0.0,
    }
}
