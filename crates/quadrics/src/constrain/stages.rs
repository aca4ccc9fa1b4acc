//! The stages in which relations are added, and rolled back where the data refuse them.

use super::admit::Verdict;
use super::alike;
use super::classes::{Classes, evict};
use super::demands::{Demand, Demands};
use super::equation::Equation;
use super::places::View;
use super::proposal::{Part, Proposal};
use super::refusals;
use super::report;
use super::rounding;
use super::solve::{Solution, solve};
use super::system::System;
use super::weigh::Outcome;
use super::{Constrained, Dimension};
use crate::math::Unit;
use crate::surface::{Condensed, Surface};

/// Increase of chi-squared of one surface that no set of relations may ask for.
pub const TOO_MUCH: f64 = 40.0;
/// Times that a stage may send surfaces or relations back before it is given up.
pub const EVICTIONS: usize = 20;

/// Surfaces on their way through the stages.
pub struct Work<'a> {
    pub(super) items: &'a [Condensed],
    pub(super) neighbours: &'a [Vec<usize>],
    pub(super) demands: &'a Demands,
    pub(super) classes: Classes,
    pub(super) directions: Vec<Unit>,
    /// Right angles between classes of directions.
    pub(super) angles: Vec<(Equation, Verdict)>,
    /// Relations that equations say, and what became of each.
    pub(super) related: Vec<(Proposal, Outcome)>,
    /// What the user asks in vain.
    pub(super) vain: Vec<&'a Demand>,
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
    pub(super) fn equations(&self) -> Vec<Equation> {
        // What is implied to first order is made exact too.
        let right = self.angles.iter().filter(|(_, v)| !matches!(v, Verdict::Refused(_)));
        let others = self.related.iter().flat_map(|(_, outcome)| outcome.equations.clone());
        right.map(|(e, _)| e.clone()).chain(others).collect()
    }

    /// Common directions, axes and planes, without right angles: of many directions those take longest.
    pub fn align(&mut self) {
        self.parallel();
        self.stage(|view, classes| view.align(classes));
    }

    /// Orientation, placement, equality.
    pub fn equalise(&mut self) {
        self.parallel();
        self.upright();
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

    pub(super) fn part<'b>(&'b self, solved: &'b (System, Solution)) -> Part<'b> {
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
