//! Region merging (paper, section 4.3(3)).

use std::collections::BTreeMap;

use rayon::prelude::*;

use super::Task;
use super::energy::Proxy;
use super::fit::{Fitted, Patch, sample, step};
use crate::error::Result;
use crate::math::Unit;
use crate::math::triangle::Triangle;

/// Faces of a region that a merge is judged by: most of the pairs are far from the cheapest.
const SAMPLE: usize = 50;

/// Two adjacent regions, the lesser first.
pub type Couple = (u32, u32);

/// What a merge would do.
#[derive(Clone)]
struct Union {
    /// Planes within the angle come first, by angle; the others by the increase of the error.
    order: (bool, f64),
    patch: Patch,
    proxy: Proxy,
}

/// What merging any two adjacent regions of a partition would do.
#[derive(Clone)]
pub struct Unions(BTreeMap<Couple, Union>);

/// Merges pairs of adjacent regions until `count` are left, or none is adjacent to another.
///
/// First adjacent planes whose normals differ by no more than `merge_angle_deg`, then the pair of
/// least `|E_ij - (E_i + E_j)|`.
///
/// # Errors
/// [`crate::Error::Cancelled`] as `step` has it, which is asked before every merge.
pub fn merge(
    task: &Task,
    labels: &mut [u32],
    regions: Vec<Fitted>,
    count: usize,
    step: impl FnMut() -> Result<()>,
) -> Result<Vec<Fitted>> {
    if regions.len() <= count {
        return Ok(regions);
    }
    let mut unions = Unions::new(task, labels, &regions);
    unions.merge(task, labels, regions, count, step)
}

impl Unions {
    /// Those of all adjacent regions.
    pub fn new(task: &Task, labels: &[u32], regions: &[Fitted]) -> Self {
        Self(unions(task, regions, &couples(task, labels, 0..labels.len())))
    }

    /// By how much every merge would raise the error, the least first.
    pub fn costs(&self) -> Vec<(f64, Couple)> {
        let mut costs: Vec<_> = self.0.iter().map(|(&couple, u)| (u.order.1, couple)).collect();
        costs.sort_by(|one, other| one.0.total_cmp(&other.0));
        costs
    }

    /// Forgets those of one region, which has been split, and looks at those of its two parts.
    pub fn split(&mut self, task: &Task, labels: &[u32], regions: &[Fitted], parts: [usize; 2]) {
        let [region, _] = parts.map(|part| part as u32);
        self.0.retain(|&(a, b), _| a != region && b != region);
        let faces = parts.iter().flat_map(|&part| &regions[part].faces);
        let faces = faces.map(|&face| face as usize);
        self.0.extend(unions(task, regions, &couples(task, labels, faces)));
    }

    /// As [`merge`]; afterwards these are the unions of what is left.
    ///
    /// # Errors
    /// Those of [`merge`].
    pub fn merge(
        &mut self,
        task: &Task,
        labels: &mut [u32],
        mut regions: Vec<Fitted>,
        count: usize,
        mut step: impl FnMut() -> Result<()>,
    ) -> Result<Vec<Fitted>> {
        let mut left = regions.len();
        while left > count {
            step()?;
            let by_order = |one: &(&Couple, &Union), other: &(&Couple, &Union)| {
                let ((plane, cost), (other_plane, other_cost)) = (one.1.order, other.1.order);
                other_plane.cmp(&plane).then(cost.total_cmp(&other_cost)).then(one.0.cmp(other.0))
            };
            let least = self.0.iter().min_by(by_order).map(|(&couple, _)| couple);
            let Some(couple) = least else { break };
            let union = self.0.remove(&couple).expect("it was found there");
            join(task, &mut regions, labels, couple, union);
            left -= 1;
            self.joined(task, &regions, couple);
        }
        Ok(self.compacted(regions, labels))
    }

