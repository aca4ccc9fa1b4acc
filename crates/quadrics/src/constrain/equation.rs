//! What cannot be substituted stays an equation, `g(u) = 0`.

use super::system::{State, System};

/// A relation between unknowns.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Equation {
    /// Two directions at right angles: the cosine between them.
    Orthogonal(usize, usize),
}

/// Step of the differences.
const STEP: f64 = 1e-6;

impl Equation {
    /// How far the equation is from holding: a cosine or a length.
    pub fn value(&self, _system: &System, state: &State) -> f64 {
        match *self {
            Self::Orthogonal(a, b) => state.directions[a].dot(&state.directions[b]),
        }
    }

    /// The unknowns that it depends on.
    pub fn unknowns(&self, _system: &System) -> Vec<usize> {
        match *self {
            Self::Orthogonal(a, b) => vec![2 * a, 2 * a + 1, 2 * b, 2 * b + 1],
        }
    }

    /// Its derivatives: unknown and value.
    pub fn row(&self, system: &System, state: &State) -> Vec<(usize, f64)> {
        let mut moved = state.clone();
        let slope = |unknown: usize| {
            let mut at = |step: f64| {
                moved.clone_from(state);
                moved.nudge(unknown, step);
                self.value(system, &moved)
            };
            (unknown, (at(STEP) - at(-STEP)) / (2.0 * STEP))
        };
        self.unknowns(system).into_iter().map(slope).collect()
    }
}
