//! Proposals, the surest first, in the Gaussian that those before leave.
//!
//! Directions are settled by now, so equations are as good as linear: a belief about the unknowns is
//! conditioned on each, and the solver makes all of them exact at the end.

use nalgebra::{DMatrix, DVector};

use super::admit::Verdict;
use super::equation::Equation;
use super::gate::{self, Gate};
use super::proposal::Proposal;
use super::solve::Solution;
use super::system::System;

/// An equation that keeps less than this of its variance follows from those before.
const RANK: f64 = 1e-9;
/// It holds already at this value.
const HOLDS: f64 = 1e-7;

/// What became of a proposal.
#[derive(Debug, Clone)]
pub struct Outcome {
    /// Accepted, implied or refused.
    pub verdict: Verdict,
    /// The equations to solve, each independent of the others; none where it does not stand.
    pub equations: Vec<Equation>,
}

impl Outcome {
    /// Rolls it back.
    pub fn refuse(&mut self) {
        if let Verdict::Accepted(chi_squared) = self.verdict {
            self.verdict = Verdict::Refused(chi_squared);
        }
        self.equations.clear();
    }
}

/// What becomes of every proposal.
pub fn weigh(
    system: &System,
    solution: &Solution,
    proposals: &[Proposal],
    gate: Gate,
) -> Vec<Outcome> {
    let mut belief = Belief::new(system, solution, proposals);
    let rows: Vec<_> = proposals.iter().map(|p| belief.rows(system, solution, p)).collect();
    let odds = |belief: &Belief, i: usize| belief.odds(&proposals[i], &rows[i], gate);
    let mut order: Vec<(f64, usize)> =
        (0..proposals.len()).filter_map(|i| Some((odds(&belief, i)?, i))).collect();
    order.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    let refused = |belief: &Belief, i: usize| Outcome {
        verdict: Verdict::Refused(belief.see(&rows[i]).chi_squared),
        equations: Vec::new(),
    };
    let mut outcomes: Vec<Outcome> = (0..proposals.len()).map(|i| refused(&belief, i)).collect();
    for (_, i) in order {
        outcomes[i] = match odds(&belief, i) {
            Some(_) => {
                let (verdict, used) = belief.take(&rows[i]);
                let equations = used.into_iter().map(|e| proposals[i].equations[e].clone());
                Outcome { verdict, equations: equations.collect() }
            }
            None => refused(&belief, i),
        };
    }
    outcomes
}

/// Equations of one proposal: values, and derivatives by place among the unknowns.
type Rows = Vec<(f64, Vec<(usize, f64)>)>;

struct Belief {
    unknowns: Vec<usize>,
    covariance: DMatrix<f64>,
    /// Variances before any equation.
    free: DVector<f64>,
    /// How far the unknowns moved from the state at which all was linearised.
    shift: DVector<f64>,
}

struct Seen {
    chi_squared: f64,
    /// Half the logarithm of the determinant of the independent equations' covariance.
    half: f64,
    independent: usize,
}

impl Belief {
    fn new(system: &System, solution: &Solution, proposals: &[Proposal]) -> Self {
        let equations = proposals.iter().flat_map(|p| &p.equations);
        let mut unknowns: Vec<usize> = equations.flat_map(|e| e.unknowns(system)).collect();
        unknowns.sort_unstable();
        unknowns.dedup();
        let units: Vec<_> = unknowns.iter().map(|&u| vec![(u, 1.0)]).collect();
        let covariance = solution.spread.of(&units);
        let (free, shift) = (covariance.diagonal(), DVector::zeros(unknowns.len()));
        Self { unknowns, covariance, free, shift }
    }

