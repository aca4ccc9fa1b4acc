//! Scans in shreds: of a wall thinner than the spacing of its scan the mesh is hundreds of loose tubes,
//! each with faces of both sides and normals in all directions.
//!
//! What is left to trust are the places of the vertices. Planes are sought among them across the gaps
//! ([`super::sheets`]); where their distances from a plane gather around two levels, those are the two
//! sides of a wall. Every face goes to the level that its corners are nearest to.

use rayon::prelude::*;

use super::Outcome;
use super::cells::Cells;
use super::levels::levels;
use super::scene::Scene;
use super::sheets::{Sheet, find};
use crate::context::Context;
use crate::error::Result;
use crate::partition::{Labels, UNLABELLED, compact, components};
use crate::surface::{Plane, Shape, Surface};

/// A mesh in so many pieces, the largest of less than half of the faces, is in shreds (the scans of six
/// sheets have 195 to 340, others at most ten; decision 0002).
const PIECES: usize = 50;
/// Planes must explain this share of the vertices, or the part is not made of them.
const EXPLAINED: f64 = 0.75;

/// The planes of a scan in shreds, if it is one and they explain it; `scene` learns its noise.
///
/// # Errors
/// Cancellation.
pub fn recognise(context: &mut Context, scene: &mut Scene) -> Result<Option<Outcome>> {
    if scene.evidence.is_quiet() || !in_shreds(scene) {
        return Ok(None);
    }
    let points = &scene.mesh.positions;
    let cells = Cells::new(points, scene.edge);
    let sheets = find(context, points, &cells, scene.edge)?;
    let explained: usize = sheets.iter().map(|sheet| sheet.points.len()).sum();
    if (explained as f64) < EXPLAINED * points.len() as f64 {
        return Ok(None);
    }
    let (labels, surfaces, sigma) = divide(scene, &cells, &sheets);
    scene.evidence.sigma = sigma;
    Ok(Some(Outcome { labels, surfaces, energy: Vec::new() }))
}

fn in_shreds(scene: &Scene) -> bool {
    let (_, sizes) = components(&vec![0; scene.mesh.faces.len()], scene.adjacency);
    let largest = sizes.iter().max().map_or(0, |&size| size as usize);
    sizes.len() >= PIECES && 2 * largest < scene.mesh.faces.len()
}

/// The faces to the sides of sheets that they are nearest to, and how much vertices err about those.
fn divide(scene: &Scene, cells: &Cells, sheets: &[Sheet]) -> (Labels, Vec<Surface>, f64) {
    let points = &scene.mesh.positions;
    // Planes, each with the number of its sheet.
    let mut sides: Vec<(usize, Plane)> = Vec::new();
    let mut errors = Vec::new();
    for (sheet, Sheet { plane, points: own }) in sheets.iter().enumerate() {
        let levels = levels(own.iter().map(|&v| plane.distance(points[v as usize])).collect());
        errors.push(levels.sigma);
        sides.extend(levels.sides(plane).map(|side| (sheet, side)));
    }
    let beside = cells.marked(sheets.iter().map(|sheet| &sheet.points[..]));
    let nearest = |face: usize| {
        let corners = scene.mesh.corners(face);
        let here = &beside[cells.of(scene.mesh.faces[face][0]) as usize];
        // What no sheet is beside goes to whichever it lies on.
        let asked = |side: &usize| here.is_empty() || here.contains(&sides[*side].0);
        let cost = |side: &usize| -> f64 {
            corners.iter().map(|&p| sides[*side].1.distance(p).powi(2)).sum()
        };
        let nearer = |one: &usize, other: &usize| cost(one).total_cmp(&cost(other));
        (0..sides.len()).filter(asked).min_by(nearer).map_or(UNLABELLED, |side| side as u32)
    };
    let former: Labels = (0..scene.mesh.faces.len()).into_par_iter().map(nearest).collect();
    let mut labels = former.clone();
    let mut surfaces = vec![Surface::FreeForm; compact(&mut labels)];
    for (&new, &old) in labels.iter().zip(&former) {
        surfaces[new as usize] = Surface::Plane(sides[old as usize].1.clone());
    }
    errors.sort_by(f64::total_cmp);
    (labels, surfaces, errors[errors.len() / 2])
}
