//! HFP: M. Attene, B. Falcidieno, M. Spagnuolo, *Hierarchical mesh segmentation based on fitting
//! primitives* (The Visual Computer 2006), the paper's reference 23.
//!
//! From the publication: every face is a cluster at first; of all pairs of adjacent clusters the one
//! whose union a plane, a sphere or a cylinder fits best is merged, until so many are left as are
//! wanted; nothing is ever taken back. The axis of a cylinder is the direction that the normals
//! vary least in.
//! Choices: errors are integrals over the faces, from moments, so that a merge costs a sum; spheres and
//! cylinders compete from [`ROUND`] faces on, below which they fit anything; with labels to start
//! from, their regions are the first clusters.

use std::cmp::Reverse;
use std::collections::{BTreeSet, BinaryHeap};

use nalgebra::Matrix3;

use super::wanted;
use crate::context::Context;
use crate::error::Result;
use crate::math::triangle::Triangle;
use crate::math::{Unit, Vector};
use crate::mesh::Working;
use crate::options::Options;
use crate::partition::{Labels, Regions, compact, components};
use crate::segment::{Metric, Outcome, Proxy, Task};
use crate::surface::moments::Moments;
use crate::surface::{Quadric, round, taubin};

/// Fewest faces of a sphere or a cylinder.
const ROUND: usize = 10;
/// Merges between two looks at the clock.
const STRIDE: usize = 256;

/// Segments a mesh in the unit cube into `options.regions` planes, spheres and cylinders.
///
/// # Errors
/// Without a number of regions; [`crate::Error::Cancelled`].
pub fn hfp(
    context: &mut Context,
    working: &Working,
    options: &Options,
    labels: Option<Labels>,
) -> Result<Outcome> {
    let regions = wanted(options)?;
    context.timed("segment", |context| {
        let start = match labels {
            Some(labels) => components(&labels, &working.adjacency).0,
            None => (0..working.len() as u32).collect(),
        };
        let mut forest = Forest::new(working, &start);
        forest.merge_down_to(context, regions)?;
        let task = Task { working, options, metric: Metric::Surfaces };
        Ok(outcome(&task, &forest, &forest.roots(&start)))
    })
}

/// The clusters of all faces as numbered regions, each with its primitive.
fn outcome(task: &Task, forest: &Forest, roots: &[u32]) -> Outcome {
    let mut labels = roots.to_vec();
    compact(&mut labels);
    let (mut proxies, mut total) = (Vec::new(), 0.0);
    for faces in Regions::new(&labels).iter() {
        let proxy = forest.clusters[roots[faces[0] as usize] as usize].fit().1;
        // A squared distance has no sides, eq. 2 has.
        let both = match &proxy {
            Proxy::Quadric(quadric) => vec![Proxy::Quadric(quadric.flipped()), proxy],
            Proxy::Plane(_) => vec![proxy],
        };
        let cost = |proxy: Proxy| (task.total_error(&proxy, faces), proxy);
        let by_error = |one: &(f64, Proxy), other: &(f64, Proxy)| one.0.total_cmp(&other.0);
        let (error, proxy) = both.into_iter().map(cost).min_by(by_error).expect("one at least");
        total += error;
        proxies.push(proxy);
    }
    Outcome { labels, proxies, energy: vec![total] }
}

/// A set of faces with all that a fit needs; two of them add up.
struct Cluster {
    faces: usize,
    moments: Moments,
    /// `∫ n nᵀ`.
    normals: Matrix3<f64>,
}

impl Cluster {
    fn joined(&self, other: &Self) -> Self {
        Self {
            faces: self.faces + other.faces,
            moments: self.moments.joined(&other.moments),
            normals: self.normals + other.normals,
        }
    }

    /// The primitive that fits best, and its total squared distance.
    fn fit(&self) -> (f64, Proxy) {
        let any = || Unit::new_unchecked(Vector::z());
        let spread = self.moments.covariance().symmetric_eigenvalues().min().max(0.0);
        let plane = taubin::plane(&self.moments)
            .unwrap_or_else(|| crate::surface::Plane::through(self.moments.centroid(), any()));
        let flat = (spread, Proxy::Plane(plane));
        let (mean, proxy) = self.round().into_iter().fold(flat, |best, (error, quadric)| {
            if error < best.0 { (error, Proxy::Quadric(quadric)) } else { best }
        });
        (mean * self.moments.area(), proxy)
    }

