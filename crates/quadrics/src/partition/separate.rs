//! Pieces of a region that do not touch become regions of their own.

use super::{Labels, components, region_count};
use crate::mesh::Adjacency;

/// Gives every piece of at least `least` faces a label of its own, the largest piece of a region its
/// old one (the first, where pieces are of one size). Lesser pieces keep the label of their region.
///
/// Returns the old label of every new one, the first `region_count(labels)` of them unchanged.
pub fn separate(labels: &mut [u32], adjacency: &Adjacency, least: u32) -> Labels {
    let (component, sizes) = components(labels, adjacency);
    let mut former: Vec<u32> = (0..region_count(labels) as u32).collect();
    let mut region_of = vec![0; sizes.len()];
    component.iter().zip(labels.iter()).for_each(|(&c, &label)| region_of[c as usize] = label);
    let mut largest: Vec<Option<usize>> = vec![None; former.len()];
    for (piece, &region) in region_of.iter().enumerate() {
        let best = &mut largest[region as usize];
        if best.is_none_or(|best| sizes[piece] > sizes[best]) {
            *best = Some(piece);
        }
    }
    let mut new = region_of.clone();
    for (piece, &region) in region_of.iter().enumerate() {
        if sizes[piece] >= least && largest[region as usize] != Some(piece) {
            new[piece] = former.len() as u32;
            former.push(region);
        }
    }
    labels.iter_mut().zip(component).for_each(|(label, c)| *label = new[c as usize]);
    former
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn large_pieces_become_regions_and_crumbs_stay() {
        // A strip of seven triangles.
        let faces: Vec<[u32; 3]> = (0..7).map(|i| [i, i + 1, i + 2]).collect();
        let adjacency = Adjacency::new(&faces, 9);
        let mut labels = vec![0, 0, 1, 0, 0, 1, 0];
        assert_eq!(separate(&mut labels, &adjacency, 2), [0, 1, 0]);
        assert_eq!(labels, [0, 0, 1, 2, 2, 1, 0]);
    }
}
