//! Geometric constraints between recognised surfaces (paper, 4.3(5)), after Li et al., "GlobFit"
//! (SIGGRAPH 2011), for all types and by the covariances of the fits.
//!
//! Surfaces and their condensed normal equations come in, never a face. Relations are added in
//! stages: orientation, placement, equality. What is equal becomes one unknown ([`system`]); what
//! cannot be substituted stays an equation ([`equation`]), admitted one at a time ([`admit`]).

mod admit;
mod cluster;
mod directions;
mod equation;
mod gate;
mod places;
mod report;
mod solve;
mod system;

use crate::math::Unit;
use crate::surface::{Condensed, Surface, direction};
use admit::{Candidate, Verdict, admit};
use equation::Equation;
use places::View;
use solve::{Solution, solve};
use system::{Classes, System};

pub use report::Link;

/// Surfaces under their relations.
pub struct Constrained {
    /// One for every surface that came in.
    pub surfaces: Vec<Surface>,
    /// The relations, by positions of the surfaces.
    pub links: Vec<Link>,
}

/// Range of the cosine between two directions.
const COSINES: f64 = 2.0;

/// Finds the relations that the data support and moves the surfaces until they hold.
pub fn constrain(items: &[Condensed]) -> Constrained {
    let mut work = Work::new(items);
    let steps: [fn(&View, &mut Classes); 3] = [
        |view, classes| view.align(classes),
        |view, classes| view.center_all(classes),
        |view, classes| view.equalise(classes),
    ];
    work.orient();
    for step in steps {
        work.stage(step);
    }
    work.done()
}

/// Sine of the angle between directions that equations made one.
const PARALLEL: f64 = 1e-9;
/// Increase of chi-squared of one surface that no set of relations may ask for.
const TOO_MUCH: f64 = 40.0;
/// Surfaces that a stage may send back before it is given up.
const EVICTIONS: usize = 20;

struct Work<'a> {
    items: &'a [Condensed],
    classes: Classes,
    directions: Vec<Unit>,
    equations: Vec<(Equation, Verdict)>,
    solved: Option<(System, Solution)>,
}

impl<'a> Work<'a> {
    fn new(items: &'a [Condensed]) -> Self {
        let classes = Classes::apart(items.len());
        Self { items, classes, directions: Vec::new(), equations: Vec::new(), solved: None }
    }

    /// Solves under the present classes and equations.
    fn solve(&self, classes: &Classes, directions: &[Unit]) -> Option<(System, Solution)> {
        let system = System::new(self.items, classes, directions);
        let equations: Vec<_> = self
            .equations
            .iter()
            .filter(|(_, verdict)| matches!(verdict, Verdict::Accepted(_)))
            .map(|(equation, _)| *equation)
            .collect();
        let solution = solve(self.items, &system, &system.state, &equations)?;
        Some((system, solution))
    }

    /// Parallel classes, then right angles between them.
    fn orient(&mut self) {
        let (class, directions) = directions::parallel(self.items);
        self.classes.direction = class;
        self.directions = directions;
        let Some((system, solution)) = self.solve(&self.classes, &self.directions) else { return };
        let count = self.directions.len();
        let size = |class: usize| {
            let one = |&i: &usize| direction(&self.items[i].surface).is_some();
            (0..self.items.len())
                .filter(one)
                .filter(|&i| self.classes.direction[i] == class)
                .count()
        };
        let pairs = (0..count).flat_map(|a| (a + 1..count).map(move |b| (a, b)));
        let candidates: Vec<Candidate> = pairs
            .map(|(a, b)| Candidate {
                equation: Equation::Orthogonal(a, b),
                range: COSINES,
                before: gate::joining(size(a), size(b)),
            })
            .filter(|c| c.equation.value(&system, &solution.state).abs() < 0.3)
            .collect();
        let (verdicts, state) = admit(&system, &solution.state, &solution.spread, &[], &candidates);
        self.equations = candidates.iter().map(|c| c.equation).zip(verdicts).collect();
        self.directions = state.directions;
        self.unite();
        self.solved = self.solve(&self.classes, &self.directions);
        if self.solved.is_none() {
            self.equations.clear();
            self.solved = Some((system, solution));
        }
    }

