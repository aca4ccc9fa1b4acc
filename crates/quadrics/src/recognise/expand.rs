//! Least energy by expansion moves (Boykov, Veksler and Zabih, PAMI 2001), over the faces where two
//! surfaces compete.

use rayon::prelude::*;

use super::assign::{Model, border_cost, face_cost};
use super::cut::Cut;
use super::pool::Pool;
use super::scene::{Marks, Scene};
use crate::mesh::NONE;
use crate::partition::Regions;
use crate::surface::Surface;

/// A face is worth asking when the new surface is at most so much worse than its own.
const SLACK: f64 = 4.0;
/// Moves that are worked out at once where there are threads to share them.
const AT_ONCE: usize = 8;

/// Lets every surface in turn take the faces that lower the energy.
///
/// Several moves are worked out at once, of regions that do not touch. One that looked at a face which a
/// move before it has changed is worked out again: whatever the number of threads, it is as if each had
/// waited for those before.
pub fn expand(scene: &Scene, models: &[Model], labels: &mut [u32]) {
    let mut current: Vec<f64> = labels
        .par_iter()
        .with_min_len(4096)
        .enumerate()
        .map(|(face, &label)| face_cost(scene, &models[label as usize], face))
        .collect();
    let regions = Regions::new(labels);
    let pool = Pool::<Work>::default();
    let batches = batches(scene, &regions, labels);
    let at_once = if rayon::current_num_threads() > 1 { AT_ONCE } else { 1 };
    let mut changed = Marks::default();
    for batch in batches.iter().flat_map(|batch| batch.chunks(at_once)) {
        let work_out = |&id: &u32, labels: &[u32], current: &[f64]| {
            let region = regions.faces(id as usize);
            pool.with(|work| Move::new(scene, models, id, region, labels, current, work))
        };
        let now: &[u32] = labels;
        let guesses: Vec<Move> =
            batch.par_iter().with_max_len(1).map(|id| work_out(id, now, &current)).collect();
        changed.clear(labels.len());
        let mut losers: Vec<u32> = Vec::new();
        for (id, guess) in batch.iter().zip(guesses) {
            let stale = losers.contains(id) || guess.seen.iter().any(|&face| changed.has(face));
            let Move { taken, .. } = if stale { work_out(id, labels, &current) } else { guess };
            for (face, cost) in taken {
                let label = &mut labels[face as usize];
                if !losers.contains(label) {
                    losers.push(*label);
                }
                changed.mark(face);
                *label = *id;
                current[face as usize] = cost;
            }
        }
    }
}

/// All regions, the lowest first, in groups of at most [`AT_ONCE`] that do not touch: their moves seldom meet.
fn batches(scene: &Scene, regions: &Regions, labels: &[u32]) -> Vec<Vec<u32>> {
    let beside = |&id: &u32| {
        let faces = regions.faces(id as usize);
        let mut beside: Vec<u32> = scene.beside(id, faces, labels).collect();
        beside.sort_unstable();
        beside.dedup();
        beside
    };
    let mut left: Vec<u32> = (0..regions.len() as u32).collect();
    let beside: Vec<Vec<u32>> = left.par_iter().map(beside).collect();
    let mut batches = Vec::new();
    while !left.is_empty() {
        let mut batch: Vec<u32> = Vec::with_capacity(AT_ONCE);
        left.retain(|&id| {
            let apart = |other: &u32| beside[id as usize].binary_search(other).is_err();
            let joins = batch.len() < AT_ONCE && batch.iter().all(apart);
            if joins {
                batch.push(id);
            }
            !joins
        });
        batches.push(batch);
    }
    batches
}

/// What one surface takes.
struct Move {
    /// Faces of others that it looked at.
    seen: Vec<u32>,
    /// Those that come over, with what they cost then.
    taken: Vec<(u32, f64)>,
}

/// Scratch for one move.
#[derive(Default)]
struct Work {
    seen: Marks,
    /// The place of a seen face among the active ones.
    place: Vec<u32>,
}

