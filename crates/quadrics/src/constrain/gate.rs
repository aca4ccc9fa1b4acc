//! When is a relation believed? Odds from the covariances of the fits, not a number of degrees.
//!
//! Two hypotheses compete for a difference `g` that is known up to the covariance `S`: the relation
//! holds and `g` is an error of the fits, `N(0, S)`, or the surfaces are free and `g` is anything,
//! uniform over a volume. The odds are `V N(g; 0, S)` times those before looking: a coarse direction
//! agrees with everything and says nothing, a fine one that agrees is no accident.

use nalgebra::{Const, DimMin, OMatrix, OVector, allocator::Allocator};
use nalgebra::{DefaultAllocator, Dim};

/// Chi-squared that a true relation exceeds once in 10 000 times, by degrees of freedom (1, 2, 3).
pub const LIMITS: [f64; 3] = [15.1, 18.4, 21.1];
/// Log odds that two surfaces share something before anything is measured.
pub const PRIOR: f64 = -2.0;

/// Log odds that groups of so many surfaces are one before anything is measured: by Pitman's rule
/// (the Chinese restaurant) a surface joins a group with odds proportional to its size.
pub fn joining(one: usize, other: usize) -> f64 {
    // Of two groups every surface of the smaller joins the larger.
    one.min(other) as f64 * (one.max(other) as f64).ln().min(3.0)
}

/// Log odds of a relation; `None` below even odds, or where chi-squared refuses it.
pub fn log_odds<D>(
    g: &OVector<f64, D>,
    s: &OMatrix<f64, D, D>,
    volume: f64,
    before: f64,
) -> Option<f64>
where
    D: Dim + DimMin<D, Output = D>,
    DefaultAllocator: Allocator<D> + Allocator<D, D>,
{
    let factor = s.clone().cholesky()?;
    let chi_squared = g.dot(&factor.solve(g));
    let count = g.len();
    let half_log_determinant: f64 = factor.l_dirty().diagonal().iter().map(|v| v.ln()).sum();
    let density =
        -chi_squared / 2.0 - half_log_determinant - count as f64 / 2.0 * std::f64::consts::TAU.ln();
    let odds = density + volume.ln() + PRIOR + before;
    (odds > 0.0 && chi_squared < LIMITS[count - 1]).then_some(odds)
}

/// [`log_odds`] of one number.
pub fn log_odds_of(g: f64, variance: f64, volume: f64, before: f64) -> Option<f64> {
    log_odds::<Const<1>>(
        &OVector::<f64, Const<1>>::new(g),
        &OMatrix::<f64, Const<1>, Const<1>>::new(variance),
        volume,
        before,
    )
}
