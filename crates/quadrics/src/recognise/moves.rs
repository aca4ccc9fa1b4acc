//! Moves between partitions: fit again, drop a region that its neighbours explain, merge two that
//! one surface explains. Each lowers the same criterion.

use rayon::prelude::*;

use super::assign::{Model, face_cost};
use super::detect::side_of;
use super::scene::{Marks, Scene};
use crate::mesh::NONE;
use crate::partition::{Regions, UNLABELLED, compact};
use crate::surface::Surface;
use crate::surface::select::{self, Choice, Evidence};

/// What one more region costs besides its surface: its boundary and its label.
pub const LABEL: f64 = 10.0;
/// Vertices that a fit looks at.
const SAMPLES: usize = 200;
/// Regions whose normals differ more across their border, on the mean, are not one surface.
const SMOOTH_DEG: f64 = 25.0;

/// Chooses the surface of every region anew.
pub fn fit(scene: &Scene, models: &mut [Model], labels: &[u32]) {
    let regions = Regions::new(labels);
    models.par_iter_mut().enumerate().for_each_init(Marks::default, |marks, (id, model)| {
        if id < regions.len() {
            refit(scene, model, regions.faces(id), marks);
        }
    });
}

/// Chooses the surface of one region anew.
pub fn fit_one(scene: &Scene, model: &mut Model, faces: &[u32]) {
    refit(scene, model, faces, &mut Marks::default());
}

fn refit(scene: &Scene, model: &mut Model, faces: &[u32], marks: &mut Marks) {
    if matches!(model.surface, Surface::FreeForm) {
        return;
    }
    if let Some(choice) = choose(scene, faces, scene.evidence, marks) {
        model.side = side_of(scene, &choice.surface, faces);
        model.surface = choice.surface;
    }
}

fn choose(scene: &Scene, faces: &[u32], evidence: Evidence, marks: &mut Marks) -> Option<Choice> {
    let gathered = scene.samples(faces, SAMPLES, marks);
    select::choose(gathered.samples(), gathered.total, evidence).into_iter().next()
}

/// Removes labels without faces and their models.
pub fn tidy(models: &mut Vec<Model>, labels: &mut [u32]) {
    let old = labels.to_vec();
    let count = compact(labels);
    let mut kept: Vec<Option<Model>> = vec![None; count];
    for (face, &label) in labels.iter().enumerate() {
        let slot = &mut kept[label as usize];
        if slot.is_none() {
            *slot = Some(models[old[face] as usize].clone());
        }
    }
    *models = kept.into_iter().flatten().collect();
}

/// Pairs of regions that touch, with the mean squared difference of normals across their border.
pub fn borders(scene: &Scene, labels: &[u32]) -> Vec<(u32, u32, f64)> {
    let mut edges: Vec<(u32, u32, f64)> = Vec::new();
    for (face, &label) in labels.iter().enumerate() {
        for other in scene.adjacency.neighbours[face] {
            if other != NONE && labels[other as usize] > label {
                let turn = (scene.normals[face] - scene.normals[other as usize]).norm_squared();
                edges.push((label, labels[other as usize], turn));
            }
        }
    }
    edges.sort_by(|a, b| (a.0, a.1).cmp(&(b.0, b.1)).then(a.2.total_cmp(&b.2)));
    edges
        .chunk_by(|a, b| (a.0, a.1) == (b.0, b.1))
        .map(|same| {
            let mean = same.iter().map(|e| e.2).sum::<f64>() / same.len() as f64;
            (same[0].0, same[0].1, mean)
        })
        .collect()
}

