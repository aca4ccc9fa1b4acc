//! From the faces of the subdivided mesh back to those of the input: the majority by area.

use crate::math::Vector;
use crate::mesh::Adjacency;
use crate::partition::{Labels, UNLABELLED, compact, components, hand_out, region_count};

/// Labels of the input's faces, and what had to be done for them.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Returned {
    /// Region of every face of the input, numbered from 0 by first face.
    pub labels: Labels,
    /// The number that every region had before.
    pub former: Vec<u32>,
    /// Regions without a majority anywhere, which kept the face that holds most of them.
    pub vanishing: usize,
    /// Faces given to a neighbour because their region had fallen apart.
    pub reassigned: usize,
}

/// Takes the labels of parts back to their parents: the label with the most area wins, the lesser
/// one where areas are equal.
///
/// `parents` and `areas` are those of the parts; adjacency, normals and areas `input_*` those of
/// the parents. A region without majority keeps the parent that holds most of it (unless that
/// makes another vanish); one that falls apart keeps its largest component.
pub fn labels_back(
    labels: &[u32],
    parents: &[u32],
    areas: &[f64],
    adjacency: &Adjacency,
    normals: &[Vector],
    input_areas: &[f64],
) -> Returned {
    let regions = region_count(labels);
    let whole = parents.iter().zip(0..).all(|(&parent, face)| parent == face);
    let (mut back, vanishing) = if whole && parents.len() == input_areas.len() {
        (labels.to_vec(), 0)
    } else {
        let shares = shares(labels, parents, areas);
        let mut back = majority(&shares, input_areas.len());
        let vanishing = keep_vanishing(&mut back, &shares, regions);
        (back, vanishing)
    };
    let whole = back.clone();
    drop_fragments(&mut back, adjacency, input_areas);
    let reassigned = hand_out(&mut back, adjacency, normals);
    let numbered = back.clone();
    let mut former = vec![UNLABELLED; compact(&mut back)];
    for (face, &new) in back.iter().enumerate() {
        // A fragment without any neighbour has become a region: it was part of its own before.
        let known = (numbered[face] as usize) < regions;
        former[new as usize] = if known { numbered[face] } else { whole[face] };
    }
    Returned { labels: back, former, vanishing, reassigned }
}

/// (parent, label, area) for every label in a parent, ascending.
fn shares(labels: &[u32], parents: &[u32], areas: &[f64]) -> Vec<(u32, u32, f64)> {
    let mut parts: Vec<(u32, u32, f64)> =
        labels.iter().zip(parents).zip(areas).map(|((&l, &p), &a)| (p, l, a)).collect();
    // Stable, so that areas are summed in the order of the faces.
    parts.sort_by_key(|&(parent, label, _)| (parent, label));
    parts
        .chunk_by(|one, other| (one.0, one.1) == (other.0, other.1))
        .map(|same| (same[0].0, same[0].1, same.iter().map(|part| part.2).sum()))
        .collect()
}

fn majority(shares: &[(u32, u32, f64)], count: usize) -> Labels {
    let mut back = vec![UNLABELLED; count];
    for of_parent in shares.chunk_by(|one, other| one.0 == other.0) {
        let most = of_parent.iter().rev().max_by(|one, other| one.2.total_cmp(&other.2));
        back[of_parent[0].0 as usize] = most.expect("a chunk is not empty").1;
    }
    back
}

/// Regions without a face take the one that holds most of them, if its owner has others.
fn keep_vanishing(back: &mut [u32], shares: &[(u32, u32, f64)], regions: usize) -> usize {
    let mut owned = vec![0usize; regions];
    back.iter().filter(|&&label| label != UNLABELLED).for_each(|&label| owned[label as usize] += 1);
    let mut by_region: Vec<_> =
        shares.iter().filter(|share| owned[share.1 as usize] == 0).copied().collect();
    by_region.sort_by(|one, other| one.1.cmp(&other.1).then(other.2.total_cmp(&one.2)));
    let mut kept = 0;
    for (parent, label, _) in by_region {
        let owner = back[parent as usize] as usize;
        if owned[label as usize] == 0 && owned[owner] > 1 {
            back[parent as usize] = label;
            owned[owner] -= 1;
            owned[label as usize] = 1;
            kept += 1;
        }
    }
    kept
}

/// Unlabels all but the component of most area of every region.
fn drop_fragments(back: &mut [u32], adjacency: &Adjacency, areas: &[f64]) {
    let (component, sizes) = components(back, adjacency);
    let mut area = vec![0.0; sizes.len()];
    for (face, &c) in component.iter().enumerate() {
        area[c as usize] += areas[face];
    }
    let mut largest = vec![UNLABELLED; region_count(back)];
    for (face, &c) in component.iter().enumerate().filter(|&(face, _)| back[face] != UNLABELLED) {
        let best = &mut largest[back[face] as usize];
        if *best == UNLABELLED || area[c as usize] > area[*best as usize] {
            *best = c;
        }
    }
    for (face, label) in back.iter_mut().enumerate().filter(|(_, label)| **label != UNLABELLED) {
        if largest[*label as usize] != component[face] {
            *label = UNLABELLED;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A strip of `n` faces.
    fn strip(n: u32) -> Adjacency {
        let faces: Vec<[u32; 3]> = (0..n).map(|i| [i, i + 1, i + 2]).collect();
        Adjacency::new(&faces, n as usize + 2)
    }

    fn back(labels: &[u32], parents: &[u32], areas: &[f64], n: u32) -> Returned {
        let normals = vec![Vector::z(); n as usize];
        labels_back(labels, parents, areas, &strip(n), &normals, &vec![1.0; n as usize])
    }

    #[test]
    fn the_label_with_the_most_area_wins() {
        let found = back(&[4, 5, 5, 5], &[0, 0, 0, 1], &[0.5, 0.2, 0.2, 1.0], 2);
        assert_eq!((found.labels, found.former), (vec![0, 1], vec![4, 5]));
    }

    #[test]
    fn a_region_without_majority_keeps_the_face_that_holds_most_of_it() {
        let labels = [0, 1, 0, 1, 0, 0];
        let found = back(&labels, &[0, 0, 1, 1, 2, 3], &[0.9, 0.1, 0.8, 0.2, 1.0, 1.0], 4);
        assert_eq!(found.vanishing, 1);
        // Face 1 is in the middle of region 0, which falls apart: the larger part stays.
        assert_eq!((found.labels, found.reassigned), (vec![0, 0, 1, 1], 1));
        assert_eq!(found.former, [1, 0]);
    }

    #[test]
    fn a_fragment_on_its_own_stays_a_region_of_the_same_surface() {
        let adjacency = Adjacency::new(&[[0, 1, 2], [1, 3, 2], [4, 5, 6]], 7);
        let normals = [Vector::z(); 3];
        let found = labels_back(&[1, 1, 1], &[0, 1, 2], &[1.0; 3], &adjacency, &normals, &[1.0; 3]);
        assert_eq!((found.labels, found.former), (vec![0, 0, 1], vec![1, 1]));
    }

    #[test]
    fn unsubdivided_labels_come_back_as_they_are() {
        let labels = [0, 0, 1, 1, 2];
        let found = back(&labels, &[0, 1, 2, 3, 4], &[1.0; 5], 5);
        assert_eq!((&found.labels[..], found.vanishing, found.reassigned), (&labels[..], 0, 0));
    }
}
