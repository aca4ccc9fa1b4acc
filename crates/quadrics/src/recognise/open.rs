//! The faces that wait for a surface, to be drawn from at random.

use super::scene::Scene;
use crate::partition::UNLABELLED;

/// Faces that are counted together: closing one costs a step, finding one a walk over the blocks.
const BLOCK: usize = 1024;

/// A seed that led nowhere is given up with the unlabelled faces around it, ring by ring, until they are
/// so many: those beside it, and under independent noise, where the next face would lead nowhere
/// either, its neighbourhood. On scans that costs F1 (0.77 to 0.73).
const BALL: usize = 2;
const BALL_NOISY: usize = 20;

/// A set of faces that only shrinks.
pub struct Open {
    open: Vec<bool>,
    /// Open faces of every block.
    counts: Vec<u32>,
    left: usize,
}

impl Open {
    /// The faces without a label.
    pub fn new(labels: &[u32]) -> Self {
        let open: Vec<bool> = labels.iter().map(|&label| label == UNLABELLED).collect();
        let count = |block: &[bool]| block.iter().filter(|&&open| open).count() as u32;
        let counts: Vec<u32> = open.chunks(BLOCK).map(count).collect();
        let left = counts.iter().map(|&count| count as usize).sum();
        Self { open, counts, left }
    }

    /// How many are left.
    pub fn len(&self) -> usize {
        self.left
    }

    /// Whether none is.
    pub fn is_empty(&self) -> bool {
        self.left == 0
    }

    /// Takes a face out, if it is in.
    pub fn close(&mut self, face: u32) {
        if std::mem::replace(&mut self.open[face as usize], false) {
            self.counts[face as usize / BLOCK] -= 1;
            self.left -= 1;
        }
    }

    /// The face that has `before` open ones before it; there must be more than that.
    pub fn nth(&self, mut before: usize) -> u32 {
        debug_assert!(before < self.left);
        let mut block = 0;
        while self.counts[block] as usize <= before {
            before -= self.counts[block] as usize;
            block += 1;
        }
        let faces = block * BLOCK..self.open.len();
        let found = faces.filter(|&face| self.open[face]).nth(before);
        found.expect("the block has as many") as u32
    }
}

/// Faces that may still be drawn as seeds, and those that were given up.
pub struct Waiting {
    /// Faces that may be drawn.
    pub open: Open,
    dead: Vec<bool>,
    /// Dead ones without a label.
    pub buried: usize,
}

impl Waiting {
    /// The faces without a label.
    pub fn new(labels: &[u32]) -> Self {
        Self { open: Open::new(labels), dead: vec![false; labels.len()], buried: 0 }
    }

    /// A seed that led nowhere is not tried again, nor are the unlabelled faces around it.
    pub fn bury(&mut self, scene: &Scene, seed: u32, labels: &[u32]) {
        let ball = if scene.noisy() { BALL_NOISY } else { BALL };
        let mut around = vec![seed];
        let mut next = 0;
        while next < around.len() && around.len() < ball {
            for other in scene.adjacency.across(around[next] as usize) {
                if labels[other] == UNLABELLED && !around.contains(&(other as u32)) {
                    around.push(other as u32);
                }
            }
            next += 1;
        }
        for face in around {
            if !std::mem::replace(&mut self.dead[face as usize], true)
                && labels[face as usize] == UNLABELLED
            {
                self.buried += 1;
                self.open.close(face);
            }
        }
    }

    /// A face is about to get a label.
    pub fn take(&mut self, face: u32, labels: &[u32]) {
        if labels[face as usize] == UNLABELLED && self.dead[face as usize] {
            self.buried -= 1;
        }
        self.open.close(face);
    }
}

#[cfg(test)]
mod tests {
    use rand::RngExt;

    use super::*;
    use crate::context::Context;

    #[test]
    fn it_numbers_its_faces_as_a_list_of_them_does() {
        let mut rng = Context::new(5).rng;
        let labels: Vec<u32> =
            (0..5000).map(|_| if rng.random_bool(0.7) { UNLABELLED } else { 0 }).collect();
        let mut list: Vec<u32> =
            (0..5000).filter(|&face| labels[face as usize] == UNLABELLED).collect();
        let mut open = Open::new(&labels);
        while !open.is_empty() {
            assert_eq!(open.len(), list.len());
            assert!((0..list.len()).step_by(7).all(|i| open.nth(i) == list[i]));
            for _ in 0..300 {
                let face = rng.random_range(0..5000);
                open.close(face);
                list.retain(|&other| other != face);
            }
            let last = open.len().checked_sub(1).map(|last| open.nth(last));
            assert_eq!(last, list.last().copied());
            last.into_iter().for_each(|face| open.close(face));
            list.pop();
        }
    }
}
