//! Initialisation (paper, section 4.2): RANSAC on the dual points of the mesh.
//!
//! After Schnabel, Wahl and Klein (2007): shapes are drawn from small neighbourhoods, scored on
//! random subsets, and the best is taken once it is unlikely that a better one was overlooked.
//! Other than there the mesh gives the neighbours: inliers are grown over it, and a face that is
//! explained is not drawn from again.

mod cleanup;
mod marks;
mod sample;
mod score;

pub use cleanup::cleanup;

use std::collections::BinaryHeap;

use rand::RngExt;
use rayon::prelude::*;

use crate::context::Context;
use crate::error::{Error, Result};
use crate::mesh::Working;
use crate::options::Options;
use crate::partition::{Labels, UNLABELLED};
use crate::surface::Surface;
use marks::Marks;
use score::{Candidate, Inliers, Tolerance, dual};

/// Probability with which the best shape may have been overlooked (Schnabel: 1 %).
const OVERLOOKED: f64 = 0.01;
/// Of the draws that start on a shape, the share that stays on it and determines it: a cautious
/// guess. Too low a share costs time only.
const GOOD_DRAWS: f64 = 0.25;
/// Draws after which the search ends in any case: a large free-form mesh has faces enough to go on
/// for hours, and what was not found by then is small.
const MOST_DRAWS: usize = 100_000;
/// Draws between two looks at the pool; their scores are estimated in parallel.
const BATCH: usize = 128;
/// Faces of the random subset that a score is estimated on.
const SUBSET: usize = 256;
/// Draws among the inliers of the best shape, which are far apart and so more exact.
const REFINEMENTS: usize = 12;
/// A shape of one more parameter must explain this fraction more: tori follow everything.
const PRICE: f64 = 0.01;

/// The partition that RANSAC finds, made connected and complete: a region for every face.
///
/// The mesh lies in the unit cube. `alpha`, `epsilon` and `tau` are those of section 5.1.
///
/// # Errors
/// [`Error::Empty`] without faces, [`Error::Cancelled`] if the listener says so.
pub fn detect(context: &mut Context, working: &Working, options: &Options) -> Result<Labels> {
    if working.is_empty() {
        return Err(Error::Empty);
    }
    let mut search = Search::new(working, options);
    while !search.is_over() {
        let left = search.left.len() as f64 / working.len() as f64;
        context.step("detect", 1.0 - left)?;
        search.draw(context);
        while search.take_best(context) {}
    }
    Ok(cleanup(working, &search.labels))
}

/// A candidate in the pool, by what it promises.
struct Entry {
    /// Score, or an upper bound of it.
    promise: f64,
    /// How many shapes had been taken when it was counted exactly; `None` for a bound.
    counted: Option<u32>,
    /// When it was drawn: the older of equal ones goes first.
    number: usize,
    candidate: Candidate,
}

impl Ord for Entry {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.promise.total_cmp(&other.promise).then(other.number.cmp(&self.number))
    }
}
impl PartialOrd for Entry {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}
impl PartialEq for Entry {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}
impl Eq for Entry {}

struct Search<'a> {
    working: &'a Working,
    tolerance: Tolerance,
    least: usize,
    labels: Labels,
    /// The faces without a label.
    left: Vec<u32>,
    /// Shapes taken, draws made, candidates they gave.
    taken: u32,
    draws: usize,
    drawn: usize,
    pool: BinaryHeap<Entry>,
    marks: Marks,
}

impl<'a> Search<'a> {
    fn new(working: &'a Working, options: &Options) -> Self {
        Self {
            working,
            tolerance: Tolerance { epsilon: options.epsilon, alpha: options.alpha },
            least: options.tau.max(1),
            labels: vec![UNLABELLED; working.len()],
            left: (0..working.len() as u32).collect(),
            taken: 0,
            draws: 0,
            drawn: 0,
            pool: BinaryHeap::new(),
            marks: Marks::new(working),
        }
    }

    /// Whether no shape of the least size can have been overlooked.
    fn is_over(&self) -> bool {
        self.left.len() < self.least || self.draws >= MOST_DRAWS || self.is_found(self.least as f64)
    }

    /// Whether a shape of so many faces would have been drawn by now.
    fn is_found(&self, size: f64) -> bool {
        let hit = (GOOD_DRAWS * size / self.left.len() as f64).min(1.0);
        (1.0 - hit).powi(self.draws as i32) < OVERLOOKED
    }

