//! Rand index and adjusted Rand index (Hubert and Arabie 1985), over pairs of faces.

use super::consistency::numbered;

/// Agreement of two partitions on pairs of faces: together in both, or apart in both.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rand {
    /// Share of the pairs that both treat alike.
    pub index: f64,
    /// The same, less what chance would give: 1 for equal partitions, about 0 for unrelated ones.
    pub adjusted: f64,
}

/// Both indices; faces without a label form one region.
pub fn rand(found: &[u32], truth: &[u32]) -> Rand {
    let (found, truth) = (numbered(found), numbered(truth));
    let mut common = vec![0u64; found.1 * truth.1];
    let (mut of_found, mut of_truth) = (vec![0u64; found.1], vec![0u64; truth.1]);
    for (&i, &j) in found.0.iter().zip(&truth.0) {
        common[i as usize * truth.1 + j as usize] += 1;
        of_found[i as usize] += 1;
        of_truth[j as usize] += 1;
    }
    let couples = |counts: &[u64]| counts.iter().map(|&n| couples(n)).sum::<f64>();
    let (both, every) = (couples(&common), self::couples(found.0.len() as u64));
    let (one, other) = (couples(&of_found), couples(&of_truth));
    if every == 0.0 {
        return Rand { index: 1.0, adjusted: 1.0 };
    }
    let (expected, best) = (one * other / every, (one + other) / 2.0);
    let adjusted = if best == expected { 1.0 } else { (both - expected) / (best - expected) };
    Rand { index: (every + 2.0 * both - one - other) / every, adjusted }
}

/// Pairs among so many.
fn couples(n: u64) -> f64 {
    let n = n as f64;
    n * (n - 1.0) / 2.0
}
