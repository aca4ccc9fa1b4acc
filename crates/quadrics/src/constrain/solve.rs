//! Gauss-Newton on the condensed normal equations, in reduced unknowns.
//!
//! Unknowns of one surface alone are eliminated first (a Schur complement each), so that the system
//! to solve has only what is shared; equations enter by their multipliers.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use super::bounds::Bounds;
use super::equation::Equation;
use super::spread::{Own, Place, Spread};
use super::system::{State, System};
use crate::surface::Condensed;

/// Most steps; 4 are the rule.
const ITERATIONS: usize = 20;
/// A step of this length, in sizes and radians, is the last one; the next would be its square, or
/// rounding along what the equations hardly determine.
const SETTLED: f64 = 1e-8;
/// All equations hold to this in the end, in sizes and radians; mostly to 1e-13.
const HOLDS: f64 = 1e-9;
/// Step of the differences.
pub const STEP: f64 = 1e-6;

/// The least sum of squares under the equations.
pub struct Solution {
    /// The unknowns.
    pub state: State,
    /// Increase of chi-squared over the free fits, of every surface.
    pub increase: Vec<f64>,
    /// Covariances.
    pub spread: Spread,
}

/// Solves; `None` where the system is singular or the steps run away.
pub fn solve(
    items: &[Condensed],
    system: &System,
    start: &State,
    equations: &[Equation],
) -> Option<Solution> {
    let place = places(system, equations);
    let mut state = start.clone();
    for _ in 0..ITERATIONS {
        let step = Step::new(items, system, &state, equations, &place)?;
        state = state.moved(step.change.as_slice());
        // A NaN is no step either.
        if step.change.amax().is_nan() || step.change.amax() > 1.0 {
            return None;
        }
        let held = || equations.iter().all(|e| e.value(system, &state).abs() < HOLDS / 10.0);
        if step.change.amax() < SETTLED && held() {
            break;
        }
    }
    if !equations.iter().all(|e| e.value(system, &state).abs() < HOLDS) {
        return None;
    }
    let last = Step::new(items, system, &state, equations, &place)?;
    let increase = (0..items.len())
        .map(|i| {
            let delta = items[i].coordinates(&system.surface(i, &state))?;
            Some(delta.dot(&(&items[i].information * &delta)))
        })
        .collect::<Option<Vec<f64>>>()?;
    Some(Solution {
        state,
        increase,
        spread: Spread {
            place,
            owns: last.owns,
            shared: last.factor.inverse() - last.bounds.known(),
        },
    })
}

/// Who owns every unknown: shared is what two surfaces or an equation depend on.
fn places(system: &System, equations: &[Equation]) -> Vec<Place> {
    let mut users = vec![0usize; system.state.len()];
    let tilts = 2 * system.state.directions.len();
    // Directions stay shared: everything is told from them.
    users[..tilts].fill(2);
    let of_surface: Vec<Vec<usize>> = (0..system.forms.len()).map(|i| system.unknowns(i)).collect();
    of_surface.iter().flatten().for_each(|&u| users[u] += 1);
    equations.iter().flat_map(|e| e.unknowns(system)).for_each(|u| users[u] += 2);
    let mut place = vec![Place::Unused; users.len()];
    let mut next = 0;
    for (unknown, &count) in users.iter().enumerate() {
        if count >= 2 {
            place[unknown] = Place::Shared(next);
            next += 1;
        }
    }
    for (i, unknowns) in of_surface.iter().enumerate() {
        let own = unknowns.iter().filter(|u| users[**u] == 1);
        own.enumerate().for_each(|(at, &u)| place[u] = Place::Own(i, at));
    }
    place
}

struct Step {
    change: DVector<f64>,
    owns: Vec<Own>,
    factor: Cholesky<f64, Dyn>,
    bounds: Bounds,
}

