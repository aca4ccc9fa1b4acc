//! What a user may choose, and what holds when nothing is chosen.

use crate::constrain::Demands;
use crate::error::{Error, Result};

/// Which of our methods runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Preset {
    /// The best that we know: no parameter depends on scale, surfaces are typed in the loop.
    #[default]
    Default,
    /// Section 4 of the paper to the letter.
    Paper,
}

/// Whose method runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Method {
    /// Ours: what [`Options::preset`] says.
    #[default]
    Quadrics,
    /// Variational shape approximation (Cohen-Steiner, Alliez, Desbrun 2004): planes.
    Vsa,
    /// Variational mesh segmentation via quadric surface fitting (Yan et al. 2012).
    Qsf,
    /// Hierarchical fitting of primitives (Attene, Falcidieno, Spagnuolo 2006).
    Hfp,
    /// The detection of the paper alone, without the loop.
    Ransac,
}

/// Where a region starts to grow from in the paper's partitioning (4.3(1)).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Seeds {
    /// The best of [`Options::seed_candidates`] neighbourhoods.
    #[default]
    Region,
    /// The face of least error, as in VSA and QSF.
    Triangle,
}

/// Whether surfaces are sought on a coarser mesh, and its faces then choose among them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Coarse {
    /// Where the mesh is large and its own faces do not show its surfaces, or it is very large.
    #[default]
    Auto,
    /// Always.
    On,
    /// Never.
    Off,
}

/// All options of a segmentation. Lengths are fractions of the longest side of the part.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// Whose method runs: ours, or one that it is compared with.
    pub method: Method,
    /// Which of our methods runs.
    pub preset: Preset,
    /// Number of regions to end with (the paper's κ); found from the data when `None`.
    pub regions: Option<usize>,
    /// Relations between the surfaces (parallel, coaxial, ...) are sought and imposed, with what the
    /// user says about them; `None` leaves every surface as it fits best.
    pub constraints: Option<Demands>,
    /// Seed of every random choice.
    pub seed: u64,
    /// Threads to use; 0 for all cores. The result does not depend on it.
    pub threads: usize,
    /// `default`: whether surfaces are sought on a coarser mesh.
    pub coarse: Coarse,
    /// `paper`: longest edge after subdivision (4.1). Fraction of the size; infinite for none.
    pub max_edge: f64,
    /// `paper`: least cosine between a face's normal and the shape's (α of 5.1).
    pub alpha: f64,
    /// `paper`: largest distance of a barycentre from the shape (ε of 5.1). Fraction of the size.
    pub epsilon: f64,
    /// `paper`: fewest faces of a detected shape (τ of 5.1: 50, 100 or 200).
    pub tau: usize,
    /// `paper`: weight of the normal term in eq. 2. Squared fraction of the size.
    pub beta: f64,
    /// `paper`: what a region grows from (4.3(1)).
    pub seeds: Seeds,
    /// `paper`: how many neighbourhoods compete to be the seed region (m of 4.3(1)).
    pub seed_candidates: usize,
    /// `paper`: faces of a seed region over faces of its region (0.1 in 4.3(1)).
    pub seed_fraction: f64,
    /// `paper`: a region of smaller planarity (eq. 4) is a plane.
    pub planarity: f64,
    /// `paper`: adjacent planes within this angle merge, in degrees (4.3(3)).
    pub merge_angle_deg: f64,
    /// `paper`: a region above this area-averaged error is split (4.3(4)); off when `None`.
    pub insertion_threshold: Option<f64>,
    /// Most rounds of the loop.
    pub max_iterations: usize,
    /// The loop has converged when the energy changes by less than this fraction.
    pub convergence: f64,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            method: Method::Quadrics,
            preset: Preset::Default,
            regions: None,
            constraints: Some(Demands::default()),
            seed: 0,
            threads: 0,
            coarse: Coarse::Auto,
            max_edge: 0.03,
            alpha: 0.9,
            epsilon: 0.02,
            tau: 100,
            beta: 1e-3,
            seeds: Seeds::Region,
            seed_candidates: 10,
            seed_fraction: 0.1,
            planarity: 1e-6,
            merge_angle_deg: 5.0,
            insertion_threshold: None,
            max_iterations: 50,
            convergence: 1e-4,
        }
    }
}

impl Options {
    /// Whether every option is in its range.
    ///
    /// # Errors
    /// [`Error::Option`] with the first that is not, and its range.
    pub fn check(&self) -> Result<()> {
        let positive = |value: f64| value > 0.0;
        let not_negative = |value: f64| value >= 0.0;
        require(self.regions != Some(0), "regions", 0.0, "at least 1")?;
        require(positive(self.max_edge), "max_edge", self.max_edge, "a length above 0")?;
        require((-1.0..=1.0).contains(&self.alpha), "alpha", self.alpha, "a cosine")?;
        require(positive(self.epsilon), "epsilon", self.epsilon, "a length above 0")?;
        require(self.tau > 0, "tau", 0.0, "at least 1")?;
        require(not_negative(self.beta), "beta", self.beta, "0 or more")?;
        require(self.seed_candidates > 0, "seed_candidates", 0.0, "at least 1")?;
        let fraction = self.seed_fraction;
        require(fraction > 0.0 && fraction <= 1.0, "seed_fraction", fraction, "in (0, 1]")?;
        require(not_negative(self.planarity), "planarity", self.planarity, "0 or more")?;
        let angle = self.merge_angle_deg;
        require((0.0..=180.0).contains(&angle), "merge_angle_deg", angle, "in [0, 180]")?;
        if let Some(threshold) = self.insertion_threshold {
            require(positive(threshold), "insertion_threshold", threshold, "above 0")?;
        }
        require(not_negative(self.convergence), "convergence", self.convergence, "0 or more")
    }
}

fn require(holds: bool, name: &str, value: f64, range: &str) -> Result<()> {
    if holds { Ok(()) } else { Err(Error::Option(format!("{name} is {value}: give {range}"))) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn defaults_pass_and_what_is_out_of_range_is_named() {
        assert_eq!(Options::default().check(), Ok(()));
        let endless = Options { max_edge: f64::INFINITY, ..Options::default() };
        assert_eq!(endless.check(), Ok(()));
        let wrong = [
            ("regions", Options { regions: Some(0), ..Options::default() }),
            ("alpha", Options { alpha: f64::NAN, ..Options::default() }),
            ("max_edge", Options { max_edge: -1.0, ..Options::default() }),
            ("seed_fraction", Options { seed_fraction: 0.0, ..Options::default() }),
        ];
        for (name, options) in wrong {
            assert!(options.check().unwrap_err().to_string().starts_with(name));
        }
    }
}
