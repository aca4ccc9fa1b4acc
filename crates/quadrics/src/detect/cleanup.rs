//! From detected shapes to connected regions without gaps (paper, section 4.2(1) and (2)).

use crate::mesh::Working;
use crate::partition::{Labels, UNLABELLED, compact, components, hand_out, region_count};

/// Of a region in more than two components the second largest is kept if it holds more than this
/// fraction of the region's faces.
const SECOND_KEPT: f64 = 0.25;

/// Connected, non-overlapping regions that cover the mesh.
pub fn cleanup(working: &Working, detected: &[u32]) -> Labels {
    let mut labels = keep_components(working, detected);
    hand_out(&mut labels, &working.adjacency, &working.geometry.normals);
    compact(&mut labels);
    labels
}

/// Step (1). One component: unchanged. Two: the second becomes a region of its own. More: so does
/// the second if it is large enough, and the others lose their label.
fn keep_components(working: &Working, detected: &[u32]) -> Labels {
    let (component, sizes) = components(detected, &working.adjacency);
    let mut of_region: Vec<Vec<u32>> = vec![Vec::new(); region_count(detected)];
    let mut listed = vec![false; sizes.len()];
    for (face, &c) in component.iter().enumerate() {
        if detected[face] != UNLABELLED && !std::mem::replace(&mut listed[c as usize], true) {
            of_region[detected[face] as usize].push(c);
        }
    }
    let mut label_of = vec![UNLABELLED; sizes.len()];
    let mut next = 0;
    for parts in &mut of_region {
        parts.sort_by_key(|&c| (std::cmp::Reverse(sizes[c as usize]), c));
        for &part in parts.iter().take(kept(parts, &sizes)) {
            label_of[part as usize] = next;
            next += 1;
        }
    }
    component.iter().map(|&c| label_of[c as usize]).collect()
}

/// How many of a region's components, largest first, are kept.
fn kept(parts: &[u32], sizes: &[u32]) -> usize {
    if parts.len() <= 2 {
        return parts.len();
    }
    let size = |c: &u32| f64::from(sizes[*c as usize]);
    let whole: f64 = parts.iter().map(size).sum();
    if size(&parts[1]) > SECOND_KEPT * whole { 2 } else { 1 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Point;
    use crate::mesh::Mesh;

    /// A strip of `n` faces.
    fn strip(n: u32) -> Working {
        let at = |i: u32| Point::new(f64::from(i), f64::from(i % 2), 0.0);
        let positions = (0..n + 2).map(at).collect();
        Working::new(Mesh { positions, faces: (0..n).map(|i| [i, i + 1, i + 2]).collect() })
    }

    #[test]
    fn two_components_are_two_regions_however_small() {
        let working = strip(5);
        assert_eq!(keep_components(&working, &[0, 0, 1, 1, 0]), [0, 0, 2, 2, 1]);
    }

    #[test]
    fn of_more_components_the_second_needs_a_quarter_of_the_faces() {
        let working = strip(10);
        let none = UNLABELLED;
        // 4, 3 and 1 faces: 3 / 8 is enough.
        let detected = [0, 0, 0, 0, 1, 0, 0, 0, 1, 0];
        assert_eq!(keep_components(&working, &detected), [0, 0, 0, 0, 2, 1, 1, 1, 3, none]);
        // 4, 2 and 2: 2 / 8 does not exceed a quarter.
        let detected = [0, 0, 0, 0, 1, 0, 0, 1, 0, 0];
        assert_eq!(keep_components(&working, &detected)[..5], [0, 0, 0, 0, 1]);
        assert_eq!(keep_components(&working, &detected)[5..], [none, none, 2, none, none]);
    }

    #[test]
    fn every_face_ends_in_one_connected_region() {
        let working = strip(10);
        let labels = cleanup(&working, &[7, UNLABELLED, 7, UNLABELLED, 7, 7, 3, 7, UNLABELLED, 3]);
        let (_, sizes) = components(&labels, &working.adjacency);
        assert_eq!(sizes.len(), region_count(&labels));
        assert_eq!(sizes.iter().sum::<u32>(), 10);
        assert_eq!(cleanup(&working, &[UNLABELLED; 10]), [0; 10]);
    }
}
