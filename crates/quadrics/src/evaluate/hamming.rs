//! Hamming distance (paper, eq. 6).

use super::Pair;

/// HD by area, in [0, 1].
///
/// Eq. 6 numbers the regions of both sides alike and takes their number as equal. Here the numbering
/// is the matching of largest overlap, and a region without partner stands against an empty one.
/// Both sums of eq. 6 are then the whole area less the matched overlap.
pub fn distance(pairs: &[Pair], total: f64) -> f64 {
    (1.0 - pairs.iter().map(|pair| pair.overlap).sum::<f64>() / total).max(0.0)
}
