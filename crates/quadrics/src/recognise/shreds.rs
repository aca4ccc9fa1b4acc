//! Scans in shreds: of a wall thinner than the spacing of its scan the mesh is hundreds of loose tubes,
//! each with faces of both sides and normals in all directions.
//!
//! What is left to trust are the places of the vertices. Planes are sought among them across the gaps
//! ([`super::sheets`]); where their distances from a plane gather around two levels, those are the two
//! sides of a wall. Every face goes to the level that its corners are nearest to.

use rayon::prelude::*;

use super::Outcome;
use super::cells::Cells;
use super::levels::Levels;
use super::scene::Scene;
use super::sheets::{Sheet, find};
use crate::context::Context;
use crate::error::Result;
use crate::partition::{Labels, UNLABELLED, compact, components};
use crate::surface::{Plane, Shape, Surface};

/// A mesh in so many pieces, the largest of less than half of the faces, is in shreds (the scans of six
/// sheets have 195 to 340, others at most ten; decision 0002).
const PIECES: usize = 50;
/// So many planes must explain this share of the vertices: a curved shell is cut into more (0.73 on a bent
/// sheet of planes, 0.33 to 0.44 on shells).
const LARGE: usize = 5;
const EXPLAINED: f64 = 0.6;
/// About the levels of a flat wall vertices err by less than this share of an edge (a sixth on a bent sheet
/// of planes, most of one where shells are curved).
const FLAT: f64 = 1.0 / 3.0;

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
    let levels: Vec<Levels> = sheets.iter().map(|sheet| sheet.levels(points)).collect();
    let flat = sheets.iter().zip(&levels).filter(|(_, levels)| levels.sigma < FLAT * scene.edge);
    let mut sizes: Vec<usize> = flat.map(|(sheet, _)| sheet.points.len()).collect();
    sizes.sort_unstable_by(|one, other| other.cmp(one));
    let explained: usize = sizes.iter().take(LARGE).sum();
    if (explained as f64) < EXPLAINED * points.len() as f64 {
        return Ok(None);
    }
    let (labels, surfaces) = divide(scene, &cells, &sheets, &levels);
    let mut errors: Vec<f64> = levels.iter().map(|levels| levels.sigma).collect();
    errors.sort_by(f64::total_cmp);
    let sigma = errors[errors.len() / 2];
    scene.evidence.sigma = sigma;
    Ok(Some(Outcome { labels, surfaces, energy: Vec::new() }))
}

fn in_shreds(scene: &Scene) -> bool {
    let (_, sizes) = components(&vec![0; scene.mesh.faces.len()], scene.adjacency);
    let largest = sizes.iter().max().map_or(0, |&size| size as usize);
    sizes.len() >= PIECES && 2 * largest < scene.mesh.faces.len()
}

/// The faces to the sides of sheets that they are nearest to.
fn divide(
    scene: &Scene,
    cells: &Cells,
    sheets: &[Sheet],
    levels: &[Levels],
) -> (Labels, Vec<Surface>) {
    // Planes, each with the number of its sheet.
    let sides: Vec<(usize, Plane)> = sheets
        .iter()
        .zip(levels)
        .enumerate()
        .flat_map(|(i, (sheet, levels))| levels.sides(&sheet.plane).map(move |side| (i, side)))
        .collect();
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
    (labels, surfaces)
}
