//! Distortion-minimising flooding with seed regions (paper, section 4.3(1)).

use super::Task;
use super::energy::Proxy;
use super::queue::{Pair, Queue};
use crate::partition::UNLABELLED;

/// Lets regions grow from their seeds over the unlabelled faces, pop by pop.
///
/// A seed is a region's number and its first faces; `proxy` gives a region's. Labelled
/// faces are walls: with one region's faces unlabelled the regrouping is local to them. Every
/// region is connected if its seed is.
pub fn flood<'p, 's>(
    task: &Task,
    proxy: impl Fn(u32) -> &'p Proxy,
    seeds: impl IntoIterator<Item = (u32, &'s [u32])>,
    labels: &mut [u32],
) {
    let mut queue = Queue::default();
    // A region reaches a face from up to three sides: the later pairs would be the same.
    let mut reached_by = vec![UNLABELLED; labels.len()];
    let mut push = |queue: &mut Queue, face: u32, region: u32, seed: bool| {
        if std::mem::replace(&mut reached_by[face as usize], region) != region {
            let error = task.error(proxy(region), face);
            queue.push(error, Pair { face, region, seed });
        }
    };
    for (region, faces) in seeds {
        for &face in faces {
            labels[face as usize] = region;
            push(&mut queue, face, region, true);
        }
    }
    while let Some(Pair { face, region, seed }) = queue.pop() {
        let owner = &mut labels[face as usize];
        // A seed face is its region's already, but has not been grown from; of the other pairs
        // of a face the first one wins and the rest are stale.
        if *owner == UNLABELLED {
            *owner = region;
        } else if !seed {
            continue;
        }
        for next in task.working.adjacency.across(face as usize) {
            if labels[next] == UNLABELLED {
                push(&mut queue, next as u32, region, false);
            }
        }
    }
}
