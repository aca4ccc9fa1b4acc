//! Lloyd's iteration with region teleportation (Cohen-Steiner et al. 2004, section 3.5).

use super::{common_energy, start, wanted};
use crate::context::Context;
use crate::error::Result;
use crate::mesh::Working;
use crate::options::{Options, Seeds};
use crate::partition::Labels;
use crate::segment::insert::insert;
use crate::segment::merge::merge;
use crate::segment::{Metric, Outcome, State, Task, lloyd};

/// Teleportations at most; the first one that does not lower the energy is the last.
const TELEPORTATIONS: usize = 20;

/// A method of this kind: seed faces, `options.regions` regions, the proxies of a metric.
///
/// The energies are those of all rounds where the metric is ours, else eq. 1 of the start and the end.
///
/// # Errors
/// Without a number of regions; [`crate::Error::Cancelled`].
pub fn variational(
    context: &mut Context,
    working: &Working,
    options: &Options,
    labels: Option<Labels>,
    metric: Metric,
) -> Result<Outcome> {
    let regions = wanted(options)?;
    let options = Options { seeds: Seeds::Triangle, merge_angle_deg: 0.0, ..options.clone() };
    let task = Task { working, options: &options, metric };
    context.timed("segment", |context| {
        let first = start::first(context, &task, labels, regions)?;
        let before = common_energy(&task, &first);
        let (best, rounds) = converge(context, &task, first)?;
        let energy = match metric {
            Metric::Surfaces => rounds,
            Metric::Normals => vec![before, common_energy(&task, &best)],
        };
        Ok(best.outcome(energy))
    })
}

/// Converges; then merges the two adjacent regions that it costs least to merge and inserts one where
/// the fit is worst, and converges again, as long as the energy falls.
///
/// The best state, and the energies of all rounds in turn.
fn converge(context: &mut Context, task: &Task, start: State) -> Result<(State, Vec<f64>)> {
    let (mut best, mut energy) = lloyd(context, task, start)?;
    // No rounds at all leave the start as it is.
    for _ in 0..TELEPORTATIONS.min(task.options.max_iterations) {
        let count = best.regions.len();
        let mut labels = best.labels.clone();
        let step = || context.step("segment", 0.5);
        let mut regions = merge(task, &mut labels, best.regions.clone(), count - 1, step)?;
        if regions.len() == count || !insert(task, &mut labels, &mut regions, 0.0) {
            break;
        }
        let (next, more) = lloyd(context, task, State { labels, regions })?;
        energy.extend(more);
        if next.energy() >= best.energy() * (1.0 - task.options.convergence) {
            break;
        }
        best = next;
    }
    Ok((best, energy))
}
