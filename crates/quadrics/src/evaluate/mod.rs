//! How good a segmentation is: against the truth, or against another result (paper, section 5.2).
//!
//! Regions are matched one to one for the largest common area; every measure that speaks of pairs of
//! regions (HD, IoU, recognition, parameters) speaks of these.

mod assignment;
mod consistency;
mod deviation;
mod energy;
mod hamming;
mod overlap;
mod parameters;
mod rand_index;
mod verdict;

pub use deviation::{Deviation, deviation};
pub use energy::{Energy, energy};
pub use overlap::Pair;
pub use rand_index::Rand;
pub use verdict::{TOLERANCE, Verdict};

use overlap::Overlap;
use verdict::Judge;

use crate::error::{Error, Result};
use crate::mesh::{Geometry, Mesh};
use crate::partition::UNLABELLED;
use crate::surface::Surface;

/// A region as it is judged.
#[derive(Debug, Clone, PartialEq)]
pub struct Named {
    /// Its type, as in the result files; `quadric` is taken by the class of its coefficients.
    pub kind: String,
    /// Its surface, in the units of the mesh; `None` for free-form, or where nothing usable is given.
    pub surface: Option<Surface>,
    /// An analytic surface that a free-form region may as well be called, with its type.
    pub near: Option<(String, Surface)>,
}

/// A segmentation as it is judged.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Answer {
    /// For every face the place of its region in `regions`, or [`UNLABELLED`].
    pub labels: Vec<u32>,
    /// The regions.
    pub regions: Vec<Named>,
}

/// All measures of one segmentation.
#[derive(Debug, Clone, PartialEq)]
pub struct Report {
    /// HD (eq. 6): 0 for the same partition, up to 1.
    pub hamming: f64,
    /// CE (eq. 7): 0 for any refinement of the truth too.
    pub consistency: f64,
    /// Rand indices over pairs of faces.
    pub rand: Rand,
    /// Mean over the true regions of the overlap with their partners; 0 without one.
    pub mean_iou: f64,
    /// Regions of both sides.
    pub regions: (usize, usize),
    /// Share of the area that the result gives to no region.
    pub unlabelled_area: f64,
    /// Every matched pair, by the found region.
    pub verdicts: Vec<Verdict>,
}

impl Report {
    /// Pairs that are right in extent and surface, and in type too where `typed`.
    pub fn hits(&self, typed: bool) -> usize {
        self.verdicts.iter().filter(|v| if typed { v.is_hit() } else { v.is_geometry() }).count()
    }
}

/// Judges `found` against `truth` on their common mesh.
///
/// `tolerance` is the largest RMS distance of a right surface from the true one, as a fraction of
/// the mesh's size.
///
/// # Errors
/// [`Error::Option`] if a side has not one label a face, or a label without a region.
pub fn evaluate(mesh: &Mesh, found: &Answer, truth: &Answer, tolerance: f64) -> Result<Report> {
    check(mesh, found, "result")?;
    check(mesh, truth, "truth")?;
    let geometry = Geometry::new(mesh);
    let overlap = Overlap::new(found, truth, &geometry.areas);
    let pairs = overlap.pairs();
    let judge = Judge { mesh, geometry: &geometry, found, truth, tolerance, size: mesh.size() };
    let mut ious = vec![0.0; truth.regions.len()];
    pairs.iter().for_each(|pair| ious[pair.truth as usize] = pair.iou);
    let bare = |(label, area): (&u32, &f64)| if *label == UNLABELLED { *area } else { 0.0 };
    let unlabelled: f64 = found.labels.iter().zip(&geometry.areas).map(bare).sum();
    Ok(Report {
        hamming: hamming::distance(&pairs, overlap.total),
        consistency: consistency::error(&found.labels, &truth.labels, &geometry.areas),
        rand: rand_index::rand(&found.labels, &truth.labels),
        mean_iou: ious.iter().sum::<f64>() / ious.len().max(1) as f64,
        regions: (found.regions.len(), truth.regions.len()),
        unlabelled_area: unlabelled / overlap.total,
        verdicts: pairs.into_iter().map(|pair| judge.judge(pair)).collect(),
    })
}

fn check(mesh: &Mesh, answer: &Answer, side: &str) -> Result<()> {
    let (labels, faces) = (answer.labels.len(), mesh.faces.len());
    if labels != faces {
        let text = format!("the {side} has {labels} labels for {faces} faces: is it of this mesh?");
        return Err(Error::Option(text));
    }
    let count = answer.regions.len() as u32;
    match answer.labels.iter().position(|&label| label != UNLABELLED && label >= count) {
        Some(face) => {
            let label = answer.labels[face];
            Err(Error::Option(format!("face {face} of the {side} is in no region: {label}")))
        }
        None if faces == 0 => Err(Error::Empty),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests;