    fn rows(&self, system: &System, solution: &Solution, proposal: &Proposal) -> Rows {
        let place = |(unknown, slope): (usize, f64)| {
            Some((self.unknowns.binary_search(&unknown).ok()?, slope))
        };
        let of = |equation: &Equation| {
            let row = equation.row(system, &solution.state);
            (equation.value(system, &solution.state), row.into_iter().filter_map(place).collect())
        };
        proposal.equations.iter().map(of).collect()
    }

    fn value(&self, (value, row): &(f64, Vec<(usize, f64)>)) -> f64 {
        value + row.iter().map(|&(at, slope)| slope * self.shift[at]).sum::<f64>()
    }

    fn covariance_of(&self, one: &[(usize, f64)], other: &[(usize, f64)]) -> f64 {
        let terms = one.iter().flat_map(|&(a, x)| other.iter().map(move |&(b, y)| (a, b, x * y)));
        terms.map(|(a, b, factor)| factor * self.covariance[(a, b)]).sum()
    }

    /// Conditions the equations on each other, one after the other.
    fn see(&self, rows: &Rows) -> Seen {
        let count = rows.len();
        let mut spread =
            DMatrix::from_fn(count, count, |a, b| self.covariance_of(&rows[a].1, &rows[b].1));
        let mut values: Vec<f64> = rows.iter().map(|row| self.value(row)).collect();
        let mut seen = Seen { chi_squared: 0.0, half: 0.0, independent: 0 };
        for e in 0..count {
            let variance = spread[(e, e)];
            let free: f64 = rows[e].1.iter().map(|&(at, x)| x * x * self.free[at]).sum();
            if variance <= RANK * free {
                if values[e].abs() > HOLDS {
                    seen.chi_squared = f64::INFINITY;
                }
                continue;
            }
            seen.chi_squared += values[e] * values[e] / variance;
            seen.half += variance.ln() / 2.0;
            seen.independent += 1;
            for f in e + 1..count {
                let gain = spread[(f, e)] / variance;
                values[f] -= gain * values[e];
                for h in e + 1..count {
                    spread[(f, h)] -= gain * spread[(e, h)];
                }
            }
        }
        seen
    }

    fn odds(&self, proposal: &Proposal, rows: &Rows, gate: Gate) -> Option<f64> {
        if proposal.forced {
            return Some(f64::MAX);
        }
        if let Some(tolerance) = if proposal.angular() { gate.angle } else { gate.length } {
            let worst = rows.iter().map(|row| self.value(row).abs()).fold(0.0, f64::max);
            return Gate::by_tolerance(tolerance, worst);
        }
        let seen = self.see(rows);
        if seen.independent == 0 {
            return (seen.chi_squared == 0.0).then_some(0.0);
        }
        let before = seen.independent as f64 * proposal.range.ln() + proposal.before;
        gate::weighed(seen.chi_squared, seen.half, seen.independent, before)
    }

    /// Conditions the unknowns on a proposal, unless it contradicts what holds; the verdict, and which
    /// of its equations are independent.
    fn take(&mut self, rows: &Rows) -> (Verdict, Vec<usize>) {
        let mut used = Vec::new();
        let seen = self.see(rows);
        if seen.chi_squared.is_infinite() {
            return (Verdict::Refused(seen.chi_squared), used);
        }
        if seen.independent == 0 {
            return (Verdict::Implied, used);
        }
        for (e, row) in rows.iter().enumerate() {
            let variance = self.covariance_of(&row.1, &row.1);
            let free: f64 = row.1.iter().map(|&(at, x)| x * x * self.free[at]).sum();
            if variance <= RANK * free {
                continue;
            }
            used.push(e);
            let value = self.value(row);
            let mut along = DVector::<f64>::zeros(self.unknowns.len());
            row.1.iter().for_each(|&(at, x)| along.axpy(x, &self.covariance.column(at), 1.0));
            self.shift.axpy(-value / variance, &along, 1.0);
            self.covariance.ger(-1.0 / variance, &along, &along, 1.0);
        }
        (Verdict::Accepted(seen.chi_squared), used)
    }
}
