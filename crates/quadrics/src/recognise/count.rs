//! Exactly as many regions as the user asks for (the paper's κ, section 4.3(3) and (4)).

use super::assign::{Model, face_cost};
use super::merge::merge_down;
use super::moves;
use super::scene::{Marks, Scene};
use crate::context::Context;
use crate::error::Result;
use crate::math::Unit;
use crate::partition::Regions;
use crate::surface::{Plane, Surface};

/// Rounds of regrouping between an inserted region and the one it was taken from.
const REGROUP: usize = 4;

/// Merges the pairs of least increase, or splits the worst regions, until `goal` are left.
///
/// # Errors
/// Cancellation.
pub fn reach(
    context: &mut Context,
    scene: &Scene,
    models: &mut Vec<Model>,
    labels: &mut [u32],
    goal: usize,
) -> Result<()> {
    while models.len() < goal.min(labels.len()) {
        context.step("insert", models.len() as f64 / goal as f64)?;
        if !insert(scene, models, labels) {
            break;
        }
    }
    merge_down(context, scene, models, labels, goal)
}

/// Splits the region of the largest total cost from its worst face; whether one could be split.
fn insert(scene: &Scene, models: &mut Vec<Model>, labels: &mut [u32]) -> bool {
    let regions = Regions::new(labels);
    let cost = |region: usize, face: u32| face_cost(scene, &models[region], face as usize);
    let total = |region: usize| regions.faces(region).iter().map(|&f| cost(region, f)).sum::<f64>();
    let splittable = (0..regions.len()).filter(|&r| regions.faces(r).len() >= 2);
    let Some((_, worst)) = splittable.map(|r| (total(r), r)).max_by(|a, b| a.0.total_cmp(&b.0))
    else {
        return false;
    };
    let faces = regions.faces(worst);
    let Some(&seed) = faces.iter().max_by(|a, b| cost(worst, **a).total_cmp(&cost(worst, **b)))
    else {
        return false;
    };
    let new = models.len() as u32;
    let Some(normal) = Unit::try_new(scene.normals[seed as usize], 0.5) else { return false };
    let plane = Plane::through(scene.geometry.barycentres[seed as usize], normal);
    let mut pair = [models[worst].clone(), Model { surface: Surface::Plane(plane), side: 1.0 }];
    let mut part = vec![seed];
    let mut seen = Marks::default();
    for _ in 0..REGROUP {
        let grown = connected(scene, &pair, labels, worst as u32, seed, &mut seen);
        if grown.len() == faces.len() || grown == part {
            break;
        }
        part = grown;
        seen.clear(labels.len());
        part.iter().for_each(|&f| {
            seen.mark(f);
        });
        let rest: Vec<u32> = faces.iter().copied().filter(|&f| !seen.has(f)).collect();
        moves::fit_one(scene, &mut pair[0], &rest);
        moves::fit_one(scene, &mut pair[1], &part);
    }
    part.iter().for_each(|&f| labels[f as usize] = new);
    models[worst] = pair[0].clone();
    models.push(pair[1].clone());
    true
}

/// The faces of a region that hang together with the seed and fit the second surface better.
fn connected(
    scene: &Scene,
    pair: &[Model; 2],
    labels: &[u32],
    region: u32,
    seed: u32,
    seen: &mut Marks,
) -> Vec<u32> {
    let better = |f: usize| face_cost(scene, &pair[1], f) < face_cost(scene, &pair[0], f);
    seen.clear(labels.len());
    seen.mark(seed);
    let mut part = vec![seed];
    let mut next = 0;
    while next < part.len() {
        for other in scene.adjacency.across(part[next] as usize) {
            if labels[other] == region && better(other) && seen.mark(other as u32) {
                part.push(other as u32);
            }
        }
        next += 1;
    }
    part
}
