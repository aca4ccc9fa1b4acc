//! `preset = "paper"`: the stations of section 4 in order, in the paper's own unit cube.

use crate::context::Context;
use crate::detect;
use crate::error::{Error, Result};
use crate::mesh::{Mesh, Working};
use crate::options::Options;
use crate::partition::Labels;
use crate::prepare::{labels_back, subdivide, to_unit_cube};
use crate::result::Repair;
use crate::segment;
use crate::surface::Surface;

/// What the paper's method finds, on the faces and in the units of the input.
#[derive(Debug, Clone, Default)]
pub struct Found {
    /// Region of every face of the input, numbered from 0; every region is connected.
    pub labels: Labels,
    /// The proxy of every region: a plane or a general quadric.
    pub proxies: Vec<Surface>,
    /// Total error (eq. 1), in the unit cube, of the start and after every round.
    pub energy: Vec<f64>,
    /// What the way back to the input's faces cost.
    pub repairs: Vec<Repair>,
}

/// Unit cube, subdivision, detection (or `initial_labels`, one a face), the loop, and back.
///
/// # Errors
/// What is wrong with mesh or options, or [`Error::Cancelled`].
pub fn paper(
    context: &mut Context,
    mesh: &Mesh,
    options: &Options,
    initial_labels: Option<&[u32]>,
) -> Result<Found> {
    if initial_labels.is_some_and(|labels| labels.len() != mesh.faces.len()) {
        let faces = mesh.faces.len();
        return Err(Error::Option(format!("initial labels: one for each of {faces} faces")));
    }
    let into = to_unit_cube(mesh)?;
    let (working, parents) = context.timed("prepare", |_| {
        let positions = mesh.positions.iter().map(|point| into * point).collect();
        let cube = Mesh { positions, faces: mesh.faces.clone() };
        let fine = subdivide(cube, options.max_edge)?;
        Ok((Working::new(fine.mesh), fine.parents))
    })?;
    let start = match initial_labels {
        Some(labels) => parents.iter().map(|&parent| labels[parent as usize]).collect(),
        None => context.timed("detect", |c| detect::detect(c, &working, options))?,
    };
    let outcome = context.timed("segment", |c| segment::paper(c, &working, options, &start))?;
    let input = Working::new(mesh.clone());
    let back = labels_back(
        &outcome.labels,
        &parents,
        &working.geometry.areas,
        &input.adjacency,
        &input.geometry.normals,
        &input.geometry.areas,
    );
    let out = into.inverse();
    let proxy = |&former: &u32| outcome.proxies[former as usize].surface().transformed(&out);
    let proxies = back.former.iter().map(proxy).collect();
    let repairs = repairs(back.vanishing, back.reassigned);
    Ok(Found { labels: back.labels, proxies, energy: outcome.energy, repairs })
}

fn repairs(vanishing: usize, reassigned: usize) -> Vec<Repair> {
    let regions = Repair {
        kind: "vanishing_regions",
        count: vanishing,
        detail: "regions with a majority in no input face kept the one that holds most of them"
            .into(),
    };
    let faces = Repair {
        kind: "fragments",
        count: reassigned,
        detail: "input faces given to a neighbour because their region had fallen apart".into(),
    };
    [regions, faces].into_iter().filter(|repair| repair.count > 0).collect()
}
