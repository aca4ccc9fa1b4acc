//! RANSAC alone: the paper's initialisation (section 4.2, after Schnabel, Wahl and Klein 2007) without
//! the loop that follows it.
//!
//! Choices: its regions are made connected and complete as in 4.2(1) and (2), and get planes and quadrics
//! by 4.3(2), so that there is an energy. The number of regions follows from tau; one that
//! is given is not reached.

use crate::context::Context;
use crate::detect::detect;
use crate::error::Result;
use crate::mesh::Working;
use crate::options::Options;
use crate::partition::Labels;
use crate::segment::{Metric, Outcome, State, Task};

/// Detects shapes in a mesh in the unit cube; `labels` replace the detection.
///
/// # Errors
/// [`crate::Error::Cancelled`].
pub fn ransac(
    context: &mut Context,
    working: &Working,
    options: &Options,
    labels: Option<Labels>,
) -> Result<Outcome> {
    let labels = match labels {
        Some(labels) => labels,
        None => context.timed("detect", |context| detect(context, working, options))?,
    };
    let task = Task { working, options, metric: Metric::Surfaces };
    let state = State::new(&task, &labels)?;
    let energy = state.energy();
    Ok(state.outcome(vec![energy]))
}
