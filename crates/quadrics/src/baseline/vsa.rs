//! VSA: D. Cohen-Steiner, P. Alliez, M. Desbrun, *Variational shape approximation* (SIGGRAPH 2004).
//!
//! From the publication: planes as proxies, the L2,1 metric (deviation of normals), flooding from the
//! face of least error, region teleportation. Choices: seeding at random (they also describe one
//! region at a time); teleportation goes on while it lowers the energy. The energy that is
//! reported is eq. 1 of its planes, before the first round and at the end.

use super::teleport::variational;
use crate::context::Context;
use crate::error::Result;
use crate::mesh::Working;
use crate::options::Options;
use crate::partition::Labels;
use crate::segment::{Metric, Outcome};

/// Segments a mesh in the unit cube into `options.regions` planar regions.
///
/// # Errors
/// Without a number of regions; [`crate::Error::Cancelled`].
pub fn vsa(
    context: &mut Context,
    working: &Working,
    options: &Options,
    labels: Option<Labels>,
) -> Result<Outcome> {
    variational(context, working, options, labels, Metric::Normals)
}