impl Move {
    fn new(
        scene: &Scene,
        models: &[Model],
        label: u32,
        region: &[u32],
        labels: &[u32],
        current: &[f64],
        work: &mut Work,
    ) -> Self {
        let model = &models[label as usize];
        // Nothing tells the faces of one free-form patch from those of another: they stay. Under noise no
        // patch takes any face: it would spread along all edges that a scan rounds.
        let free = |id: u32| matches!(models[id as usize].surface, Surface::FreeForm);
        let barred =
            |face: u32| free(label) && (free(labels[face as usize]) || !scene.evidence.general);
        // Faces of others, reached from the region, that might come over.
        work.seen.clear(labels.len());
        work.place.resize(labels.len(), NONE);
        let mut seen: Vec<u32> = Vec::new();
        let mut active: Vec<(u32, f64)> = Vec::new();
        let others = |face: u32| {
            let across = scene.adjacency.neighbours[face as usize].into_iter();
            across.filter(|&f| f != NONE && labels[f as usize] != label)
        };
        let own = region.iter().filter(|&&f| labels[f as usize] == label);
        let mut border: Vec<u32> = own.flat_map(|&f| others(f)).collect();
        let mut next = 0;
        loop {
            for face in border.drain(..).filter(|&face| work.seen.mark(face)) {
                seen.push(face);
                work.place[face as usize] = NONE;
                let cost = face_cost(scene, model, face as usize);
                if cost < current[face as usize] + SLACK && !barred(face) {
                    work.place[face as usize] = active.len() as u32;
                    active.push((face, cost));
                }
            }
            let Some(&(face, _)) = active.get(next) else { break };
            next += 1;
            border.extend(others(face));
        }
        let stays = cut(scene, label, &active, labels, current, work);
        let taken = active.into_iter().zip(stays).filter(|(_, stays)| !stays);
        Self { seen, taken: taken.map(|(comes, _)| comes).collect() }
    }
}

/// Whether each of the active faces stays with its surface.
fn cut(
    scene: &Scene,
    label: u32,
    active: &[(u32, f64)],
    labels: &[u32],
    current: &[f64],
    work: &Work,
) -> Vec<bool> {
    // Source: the face comes over. Sink: it stays.
    let mut cut = Cut::new(active.len());
    for (i, &(face, cost)) in active.iter().enumerate() {
        let face = face as usize;
        let (mut stay, mut come) = (current[face], cost);
        for (edge, &other) in scene.adjacency.neighbours[face].iter().enumerate() {
            if other == NONE {
                continue;
            }
            let length = border_cost(scene, face, edge);
            let differ = if labels[other as usize] == labels[face] { 0.0 } else { length };
            let place = if work.seen.has(other) { work.place[other as usize] } else { NONE };
            match place as usize {
                // Both come: no border. One comes: a border. Both stay: as it was.
                j if place != NONE && j > i => {
                    stay += differ;
                    cut.edge(i, j, length, length - differ);
                }
                _ if place != NONE => {}
                _ if labels[other as usize] == label => stay += length,
                _ => {
                    stay += differ;
                    come += length;
                }
            }
        }
        cut.node(i, stay, come);
    }
    cut.solve()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::context::Context;
    use crate::mesh::Working;
    use crate::prepare::to_unit_cube;
    use crate::recognise::assign::models;
    use crate::synth::{self, Noise, Part};

    fn noisy_demo() -> (Part, Working) {
        let part = synth::part("demo", 8_000).unwrap();
        let part = part.transformed(&to_unit_cube(&part.mesh).unwrap());
        let noise = Noise::uniform(0.004, 0.9);
        let noisy = synth::add_noise(&mut Context::new(1), &part.mesh, &noise).unwrap();
        (part, Working::new(noisy))
    }

    #[test]
    fn moves_at_once_come_to_what_moves_in_turn_come_to() {
        let (part, working) = noisy_demo();
        let scene = Scene::new(&working);
        let models = models(&scene, &Regions::new(&part.labels), part.surfaces.iter());
        let expanded = |threads: usize| {
            let mut labels = part.labels.clone();
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| expand(&scene, &models, &mut labels));
            labels
        };
        let in_turn = expanded(1);
        assert_ne!(in_turn, part.labels);
        assert_eq!(expanded(3), in_turn);
    }

    #[test]
    fn what_no_surface_explains_takes_no_faces_under_noise() {
        let (part, working) = noisy_demo();
        let mut scene = Scene::new(&working);
        // Less than there is: nothing explains anything.
        scene.evidence.sigma /= 10.0;
        scene.evidence.general = false;
        let mut models = models(&scene, &Regions::new(&part.labels), part.surfaces.iter());
        models[0].surface = Surface::FreeForm;
        let mut labels = part.labels.clone();
        expand(&scene, &models, &mut labels);
        let count = |labels: &[u32]| labels.iter().filter(|&&label| label == 0).count();
        assert!(count(&labels) <= count(&part.labels));
    }
}
