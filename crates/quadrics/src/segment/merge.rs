//! Region merging (paper, section 4.3(3)).

use std::collections::BTreeMap;

use rayon::prelude::*;

use super::Task;
use super::energy::Proxy;
use super::fit::{Fitted, Patch, sample, step};
use crate::error::Result;
use crate::math::Unit;

/// Faces of a region that a merge is judged by: most of the pairs are far from the cheapest.
const SAMPLE: usize = 50;

/// Two adjacent regions, the lesser first.
type Couple = (u32, u32);

/// What a merge would do.
#[derive(Clone)]
struct Union {
    /// Planes within the angle come first, by angle; the others by the increase of the error.
    order: (bool, f64),
    patch: Patch,
    proxy: Proxy,
}

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
    mut step: impl FnMut() -> Result<()>,
) -> Result<Vec<Fitted>> {
    let mut alive: Vec<Option<Fitted>> = regions.into_iter().map(Some).collect();
    let mut left = alive.len();
    if left <= count {
        return Ok(alive.into_iter().flatten().collect());
    }
    let mut unions = unions(task, &alive, &couples(task, labels));
    while left > count {
        step()?;
        let by_order = |one: &(&Couple, &Union), other: &(&Couple, &Union)| {
            let ((plane, cost), (other_plane, other_cost)) = (one.1.order, other.1.order);
            other_plane.cmp(&plane).then(cost.total_cmp(&other_cost)).then(one.0.cmp(other.0))
        };
        let Some(couple) = unions.iter().min_by(by_order).map(|(&couple, _)| couple) else { break };
        let union = unions.remove(&couple).expect("it was found there");
        join(task, &mut alive, labels, couple, union);
        left -= 1;
        renew(task, &alive, &mut unions, couple);
    }
    Ok(compacted(alive, labels))
}

/// All pairs of regions that share an edge.
fn couples(task: &Task, labels: &[u32]) -> Vec<Couple> {
    let mut couples: Vec<Couple> = (0..labels.len())
        .flat_map(|face| task.working.adjacency.across(face).map(move |other| (face, other)))
        .map(|(face, other)| (labels[face], labels[other]))
        .filter(|(one, other)| one < other)
        .collect();
    couples.sort_unstable();
    couples.dedup();
    couples
}

fn unions(task: &Task, alive: &[Option<Fitted>], of: &[Couple]) -> BTreeMap<Couple, Union> {
    let region = |i: u32| alive[i as usize].as_ref().expect("only live regions have neighbours");
    of.par_iter().map(|&(i, j)| ((i, j), union(task, region(i), region(j)))).collect()
}

fn union(task: &Task, one: &Fitted, other: &Fitted) -> Union {
    let patch = one.patch.joined(&other.patch);
    let proxy = patch
        .proxy(task, || Box::new(sample(&one.faces, SAMPLE).chain(sample(&other.faces, SAMPLE))));
    let increase =
        || [one, other].map(|region| increase(task, &proxy, region)).iter().sum::<f64>().abs();
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
fn increase(task: &Task, proxy: &Proxy, region: &Fitted) -> f64 {
    let step = step(region.faces.len(), SAMPLE);
    let faces = region.faces.iter().zip(&region.errors).step_by(step);
    faces.map(|(&face, error)| task.error(proxy, face) - error).sum::<f64>() * step as f64
}

/// Well conditioned for small angles, where the arc cosine is not.
fn between(a: &Unit, b: &Unit) -> f64 {
    a.cross(b).norm().atan2(a.dot(b))
}

/// The lesser region takes over the other's faces.
fn join(
    task: &Task,
    alive: &mut [Option<Fitted>],
    labels: &mut [u32],
    (i, j): Couple,
    union: Union,
) {
    let one = alive[i as usize].take().expect("alive");
    let other = alive[j as usize].take().expect("alive");
    other.faces.iter().for_each(|&face| labels[face as usize] = i);
    let mut faces = one.faces;
    faces.extend(other.faces);
    faces.sort_unstable();
    alive[i as usize] = Some(Fitted::new(task, faces, union.patch, union.proxy));
}

/// The pairs of the merged region, and of nobody else, are looked at again.
fn renew(
    task: &Task,
    alive: &[Option<Fitted>],
    known: &mut BTreeMap<Couple, Union>,
    (i, j): Couple,
) {
    let touched = |&(a, b): &Couple| a == i || a == j || b == i || b == j;
    let mut again: Vec<Couple> = known.keys().copied().filter(touched).collect();
    known.retain(|couple, _| !touched(couple));
    for (a, b) in &mut again {
        let other = if *a == i || *a == j { *b } else { *a };
        (*a, *b) = (i.min(other), i.max(other));
    }
    again.sort_unstable();
    again.dedup();
    known.extend(unions(task, alive, &again));
}

fn compacted(alive: Vec<Option<Fitted>>, labels: &mut [u32]) -> Vec<Fitted> {
    let regions: Vec<Fitted> = alive.into_iter().flatten().collect();
    for (label, region) in regions.iter().enumerate() {
        region.faces.iter().for_each(|&face| labels[face as usize] = label as u32);
    }
    regions
}
