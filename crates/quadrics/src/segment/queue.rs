//! The global priority queue of the partitioning (paper, section 4.3(1)).

use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// A pair of a face and a region that could own it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Pair {
    /// The face.
    pub face: u32,
    /// The region.
    pub region: u32,
    /// Whether the face is in the region's seed, and so its own already.
    pub seed: bool,
}

/// Smallest error first; a total order, so that every machine pops in the same one.
#[derive(Debug, Default)]
pub struct Queue {
    heap: BinaryHeap<Reverse<(u64, u32)>>,
}

impl Queue {
    /// Adds a pair. `error` is not negative; NaN counts as the largest of all.
    pub fn push(&mut self, error: f64, pair: Pair) {
        self.heap.push(Reverse((key(error, pair.face), pair.region << 1 | u32::from(pair.seed))));
    }

    /// Takes the pair of least error: of equal ones the least face, then the least region.
    pub fn pop(&mut self) -> Option<Pair> {
        let Reverse((key, tail)) = self.heap.pop()?;
        Some(Pair { face: key as u32, region: tail >> 1, seed: tail & 1 == 1 })
    }
}

/// Error in the high half, face in the low one.
fn key(error: f64, face: u32) -> u64 {
    debug_assert!(error.is_nan() || error >= 0.0);
    // The bits of a non-negative f32 sort like the number itself, so an integer queue will do.
    let bits = if error.is_nan() { u32::MAX } else { (error.abs() as f32).to_bits() };
    u64::from(bits) << 32 | u64::from(face)
}

#[cfg(test)]
mod tests {
    use rand::RngExt;

    use super::*;
    use crate::context::Context;

    #[test]
    fn pairs_come_out_as_a_stable_sort_would_have_them() {
        let mut rng = Context::new(4).rng;
        for _ in 0..100 {
            let mut queue = Queue::default();
            let mut plain = Vec::new();
            for _ in 0..rng.random_range(0..60) {
                // Few values, so that there are ties.
                let error = f64::from(rng.random_range(0..5u32)) * 1e-17;
                let (face, region) = (rng.random_range(0..4), rng.random_range(0..4));
                let pair = Pair { face, region, seed: rng.random() };
                queue.push(error, pair);
                plain.push((error as f32, face, region, pair.seed));
            }
            plain.sort_by(|one, other| one.partial_cmp(other).unwrap());
            for (_, face, region, seed) in plain {
                assert_eq!(queue.pop(), Some(Pair { face, region, seed }));
            }
            assert_eq!(queue.pop(), None);
        }
    }

    #[test]
    fn what_is_not_a_number_comes_last() {
        let mut queue = Queue::default();
        for (face, error) in [f64::NAN, f64::INFINITY, 1.0].into_iter().enumerate() {
            queue.push(error, Pair { face: face as u32, region: 0, seed: false });
        }
        let order: Vec<_> = std::iter::from_fn(|| queue.pop()).map(|pair| pair.face).collect();
        assert_eq!(order, [2, 1, 0]);
    }
}