/// Hands regions to their neighbours where that costs less than the region; how many went.
pub fn drop_needless(scene: &Scene, models: &[Model], labels: &mut [u32]) -> usize {
    let regions = Regions::new(labels);
    let mut order: Vec<usize> = (0..regions.len()).collect();
    order.sort_by_key(|&id| regions.faces(id).len());
    let mut dropped = 0;
    for id in order {
        let faces = regions.faces(id);
        if faces.is_empty() {
            continue;
        }
        let mut neighbours: Vec<u32> = faces
            .iter()
            .flat_map(|&f| scene.adjacency.neighbours[f as usize])
            .filter(|&f| f != NONE && labels[f as usize] != id as u32)
            .map(|f| labels[f as usize])
            .collect();
        neighbours.sort_unstable();
        neighbours.dedup();
        if neighbours.is_empty() {
            continue;
        }
        let vertices = (faces.len() as f64 / 2.0).max(2.0);
        let price = LABEL + 2.0 * select::cost(&models[id].surface) * vertices.ln() / 2.0;
        let mut gain = price;
        let mut moved: Vec<u32> = Vec::with_capacity(faces.len());
        for &face in faces {
            let best = neighbours
                .iter()
                .map(|&n| (face_cost(scene, &models[n as usize], face as usize), n))
                .min_by(|a, b| a.0.total_cmp(&b.0));
            let Some((cost, label)) = best else { break };
            gain -= cost - face_cost(scene, &models[id], face as usize);
            moved.push(label);
            if gain < -1000.0 {
                break;
            }
        }
        if gain > 0.0 && moved.len() == faces.len() {
            faces.iter().zip(moved).for_each(|(&f, label)| labels[f as usize] = label);
            dropped += 1;
        }
    }
    dropped
}

/// Merges pairs that one surface explains, best gain first, until none is left or `goal` regions
/// remain; how many went.
pub fn merge(scene: &Scene, models: &mut Vec<Model>, labels: &mut [u32]) -> usize {
    let evidence = merging(scene.evidence);
    let mut merged = 0;
    loop {
        let regions = Regions::new(labels);
        let own: Vec<f64> = (0..regions.len())
            .into_par_iter()
            .map_init(Marks::default, |marks, id| {
                let gathered = scene.samples(regions.faces(id), SAMPLES, marks);
                let surface = models[id].surface.clone();
                select::judge(surface, gathered.samples(), gathered.total, evidence).criterion
            })
            .collect();
        let smooth = 2.0 - 2.0 * SMOOTH_DEG.to_radians().cos();
        let mut gains: Vec<(f64, u32, u32, Choice)> = borders(scene, labels)
            .into_par_iter()
            .filter(|&(_, _, turn)| turn < smooth)
            .map_init(Marks::default, |marks, (a, b, _)| {
                let faces = [regions.faces(a as usize), regions.faces(b as usize)].concat();
                let choice = choose(scene, &faces, evidence, marks)?;
                let gain = own[a as usize] + own[b as usize] + 2.0 * LABEL - choice.criterion;
                (gain > 0.0).then_some((gain, a, b, choice))
            })
            .flatten()
            .collect();
        gains.sort_by(|a, b| b.0.total_cmp(&a.0).then((a.1, a.2).cmp(&(b.1, b.2))));
        // Pairs that share a region wait for the next round.
        let mut busy = vec![false; regions.len()];
        let mut into: Vec<u32> = (0..regions.len() as u32).collect();
        let mut now = 0;
        for (_, a, b, choice) in gains {
            if !busy[a as usize] && !busy[b as usize] {
                busy[a as usize] = true;
                busy[b as usize] = true;
                into[b as usize] = a;
                let faces = [regions.faces(a as usize), regions.faces(b as usize)].concat();
                models[a as usize] = Model {
                    side: side_of(scene, &choice.surface, &faces),
                    surface: choice.surface,
                };
                now += 1;
            }
        }
        if now == 0 {
            return merged;
        }
        merged += now;
        labels.iter_mut().filter(|l| **l != UNLABELLED).for_each(|l| *l = into[*l as usize]);
        tidy(models, labels);
    }
}

/// Merging discounts correlated samples less than the choice of types does: a misfit that is too
/// large to be noise counts, however few samples are independent.
fn merging(evidence: Evidence) -> Evidence {
    Evidence { independent: evidence.independent.sqrt(), ..evidence }
}