impl Step {
    fn new(
        items: &[Condensed],
        system: &System,
        state: &State,
        equations: &[Equation],
        place: &[Place],
    ) -> Option<Self> {
        let count = place.iter().filter(|p| matches!(p, Place::Shared(_))).count();
        let mut matrix = DMatrix::<f64>::zeros(count, count);
        let mut right = DVector::<f64>::zeros(count);
        let mut owns = Vec::with_capacity(items.len());
        let mut rights = Vec::with_capacity(items.len());
        let mut moved = state.clone();
        for (i, item) in items.iter().enumerate() {
            let (jacobian, delta, unknowns) = linearised(item, system, &mut moved, i)?;
            let weighted = jacobian.transpose() * &item.information;
            let (hessian, gradient) = (&weighted * &jacobian, -(&weighted * &delta));
            let (own, shared): (Vec<usize>, Vec<usize>) =
                (0..unknowns.len()).partition(|&k| matches!(place[unknowns[k]], Place::Own(..)));
            let inverse = hessian.select_rows(&own).select_columns(&own);
            let inverse = if own.is_empty() { inverse } else { inverse.cholesky()?.inverse() };
            let gain = &inverse * hessian.select_rows(&own).select_columns(&shared);
            let across = hessian.select_rows(&shared).select_columns(&own);
            let reduced = hessian.select_rows(&shared).select_columns(&shared) - &across * &gain;
            let own_right = gradient.select_rows(&own);
            let reduced_right = gradient.select_rows(&shared) - &gain.transpose() * &own_right;
            let at: Vec<usize> = shared
                .iter()
                .map(|&k| match place[unknowns[k]] {
                    Place::Shared(at) => at,
                    _ => unreachable!("partitioned above"),
                })
                .collect();
            for (a, &row) in at.iter().enumerate() {
                right[row] += reduced_right[a];
                for (b, &column) in at.iter().enumerate() {
                    matrix[(row, column)] += reduced[(a, b)];
                }
            }
            rights.push(&inverse * own_right);
            owns.push(Own {
                unknowns: own.iter().map(|&k| unknowns[k]).collect(),
                shared: at,
                inverse,
                gain,
            });
        }
        let factor = factor(matrix)?;
        let bounds = Bounds::new(&factor, system, state, equations, place)?;
        let mut change = factor.solve(&right);
        change -= bounds.correction(&change);
        let mut all = DVector::zeros(place.len());
        for (unknown, p) in place.iter().enumerate() {
            if let Place::Shared(at) = p {
                all[unknown] = change[*at];
            }
        }
        for (own, right) in owns.iter().zip(rights) {
            let shared =
                DVector::from_iterator(own.shared.len(), own.shared.iter().map(|&s| change[s]));
            let step = right - &own.gain * shared;
            own.unknowns.iter().zip(step.iter()).for_each(|(&u, &value)| all[u] = value);
        }
        Some(Self { change: all, owns, factor, bounds })
    }
}

/// Cholesky, with a ridge far below what any region says, for what no region determines.
fn factor(mut matrix: DMatrix<f64>) -> Option<Cholesky<f64, Dyn>> {
    for i in 0..matrix.nrows() {
        matrix[(i, i)] = matrix[(i, i)] * (1.0 + 1e-12) + 1e-9;
    }
    matrix.cholesky()
}

/// Jacobian of a surface's coordinates, their values, and the unknowns. `state` comes back as it was.
fn linearised(
    item: &Condensed,
    system: &System,
    state: &mut State,
    i: usize,
) -> Option<(DMatrix<f64>, DVector<f64>, Vec<usize>)> {
    let unknowns = system.unknowns(i);
    let delta = item.coordinates(&system.surface(i, state))?;
    let mut jacobian = DMatrix::zeros(delta.len(), unknowns.len());
    for (k, &unknown) in unknowns.iter().enumerate() {
        let mut at = |step: f64| {
            let kept = state.value(unknown);
            state.nudge(unknown, step);
            let seen = item.coordinates(&system.surface(i, state));
            state.restore(unknown, kept);
            seen
        };
        let slope = (at(STEP)? - at(-STEP)?) / (2.0 * STEP);
        jacobian.set_column(k, &slope);
    }
    Some((jacobian, delta, unknowns))
}
