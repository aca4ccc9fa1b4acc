//! Consistency error (paper, eq. 7).

use crate::partition::compact;

/// CE: the mean over faces of the local refinement error, which is by area, in the better direction.
///
/// Faces without a label form one region. 0 where one side refines the other: read it beside HD.
pub fn error(found: &[u32], truth: &[u32], areas: &[f64]) -> f64 {
    let (found, truth) = (numbered(found), numbered(truth));
    let (rows, columns) = (found.1, truth.1);
    let mut common = vec![0.0; rows * columns];
    let (mut of_found, mut of_truth) = (vec![0.0; rows], vec![0.0; columns]);
    for ((&i, &j), area) in found.0.iter().zip(&truth.0).zip(areas) {
        common[i as usize * columns + j as usize] += area;
        of_found[i as usize] += area;
        of_truth[j as usize] += area;
    }
    let outside = |shared: f64, whole: f64| if whole > 0.0 { 1.0 - shared / whole } else { 0.0 };
    let (mut one, mut other) = (0.0, 0.0);
    for (&i, &j) in found.0.iter().zip(&truth.0) {
        let shared = common[i as usize * columns + j as usize];
        one += outside(shared, of_found[i as usize]);
        other += outside(shared, of_truth[j as usize]);
    }
    (f64::min(one, other) / areas.len() as f64).max(0.0)
}

/// Labels from 0, unlabelled faces with one of their own, and how many there are.
pub fn numbered(labels: &[u32]) -> (Vec<u32>, usize) {
    // One more than each: u32::MAX, no label, becomes 0.
    let mut labels: Vec<u32> = labels.iter().map(|label| label.wrapping_add(1)).collect();
    let count = compact(&mut labels);
    (labels, count)
}
