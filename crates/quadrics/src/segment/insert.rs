//! Region insertion (paper, section 4.3(4)).

use super::Task;
use super::energy::Proxy;
use super::fit::{Fitted, fit};
use super::flood::flood;
use super::seeds::seed;
use crate::math::{Unit, Vector};
use crate::partition::UNLABELLED;
use crate::surface::Plane;

/// Rounds of the local regrouping; it nearly always settles in fewer.
const LOCAL_ROUNDS: usize = 10;

/// Splits the region of the largest area-averaged error, if that is at least `limit`: from its
/// face of largest error a new region, a plane at first, grows against it. Only these two change.
///
/// Regions of one face cannot be split; `false` where there is no other.
pub fn insert(task: &Task, labels: &mut [u32], regions: &mut Vec<Fitted>, limit: f64) -> bool {
    let worst = (0..regions.len())
        .filter(|&region| regions[region].faces.len() > 1 && regions[region].mean_error() >= limit)
        // Of equal ones the first.
        .rev()
        .max_by(|&i, &j| regions[i].mean_error().total_cmp(&regions[j].mean_error()));
    let Some(worst) = worst else { return false };
    split(task, labels, regions, worst);
    true
}

/// Splits a region of several faces; the new one is the last.
pub fn split(task: &Task, labels: &mut [u32], regions: &mut Vec<Fitted>, region: usize) {
    let numbers = [region as u32, regions.len() as u32];
    let local = Local { task, faces: &regions[region].faces, numbers };
    let [old, new] = local.split(labels, &regions[region]);
    regions[region] = old;
    regions.push(new);
}

/// Two regions that share out the faces of one between them.
struct Local<'a> {
    task: &'a Task<'a>,
    faces: &'a [u32],
    numbers: [u32; 2],
}

impl Local<'_> {
    /// Regrouping and fitting, round by round, while the error falls.
    fn split(&self, labels: &mut [u32], region: &Fitted) -> [Fitted; 2] {
        let worst = worst_face(region);
        let rest = without(seed(self.task, labels, self.numbers[0], region), worst, region);
        let plane = Proxy::Plane(tangent(self.task, worst));
        let mut best = self.regroup(labels, [&region.proxy, &plane], [&rest, &[worst]]);
        for _ in 0..LOCAL_ROUNDS {
            let seed = |i: usize| seed(self.task, labels, self.numbers[i], &best[i]).to_vec();
            let seeds = [seed(0), seed(1)];
            let proxies = [&best[0].proxy, &best[1].proxy];
            let next = self.regroup(labels, proxies, [&seeds[0], &seeds[1]]);
            if next[0].error + next[1].error >= best[0].error + best[1].error {
                break;
            }
            best = next;
        }
        for (number, region) in self.numbers.iter().zip(&best) {
            region.faces.iter().for_each(|&face| labels[face as usize] = *number);
        }
        best
    }

    /// Floods the faces from two seeds, and fits again.
    fn regroup(&self, labels: &mut [u32], proxies: [&Proxy; 2], seeds: [&[u32]; 2]) -> [Fitted; 2] {
        let [old, new] = self.numbers;
        self.faces.iter().for_each(|&face| labels[face as usize] = UNLABELLED);
        let proxy = |region| proxies[usize::from(region == new)];
        flood(self.task, proxy, [(old, seeds[0]), (new, seeds[1])], labels);
        let of = |region| {
            self.faces.iter().copied().filter(|&face| labels[face as usize] == region).collect()
        };
        let (one, other) = rayon::join(|| fit(self.task, of(old)), || fit(self.task, of(new)));
        [one, other]
    }
}

/// The face of the largest error, the first of equal ones.
fn worst_face(region: &Fitted) -> u32 {
    let by_error = |one: &(&u32, &f64), other: &(&u32, &f64)| one.1.total_cmp(other.1);
    let worst = region.faces.iter().zip(&region.errors).rev().max_by(by_error);
    *worst.expect("a region has a face").0
}

/// The old region's seed without the new one's: a single face where that would cut it in two.
fn without(seed: &[u32], face: u32, region: &Fitted) -> Vec<u32> {
    if !seed.contains(&face) {
        return seed.to_vec();
    }
    let others = seed.iter().chain(&region.faces);
    others.copied().find(|&other| other != face).into_iter().collect()
}

/// The plane of one face.
pub fn tangent(task: &Task, face: u32) -> Plane {
    let geometry = &task.working.geometry;
    // A face without area has no normal: any plane through it does.
    let normal = Unit::try_new(geometry.normals[face as usize], 0.5).unwrap_or_else(Vector::z_axis);
    Plane::through(geometry.barycentres[face as usize], normal)
}
