//! When is a relation believed? Odds from the covariances of the fits, not a number of degrees.
//!
//! Two hypotheses compete for a difference `g` that is known up to the covariance `S`: the relation
//! holds and `g` is an error of the fits, `N(0, S)`, or the surfaces are free and `g` is anything,
//! uniform over a volume. The odds are `V N(g; 0, S)` times those before looking: a coarse direction
//! agrees with everything and says nothing, a fine one that agrees is no accident.

use nalgebra::{DMatrix, DVector};

/// Log odds that two surfaces share something before anything is measured.
pub const PRIOR: f64 = -2.0;
/// Chi-squared that a true relation exceeds once in 10 000 times, by number of equations (1, 2, 3).
const LIMITS: [f64; 3] = [15.14, 18.42, 21.11];
/// Standard normal deviate that is exceeded once in 10 000 times.
const RARE: f64 = 3.719;

/// Chi-squared that a true relation of so many equations exceeds once in 10 000 times; of more than
/// three by Wilson and Hilferty (1931), up to 3 % too much.
pub fn limit(count: usize) -> f64 {
    if let Some(&exact) = LIMITS.get(count.wrapping_sub(1)) {
        return exact;
    }
    let ninth = 2.0 / (9.0 * count as f64);
    count as f64 * (1.0 - ninth + RARE * ninth.sqrt()).powi(3)
}

/// Log odds that groups of so many surfaces are one before anything is measured: by Pitman's rule
/// (the Chinese restaurant) a surface joins a group with odds proportional to its size.
pub fn joining(one: usize, other: usize) -> f64 {
    // Of two groups every surface of the smaller joins the larger.
    one.min(other) as f64 * (one.max(other) as f64).ln().min(3.0)
}

/// Log odds, over those of any two, that sizes of one kind along one direction are equal. Of the true
/// radii of parallel cylinders within 15 % of each other 97 % are equal in `parts`, 90 % in `cad`; of
/// those that are not parallel half and three quarters: drills and cutters are few, and their sizes are
/// preferred numbers a tenth apart.
pub const KIN: f64 = 2.0;

/// A user's own gate: what deviates less is related, what deviates more is not, however well it is
/// known. `None` leaves it to the odds.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Gate {
    /// For directions and half angles, in radians.
    pub angle: Option<f64>,
    /// For places and sizes.
    pub length: Option<f64>,
}

impl Gate {
    /// Log odds under a tolerance of the user's: surer the smaller the deviation.
    pub fn by_tolerance(tolerance: f64, deviation: f64) -> Option<f64> {
        (deviation <= tolerance).then(|| 1.0 - deviation / tolerance.max(f64::MIN_POSITIVE))
    }
}

/// Log odds of a relation; `None` below even odds, or where chi-squared refuses it.
pub fn log_odds(g: &DVector<f64>, s: &DMatrix<f64>, volume: f64, before: f64) -> Option<f64> {
    let factor = s.clone().cholesky()?;
    let chi_squared = g.dot(&factor.solve(g));
    let half_log_determinant: f64 = factor.l_dirty().diagonal().iter().map(|v| v.ln()).sum();
    weighed(chi_squared, half_log_determinant, g.len(), volume.ln() + before)
}

/// [`log_odds`] of one number.
pub fn log_odds_of(g: f64, variance: f64, volume: f64, before: f64) -> Option<f64> {
    weighed(g * g / variance, variance.ln() / 2.0, 1, volume.ln() + before)
}

/// From chi-squared, half the logarithm of the determinant, the number of equations, and the log
/// odds before looking times the volume.
pub fn weighed(chi_squared: f64, half: f64, count: usize, before: f64) -> Option<f64> {
    let density = -chi_squared / 2.0 - half - count as f64 / 2.0 * std::f64::consts::TAU.ln();
    let odds = density + before + PRIOR;
    (odds > 0.0 && chi_squared < limit(count)).then_some(odds)
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_limits_are_those_of_tables() {
        // Quantiles of chi-squared at 1e-4.
        for (count, exact) in [(2, 18.42), (4, 23.51), (10, 35.56)] {
            assert!((super::limit(count) / exact - 1.0).abs() < 0.035);
        }
    }
}
