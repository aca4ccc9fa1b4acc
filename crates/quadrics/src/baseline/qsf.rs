//! QSF: D.-M. Yan, W. Wang, Y. Liu, Z. Yang, *Variational mesh segmentation via quadric surface fitting*
//! (Computer-Aided Design 2012), the paper's reference 13.
//!
//! From the publication: general quadrics under eq. 2, random seed faces, flooding from the face of
//! least error, region teleportation. Choices: a region is a plane by eq. 4, as ours are (they compare
//! the error of the plane with a threshold of their own); their smoothing of boundaries by
//! a cut is left out, since the paper's comparison is of the loops. The energies are those of all
//! rounds, teleportations included.

use super::teleport::variational;
use crate::context::Context;
use crate::error::Result;
use crate::mesh::Working;
use crate::options::Options;
use crate::partition::Labels;
use crate::segment::{Metric, Outcome};

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
    variational(context, working, options, labels, Metric::Surfaces)
}
