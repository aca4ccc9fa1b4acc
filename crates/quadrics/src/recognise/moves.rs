//! Moves between partitions: fit again, drop a region that its neighbours explain.

use rayon::prelude::*;

use super::around::Around;
use super::assign::{Model, face_cost};
use super::pool::Pool;
use super::related;
use super::scene::{Gathered, Marks, Scene};
use crate::partition::{Regions, compact};
use crate::surface::select::{self, Choice, Evidence};
use crate::surface::{Surface, general};

/// What one more region costs besides its surface: its boundary and its label.
pub(super) const LABEL: f64 = 10.0;
/// What a region must save beside the price of its surface, in nats over its faces, to be kept. More
/// than [`LABEL`]: faces count vertices twice, and crumbs between two surfaces fit by chance (25 and
/// 100 are about as good, decision 0002). On scans faces that err together count less already.
const KEEP: f64 = 60.0;
const KEEP_SCAN: f64 = 30.0;
/// Vertices that a fit looks at.
pub(super) const SAMPLES: usize = 200;

/// Chooses the surface of every region anew; under independent noise also among the blends of its neighbours.
pub fn fit(scene: &Scene, models: &mut [Model], labels: &[u32]) {
    let regions = Regions::new(labels);
    let pool = Pool::<Marks>::default();
    models.par_iter_mut().enumerate().with_max_len(1).for_each(|(id, model)| {
        if id < regions.len() {
            pool.with(|marks| refit(scene, model, regions.faces(id), marks));
        }
    });
    if scene.noisy() {
        blend(scene, models, labels, &regions);
    }
}

/// Makes blends of the regions that are blends of their neighbours rather than what they are now.
fn blend(scene: &Scene, models: &mut [Model], labels: &[u32], regions: &Regions) {
    let walls = models.to_vec();
    let around = Around { scene, models: &walls, labels, regions };
    let pool = Pool::<Marks>::default();
    models.par_iter_mut().enumerate().with_max_len(1).for_each(|(id, model)| {
        if id < regions.len() {
            let faces = regions.faces(id);
            let rather = pool.with(|marks| {
                let gathered = scene.samples(faces, SAMPLES, marks);
                around.rather(id, &gathered, marks)
            });
            if let Some((blend, _)) = rather {
                *model = Model::new(scene, blend.surface, faces);
            }
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
    let gathered = scene.samples(faces, SAMPLES, marks);
    let (samples, total, evidence) = (gathered.samples(), gathered.total, scene.evidence);
    let simple = best(scene, &gathered, evidence);
    // Under noise only a region that is of a general type already may be of one.
    let general = model.surface.is_general() && !evidence.general;
    let general = general.then(|| general::choose(samples, total, evidence));
    // On a clean mesh a few strange faces turn a fit away from what all the others lie on. Quadrics
    // are not worth it: they may be patches of what no surface explains.
    let quadric = matches!(model.surface, Surface::Quadric(_));
    let known = (!quadric && evidence.general)
        .then(|| select::judge(model.surface.clone(), samples, total, evidence));
    let choices = simple.into_iter().chain(general.into_iter().flatten()).chain(known);
    if let Some(choice) = choices.min_by(|a, b| a.criterion.total_cmp(&b.criterion)) {
        *model = Model::new(scene, choice.surface, faces);
    }
}

/// The best surface for some faces.
pub(super) fn choose(
    scene: &Scene,
    faces: &[u32],
    evidence: Evidence,
    marks: &mut Marks,
) -> Option<Choice> {
    best(scene, &scene.samples(faces, SAMPLES, marks), evidence)
}

/// The best surface, free or related.
pub(super) fn best(scene: &Scene, gathered: &Gathered, evidence: Evidence) -> Option<Choice> {
    let free = select::choose(gathered.samples(), gathered.total, evidence).into_iter().next()?;
    let (than, bound) = (&free.surface, free.criterion);
    let near = scene.shown.nearest(&gathered.points);
    Some(related::best(scene, gathered, evidence, than, bound, near).unwrap_or(free))
}

/// What a surface is worth for some faces.
pub(super) fn judge(
    scene: &Scene,
    surface: &Surface,
    faces: &[u32],
    evidence: Evidence,
    marks: &mut Marks,
) -> Choice {
    related::priced(scene, surface.clone(), &scene.samples(faces, SAMPLES, marks), evidence)
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
    let of_face = |(face, &label): (usize, &u32)| {
        let across = scene.adjacency.across(face).filter(move |&other| labels[other] > label);
        across.map(move |other| {
            let turn = (scene.normals[face] - scene.normals[other]).norm_squared();
            (label, labels[other], turn)
        })
    };
    let faces = labels.par_iter().with_min_len(4096).enumerate();
    let mut edges: Vec<(u32, u32, f64)> = faces.flat_map_iter(of_face).collect();
    edges.par_sort_unstable_by(|a, b| (a.0, a.1).cmp(&(b.0, b.1)).then(a.2.total_cmp(&b.2)));
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
    let keep = if scene.correlated() { KEEP_SCAN } else { KEEP };
    let mut dropped = 0;
    for id in order {
        let faces = regions.faces(id);
        if faces.is_empty() {
            continue;
        }
        let mut neighbours: Vec<u32> = scene
            .beside(id as u32, faces, labels)
            // A free-form neighbour explains nothing.
            .filter(|&n| !matches!(models[n as usize].surface, Surface::FreeForm))
            .collect();
        neighbours.sort_unstable();
        neighbours.dedup();
        if neighbours.is_empty() {
            continue;
        }
        let vertices = (faces.len() as f64 / 2.0).max(2.0);
        let freedom = select::cost(&models[id].surface) - scene.shown.held(&models[id].surface).0;
        let price = keep + freedom * vertices.ln();
        let mut gain = price;
        let mut moved: Vec<u32> = Vec::with_capacity(faces.len());
        for &face in faces {
            let best = neighbours
                .iter()
                .map(|&n| (face_cost(scene, &models[n as usize], face as usize), n))
                .min_by(|a, b| a.0.total_cmp(&b.0));
            let Some((cost, label)) = best else { break };
            // What neighbours say together counts once.
            let own = face_cost(scene, &models[id], face as usize);
            gain -= scene.evidence.independent * (cost - own);
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
