//! Equations, one after the other: accepted, implied by those before, or refused.
//!
//! A Gaussian is conditioned on one equation at a time, the surest first. After each the unknowns
//! move until all accepted equations hold exactly, and everything is linearised there: four
//! directions at right angles to each other are no contradiction to first order, only in truth.

use nalgebra::{DMatrix, DVector};

use super::equation::Equation;
use super::gate::{self, Gate};
use super::spread::Spread;
use super::system::{State, System};

/// What became of a candidate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Verdict {
    /// It holds now, at this increase of chi-squared.
    Accepted(f64),
    /// It follows from the others.
    Implied,
    /// The data refuse it, at this increase of chi-squared.
    Refused(f64),
}

/// An equation that might hold.
#[derive(Debug, Clone)]
pub struct Candidate {
    /// What would hold.
    pub equation: Equation,
    /// Range of its value if it does not hold.
    pub range: f64,
    /// Log odds before anything is measured, over those of any relation.
    pub before: f64,
    /// The user wants it.
    pub forced: bool,
}

/// A row, scaled to length one, that keeps less than this beside the accepted ones depends on them.
const RANK: f64 = 1e-6;
/// An equation holds at this value.
const HOLDS: f64 = 1e-12;
/// Newton steps towards the equations; 4 are the rule.
const STEPS: usize = 12;

/// Judges candidates in the light of each other; the state in which all accepted ones hold.
pub fn admit(
    system: &System,
    state: &State,
    spread: &Spread,
    candidates: &[Candidate],
    gate: Gate,
) -> (Vec<Verdict>, State) {
    let mut judge = Judge::new(system, state, spread, candidates, gate);
    let mut verdicts: Vec<Option<Verdict>> = vec![None; candidates.len()];
    loop {
        let open = (0..candidates.len()).filter(|&i| verdicts[i].is_none());
        let seen = open.filter_map(|i| Some((judge.odds(&candidates[i])?, i)));
        let Some((_, i)) = seen.max_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1))) else {
            break;
        };
        verdicts[i] = Some(judge.take(candidates[i].equation.clone()));
    }
    let refused = |c: &Candidate| {
        let (value, variance, _) = judge.see(&c.equation);
        Verdict::Refused(value * value / variance)
    };
    let verdicts = verdicts.iter().zip(candidates).map(|(v, c)| v.unwrap_or_else(|| refused(c)));
    (verdicts.collect(), judge.state.clone())
}

struct Judge<'a> {
    system: &'a System,
    gate: Gate,
    state: State,
    /// The unknowns that any equation depends on.
    unknowns: Vec<usize>,
    /// Covariance before and under the accepted equations.
    free: DMatrix<f64>,
    covariance: DMatrix<f64>,
    accepted: Vec<Equation>,
}

impl<'a> Judge<'a> {
    fn new(
        system: &'a System,
        state: &State,
        spread: &Spread,
        candidates: &[Candidate],
        gate: Gate,
    ) -> Self {
        let equations = candidates.iter().map(|c| &c.equation);
        let mut unknowns: Vec<usize> = equations.flat_map(|e| e.unknowns(system)).collect();
        unknowns.sort_unstable();
        unknowns.dedup();
        let units: Vec<_> = unknowns.iter().map(|&u| vec![(u, 1.0)]).collect();
        let free = spread.of(&units);
        let (state, accepted) = (state.clone(), Vec::new());
        Self { system, gate, state, unknowns, covariance: free.clone(), free, accepted }
    }

    /// Value and variance of an equation whose row is scaled to length one, and the row.
    fn see(&self, equation: &Equation) -> (f64, f64, Vec<(usize, f64)>) {
        let (value, row) = self.row(equation, &self.state);
        let mut variance = 0.0;
        for &(a, x) in &row {
            for &(b, y) in &row {
                variance += x * y * self.covariance[(a, b)];
            }
        }
        (value, variance.max(f64::MIN_POSITIVE), row)
    }

