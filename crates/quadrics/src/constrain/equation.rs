//! What cannot be substituted stays an equation, `g(u) = 0`.

use super::system::{State, System};
use crate::math::frame;

/// A relation between unknowns.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Equation {
    /// Two directions at right angles: the cosine between them.
    Orthogonal(usize, usize),
}

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
    pub fn row(&self, _system: &System, state: &State) -> Vec<(usize, f64)> {
        match *self {
            Self::Orthogonal(a, b) => {
                let (one, other) = (state.directions[a], state.directions[b]);
                let (u, v) = frame(&one);
                let (s, t) = frame(&other);
                let slopes = [u.dot(&other), v.dot(&other), s.dot(&one), t.dot(&one)];
                [2 * a, 2 * a + 1, 2 * b, 2 * b + 1].into_iter().zip(slopes).collect()
            }
        }
    }
}
