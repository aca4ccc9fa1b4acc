//! The optimisation of paper, section 4.3: Lloyd's iteration between partition and proxies.
//!
//! It starts from labels, wherever they come from. One round grows the regions anew from their
//! best fitted parts (`seeds`, `flood`) and fits a surface to each (`fit`); before the first
//! one `merge` and `insert` bring the number of regions to the one that is wanted, and after a few
//! `exchange` moves regions to where they lower the error more.

mod energy;
mod exchange;
pub(crate) mod fit;
pub(crate) mod flood;
pub(crate) mod insert;
pub(crate) mod merge;
mod queue;
mod seeds;

pub use energy::Proxy;

use std::collections::HashSet;
use std::hash::{DefaultHasher, Hash, Hasher};

use fit::{Fitted, fit_all};

use crate::context::Context;
use crate::error::{Error, Result};
use crate::math::triangle::Triangle;
use crate::mesh::Working;
use crate::options::{Options, Seeds};
use crate::partition::{Labels, Regions, UNLABELLED, components, hand_out};
use crate::surface::Plane;

/// Rounds without a new least energy after which the loop only wanders around its best partition.
const PATIENCE: usize = 4;
/// The same where it grows from seed triangles, which oscillate on the way down (Fig. 5).
const PATIENCE_OF_TRIANGLES: usize = 10;
/// Rounds before regions are exchanged, and between exchanges: errors of the start are gone by then.
const SETTLING: usize = 3;
/// Share of the error that exchanges and the rounds after them must save for more of them to follow.
const WORTH_IT: f64 = 0.01;

/// What the loop ends with.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// Region of every face; every region is connected and has at least one.
    pub labels: Labels,
    /// The surface of every region, its gradient on the side of the region's normals.
    pub proxies: Vec<Proxy>,
    /// Total error (eq. 1) of the adjusted start, then after every round and every series of
    /// exchanges. The labels are those of the least of them.
    pub energy: Vec<f64>,
}

/// What a face costs under a proxy, and so which proxies there are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Metric {
    /// Eq. 2, with planes and quadrics.
    Surfaces,
    /// L2,1 alone, with planes: the deviation of normals, as in VSA.
    Normals,
}

/// What stays the same during a run.
pub(crate) struct Task<'a> {
    pub working: &'a Working,
    pub options: &'a Options,
    pub metric: Metric,
}

impl Task<'_> {
    /// `E(t, P)` of the metric.
    pub fn error(&self, proxy: &Proxy, face: u32) -> f64 {
        let triangle = self.working.triangle(face);
        match (self.metric, proxy) {
            (Metric::Normals, Proxy::Plane(plane)) => deviation(plane, &triangle),
            _ => proxy.error(&triangle, self.options.beta),
        }
    }

    /// `E(t, P)` of several faces.
    pub fn errors(&self, proxy: &Proxy, triangles: &[Triangle]) -> Vec<f64> {
        match (self.metric, proxy) {
            (Metric::Normals, Proxy::Plane(plane)) => {
                triangles.iter().map(|triangle| deviation(plane, triangle)).collect()
            }
            _ => proxy.errors(triangles, self.options.beta),
        }
    }

    pub fn total_error(&self, proxy: &Proxy, faces: &[u32]) -> f64 {
        self.errors(proxy, &self.working.triangles(faces)).iter().sum()
    }
}

/// L2,1 of a face under a plane.
fn deviation(plane: &Plane, triangle: &Triangle) -> f64 {
    triangle.area * (plane.normal.into_inner() - triangle.normal).norm_squared()
}

/// A partition with its proxies.
#[derive(Clone)]
pub(crate) struct State {
    pub labels: Labels,
    pub regions: Vec<Fitted>,
}

impl State {
    /// The regions of a start, fitted: what is not connected counts as several.
    pub fn new(task: &Task, start: &[u32]) -> Result<Self> {
        let labels = connected(task.working, start)?;
        let regions = fit_all(task, faces_of(&labels), &[]);
        Ok(Self { labels, regions })
    }

    /// Eq. 1, in the metric of the task.
    pub fn energy(&self) -> f64 {
        self.regions.iter().map(|region| region.error).sum()
    }

    /// As a result, with the energies on the way to it.
    pub fn outcome(self, energy: Vec<f64>) -> Outcome {
        let proxies = self.regions.into_iter().map(|region| region.proxy).collect();
        Outcome { labels: self.labels, proxies, energy }
    }
}

