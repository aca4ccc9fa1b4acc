//! The first stage: which directions are one, and which are at right angles.

use super::admit::{Candidate, Verdict, admit};
use super::demands::Demand;
use super::directions;
use super::equation::Equation;
use super::gate;
use super::solve::Solution;
use super::stages::Work;
use super::system::System;
use crate::surface::direction;

/// Range of the cosine between two directions.
const COSINES: f64 = 2.0;
/// Directions whose cosine is larger are no candidates for a right angle.
const OBLIQUE: f64 = 0.3;
/// Sine of the angle between directions that equations made one.
const PARALLEL: f64 = 1e-9;

impl Work<'_> {
    /// Parallel classes.
    pub(super) fn parallel(&mut self) {
        let rules = self.demands.rules("parallel");
        let (class, directions) = directions::parallel(self.items, &rules, self.demands.gate);
        self.classes.direction = class;
        self.directions = directions;
        self.solved = self.solve(&self.classes, &self.directions);
    }

    /// Right angles between parallel classes.
    pub(super) fn upright(&mut self) {
        let Some((system, solution)) = self.solved.take() else { return };
        let candidates = self.right_angles(&system, &solution);
        let (verdicts, state) =
            admit(&system, &solution.state, &solution.spread, &candidates, self.demands.gate);
        self.angles = candidates.into_iter().map(|c| c.equation).zip(verdicts).collect();
        self.directions = state.directions;
        self.unite();
        self.solved = self.solve(&self.classes, &self.directions);
        if self.solved.is_none() {
            self.angles.clear();
            self.solved = Some((system, solution));
        }
    }

    fn right_angles(&self, system: &System, solution: &Solution) -> Vec<Candidate> {
        let count = self.directions.len();
        let class = &self.classes.direction;
        let size = |number: usize| {
            let one =
                |&i: &usize| class[i] == number && direction(&self.items[i].surface).is_some();
            (0..self.items.len()).filter(one).count()
        };
        // Between the classes of the surfaces that the user names.
        let named = |a: usize, b: usize, forced: bool| {
            let between = |demand: &&Demand| {
                let ends = [class[demand.regions[0]], class[demand.regions[1]]];
                demand.kind == "orthogonal"
                    && demand.forced == forced
                    && (ends == [a, b] || ends == [b, a])
            };
            self.demands.relations.iter().any(|demand| between(&demand))
        };
        let pairs = (0..count).flat_map(|a| (a + 1..count).map(move |b| (a, b)));
        pairs
            .filter(|&(a, b)| !named(a, b, false))
            .map(|(a, b)| Candidate {
                equation: Equation::Orthogonal(a, b),
                range: COSINES,
                before: gate::joining(size(a), size(b)),
                forced: named(a, b, true),
            })
            .filter(|c| c.forced || c.equation.value(system, &solution.state).abs() < OBLIQUE)
            .collect()
    }

    /// Directions that right angles made parallel are one.
    fn unite(&mut self) {
        let count = self.directions.len();
        for (a, b) in (0..count).flat_map(|a| (a + 1..count).map(move |b| (a, b))) {
            if self.directions[a].cross(&self.directions[b]).norm() > PARALLEL {
                continue;
            }
            self.classes.direction.iter_mut().filter(|c| **c == b).for_each(|c| *c = a);
            let one = |class: usize| if class == b { a } else { class };
            // What was said of both is said once.
            for (equation, verdict) in std::mem::take(&mut self.angles) {
                let Equation::Orthogonal(i, j) = equation else { continue };
                let (i, j) = (one(i), one(j));
                let equation = Equation::Orthogonal(i.min(j), i.max(j));
                let known = self.angles.iter_mut().find(|(other, _)| *other == equation);
                match known {
                    Some((_, old)) if matches!(verdict, Verdict::Accepted(_)) => *old = verdict,
                    Some(_) => {}
                    None => self.angles.push((equation, verdict)),
                }
            }
        }
    }
}
