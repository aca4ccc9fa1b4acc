//! Noise off a mesh whose surfaces are known (paper, section 5.5).
//!
//! A vertex inside a region goes to its surface, one between two to the curve where they meet, one
//! where three meet to their point. Nothing moves further than the noise explains, nor aside of the
//! direction that it acts in (`place`), nor to a curve that most vertices along it are too far from
//! (`crease`): those go to one of the surfaces, or stay. Where all neighbours lie off a surface on
//! the same side, it is the surface that errs, and a vertex goes to where its neighbours are on the
//! mean (`offset`, `shared`). A way that leads off what the neighbours allow is cut short (`local`, and
//! along creases `crease`).

mod crease;
mod direction;
mod fold;
mod free;
mod local;
mod offset;
mod place;
mod shared;

use offset::Offsets;
use place::{Goal, Noisy};
use rayon::prelude::*;

use crate::error::{Error, Result};
use crate::math::Point;
use crate::mesh::{Mesh, Working};
use crate::partition::UNLABELLED;
use crate::surface::Surface;

/// Single precision stores a clean mesh to so many sizes: never less noise than that.
const ROUNDING: f64 = 1e-7;

/// What the vertices of a region should lie on.
struct Task<'a> {
    working: &'a Working,
    labels: &'a [u32],
    surfaces: &'a [Surface],
    /// Of every region, 1 or -1: whether its faces look the way its surface does.
    sides: Vec<f64>,
    /// Standard deviation of the noise across the surface.
    sigma: f64,
}

impl Task<'_> {
    /// The regions at a vertex that have a surface, ascending.
    fn regions(&self, vertex: u32) -> Vec<u32> {
        let around = self.working.adjacency.around(vertex);
        let mut regions: Vec<u32> = around.iter().map(|&f| self.labels[f as usize]).collect();
        regions.sort_unstable();
        regions.dedup();
        regions.retain(|&region| {
            region != UNLABELLED && !matches!(self.surfaces[region as usize], Surface::FreeForm)
        });
        regions
    }
}

/// The positions of all vertices without the noise; `labels` are places in `surfaces`, which are in
/// the units of the mesh, as `sigma` is.
///
/// In free-form regions vertices go to a smooth piece of their neighbours; those on the border of such a
/// region and those of faces without a label stay, where no other region has them.
///
/// # Errors
/// [`Error::Option`] if there is not one label a face, a label has no surface, or sigma is no length.
pub fn denoise(
    mesh: &Mesh,
    labels: &[u32],
    surfaces: &[Surface],
    sigma: f64,
) -> Result<Vec<Point>> {
    let (given, faces) = (labels.len(), mesh.faces.len());
    if given != faces {
        let text = format!("{given} labels for {faces} faces: are they of this mesh?");
        return Err(Error::Option(text));
    }
    let known = |label: u32| label == UNLABELLED || (label as usize) < surfaces.len();
    if let Some(face) = labels.iter().position(|&label| !known(label)) {
        return Err(Error::Option(format!(
            "face {face} is in region {}: it is not there",
            labels[face]
        )));
    }
    if !(sigma >= 0.0 && sigma.is_finite()) {
        return Err(Error::Option(format!("the noise is {sigma}: give a length")));
    }
    let working = Working::new(mesh.clone());
    let sigma = sigma.max(ROUNDING * mesh.size());
    let sides = direction::sides(&working, labels, surfaces);
    let task = Task { working: &working, labels, surfaces, sides, sigma };
    let regions: Vec<Vec<u32>> =
        (0..mesh.positions.len() as u32).into_par_iter().map(|v| task.regions(v)).collect();
    let offsets = Offsets::new(&task, &regions);
    let reach = offsets.reach(&regions, surfaces.len(), sigma);
    let moved = move_all(&task, &regions, &offsets, reach);
    let moved = shared::take_back(&task, moved, &regions, reach);
    let moved = local::hold(&task, moved, &regions);
    Ok(fold::unfold(&task, moved))
}

/// Every vertex to where its surfaces meet, as far as the noise explains it.
fn move_all(task: &Task, regions: &[Vec<u32>], offsets: &Offsets, reach: f64) -> Vec<Point> {
    let vertices = (0..regions.len()).into_par_iter();
    let goals: Vec<Vec<Goal>> = vertices
        .clone()
        .map_init(offset::Search::default, |search, vertex| {
            let mut goal = |&region: &u32| Goal {
                surface: &task.surfaces[region as usize],
                offset: offsets.at(task, vertex as u32, region, search),
            };
            regions[vertex].iter().map(&mut goal).collect()
        })
        .collect();
    let noisy: Vec<Noisy> = vertices.clone().map(|v| task.noisy(v as u32, reach)).collect();
    let joint = |vertex: usize| match goals[vertex].len() {
        0 | 1 => None,
        _ => noisy[vertex].joint(&goals[vertex]),
    };
    let joints: Vec<Option<Point>> = vertices.clone().map(joint).collect();
    let creases = crease::Creases { task, regions, joints: &joints, noisy: &noisy };
    vertices
        .map(|vertex| match regions[vertex].is_empty() {
            true => free::place(task, vertex as u32, reach),
            false => creases.place(vertex, &goals[vertex]),
        })
        .collect()
}

#[cfg(test)]
mod tests;
