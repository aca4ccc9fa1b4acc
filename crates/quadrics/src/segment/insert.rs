//! Region insertion (paper, section 4.3(4)).

use super::Task;
use super::energy::Proxy;
use super::fit::{Fitted, fit};
use super::flood::flood;
use super::seeds::seed;
use crate::math::Unit;
use crate::partition::UNLABELLED;
use crate::surface::Plane;

/// Rounds of the local regrouping; it nearly always settles in fewer.
const LOCAL_ROUNDS: usize = 10;

/// Splits the region of the largest area-averaged error above `limit`: from its face of largest
/// error a new region, a plane at first, grows against it. Only these two regions change.
///
/// Regions of one face cannot be split; `false` where there is no other.
pub fn insert(task: &Task, labels: &mut [u32], regions: &mut Vec<Fitted>, limit: f64) -> bool {
    let worst = (0..regions.len())
        .filter(|&region| regions[region].faces.len() > 1 && regions[region].mean_error() >= limit)
        // Of equal ones the first.
        .rev()
        .max_by(|&i, &j| regions[i].mean_error().total_cmp(&regions[j].mean_error()));
    let Some(worst) = worst else { return false };
    let (old, new) = split(task, labels, &regions[worst], (worst as u32, regions.len() as u32));
    regions[worst] = old;
    regions.push(new);
    true
}

/// Regroups the faces of one region around two proxies, round by round, while the error falls.
fn split(
    task: &Task,
    labels: &mut [u32],
    region: &Fitted,
    (old, new): (u32, u32),
) -> (Fitted, Fitted) {
    let seed_face = worst_face(task, region);
    let rest: Vec<u32> = seed(task, labels, old, region);
    let rest = without(rest, seed_face, region);
    let plane = Proxy::Plane(tangent(task, seed_face));
    let mut best = regroup(
        task,
        labels,
        &region.faces,
        [&region.proxy, &plane],
        [&rest, &[seed_face]],
        (old, new),
    );
    for _ in 0..LOCAL_ROUNDS {
        let seeds = [seed(task, labels, old, &best.0), seed(task, labels, new, &best.1)];
        let proxies = [&best.0.proxy, &best.1.proxy];
        let next =
            regroup(task, labels, &region.faces, proxies, [&seeds[0], &seeds[1]], (old, new));
        let error = |(one, other): &(Fitted, Fitted)| one.error + other.error;
        if error(&next) >= error(&best) {
            break;
        }
        best = next;
    }
    best.0.faces.iter().for_each(|&face| labels[face as usize] = old);
    best.1.faces.iter().for_each(|&face| labels[face as usize] = new);
    best
}

/// Floods the faces from two seeds, and fits again.
fn regroup(
    task: &Task,
    labels: &mut [u32],
    faces: &[u32],
    proxies: [&Proxy; 2],
    seeds: [&[u32]; 2],
    (old, new): (u32, u32),
) -> (Fitted, Fitted) {
    faces.iter().for_each(|&face| labels[face as usize] = UNLABELLED);
    flood(
        task,
        |region| proxies[usize::from(region == new)],
        [(old, seeds[0]), (new, seeds[1])],
        labels,
    );
    let of = |region| faces.iter().copied().filter(|&f| labels[f as usize] == region).collect();
    rayon::join(|| fit(task, of(old)), || fit(task, of(new)))
}

fn worst_face(task: &Task, region: &Fitted) -> u32 {
    let error = |&face: &u32| task.error(&region.proxy, face);
    let by_error =
        |one: &u32, other: &u32| error(one).total_cmp(&error(other)).then(other.cmp(one));
    region.faces.iter().copied().max_by(by_error).expect("a region has a face")
}

/// The old region's seed without the new one's, and connected still: else the best other face.
fn without(seed: Vec<u32>, face: u32, region: &Fitted) -> Vec<u32> {
    if !seed.contains(&face) {
        return seed;
    }
    let first = if seed[0] == face {
        region.faces.iter().copied().find(|&f| f != face)
    } else {
        Some(seed[0])
    };
    first.into_iter().collect()
}

/// The plane of one face.
fn tangent(task: &Task, face: u32) -> Plane {
    let geometry = &task.working.geometry;
    let normal = geometry.normals[face as usize];
    let normal = Unit::try_new(normal, 0.5).unwrap_or(crate::math::Vector::z_axis());
    Plane::through(geometry.barycentres[face as usize], normal)
}
