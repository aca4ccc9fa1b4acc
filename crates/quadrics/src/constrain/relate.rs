//! The stages after equality: relations that equations say, proposed together, weighed, solved, and
//! rolled back where they pull a surface too far.

use super::admit::Verdict;
use super::asked;
use super::contact;
use super::equation::Equation;
use super::gaps;
use super::mirror;
use super::pattern;
use super::proposal::Proposal;
use super::rounding;
use super::solve::{Solution, solve};
use super::stages::{EVICTIONS, TOO_MUCH, Work};
use super::system::System;
use super::weigh::{Outcome, weigh};

/// What follows from the others holds to this, in radians and sizes.
const FOLLOWS: f64 = 1e-9;

/// Of more surfaces no relations are sought but what is equal and at right angles: pairs and triples
/// grow with the square and the cube of their number, and so does the system that their equations make.
const MANY: usize = 250;

impl Work<'_> {
    /// What equations say: contact, distances and angles, symmetry, patterns, the user's values.
    pub fn relate(&mut self) {
        let Some(solved) = self.solved.take() else { return };
        let part = self.part(&solved);
        let (mut proposals, vain) = asked::proposals(&part);
        let wanted = |new: &Proposal| {
            !self.demands.forbids(new.kind, &new.surfaces)
                && !self.demands.forced().any(|d| d.kind == new.kind && d.regions == new.surfaces)
        };
        let many = self.items.len() > MANY;
        let sought = [contact::proposals, pattern::proposals, mirror::proposals, gaps::proposals];
        for found in sought.into_iter().filter(|_| !many) {
            proposals.extend(found(&part).into_iter().filter(wanted));
        }
        let vain = vain
            .into_iter()
            .filter_map(|demand| self.demands.relations.iter().find(|known| *known == demand))
            .collect();
        self.vain = vain;
        self.solved = Some(self.impose(solved, proposals));
    }

    /// Dimensions onto the user's grid.
    pub fn round(&mut self) {
        let Some(solved) = self.solved.take() else { return };
        let proposals = rounding::proposals(&self.part(&solved));
        self.solved = Some(self.impose(solved, proposals));
    }

    /// Weighs proposals and solves under those that stand; what cannot be solved, or pulls a surface
    /// too far, is rolled back.
    fn impose(
        &mut self,
        solved: (System, Solution),
        proposals: Vec<Proposal>,
    ) -> (System, Solution) {
        if proposals.is_empty() {
            return solved;
        }
        let (system, solution) = &solved;
        let known = self.related.len();
        let outcomes = weigh(system, solution, &proposals, self.demands.gate);
        self.related.extend(proposals.into_iter().zip(outcomes));
        for _ in 0..EVICTIONS {
            // The unknowns are the same: start where the relations so far hold.
            let next = solve(self.items, system, &solution.state, &self.equations());
            let excess: Vec<f64> = match &next {
                Some(next) => next
                    .increase
                    .iter()
                    .zip(&solution.increase)
                    .map(|(new, old)| new - old)
                    .collect(),
                None => vec![f64::INFINITY; self.items.len()],
            };
            let worst = excess.iter().copied().fold(0.0, f64::max);
            let sent = if worst > TOO_MUCH { self.roll_back(known, &excess, worst) } else { 0 };
            match next {
                Some(next) if sent == 0 => {
                    self.confirm(known, system, &next);
                    return (solved.0, next);
                }
                None if sent == 0 => break,
                _ => {}
            }
        }
        self.related[known..].iter_mut().for_each(|(_, outcome)| outcome.refuse());
        solved
    }

    /// Rolls back what pulls the surfaces that moved most, and of that what the data like least; how
    /// many relations that were.
    fn roll_back(&mut self, known: usize, excess: &[f64], worst: f64) -> usize {
        let pulls = |p: &Proposal| {
            !p.forced && p.surfaces.iter().any(|&i| excess[i] > TOO_MUCH.max(worst / 2.0))
        };
        let mut open: Vec<(f64, &mut Outcome)> = self.related[known..]
            .iter_mut()
            .filter(|(proposal, _)| pulls(proposal))
            .filter_map(|(_, outcome)| match outcome.verdict {
                Verdict::Accepted(chi_squared) => Some((chi_squared, outcome)),
                _ => None,
            })
            .collect();
        open.sort_by(|a, b| b.0.total_cmp(&a.0));
        let sent = open.len().div_ceil(2);
        open.into_iter().take(sent).for_each(|(_, outcome)| outcome.refuse());
        sent
    }

    /// What was implied by relations that were rolled back does not hold.
    fn confirm(&mut self, known: usize, system: &System, solution: &Solution) {
        for (proposal, outcome) in &mut self.related[known..] {
            let holds = |e: &Equation| e.value(system, &solution.state).abs() < FOLLOWS;
            if outcome.verdict == Verdict::Implied && !proposal.equations.iter().all(holds) {
                outcome.verdict = Verdict::Refused(f64::INFINITY);
            }
        }
    }
}
