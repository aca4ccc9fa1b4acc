//! Faces that nobody owns go to a neighbour, wave by wave (paper, section 4.2(2)).

use super::{UNLABELLED, region_count};
use crate::math::Vector;
use crate::mesh::Adjacency;

/// Gives every unlabelled face the label of an adjacent region, from the regions outwards: of its
/// labelled neighbours the one whose normal is nearest, then the least label.
///
/// Where no region is in reach (a component without any label), the whole component becomes one
/// region of its own. Regions that were connected stay so. Returns how many faces were given away.
pub fn hand_out(labels: &mut [u32], adjacency: &Adjacency, normals: &[Vector]) -> usize {
    let homeless: Vec<usize> = (0..labels.len()).filter(|&f| labels[f] == UNLABELLED).collect();
    spread(labels, adjacency, normals, homeless.clone());
    let mut next = region_count(labels) as u32;
    for &face in &homeless {
        if labels[face] == UNLABELLED {
            labels[face] = next;
            next += 1;
            let around = adjacency.across(face).collect();
            spread(labels, adjacency, normals, around);
        }
    }
    homeless.len()
}

/// Waves that start at those of `candidates` that have a labelled neighbour.
fn spread(
    labels: &mut [u32],
    adjacency: &Adjacency,
    normals: &[Vector],
    mut candidates: Vec<usize>,
) {
    while !candidates.is_empty() {
        candidates.sort_unstable();
        candidates.dedup();
        // All of a wave choose before any of it is labelled: its order must not matter.
        let wave: Vec<(usize, u32)> = candidates
            .iter()
            .filter(|&&face| labels[face] == UNLABELLED)
            .filter_map(|&face| Some((face, likest(labels, adjacency, normals, face)?)))
            .collect();
        for &(face, label) in &wave {
            labels[face] = label;
        }
        candidates = wave.iter().flat_map(|&(face, _)| adjacency.across(face)).collect();
        candidates.retain(|&face| labels[face] == UNLABELLED);
    }
}

/// The label of the labelled neighbour with the nearest normal.
fn likest(labels: &[u32], adjacency: &Adjacency, normals: &[Vector], face: usize) -> Option<u32> {
    adjacency
        .across(face)
        .filter(|&other| labels[other] != UNLABELLED)
        .max_by(|&one, &other| {
            let near = |f: usize| normals[f].dot(&normals[face]);
            near(one).total_cmp(&near(other)).then(labels[other].cmp(&labels[one]))
        })
        .map(|other| labels[other])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_strip_is_shared_in_the_middle_and_an_island_becomes_a_region() {
        // A strip of six faces, and an island of two.
        let mut faces: Vec<[u32; 3]> = (0..6).map(|i| [i, i + 1, i + 2]).collect();
        faces.extend([[8, 9, 10], [9, 11, 10]]);
        let adjacency = Adjacency::new(&faces, 12);
        let normals = vec![Vector::z(); 8];
        let mut labels = vec![UNLABELLED; 8];
        (labels[0], labels[5]) = (1, 0);
        assert_eq!(hand_out(&mut labels, &adjacency, &normals), 6);
        assert_eq!(labels, [1, 1, 1, 0, 0, 0, 2, 2]);
    }

    #[test]
    fn between_two_regions_the_nearer_normal_decides() {
        let adjacency = Adjacency::new(&[[0, 1, 2], [1, 3, 2], [2, 3, 4]], 5);
        let normals = [Vector::x(), Vector::z(), Vector::z()];
        let mut labels = vec![0, UNLABELLED, 1];
        hand_out(&mut labels, &adjacency, &normals);
        assert_eq!(labels, [0, 1, 1]);
    }
}
