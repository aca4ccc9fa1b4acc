//! QSF: D.-M. Yan, W. Wang, Y. Liu, Z. Yang, *Variational mesh segmentation via quadric surface fitting*
//! (Computer-Aided Design 2012), the paper's reference 13.
//!
//! From the publication: general quadrics under eq. 2, random seed faces, flooding from the face of
//! least error, region teleportation. Choices: a region is a plane by eq. 4, as ours are (they compare
//! the error of the plane with a threshold of their own); their smoothing of boundaries by
//! a cut is left out, since the paper's comparison is of the loops. The energies are those of all
//! rounds, teleportations included.

use super::{start, teleport, wanted};
use crate::context::Context;
use crate::error::Result;
use crate::mesh::Working;
use crate::options::{Options, Seeds};
use crate::partition::Labels;
use crate::segment::{Metric, Outcome, Task};

/// Segments a mesh in the unit cube into `options.regions` quadrics.
///
/// # Errors
/// Without a number of regions; [`crate::Error::Cancelled`].
pub fn qsf(
    context: &mut Context,
    working: &Working,
    options: &Options,
    labels: Option<Labels>,
) -> Result<Outcome> {
    let regions = wanted(options)?;
    let options = Options { seeds: Seeds::Triangle, merge_angle_deg: 0.0, ..options.clone() };
    let task = Task { working, options: &options, metric: Metric::Surfaces };
    context.timed("segment", |context| {
        let first = start::first(context, &task, labels, regions)?;
        let (best, energy) = teleport::converge(context, &task, first)?;
        Ok(best.outcome(energy))
    })
}
