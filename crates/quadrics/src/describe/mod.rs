//! What the result says of every region, from labels and the surfaces that they were recognised by.

mod confidence;
mod fit;
mod signs;

pub use confidence::{confidence, is_noteworthy};
pub use fit::{Recognised, fit, settled};

use rayon::prelude::*;

use signs::Reader;

use crate::context::Context;
use crate::error::Result;
use crate::math::{Point, Similarity};
use crate::mesh::{Adjacency, NONE};
use crate::partition::Regions;
use crate::recognise::assign::models;
use crate::recognise::scene::{Marks, Scene};
use crate::result::{Region, Side};
use crate::surface::{Cylinder, Scatter, Surface, Waves, centroid, uncertainty};

/// Regions between two looks at the clock.
const CHUNK: usize = 32;

/// Descriptions of all regions, and the deviation of normals over all of them.
#[derive(Debug, Clone, Default)]
pub struct Described {
    /// In the frame that `out` leads to.
    pub regions: Vec<Region>,
    /// Standard deviation of the face normals from those of the surfaces, in degrees.
    pub normal_deg: f64,
}

/// Fits every region of `labels` anew; `surfaces` has what each was recognised by, in the unit cube.
///
/// # Errors
/// Cancellation.
pub fn fit_all(
    context: &mut Context,
    scene: &Scene,
    labels: &[u32],
    surfaces: &[Surface],
) -> Result<Vec<Recognised>> {
    let regions = Regions::new(labels);
    let mut found = Vec::with_capacity(surfaces.len());
    for (chunk, known) in surfaces.chunks(CHUNK).enumerate() {
        let first = chunk * CHUNK;
        context.step("describe", first as f64 / surfaces.len() as f64)?;
        let one = |marks: &mut Marks, (i, known): (usize, &Surface)| {
            fit(scene, regions.faces(first + i), known, marks)
        };
        found.par_extend(known.par_iter().enumerate().map_init(Marks::default, one));
    }
    if scene.correlated() {
        let fits: Vec<_> = found.iter().map(|fit| (&fit.surface, fit.support.as_slice())).collect();
        let waves = Waves::measure(&fits);
        found.iter_mut().for_each(|fit| fit.waves = waves);
    }
    Ok(found)
}

/// Describes the regions of `labels` on the mesh of `scene`, which lies in the unit cube; `found`
/// has the surface of every label, in that cube, and `out` leads from it to the frame of the result.
pub fn describe(
    scene: &Scene,
    labels: &[u32],
    found: &[Recognised],
    out: &Similarity,
) -> Described {
    let regions = Regions::new(labels);
    let neighbours = neighbours(labels, scene.adjacency, regions.len());
    let models = models(scene, &regions, found.iter().map(|found| &found.surface));
    let reader = Reader { scene, labels, models: &models };
    let mut described = Described::default();
    let mut angles = Vec::new();
    let rows: Vec<_> = found
        .par_iter()
        .enumerate()
        .map_init(Marks::default, |marks, (i, found)| {
            let (mut region, angles) = one(scene, regions.faces(i), found, out, marks);
            // Either doubt suffices: about the type, or about the extent.
            if let Some(signs) = reader.read(i, regions.faces(i), marks) {
                region.confidence = region.confidence.min(signs.probability());
            }
            (region, angles)
        })
        .collect();
    for (region, own) in rows {
        described.regions.push(region);
        angles.extend(own);
    }
    for (id, (region, neighbours)) in described.regions.iter_mut().zip(neighbours).enumerate() {
        region.id = id as u32;
        region.neighbours = neighbours;
    }
    described.normal_deg = rayleigh(&mut angles);
    described
}

/// Everything of one region but its place among the others, and the angles of its face normals.
fn one(
    scene: &Scene,
    faces: &[u32],
    found: &Recognised,
    out: &Similarity,
    marks: &mut Marks,
) -> (Region, Vec<f64>) {
    let (surface, side) = oriented(scene, faces, found.surface.clone());
    let surface = anchored(surface, &found.support);
    let scale = out.scaling();
    let deviations = deviations(scene, faces, &surface, marks);
    let angles = angles(scene, faces, &surface, side);
    let area: f64 = faces.iter().map(|&face| scene.geometry.areas[face as usize]).sum();
    let weigh = |(&face, angle): (&u32, &f64)| scene.geometry.areas[face as usize] * angle;
    let turned: f64 = faces.iter().zip(&angles).map(weigh).sum();
    let region = Region {
        id: 0,
        side,
        confidence: found.confidence,
        runner_up: found.runner_up.as_ref().map(|other| other.class_name(1.0)),
        faces: faces.len(),
        area: area * scale * scale,
        rms: deviations.map(|(rms, _)| rms * scale),
        max_deviation: deviations.map(|(_, most)| most * scale),
        mean_normal_deviation_deg: deviations.map(|_| turned / area.max(f64::MIN_POSITIVE)),
        uncertainty: known(&surface, found, out),
        neighbours: Vec::new(),
        surface: surface.transformed(out),
    };
    (region, angles)
}