    /// The sphere and the cylinder, each with its mean squared distance.
    fn round(&self) -> Vec<(f64, Quadric)> {
        if self.faces < ROUND {
            return Vec::new();
        }
        let eigen = self.normals.symmetric_eigen();
        let axis = eigen.eigenvectors.column(eigen.eigenvalues.imin()).into_owned();
        let cylinder = round::cylinder(&self.moments, &Unit::new_normalize(axis));
        round::sphere(&self.moments).into_iter().chain(cylinder).collect()
    }
}

/// All clusters that ever were, and the queue of pairs.
struct Forest {
    clusters: Vec<Cluster>,
    /// What a cluster was merged into; itself while it lives.
    parent: Vec<u32>,
    neighbours: Vec<BTreeSet<u32>>,
    alive: usize,
    /// Cost, then the pair; stale where one of the two is no more.
    queue: BinaryHeap<Reverse<(u64, u32, u32)>>,
}

impl Forest {
    fn new(working: &Working, start: &[u32]) -> Self {
        let regions = Regions::new(start);
        let clusters: Vec<Cluster> = regions.iter().map(|faces| cluster(working, faces)).collect();
        let mut neighbours = vec![BTreeSet::new(); clusters.len()];
        for face in 0..working.len() {
            for other in working.adjacency.across(face) {
                if start[other] != start[face] {
                    neighbours[start[face] as usize].insert(start[other]);
                }
            }
        }
        let (parent, alive) = ((0..clusters.len() as u32).collect(), clusters.len());
        let mut forest = Self { clusters, parent, neighbours, alive, queue: BinaryHeap::new() };
        for one in 0..alive as u32 {
            for other in
                forest.neighbours[one as usize].range(one + 1..).copied().collect::<Vec<_>>()
            {
                forest.push(one, other);
            }
        }
        forest
    }

    fn push(&mut self, one: u32, other: u32) {
        let union = self.clusters[one as usize].joined(&self.clusters[other as usize]);
        // The bits of a number that is not negative sort like the number itself.
        self.queue.push(Reverse((union.fit().0.abs().to_bits(), one, other)));
    }

    fn merge_down_to(&mut self, context: &mut Context, regions: usize) -> Result<()> {
        let first = self.alive;
        while self.alive > regions {
            let Some(Reverse((_, one, other))) = self.queue.pop() else { break };
            let lives = |cluster: u32| self.parent[cluster as usize] == cluster;
            if lives(one) && lives(other) {
                self.merge(one, other);
                if self.alive.is_multiple_of(STRIDE) {
                    context.step("segment", 1.0 - self.alive as f64 / first as f64)?;
                }
            }
        }
        Ok(())
    }

    /// Both become a new cluster: pairs with the old ones are stale by their numbers alone.
    fn merge(&mut self, one: u32, other: u32) {
        let new = self.clusters.len() as u32;
        let union = self.clusters[one as usize].joined(&self.clusters[other as usize]);
        self.clusters.push(union);
        self.parent.push(new);
        let mut around = std::mem::take(&mut self.neighbours[one as usize]);
        around.append(&mut std::mem::take(&mut self.neighbours[other as usize]));
        around.remove(&one);
        around.remove(&other);
        for old in [one, other] {
            self.parent[old as usize] = new;
        }
        for &next in &around {
            let theirs = &mut self.neighbours[next as usize];
            theirs.remove(&one);
            theirs.remove(&other);
            theirs.insert(new);
        }
        for &next in &around {
            self.push(next, new);
        }
        self.neighbours.push(around);
        self.alive -= 1;
    }

    /// The living cluster of every face.
    fn roots(&self, start: &[u32]) -> Labels {
        let mut root: Vec<u32> = self.parent.clone();
        // Parents have larger numbers: from the last to the first every parent is known.
        for cluster in (0..root.len()).rev() {
            root[cluster] = root[root[cluster] as usize];
        }
        start.iter().map(|&cluster| root[cluster as usize]).collect()
    }
}

fn cluster(working: &Working, faces: &[u32]) -> Cluster {
    let triangles = working.triangles(faces);
    let mut moments = Moments::about(working.geometry.barycentres[faces[0] as usize]);
    moments.add(&triangles);
    let spread = |t: &Triangle| t.normal * t.normal.transpose() * t.area;
    Cluster { faces: faces.len(), moments, normals: triangles.iter().map(spread).sum() }
}
