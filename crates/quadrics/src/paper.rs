//! `preset = "paper"`: the stations of section 4 in order, in the paper's own unit cube.

use crate::context::Context;
use crate::detect;
use crate::error::{Error, Result};
use crate::mesh::{Mesh, Working};
use crate::options::Options;
use crate::partition::Labels;
use crate::prepare::{Ordered, labels_back, ordered, subdivide, to_unit_cube};
use crate::result::Repair;
use crate::segment::{self, Outcome};
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
    in_cube(context, mesh, options, initial_labels, |context, working, start| {
        let start = match start {
            Some(labels) => labels,
            None => context.timed("detect", |c| detect::detect(c, working, options))?,
        };
        context.timed("segment", |c| segment::paper(c, working, options, &start))
    })
}

/// A method on the subdivided mesh in the unit cube, and the way back to the faces of the input.
///
/// # Errors
/// Those of the method, and what is wrong with mesh or options.
pub fn in_cube(
    context: &mut Context,
    mesh: &Mesh,
    options: &Options,
    initial_labels: Option<&[u32]>,
    method: impl FnOnce(&mut Context, &Working, Option<Labels>) -> Result<Outcome>,
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
        // Neighbours in space are neighbours in memory, and draws do not depend on the file's order.
        let Ordered { mesh, former } = ordered(&fine.mesh);
        let parents: Vec<u32> = former.iter().map(|&face| fine.parents[face as usize]).collect();
        Ok((Working::new(mesh), parents))
    })?;
    let start = initial_labels
        .map(|labels| parents.iter().map(|&parent| labels[parent as usize]).collect());
    let outcome = method(context, &working, start)?;
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Vector;
    use crate::mesh::samples::{Sample, can, cube};
    use crate::partition::{components, region_count};

    /// In millimetres, far from the origin.
    fn scaled(sample: Sample) -> Mesh {
        let place = |p: &crate::math::Point| p * 250.0 + Vector::new(1000.0, -500.0, 30.0);
        Mesh { positions: sample.mesh.positions.iter().map(place).collect(), ..sample.mesh }
    }

    #[test]
    fn proxies_fit_the_regions_in_the_units_of_the_input() {
        // Edges of 25 mm in a part of 250: they are subdivided.
        let mesh = scaled(cube(10));
        let found = paper(&mut Context::new(0), &mesh, &Options::default(), None).unwrap();
        assert_eq!((found.labels.len(), found.proxies.len()), (mesh.faces.len(), 6));
        for (face, &label) in found.labels.iter().enumerate() {
            for corner in mesh.corners(face) {
                let off = found.proxies[label as usize].distance(corner).unwrap();
                assert!(off.abs() < 1e-9 * 250.0, "{off}");
            }
        }
        assert_eq!(found.repairs, []);
    }

    #[test]
    fn a_coarse_can_comes_back_in_connected_regions() {
        // Far fewer faces than the subdivided mesh has: boundaries must find the input's edges.
        let mesh = scaled(can(3));
        for regions in [None, Some(3), Some(8)] {
            let options = Options { regions, ..Options::default() };
            let found = paper(&mut Context::new(1), &mesh, &options, None).unwrap();
            let input = Working::new(mesh.clone());
            let (_, sizes) = components(&found.labels, &input.adjacency);
            assert_eq!(sizes.len(), region_count(&found.labels));
            assert_eq!(sizes.len(), found.proxies.len());
        }
    }

    #[test]
    fn a_start_replaces_the_detection() {
        let Sample { mesh, labels } = can(8);
        let mut context = Context::new(0);
        let found = paper(&mut context, &mesh, &Options::default(), Some(&labels)).unwrap();
        assert_eq!(found.labels, labels);
        assert!(context.timing().iter().all(|(stage, _)| *stage != "detect"));
        let short = paper(&mut context, &mesh, &Options::default(), Some(&labels[1..]));
        assert!(matches!(short, Err(Error::Option(_))));
    }

    #[test]
    fn the_order_of_the_faces_in_the_file_does_not_matter() {
        let mesh = scaled(can(10));
        let turned = Mesh { faces: mesh.faces.iter().rev().copied().collect(), ..mesh.clone() };
        let options = Options { regions: Some(5), ..Options::default() };
        let of = |mesh| paper(&mut Context::new(3), mesh, &options, None).unwrap();
        let (one, other) = (of(&mesh), of(&turned));
        let mut pairs: Vec<_> = one.labels.iter().zip(other.labels.iter().rev()).collect();
        pairs.sort_unstable();
        pairs.dedup();
        // The same regions, which may bear other numbers.
        assert_eq!((pairs.len(), one.energy), (5, other.energy));
    }

    #[test]
    fn the_same_seed_gives_the_same_result_with_any_number_of_threads() {
        let mesh = scaled(can(10));
        let options = Options { regions: Some(5), ..Options::default() };
        let with = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| paper(&mut Context::new(3), &mesh, &options, None).unwrap())
        };
        let (one, three) = (with(1), with(3));
        assert_eq!((one.labels, one.energy), (three.labels, three.energy));
        assert_eq!(one.proxies, three.proxies);
    }
}
