//! Regions and what lies around them.

use std::collections::BTreeMap;

use super::assign::Model;
use super::scene::Scene;
use crate::partition::Regions;

/// Neighbours that are looked at: those of the longest borders.
const NEIGHBOURS: usize = 4;

/// Regions and what lies around them.
#[derive(Clone, Copy)]
pub struct Around<'a> {
    /// Where they lie.
    pub scene: &'a Scene<'a>,
    /// Their surfaces.
    pub models: &'a [Model],
    /// Region of every face.
    pub labels: &'a [u32],
    /// Faces of every region.
    pub regions: &'a Regions,
}

impl Around<'_> {
    /// The neighbours of a region with the longest borders, the longest first.
    pub fn neighbours(&self, id: usize) -> Vec<u32> {
        let mut borders: BTreeMap<u32, usize> = BTreeMap::new();
        for other in self.scene.beside(id as u32, self.regions.faces(id), self.labels) {
            *borders.entry(other).or_default() += 1;
        }
        let mut longest: Vec<(u32, usize)> = borders.into_iter().collect();
        longest.sort_by_key(|&(_, edges)| std::cmp::Reverse(edges));
        longest.truncate(NEIGHBOURS);
        longest.into_iter().map(|(other, _)| other).collect()
    }
}