    /// The pairs of the merged region, and of nobody else, are looked at again.
    fn joined(&mut self, task: &Task, regions: &[Fitted], (i, j): Couple) {
        let touched = |&(a, b): &Couple| a == i || a == j || b == i || b == j;
        let mut again: Vec<Couple> = self.0.keys().copied().filter(touched).collect();
        self.0.retain(|couple, _| !touched(couple));
        for (a, b) in &mut again {
            let other = if *a == i || *a == j { *b } else { *a };
            (*a, *b) = (i.min(other), i.max(other));
        }
        again.sort_unstable();
        again.dedup();
        self.0.extend(unions(task, regions, &again));
    }

    /// What has faces left, numbered anew.
    fn compacted(&mut self, regions: Vec<Fitted>, labels: &mut [u32]) -> Vec<Fitted> {
        let mut numbers = Vec::with_capacity(regions.len());
        let mut next = 0;
        for region in &regions {
            region.faces.iter().for_each(|&face| labels[face as usize] = next);
            numbers.push(next);
            next += u32::from(!region.faces.is_empty());
        }
        let number = |region: u32| numbers[region as usize];
        let known = std::mem::take(&mut self.0).into_iter();
        self.0 = known.map(|((i, j), union)| ((number(i), number(j)), union)).collect();
        regions.into_iter().filter(|region| !region.faces.is_empty()).collect()
    }
}

/// All pairs of regions that share an edge of some faces.
fn couples(task: &Task, labels: &[u32], faces: impl Iterator<Item = usize>) -> Vec<Couple> {
    let across = |face| task.working.adjacency.across(face).map(move |other| (face, other));
    let mut couples: Vec<Couple> = faces
        .flat_map(across)
        .map(|(face, other)| (labels[face], labels[other]))
        .filter(|(one, other)| one != other)
        .map(|(one, other)| (one.min(other), one.max(other)))
        .collect();
    couples.sort_unstable();
    couples.dedup();
    couples
}

fn unions(task: &Task, regions: &[Fitted], of: &[Couple]) -> BTreeMap<Couple, Union> {
    let region = |i: u32| &regions[i as usize];
    of.par_iter().map(|&(i, j)| ((i, j), union(task, region(i), region(j)))).collect()
}

fn union(task: &Task, one: &Fitted, other: &Fitted) -> Union {
    let patch = one.patch.joined(&other.patch);
    let samples = [one, other].map(|region| sample(task, &region.faces, SAMPLE));
    let proxy = patch.proxy(task, || samples.concat());
    let increase = || {
        let of = |(region, sample): (_, &Vec<_>)| increase(task, &proxy, region, sample);
        [one, other].into_iter().zip(&samples).map(of).sum::<f64>().abs()
    };
    let order = match (&one.proxy, &other.proxy) {
        (Proxy::Plane(a), Proxy::Plane(b)) => {
            let angle = between(&a.normal, &b.normal).to_degrees();
            if angle <= task.options.merge_angle_deg { (true, angle) } else { (false, increase()) }
        }
        _ => (false, increase()),
    };
    Union { order, patch, proxy }
}

/// What a region's error grows by under another proxy, from a sample of its faces.
fn increase(task: &Task, proxy: &Proxy, region: &Fitted, sample: &[Triangle]) -> f64 {
    let step = step(region.faces.len(), SAMPLE);
    let before = region.errors.iter().step_by(step);
    let errors = task.errors(proxy, sample);
    errors.iter().zip(before).map(|(error, before)| error - before).sum::<f64>() * step as f64
}

/// Well conditioned for small angles, where the arc cosine is not.
fn between(a: &Unit, b: &Unit) -> f64 {
    a.cross(b).norm().atan2(a.dot(b))
}

/// The lesser region takes over the other's faces; the other is left without any.
fn join(task: &Task, regions: &mut [Fitted], labels: &mut [u32], (i, j): Couple, union: Union) {
    let [mut faces, others] = [i, j].map(|r| std::mem::take(&mut regions[r as usize].faces));
    others.iter().for_each(|&face| labels[face as usize] = i);
    faces.extend(others);
    faces.sort_unstable();
    regions[i as usize] = Fitted::new(task, faces, union.patch, union.proxy);
}
