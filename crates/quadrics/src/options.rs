//! What a user may choose, and what holds when nothing is chosen.

/// Which method runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Preset {
    /// The best that we know: no parameter depends on scale, surfaces are typed in the loop.
    #[default]
    Default,
    /// Section 4 of the paper to the letter.
    Paper,
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

/// All options of a segmentation. Lengths are fractions of the longest side of the part.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// Which method runs.
    pub preset: Preset,
    /// Number of regions to end with (the paper's κ); found from the data when `None`.
    pub regions: Option<usize>,
    /// Seed of every random choice.
    pub seed: u64,
    /// Threads to use; 0 for all cores. The result does not depend on it.
    pub threads: usize,
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
            preset: Preset::Default,
            regions: None,
            seed: 0,
            threads: 0,
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