    /// Draws a batch of candidates and bounds their scores.
    fn draw(&mut self, context: &mut Context) {
        let rng = &mut context.rng;
        let whole = self.left.len();
        let subset: Vec<u32> = match whole {
            ..=SUBSET => self.left.clone(),
            _ => (0..SUBSET).map(|_| self.left[rng.random_range(0..whole)]).collect(),
        };
        let mut drawn = Vec::with_capacity(BATCH);
        for _ in 0..BATCH {
            let start = self.left[rng.random_range(0..whole)];
            let (labels, marks) = (&self.labels, &mut self.marks);
            drawn.push(sample::neighbourhood(self.working, labels, start, rng, marks));
        }
        let bounded: Vec<(f64, Candidate)> = drawn
            .par_iter()
            .flat_map_iter(|faces| candidates(self.working, &self.tolerance, faces))
            .map(|candidate| {
                let bound = candidate.bound(self.working, &self.tolerance, &subset, whole);
                (bound * worth(&candidate.surface), candidate)
            })
            .collect();
        for (promise, candidate) in bounded {
            self.drawn += 1;
            self.pool.push(Entry { promise, counted: None, number: self.drawn, candidate });
        }
        self.draws += BATCH;
    }

    /// Takes the best shape of the pool if it is unlikely that a better one was overlooked.
    fn take_best(&mut self, context: &mut Context) -> bool {
        while let Some(mut entry) = self.pool.pop() {
            if self.labels[entry.candidate.start as usize] != UNLABELLED {
                continue;
            }
            if entry.counted != Some(self.taken) {
                // What was promised can only have become less: count, and see who is best now.
                let inliers = self.inliers(&entry.candidate);
                entry.counted = Some(self.taken);
                entry.promise = inliers.score * worth(&entry.candidate.surface);
                if inliers.faces.len() >= self.least {
                    self.pool.push(entry);
                }
                continue;
            }
            if !self.is_found(entry.promise) {
                self.pool.push(entry);
                return false;
            }
            self.take(context, entry.candidate);
            return true;
        }
        false
    }

    fn inliers(&mut self, candidate: &Candidate) -> Inliers {
        candidate.inliers(self.working, &self.tolerance, &self.labels, &mut self.marks)
    }

    /// Labels the inliers of a candidate, after a few draws among them for a better one.
    fn take(&mut self, context: &mut Context, candidate: Candidate) {
        let mut best = self.inliers(&candidate);
        let kind = candidate.surface.type_name();
        let around = best.faces.clone();
        for _ in 0..REFINEMENTS {
            let pick = |_| around[context.rng.random_range(0..around.len())];
            let faces: Vec<u32> =
                std::iter::once(candidate.start).chain((0..3).map(pick)).collect();
            for better in candidates(self.working, &self.tolerance, &faces) {
                if better.surface.type_name() == kind {
                    let inliers = self.inliers(&better);
                    if inliers.score > best.score {
                        best = inliers;
                    }
                }
            }
        }
        for &face in &best.faces {
            self.labels[face as usize] = self.taken;
        }
        let labels = &self.labels;
        self.left.retain(|&face| labels[face as usize] == UNLABELLED);
        self.taken += 1;
    }
}

/// The shapes through the barycentres of some faces that are compatible with all of them.
fn candidates(working: &Working, tolerance: &Tolerance, faces: &[u32]) -> Vec<Candidate> {
    let draw: Vec<_> = faces.iter().map(|&face| dual(working, face as usize)).collect();
    sample::shapes(&draw)
        .into_iter()
        .filter_map(|surface| Candidate::through(working, tolerance, surface, faces[0]))
        .filter(|candidate| draw.iter().all(|&dual| candidate.weight(tolerance, dual) > 0.0))
        .collect()
}

/// What a face of a shape counts: less for more parameters.
fn worth(surface: &Surface) -> f64 {
    let extra = match surface {
        Surface::Plane(_) => 0.0,
        Surface::Sphere(_) => 1.0,
        Surface::Cylinder(_) => 2.0,
        Surface::Cone(_) => 3.0,
        _ => 4.0,
    };
    1.0 - PRICE * extra
}

#[cfg(test)]
mod tests;
