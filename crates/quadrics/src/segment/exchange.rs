//! Insertion and merging when the loop has settled: a region too many goes where one is missing.
//!
//! Lloyd's iteration moves boundaries and leaves regions where the start has put them. Insertion where
//! a region errs too much and merging down to the wanted number are the paper's own operators
//! (section 4.3(3) and (4)); here the total error decides. As the paper has it only the regions in
//! question are regrouped, so that an exchange costs little.

use super::fit::Fitted;
use super::insert::split;
use super::merge::{Couple, Unions};
use super::{State, Task};
use crate::context::Context;
use crate::error::Result;
use crate::options::Options;

/// Exchanges at most.
const EXCHANGES: usize = 20;
/// The regions that fit worst are tried, so many of them.
const TRIES: usize = 6;

/// Exchanges regions as long as the total error falls; `None` if it does not at once.
///
/// # Errors
/// [`crate::Error::Cancelled`].
pub fn exchange(context: &mut Context, task: &Task, state: &State) -> Result<Option<State>> {
    // The error alone decides: planes of nearly one direction are not merged for that.
    let options = Options { merge_angle_deg: 0.0, ..task.options.clone() };
    let task = &Task { options: &options, ..*task };
    let unions = Unions::new(task, &state.labels, &state.regions);
    let mut best = once(context, task, state, &unions)?;
    for _ in 1..EXCHANGES {
        let Some((state, unions)) = &best else { break };
        match once(context, task, state, unions)? {
            Some(better) => best = Some(better),
            None => break,
        }
    }
    Ok(best.map(|(state, _)| state))
}

/// A split of a region that fits badly and the cheapest merge, if together they lower the error.
fn once(
    context: &mut Context,
    task: &Task,
    state: &State,
    unions: &Unions,
) -> Result<Option<(State, Unions)>> {
    let count = state.regions.len();
    // A split saves no more than the region's error, and the merge that pays for it costs that much.
    let costs = unions.costs();
    let is_worth_it = |&region: &usize| {
        let Fitted { faces, error, .. } = &state.regions[region];
        let apart = |(_, (a, b)): &&(f64, Couple)| [*a, *b].iter().all(|&r| r as usize != region);
        faces.len() > 1 && costs.iter().find(apart).is_none_or(|(cost, _)| error > cost)
    };
    let mut worst: Vec<usize> = (0..count).filter(is_worth_it).collect();
    worst.sort_by(|&i, &j| state.regions[j].mean_error().total_cmp(&state.regions[i].mean_error()));
    for &region in worst.iter().take(TRIES) {
        let State { mut labels, mut regions } = state.clone();
        let mut unions = unions.clone();
        split(task, &mut labels, &mut regions, region);
        unions.split(task, &labels, &regions, [region, count]);
        let step = || context.step("segment", 0.9);
        let regions = unions.merge(task, &mut labels, regions, count, step)?;
        let next = State { labels, regions };
        if lower(task, next.energy(), state.energy()) {
            return Ok(Some((next, unions)));
        }
    }
    Ok(None)
}

fn lower(task: &Task, energy: f64, than: f64) -> bool {
    energy < than * (1.0 - task.options.convergence)
}
