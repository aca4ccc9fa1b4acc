//! The start of VSA and QSF: regions around random faces.

use rand::seq::SliceRandom;

use crate::context::Context;
use crate::error::Result;
use crate::partition::{Labels, UNLABELLED};
use crate::segment::flood::flood;
use crate::segment::insert::tangent;
use crate::segment::{Proxy, State, Task, adjust};

/// The first state of the loop, in exactly `regions` regions: those of `labels`, or around random faces.
///
/// # Errors
/// [`crate::Error::Cancelled`].
pub fn first(
    context: &mut Context,
    task: &Task,
    labels: Option<Labels>,
    regions: usize,
) -> Result<State> {
    let labels = labels.unwrap_or_else(|| random(context, task, regions));
    let state = State::new(task, &labels)?;
    adjust(context, task, state)
}

/// Draws `regions` faces and floods the mesh from them, each with the plane of its face.
fn random(context: &mut Context, task: &Task, regions: usize) -> Labels {
    let mut faces: Vec<u32> = (0..task.working.len() as u32).collect();
    let (seeds, _) = faces.partial_shuffle(&mut context.rng, regions);
    let proxies: Vec<Proxy> = seeds.iter().map(|&face| Proxy::Plane(tangent(task, face))).collect();
    let mut labels = vec![UNLABELLED; task.working.len()];
    let numbered = (0..).zip(seeds.chunks(1));
    flood(task, |region| &proxies[region as usize], numbered, &mut labels);
    labels
}
