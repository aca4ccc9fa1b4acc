//! A place or a size that is known up to its covariance.

use nalgebra::{DMatrix, DVector};

use super::cluster::{Estimate, SKEW};
use super::gate::{self, Gate};
use crate::math::Point;

/// Keys of different groups are further apart than any two places in the unit cube.
const GROUPS: f64 = 1e3;

/// Where something is, in one or more numbers, and their covariance.
pub struct Position {
    /// Only things of one group are compared.
    pub group: usize,
    /// Of sizes: what they are of and along which direction, as long as it is one for all of them.
    pub kin: Option<(usize, usize)>,
    /// How many things it stands for.
    pub count: usize,
    /// Whether large groups attract: axes gather, sizes do not.
    pub social: bool,
    /// Where it is.
    pub value: DVector<f64>,
    /// Covariance of that.
    pub covariance: DMatrix<f64>,
    /// Where it was measured.
    pub measured: Point,
    /// Variance of the direction that leads elsewhere.
    pub turn: f64,
    /// Volume of the places that it might have been in.
    pub volume: f64,
    /// The user's tolerance, if there is one.
    pub tolerance: Option<f64>,
}

impl Position {
    /// Variance that the direction adds over the way between two measurements.
    fn swing(&self, other: &Self) -> f64 {
        (self.measured - other.measured).norm_squared() * self.turn.max(other.turn)
    }

    fn lever(&self, other: &Self) -> DMatrix<f64> {
        DMatrix::identity(self.value.len(), self.value.len()) * self.swing(other)
    }

    /// Chi-squared and number of equations of two being one.
    pub fn chi_squared(&self, other: &Self) -> (f64, usize) {
        let apart = &self.value - &other.value;
        let covariance = &self.covariance + &other.covariance + self.lever(other);
        let factor = covariance.cholesky();
        (factor.map_or(f64::INFINITY, |f| apart.dot(&f.solve(&apart))), apart.len())
    }
}

impl Estimate for Position {
    fn log_odds(&self, other: &Self) -> Option<f64> {
        if self.group != other.group {
            return None;
        }
        let squared: f64 =
            self.value.iter().zip(other.value.iter()).map(|(a, b)| (a - b).powi(2)).sum();
        if let Some(tolerance) = self.tolerance {
            return Gate::by_tolerance(tolerance, squared.sqrt());
        }
        // No variance exceeds the trace, so chi-squared is at least this: most pairs end here.
        let count = self.value.len();
        let lever = count as f64 * self.swing(other);
        let trace = self.covariance.trace() + other.covariance.trace() + lever;
        if squared > gate::limit(count) * trace {
            return None;
        }
        let apart = &self.value - &other.value;
        let covariance = &self.covariance + &other.covariance + self.lever(other);
        let before = if self.social {
            gate::joining(self.count, other.count)
        } else if self.kin.is_some() && self.kin == other.kin {
            gate::KIN
        } else {
            0.0
        };
        let volume = self.volume.max(other.volume);
        gate::log_odds(&apart, &covariance, volume, before)
    }

    fn key(&self) -> f64 {
        self.group as f64 * GROUPS + self.value.iter().zip(SKEW).map(|(x, w)| x * w).sum::<f64>()
    }

    fn fused(&self, other: &Self) -> Self {
        let total = (&self.covariance + &other.covariance).try_inverse();
        let gain = total.map_or_else(|| self.covariance.clone() * 0.0, |t| &self.covariance * t);
        let nearer = self.covariance.trace() <= other.covariance.trace();
        Self {
            group: self.group,
            kin: self.kin.filter(|_| self.kin == other.kin),
            count: self.count + other.count,
            social: self.social,
            value: &self.value + &gain * (&other.value - &self.value),
            covariance: &self.covariance - &gain * &self.covariance,
            measured: if nearer { self.measured } else { other.measured },
            turn: self.turn.max(other.turn),
            volume: self.volume,
            tolerance: self.tolerance,
        }
    }
}
