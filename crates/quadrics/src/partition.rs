//! Who owns which face.

mod hand_out;
mod separate;
mod trees;

pub use hand_out::hand_out;
pub use separate::separate;
pub(crate) use trees::{join, root};

use rayon::prelude::*;

use crate::mesh::Adjacency;

/// The region of every face, counted from 0.
pub type Labels = Vec<u32>;

/// A face that no region owns yet.
pub const UNLABELLED: u32 = u32::MAX;

/// The faces of every region, flat: the transpose of [`Labels`].
#[derive(Debug, Clone, Default)]
pub struct Regions {
    offsets: Vec<u32>,
    faces: Vec<u32>,
}

impl Regions {
    /// Gathers the faces of every region, in ascending order; unlabelled faces are in none.
    pub fn new(labels: &[u32]) -> Self {
        let count = region_count(labels);
        let mut offsets = vec![0u32; count + 1];
        for &label in labels.iter().filter(|&&label| label != UNLABELLED) {
            offsets[label as usize + 1] += 1;
        }
        for region in 0..count {
            offsets[region + 1] += offsets[region];
        }
        let mut next = offsets.clone();
        let mut faces = vec![0; offsets[count] as usize];
        for (face, &label) in labels.iter().enumerate().filter(|(_, label)| **label != UNLABELLED) {
            faces[next[label as usize] as usize] = face as u32;
            next[label as usize] += 1;
        }
        Self { offsets, faces }
    }

    /// Number of regions.
    pub fn len(&self) -> usize {
        self.offsets.len().saturating_sub(1)
    }

    /// Whether there is no region at all.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The faces of a region.
    pub fn faces(&self, region: usize) -> &[u32] {
        &self.faces[self.offsets[region] as usize..self.offsets[region + 1] as usize]
    }

    /// The faces of every region in turn.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &[u32]> {
        (0..self.len()).map(|region| self.faces(region))
    }
}

/// One more than the greatest label; 0 where nothing is labelled.
pub fn region_count(labels: &[u32]) -> usize {
    labels.iter().filter(|&&label| label != UNLABELLED).max().map_or(0, |&label| label as usize + 1)
}

/// Numbers the labels that occur from 0, in the order of their first face.
pub fn compact(labels: &mut [u32]) -> usize {
    let mut new = vec![UNLABELLED; region_count(labels)];
    let mut count = 0;
    for label in labels.iter_mut().filter(|label| **label != UNLABELLED) {
        let slot = &mut new[*label as usize];
        if *slot == UNLABELLED {
            *slot = count;
            count += 1;
        }
        *label = *slot;
    }
    count as usize
}

/// Faces that are joined by one thread.
const CHUNK: usize = 1 << 15;

/// Connected components of equal labels: component of every face, and faces in every component.
///
/// Components are numbered in the order of their first face; an unlabelled face is in a component
/// of unlabelled faces. By joining trees of faces, those of a chunk at once, then across chunks.
pub fn components(labels: &[u32], adjacency: &Adjacency) -> (Vec<u32>, Vec<u32>) {
    let mut parent: Vec<u32> = (0..labels.len() as u32).collect();
    let within = |(chunk, own): (usize, &mut [u32])| {
        let first = chunk * CHUNK;
        let mut across = Vec::new();
        for face in first..first + own.len() {
            for other in adjacency.across(face) {
                if other >= face || labels[other] != labels[face] {
                    continue;
                }
                match other.checked_sub(first) {
                    Some(_) => join(own, first as u32, face as u32, other as u32),
                    None => across.push((face as u32, other as u32)),
                }
            }
        }
        across
    };
    let across: Vec<(u32, u32)> =
        parent.par_chunks_mut(CHUNK).enumerate().flat_map_iter(within).collect();
    across.into_iter().for_each(|(face, other)| join(&mut parent, 0, face, other));
    // A tree's root is its first face, and a parent comes before its children.
    let mut sizes = Vec::new();
    let mut component = parent;
    for face in 0..component.len() {
        let parent = component[face] as usize;
        if parent == face {
            component[face] = sizes.len() as u32;
            sizes.push(1);
        } else {
            component[face] = component[parent];
            sizes[component[face] as usize] += 1;
        }
    }
    (component, sizes)
}

#[cfg(test)]
mod tests {
    use rand::RngExt;

    use super::*;

    #[test]
    fn compact_numbers_labels_by_first_appearance() {
        let mut labels = vec![7, 7, UNLABELLED, 2, 7, 0];
        assert_eq!(compact(&mut labels), 3);
        assert_eq!(labels, [0, 0, UNLABELLED, 1, 0, 2]);
        let regions = Regions::new(&labels);
        assert_eq!(regions.iter().collect::<Vec<_>>(), [&[0, 1, 4][..], &[3], &[5]]);
    }

    /// A component at a time, breadth first.
    fn plain(labels: &[u32], adjacency: &Adjacency) -> Vec<u32> {
        let mut component = vec![UNLABELLED; labels.len()];
        let mut next = 0;
        for start in 0..labels.len() {
            if component[start] == UNLABELLED {
                let mut wave = vec![start];
                while let Some(face) = wave.pop() {
                    component[face] = next;
                    let open = |other: &usize| component[*other] == UNLABELLED;
                    let same = |other: &usize| labels[*other] == labels[start];
                    wave.extend(adjacency.across(face).filter(open).filter(same));
                }
                next += 1;
            }
        }
        component
    }

    #[test]
    fn components_across_chunks_are_those_found_one_by_one() {
        // A ladder of triangles in random order, with a chance of a new label at each.
        let count = 3 * CHUNK as u32 + 17;
        let mut order: Vec<u32> = (0..count).collect();
        let mut rng = crate::context::Context::new(2).rng;
        for i in (1..order.len()).rev() {
            order.swap(i, rng.random_range(0..=i));
        }
        let faces: Vec<[u32; 3]> = order.iter().map(|&i| [i, i + 1, i + 2]).collect();
        let labels: Vec<u32> = order.iter().map(|&i| i / 5000 % 3).collect();
        let adjacency = Adjacency::new(&faces, count as usize + 2);
        let (component, sizes) = components(&labels, &adjacency);
        assert_eq!(component, plain(&labels, &adjacency));
        assert_eq!(sizes.iter().sum::<u32>(), count);
    }

    #[test]
    fn equal_labels_that_do_not_touch_are_two_components() {
        // A strip of four triangles.
        let adjacency = Adjacency::new(&[[0, 1, 2], [1, 3, 2], [2, 3, 4], [3, 5, 4]], 6);
        let (component, sizes) = components(&[1, 0, 0, 1], &adjacency);
        assert_eq!((component, sizes), (vec![0, 1, 1, 2], vec![1, 2, 1]));
    }
}
