//! Equations, one after the other: accepted, implied by those before, or refused.

use nalgebra::DVector;

use super::equation::Equation;
use super::gate;
use super::solve::{RANK, Solution};
use super::system::System;

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
}

/// Judges candidates, the surest first, each in the light of those accepted before: a Gaussian
/// conditioned on one equation at a time.
pub fn admit(system: &System, solution: &Solution, candidates: &[Candidate]) -> Vec<Verdict> {
    let mut unknowns: Vec<usize> =
        candidates.iter().flat_map(|c| c.equation.unknowns(system)).collect();
    unknowns.sort_unstable();
    unknowns.dedup();
    let units: Vec<_> = unknowns.iter().map(|&u| vec![(u, 1.0)]).collect();
    let mut covariance = solution.spread.of(&units);
    let mut shift = DVector::<f64>::zeros(unknowns.len());
    let mut basis: Vec<DVector<f64>> = Vec::new();
    let rows: Vec<_> =
        candidates.iter().map(|c| Row::new(c, system, solution, &unknowns)).collect();
    let mut verdicts: Vec<Option<Verdict>> = vec![None; candidates.len()];
    loop {
        let mut best: Option<(f64, usize, f64)> = None;
        for (i, row) in rows.iter().enumerate().filter(|(i, _)| verdicts[*i].is_none()) {
            let value = row.value + row.row.dot(&shift);
            let variance = row.row.dot(&(&covariance * &row.row)).max(f64::MIN_POSITIVE);
            if let Some(odds) = gate::log_odds_of(value, variance, row.range, row.before)
                && best.is_none_or(|(known, ..)| odds > known)
            {
                best = Some((odds, i, value * value / variance));
            }
        }
        let Some((_, i, chi_squared)) = best else { break };
        let row = &rows[i];
        if independent(&row.row, &mut basis) {
            let along = &covariance * &row.row;
            let variance = row.row.dot(&along).max(f64::MIN_POSITIVE);
            shift -= &along * ((row.value + row.row.dot(&shift)) / variance);
            covariance.ger(-1.0 / variance, &along, &along, 1.0);
            verdicts[i] = Some(Verdict::Accepted(chi_squared));
        } else {
            verdicts[i] = Some(Verdict::Implied);
        }
    }
    let refused = |row: &Row| {
        let value = row.value + row.row.dot(&shift);
        let variance = row.row.dot(&(&covariance * &row.row)).max(f64::MIN_POSITIVE);
        Verdict::Refused(value * value / variance)
    };
    verdicts.iter().zip(&rows).map(|(v, row)| v.unwrap_or_else(|| refused(row))).collect()
}

/// A candidate's derivatives scaled to length one, its value and range likewise.
struct Row {
    row: DVector<f64>,
    value: f64,
    range: f64,
    before: f64,
}

impl Row {
    fn new(
        candidate: &Candidate,
        system: &System,
        solution: &Solution,
        unknowns: &[usize],
    ) -> Self {
        let mut row = DVector::zeros(unknowns.len());
        for (unknown, value) in candidate.equation.row(system, &solution.state) {
            if let Ok(at) = unknowns.binary_search(&unknown) {
                row[at] = value;
            }
        }
        let length = row.norm().max(f64::MIN_POSITIVE);
        let value = candidate.equation.value(system, &solution.state) / length;
        Self { row: row / length, value, range: candidate.range / length, before: candidate.before }
    }
}

/// Adds a row to an orthonormal basis (Gram-Schmidt, twice), unless it depends on it.
fn independent(row: &DVector<f64>, basis: &mut Vec<DVector<f64>>) -> bool {
    let mut rest = row.clone();
    for _ in 0..2 {
        for known in basis.iter() {
            rest.axpy(-known.dot(&rest), known, 1.0);
        }
    }
    let length = rest.norm();
    if length > RANK {
        basis.push(rest / length);
    }
    length > RANK
}