    /// Directions that right angles made parallel are one.
    fn unite(&mut self) {
        let count = self.directions.len();
        for (a, b) in (0..count).flat_map(|a| (a + 1..count).map(move |b| (a, b))) {
            if self.directions[a].cross(&self.directions[b]).norm() > PARALLEL {
                continue;
            }
            self.classes.direction.iter_mut().filter(|c| **c == b).for_each(|c| *c = a);
            for (equation, _) in &mut self.equations {
                let Equation::Orthogonal(i, j) = equation;
                [i, j].into_iter().filter(|k| **k == b).for_each(|k| *k = a);
            }
            // What was said of both is said once.
            let equations = std::mem::take(&mut self.equations);
            for (equation, verdict) in equations {
                let Equation::Orthogonal(i, j) = equation;
                let equation = Equation::Orthogonal(i.min(j), i.max(j));
                let known = self.equations.iter_mut().find(|(other, _)| *other == equation);
                match known {
                    Some((_, old)) if matches!(verdict, Verdict::Accepted(_)) => *old = verdict,
                    Some(_) => {}
                    None => self.equations.push((equation, verdict)),
                }
            }
        }
    }

    /// One stage of equalities; surfaces that would have to move too far stay as they were.
    fn stage(&mut self, step: fn(&View, &mut Classes)) {
        let Some((system, solution)) = &self.solved else { return };
        let mut classes = self.classes.clone();
        step(&View { system, solution }, &mut classes);
        let directions = solution.state.directions.clone();
        let before = solution.increase.clone();
        for _ in 0..EVICTIONS {
            let Some((system, solution)) = self.solve(&classes, &directions) else { return };
            let excess = |i: &usize| solution.increase[*i] - before[*i];
            let worst = (0..self.items.len()).map(|i| excess(&i)).fold(0.0, f64::max);
            if worst <= TOO_MUCH {
                self.classes = classes;
                self.solved = Some((system, solution));
                return;
            }
            // Those that pull nearly as hard are mostly on the same wrong side.
            let pulls = |i: &usize| excess(i) > TOO_MUCH.max(worst / 2.0);
            for surface in (0..self.items.len()).filter(pulls) {
                evict(&mut classes, &self.classes, surface);
            }
        }
    }

    fn done(self) -> Constrained {
        let free: Vec<Surface> = self.items.iter().map(|item| item.surface.clone()).collect();
        let Some((system, solution)) = &self.solved else {
            return Constrained { surfaces: free, links: Vec::new() };
        };
        let surfaces: Vec<Surface> =
            (0..free.len()).map(|i| system.surface(i, &solution.state)).collect();
        let links = report::links(self.items, &self.classes, &self.equations, &surfaces);
        Constrained { surfaces, links }
    }
}

/// Takes a surface out of what a stage put it in.
fn evict(classes: &mut Classes, old: &Classes, surface: usize) {
    fn apart(new: &mut [usize], old: &[usize], surface: usize) {
        if new[surface] == old[surface] && new.iter().filter(|c| **c == new[surface]).count() < 2 {
            return;
        }
        let left = new[surface];
        let rest: Vec<usize> = (0..new.len()).filter(|&i| i != surface && new[i] == left).collect();
        // The class is called after its first surface.
        rest.iter().for_each(|&i| new[i] = rest[0]);
        new[surface] = surface;
    }
    for (new, old) in [
        (&mut classes.line, &old.line),
        (&mut classes.center, &old.center),
        (&mut classes.offset, &old.offset),
        (&mut classes.radius, &old.radius),
        (&mut classes.angle, &old.angle),
    ] {
        if new != old {
            apart(new, old, surface);
        }
    }
}

#[cfg(test)]
mod admit_tests;
#[cfg(test)]
mod tests;
