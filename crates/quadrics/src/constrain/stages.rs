//! The stages in which relations are added, and rolled back where the data refuse them.

use super::admit::Verdict;
use super::alike;
use super::asked;
use super::classes::{Classes, evict};
use super::contact;
use super::demands::{Demand, Demands};
use super::equation::Equation;
use super::gaps;
use super::mirror;
use super::pattern;
use super::places::View;
use super::proposal::{Part, Proposal};
use super::refusals;
use super::report;
use super::rounding;
use super::solve::{Solution, solve};
use super::system::System;
use super::weigh::{Outcome, weigh};
use super::{Constrained, Dimension};
use crate::math::Unit;
use crate::surface::{Condensed, Surface};

/// Of more surfaces no relations are sought but what is equal and at right angles: pairs and triples
/// grow with the square and the cube of their number, and so does the system that their equations make.
const MANY: usize = 250;
/// Increase of chi-squared of one surface that no set of relations may ask for.
const TOO_MUCH: f64 = 40.0;
/// What follows from the others holds to this, in radians and sizes.
const FOLLOWS: f64 = 1e-9;
/// Times that a stage may send surfaces or relations back before it is given up.
const EVICTIONS: usize = 20;

/// Surfaces on their way through the stages.
pub struct Work<'a> {
    pub(super) items: &'a [Condensed],
    neighbours: &'a [Vec<usize>],
    pub(super) demands: &'a Demands,
    pub(super) classes: Classes,
    pub(super) directions: Vec<Unit>,
    /// Right angles between classes of directions.
    pub(super) angles: Vec<(Equation, Verdict)>,
    related: Vec<(Proposal, Outcome)>,
    vain: Vec<&'a Demand>,
    pub(super) solved: Option<(System, Solution)>,
}

impl<'a> Work<'a> {
    /// Every surface on its own.
    pub fn new(items: &'a [Condensed], neighbours: &'a [Vec<usize>], demands: &'a Demands) -> Self {
        let classes = Classes::apart(items.len());
        Self {
            items,
            neighbours,
            demands,
            classes,
            directions: Vec::new(),
            angles: Vec::new(),
            related: Vec::new(),
            vain: Vec::new(),
            solved: None,
        }
    }

    /// Solves under the present equations.
    pub(super) fn solve(
        &self,
        classes: &Classes,
        directions: &[Unit],
    ) -> Option<(System, Solution)> {
        let system = System::new(self.items, classes, directions);
        let solution = solve(self.items, &system, &system.state, &self.equations())?;
        Some((system, solution))
    }

    /// What holds and is no class of equal things.
    fn equations(&self) -> Vec<Equation> {
        // What is implied to first order is made exact too.
        let right = self.angles.iter().filter(|(_, v)| !matches!(v, Verdict::Refused(_)));
        let others = self.related.iter().flat_map(|(_, outcome)| outcome.equations.clone());
        right.map(|(e, _)| e.clone()).chain(others).collect()
    }

    /// Orientation, placement, equality.
    pub fn equalise(&mut self) {
        self.orient();
        self.stage(|view, classes| view.align(classes));
        self.stage(|view, classes| view.center_all(classes));
        self.stage(|view, classes| view.equalise(classes));
    }

    /// One stage of equalities; surfaces that would have to move too far stay as they were, unless
    /// the user holds them.
    fn stage(&mut self, step: fn(&View, &mut Classes)) {
        let Some((system, solution)) = &self.solved else { return };
        let mut classes = self.classes.clone();
        step(&View { system, solution, demands: self.demands }, &mut classes);
        let directions = solution.state.directions.clone();
        let before = solution.increase.clone();
        let held =
            |i: &usize| self.demands.relations.iter().any(|d| d.forced && d.regions.contains(i));
        for _ in 0..EVICTIONS {
            let Some((system, solution)) = self.solve(&classes, &directions) else { return };
            let excess = |i: &usize| solution.increase[*i] - before[*i];
            let free = || (0..self.items.len()).filter(|i| !held(i));
            let worst = free().map(|i| excess(&i)).fold(0.0, f64::max);
            if worst <= TOO_MUCH {
                self.classes = classes;
                self.solved = Some((system, solution));
                return;
            }
            // Those that pull nearly as hard are mostly on the same wrong side.
            let pulls = |i: &usize| excess(i) > TOO_MUCH.max(worst / 2.0);
            for surface in free().filter(pulls) {
                evict(&mut classes, &self.classes, surface);
            }
        }
    }

    fn part<'b>(&'b self, solved: &'b (System, Solution)) -> Part<'b> {
        let (system, solution) = solved;
        let surfaces = (0..self.items.len()).map(|i| system.surface(i, &solution.state)).collect();
        Part {
            items: self.items,
            classes: &self.classes,
            view: View { system, solution, demands: self.demands },
            surfaces,
            neighbours: self.neighbours,
        }
    }

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

    /// The surfaces as they are now.
    pub fn surfaces(&self) -> Vec<Surface> {
        match &self.solved {
            Some(solved) => self.part(solved).surfaces,
            None => self.items.iter().map(|item| item.surface.clone()).collect(),
        }
    }

    /// What came out.
    pub fn done(mut self) -> Constrained {
        let Some(solved) = self.solved.take() else {
            let (links, dimensions, scatters) = (Vec::new(), Vec::new(), Vec::new());
            return Constrained { surfaces: self.surfaces(), links, dimensions, scatters };
        };
        let part = self.part(&solved);
        let mut links = alike::links(&part, &self.angles);
        links.extend(report::equations(&part, &self.related));
        links.extend(self.vain.iter().map(|demand| report::vain(demand)));
        links.extend(refusals::near_misses(&part));
        let rounded: Vec<Proposal> = self
            .related
            .iter()
            .filter(|(p, o)| p.kind == "rounded" && matches!(o.verdict, Verdict::Accepted(_)))
            .map(|(p, _)| p.clone())
            .collect();
        let dimensions: Vec<Dimension> = rounding::dimensions(&part, &rounded);
        let scatters = part.view.scatters();
        Constrained { surfaces: part.surfaces, links, dimensions, scatters }
    }
}
