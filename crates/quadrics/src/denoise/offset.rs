//! Where a surface errs: the mean side on which the vertices of a region lie near a place.

use super::Task;
use crate::mesh::NONE;

/// Vertices that a mean is taken over, at most.
const NEIGHBOURS: usize = 40;
/// A vertex moves by at most so many standard deviations of the noise: of Gaussian noise one vertex
/// in sixteen thousand lies further off ...
pub const REACH: f64 = 4.0;
/// ... and no further than nearly all vertices of a region lie off: eq. 5 ends at 1.8 deviations. The
/// few beyond keep what is left, which costs less than moving many too far.
const NEARLY_ALL: f64 = 0.95;
/// Vertices of which that can be told.
const FEWEST: usize = 50;
/// A mean of so many standard errors is no chance.
const SIGNIFICANT: f64 = 3.0;

/// Signed distances of all vertices that lie inside one region from its surface.
pub struct Offsets {
    distance: Vec<f64>,
}

/// What a search leaves behind for the next one: which faces and vertices it has seen.
#[derive(Default)]
pub struct Search {
    faces: Vec<u32>,
    vertices: Vec<u32>,
}

impl Offsets {
    pub fn new(task: &Task, regions: &[Vec<u32>]) -> Self {
        let distance = |(vertex, regions): (usize, &Vec<u32>)| match regions[..] {
            [only] => {
                let surface = &task.surfaces[only as usize];
                surface.distance(task.working.mesh.positions[vertex]).unwrap_or(f64::NAN)
            }
            _ => f64::NAN,
        };
        Self { distance: regions.iter().enumerate().map(distance).collect() }
    }

    /// How far the noise goes: the median of what the regions say, since a wrong surface is further off.
    pub fn reach(&self, regions: &[Vec<u32>], count: usize, sigma: f64) -> f64 {
        let mut far = vec![Vec::new(); count];
        for (regions, distance) in regions.iter().zip(&self.distance) {
            if !distance.is_nan() {
                far[regions[0] as usize].push(distance.abs());
            }
        }
        far.retain(|far| far.len() >= FEWEST);
        let nearly_all = |mut far: Vec<f64>| {
            let at = (NEARLY_ALL * (far.len() - 1) as f64) as usize;
            (*far.select_nth_unstable_by(at, f64::total_cmp).1, far.len())
        };
        let mut reaches: Vec<(f64, usize)> = far.into_iter().map(nearly_all).collect();
        reaches.sort_unstable_by(|one, other| one.0.total_cmp(&other.0));
        let half = reaches.iter().map(|(_, vertices)| vertices).sum::<usize>() / 2;
        let mut below = 0;
        let median = reaches.iter().find(|(_, vertices)| {
            below += vertices;
            below > half
        });
        median.map_or(f64::INFINITY, |(reach, _)| *reach).min(REACH * sigma)
    }

    /// How far off the surface of `region` the vertices near `vertex` lie, as far as that is no
    /// chance.
    pub fn at(&self, task: &Task, vertex: u32, region: u32, search: &mut Search) -> f64 {
        search.around(task, vertex, region, |v| !self.distance[v as usize].is_nan());
        let near = search.vertices.iter().map(|&v| self.distance[v as usize]);
        let near: Vec<f64> = near.filter(|distance| !distance.is_nan()).collect();
        let count = near.len() as f64;
        let mean = near.iter().sum::<f64>() / count.max(1.0);
        let chance = SIGNIFICANT * task.sigma / count.sqrt();
        // Breiman's garrote: nothing below the threshold, nearly all far above it, no jump between.
        if mean.abs() > chance { mean * (1.0 - (chance / mean).powi(2)) } else { 0.0 }
    }
}

impl Search {
    /// Gathers vertices of a region around a vertex, breadth first, until [`NEIGHBOURS`] of them are
    /// `useful`.
    fn around(&mut self, task: &Task, vertex: u32, region: u32, useful: impl Fn(u32) -> bool) {
        self.faces.clear();
        self.vertices.clear();
        let own = |face: &u32| task.labels[*face as usize] == region;
        let adjacency = &task.working.adjacency;
        self.faces.extend(adjacency.around(vertex).iter().filter(|face| own(face)));
        let (mut next, mut found) = (0, 0);
        while next < self.faces.len() && found < NEIGHBOURS {
            let face = self.faces[next] as usize;
            next += 1;
            for corner in task.working.mesh.faces[face] {
                // A hundred at most: to look through them is quicker than to mark them.
                if !self.vertices.contains(&corner) {
                    self.vertices.push(corner);
                    found += usize::from(useful(corner));
                }
            }
            for other in adjacency.neighbours[face] {
                if other != NONE && own(&other) && !self.faces.contains(&other) {
                    self.faces.push(other);
                }
            }
        }
    }
}
