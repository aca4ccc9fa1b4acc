//! The stations in order, nothing else.

use crate::context::Context;
use crate::error::{Error, Result};
use crate::mesh::Mesh;
use crate::options::Options;
use crate::result::Segmentation;

/// Segments a mesh into regions, each with its surface.
///
/// `initial_labels`, one per face, replaces the detection: the loop starts from any labels.
///
/// # Errors
/// What is wrong with the mesh or the options, or [`Error::Cancelled`].
pub fn segment(
    _context: &mut Context,
    mesh: &Mesh,
    _options: &Options,
    _initial_labels: Option<&[u32]>,
) -> Result<Segmentation> {
    if mesh.faces.is_empty() {
        return Err(Error::Empty);
    }
    Ok(Segmentation::default())
}