    fn row(&self, equation: &Equation, state: &State) -> (f64, Vec<(usize, f64)>) {
        let row = equation.row(self.system, state);
        let length = row.iter().map(|(_, v)| v * v).sum::<f64>().sqrt().max(f64::MIN_POSITIVE);
        let at = |(unknown, value): (usize, f64)| {
            Some((self.unknowns.binary_search(&unknown).ok()?, value / length))
        };
        let row: Vec<_> = row.into_iter().filter_map(at).collect();
        (equation.value(self.system, state) / length, row)
    }

    fn odds(&self, candidate: &Candidate) -> Option<f64> {
        let (value, variance, _) = self.see(&candidate.equation);
        // What holds already is known for sure.
        if value.abs() < HOLDS && variance < HOLDS {
            return Some(f64::MAX);
        }
        if candidate.forced {
            return Some(f64::MAX);
        }
        if let Some(tolerance) = self.gate.angle {
            // The row has length one: the value is an angle by the square root of two.
            return Gate::by_tolerance(tolerance, value.abs() * std::f64::consts::SQRT_2);
        }
        gate::log_odds_of(value, variance, candidate.range, candidate.before)
    }

    /// Adds an equation, or rolls it back.
    fn take(&mut self, equation: Equation) -> Verdict {
        let (value, variance, row) = self.see(&equation);
        let chi_squared = value * value / variance;
        self.accepted.push(equation);
        if !self.independent() {
            self.accepted.pop();
            let holds = value.abs() < 1e-9;
            return if holds { Verdict::Implied } else { Verdict::Refused(chi_squared) };
        }
        let mut along = DVector::<f64>::zeros(self.unknowns.len());
        row.iter().for_each(|&(at, x)| along += self.covariance.column(at) * x);
        let Some(state) = self.fulfilled(&along, -value / variance) else {
            self.accepted.pop();
            return Verdict::Refused(chi_squared);
        };
        self.state = state;
        self.covariance.ger(-1.0 / variance, &along, &along.clone(), 1.0);
        Verdict::Accepted(chi_squared)
    }

    /// Rank-revealing: whether the scaled rows of all accepted equations are independent.
    fn independent(&self) -> bool {
        let factor = self.jacobian(&self.state).0.transpose().col_piv_qr();
        let least = factor.unpack_r().diagonal().iter().fold(f64::INFINITY, |m, v| m.min(v.abs()));
        self.accepted.len() <= self.unknowns.len() && least > RANK
    }

    /// Scaled rows and values of all accepted equations.
    fn jacobian(&self, state: &State) -> (DMatrix<f64>, DVector<f64>) {
        let mut rows = DMatrix::<f64>::zeros(self.accepted.len(), self.unknowns.len());
        let mut values = DVector::<f64>::zeros(self.accepted.len());
        for (e, equation) in self.accepted.iter().enumerate() {
            let (value, row) = self.row(equation, state);
            values[e] = value;
            row.into_iter().for_each(|(at, x)| rows[(e, at)] = x);
        }
        (rows, values)
    }

    /// The state in which all accepted equations hold, from a first step `factor * along`.
    fn fulfilled(&self, along: &DVector<f64>, factor: f64) -> Option<State> {
        let mut state = self.moved(&self.state, &(along * factor));
        for _ in 0..STEPS {
            let (rows, values) = self.jacobian(&state);
            if values.amax() < HOLDS {
                return Some(state);
            }
            let spread = &self.free * rows.transpose();
            let step = -&spread * (&rows * &spread).cholesky()?.solve(&values);
            // A NaN is no step either.
            if step.amax().is_nan() || step.amax() > 0.5 {
                return None;
            }
            state = self.moved(&state, &step);
        }
        None
    }

    fn moved(&self, state: &State, step: &DVector<f64>) -> State {
        let mut all = vec![0.0; self.system.state.len()];
        self.unknowns.iter().zip(step.iter()).for_each(|(&u, &value)| all[u] = value);
        state.moved(&all)
    }
}
