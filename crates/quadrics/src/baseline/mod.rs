//! Other people's methods on our kernels, to be compared with.
//!
//! Each file says what it takes from its publication and which choices it makes. All start from
//! labels where they start from any, work on the subdivided mesh in the paper's unit cube, and end
//! with the energy of eq. 1 to 3, so that their errors can be compared.

mod hfp;
mod qsf;
mod ransac;
mod start;
mod teleport;
mod vsa;

use crate::context::Context;
use crate::error::{Error, Result};
use crate::mesh::Mesh;
use crate::options::{Method, Options};
use crate::paper::{Found, in_cube, paper};
use crate::segment::{Metric, State, Task};

/// Segments a mesh by `options.method`; `initial_labels` has one a face.
///
/// # Errors
/// What is wrong with mesh or options, [`Error::Option`] if the method needs a number of regions and
/// none is given, or [`Error::Cancelled`].
pub fn baseline(
    context: &mut Context,
    mesh: &Mesh,
    options: &Options,
    initial_labels: Option<&[u32]>,
) -> Result<Found> {
    let method = match options.method {
        Method::Quadrics => return paper(context, mesh, options, initial_labels),
        Method::Vsa => vsa::vsa,
        Method::Qsf => qsf::qsf,
        Method::Hfp => hfp::hfp,
        Method::Ransac => ransac::ransac,
    };
    in_cube(context, mesh, options, initial_labels, |context, working, start| {
        method(context, working, options, start)
    })
}

/// The number of regions, which these methods cannot find.
fn wanted(options: &Options) -> Result<usize> {
    options.regions.ok_or_else(|| Error::Option("this method needs a number of regions".into()))
}

/// Eq. 1 of regions that another metric made.
fn common_energy(task: &Task, state: &State) -> f64 {
    let common = Task { metric: Metric::Surfaces, ..*task };
    state.regions.iter().map(|region| common.total_error(&region.proxy, &region.faces)).sum()
}

#[cfg(test)]
mod tests;