/// How well the parameters are known: under the relations where there are some.
fn known(surface: &Surface, found: &Recognised, out: &Similarity) -> Vec<(&'static str, f64)> {
    let Some(scatter) = &found.scatter else {
        return uncertainty(surface, &found.support, found.sigma, out);
    };
    let anchor = |surface: &Surface| anchored(surface.clone(), &found.support);
    let moved = scatter.moved.iter().map(|both| both.each_ref().map(anchor)).collect();
    let scatter = Scatter { moved, ..scatter.clone() };
    scatter.uncertainty(&anchor(&found.surface), out)
}

/// The surface with a plane's normal outward by the mesh, and the side of the material.
fn oriented(scene: &Scene, faces: &[u32], surface: Surface) -> (Surface, Side) {
    let along = |&face: &u32| {
        let face = face as usize;
        let normal = surface.normal(scene.geometry.barycentres[face])?;
        Some(scene.geometry.areas[face] * normal.dot(&scene.geometry.normals[face]))
    };
    let agrees = faces.iter().filter_map(along).sum::<f64>() >= 0.0;
    match surface {
        Surface::Plane(mut plane) if !agrees => {
            (plane.normal, plane.offset) = (-plane.normal, -plane.offset);
            (Surface::Plane(plane), Side::Outside)
        }
        Surface::Quadric(quadric) => {
            // Like a sphere's, normals look away from the centre; a saddle's go with the mesh.
            let (_, _, form) = quadric.parts();
            let values = form.symmetric_eigenvalues();
            let flat = 1e-3 * values.amax();
            let sign = |value: &f64| if value.abs() > flat { value.signum() } else { 0.0 };
            let sum: f64 = values.iter().map(sign).sum();
            let flip = if sum == 0.0 { !agrees } else { sum < 0.0 };
            let side = if agrees != flip { Side::Outside } else { Side::Inside };
            (Surface::Quadric(if flip { quadric.flipped() } else { quadric }), side)
        }
        other => (other, if agrees { Side::Outside } else { Side::Inside }),
    }
}

/// The surface with the point of a cylinder's axis beside the data, where it is known best.
fn anchored(surface: Surface, support: &[Point]) -> Surface {
    match (surface, centroid(support)) {
        (Surface::Cylinder(s), Some(near)) => {
            let point = s.point + s.axis.into_inner() * s.axis.dot(&(near - s.point));
            Surface::Cylinder(Cylinder { point, ..s })
        }
        (other, _) => other,
    }
}

/// Root mean square and largest distance of the vertices of some faces.
fn deviations(
    scene: &Scene,
    faces: &[u32],
    surface: &Surface,
    marks: &mut Marks,
) -> Option<(f64, f64)> {
    marks.clear(scene.mesh.positions.len());
    let (mut squares, mut most, mut count) = (0.0, 0f64, 0usize);
    for &vertex in faces.iter().flat_map(|&face| &scene.mesh.faces[face as usize]) {
        if marks.mark(vertex) {
            let distance = surface.distance(scene.mesh.positions[vertex as usize])?;
            squares += distance * distance;
            most = most.max(distance.abs());
            count += 1;
        }
    }
    Some(((squares / count.max(1) as f64).sqrt(), most))
}

/// Angles between the normals of faces and of their surface, in degrees; empty for free-form.
fn angles(scene: &Scene, faces: &[u32], surface: &Surface, side: Side) -> Vec<f64> {
    if matches!(surface, Surface::FreeForm) {
        return Vec::new();
    }
    let sign = if side == Side::Outside { 1.0 } else { -1.0 };
    let angle = |&face: &u32| {
        let face = face as usize;
        // On an axis or in a centre there is no normal to deviate from.
        surface.normal(scene.geometry.barycentres[face]).map_or(0.0, |normal| {
            // Between unit vectors, exact for small angles too.
            let chord = (normal.into_inner() * sign - scene.geometry.normals[face]).norm();
            (2.0 * (chord / 2.0).min(1.0).asin()).to_degrees()
        })
    };
    faces.iter().map(angle).collect()
}

/// Standard deviation per direction of angles in two, by their median: creases do not count.
fn rayleigh(angles: &mut [f64]) -> f64 {
    let middle = angles.len() / 2;
    if angles.is_empty() {
        return 0.0;
    }
    *angles.select_nth_unstable_by(middle, f64::total_cmp).1 / (2.0 * 2f64.ln()).sqrt()
}

/// For every region the regions across its edges, ascending.
/// The regions that share an edge with each, ascending.
pub fn neighbours(labels: &[u32], adjacency: &Adjacency, count: usize) -> Vec<Vec<u32>> {
    let mut pairs = Vec::new();
    for (face, &label) in labels.iter().enumerate() {
        for other in adjacency.neighbours[face] {
            if other != NONE && labels[other as usize] != label {
                pairs.push((label, labels[other as usize]));
            }
        }
    }
    pairs.sort_unstable();
    pairs.dedup();
    let mut neighbours = vec![Vec::new(); count];
    pairs.into_iter().for_each(|(region, other)| neighbours[region as usize].push(other));
    neighbours
}