/// Optimises a partition of a mesh in the unit cube.
///
/// `start` has a label for every face; unlabelled ones are handed out, and what is not connected
/// counts as several regions. With `options.regions` exactly so many come out, or as many as
/// the mesh has components where that is more, or faces where that is less.
///
/// # Errors
/// [`Error::Option`] if there is not one label a face, [`Error::Cancelled`] if the listener says so.
pub fn paper(
    context: &mut Context,
    working: &Working,
    options: &Options,
    start: &[u32],
) -> Result<Outcome> {
    if working.is_empty() {
        return Err(Error::Empty);
    }
    let task = Task { working, options, metric: Metric::Surfaces };
    let start = State::new(&task, start)?;
    let state = adjust(context, &task, start)?;
    // A given number is reached by merging, which leaves regions where the start has put them.
    if options.regions.is_none() || options.max_iterations <= SETTLING {
        let (best, energy) = lloyd(context, &task, state)?;
        return Ok(best.outcome(energy));
    }
    let mut energy = Vec::new();
    let (mut best, mut falls) = settle(context, &task, state, SETTLING, &mut energy)?;
    while energy.len() <= options.max_iterations {
        let Some(exchanged) = exchange::exchange(context, &task, &best)? else { break };
        let before = best.energy();
        (best, falls) = settle(context, &task, exchanged, SETTLING, &mut energy)?;
        if best.energy() > (1.0 - WORTH_IT) * before {
            break;
        }
    }
    if falls {
        (best, _) = settle(context, &task, best, options.max_iterations, &mut energy)?;
    }
    Ok(best.outcome(energy))
}

/// At most so many rounds, of those that are left; whether the last one was the best.
fn settle(
    context: &mut Context,
    task: &Task,
    state: State,
    most: usize,
    energy: &mut Vec<f64>,
) -> Result<(State, bool)> {
    let left = task.options.max_iterations.saturating_sub(energy.len());
    let options = Options { max_iterations: left.min(most), ..task.options.clone() };
    let (best, errors) = lloyd(context, &Task { options: &options, ..*task }, state)?;
    let falls = errors.last() == Some(&best.energy());
    energy.extend(errors);
    Ok((best, falls))
}

/// Lloyd's iteration: the best partition seen, and the energy of the start and after every round.
pub(crate) fn lloyd(
    context: &mut Context,
    task: &Task,
    mut state: State,
) -> Result<(State, Vec<f64>)> {
    let mut energy = vec![state.energy()];
    let (mut best, mut best_round) = (state.clone(), 0);
    let mut seen = HashSet::from([fingerprint(&state.labels)]);
    let patience = match task.options.seeds {
        Seeds::Region => PATIENCE,
        Seeds::Triangle => PATIENCE_OF_TRIANGLES,
    };
    for round in 0..task.options.max_iterations {
        context.step("segment", round as f64 / task.options.max_iterations as f64)?;
        state = round_of(task, state);
        energy.push(state.energy());
        if energy[round + 1] < energy[best_round] {
            (best, best_round) = (state.clone(), round + 1);
        }
        let change = (energy[round + 1] - energy[round]).abs();
        // A partition that was there before is a fixed point or a cycle: nothing new can come.
        let known = !seen.insert(fingerprint(&state.labels));
        if known
            || round + 1 - best_round >= patience
            || change <= task.options.convergence * energy[round]
        {
            break;
        }
    }
    Ok((best, energy))
}

/// Partitioning, then surface fitting.
fn round_of(task: &Task, state: State) -> State {
    let State { mut labels, regions } = state;
    let seeds = seeds::seeds(task, &labels, &regions);
    labels.fill(UNLABELLED);
    let numbered = seeds.iter().enumerate().map(|(region, faces)| (region as u32, &faces[..]));
    flood::flood(task, |region| &regions[region as usize].proxy, numbered, &mut labels);
    let regions = fit_all(task, faces_of(&labels), &regions);
    State { labels, regions }
}

/// Brings the number of regions to the one that is wanted, by merging and insertion.
pub(crate) fn adjust(context: &mut Context, task: &Task, state: State) -> Result<State> {
    let State { mut labels, mut regions } = state;
    if let Some(limit) = task.options.insertion_threshold {
        while insert::insert(task, &mut labels, &mut regions, limit.max(f64::MIN_POSITIVE)) {
            context.step("segment", 0.0)?;
        }
    }
    if let Some(wanted) = task.options.regions {
        let step = || context.step("segment", 0.0);
        regions = merge::merge(task, &mut labels, regions, wanted, step)?;
        while regions.len() < wanted && insert::insert(task, &mut labels, &mut regions, 0.0) {
            context.step("segment", 0.0)?;
        }
    }
    Ok(State { labels, regions })
}

/// The start as a partition into connected regions, numbered by their first face.
fn connected(working: &Working, start: &[u32]) -> Result<Labels> {
    if start.len() != working.len() {
        let (labels, faces) = (start.len(), working.len());
        return Err(Error::Option(format!("{labels} initial labels for {faces} faces: one each")));
    }
    let mut labels = start.to_vec();
    hand_out(&mut labels, &working.adjacency, &working.geometry.normals);
    Ok(components(&labels, &working.adjacency).0)
}

fn faces_of(labels: &[u32]) -> Vec<Vec<u32>> {
    Regions::new(labels).iter().map(<[u32]>::to_vec).collect()
}

fn fingerprint(labels: &[u32]) -> u64 {
    let mut hasher = DefaultHasher::new();
    labels.hash(&mut hasher);
    hasher.finish()
}

#[cfg(test)]
mod tests;
