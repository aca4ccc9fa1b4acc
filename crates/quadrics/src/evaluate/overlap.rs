//! Common areas of found and true regions, and the matching that is made from them.

use super::Answer;
use super::assignment::assign;
use crate::partition::UNLABELLED;

/// A found region and the true region that is matched to it, by their places.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pair {
    /// The found region.
    pub found: u32,
    /// The true region.
    pub truth: u32,
    /// Their common area.
    pub overlap: f64,
    /// Common area over the area of both together.
    pub iou: f64,
}

/// Areas of all regions and of all their intersections.
pub struct Overlap {
    common: Vec<Vec<f64>>,
    found: Vec<f64>,
    truth: Vec<f64>,
    /// Area of the mesh.
    pub total: f64,
}

impl Overlap {
    pub fn new(found: &Answer, truth: &Answer, areas: &[f64]) -> Self {
        let mut overlap = Self {
            common: vec![vec![0.0; truth.regions.len()]; found.regions.len()],
            found: vec![0.0; found.regions.len()],
            truth: vec![0.0; truth.regions.len()],
            total: areas.iter().sum(),
        };
        for ((&one, &other), area) in found.labels.iter().zip(&truth.labels).zip(areas) {
            if one != UNLABELLED {
                overlap.found[one as usize] += area;
            }
            if other != UNLABELLED {
                overlap.truth[other as usize] += area;
            }
            if one != UNLABELLED && other != UNLABELLED {
                overlap.common[one as usize][other as usize] += area;
            }
        }
        overlap
    }

    /// The one-to-one matching of largest common area, by found region; pairs that share nothing are
    /// left out. A pair with an IoU above 1/2 is part of every such matching.
    pub fn pairs(&self) -> Vec<Pair> {
        let pair = |(i, j): (usize, usize)| {
            let overlap = self.common[i][j];
            let iou = overlap / (self.found[i] + self.truth[j] - overlap);
            (overlap > 0.0).then_some(Pair { found: i as u32, truth: j as u32, overlap, iou })
        };
        assign(&self.common).into_iter().filter_map(pair).collect()
    }
}
