//! The noise seen by whole regions: its standard deviation and its correlation.
//!
//! Small neighbourhoods miss the waviness of a scan and mistake curvature for noise; regions grown
//! from probes tell both apart. The estimate is repeated until what it grows agrees with it.

use rand::RngExt;
use rayon::prelude::*;

use super::detect::{Workspace, propose};
use super::scene::{ROUNDING, Scene};
use crate::context::Context;
use crate::error::Result;
use crate::partition::UNLABELLED;
use crate::surface::Surface;
use crate::surface::select::Evidence;

/// Regions that are grown per round, and rounds.
const PROBES: usize = 32;
const ROUNDS: usize = 5;
/// Residuals beyond 2.5 sigma are not in the region: the rest scatter less by this factor.
const TRUNCATION: f64 = 1.1;
/// Fewest faces of a region that speaks.
const FEWEST: usize = 60;
/// The estimate is good when it changes by less than this factor.
const SETTLED: f64 = 1.06;
/// Quantile of the regions that speaks for all: those that took in a neighbour scatter more.
const QUANTILE: f64 = 0.3;
/// Correlation of residuals across an edge above which the noise is that of a scan. Independent
/// noise leaves about 0, waviness of four edges about 0.8.
const CORRELATED: f64 = 0.3;
/// Independent samples over vertices on scans; the choice of types hardly depends on it.
const INDEPENDENT: f64 = 0.05;

/// Below it a mesh is clean, and a quadric that fits is the surface; above, quadrics bridge creases.
const QUIET: f64 = 20.0 * ROUNDING;

/// What a probe saw: deviation, its correlation across edges, deviation of normals, faces.
struct Row {
    sigma: f64,
    correlation: f64,
    turn: f64,
    faces: f64,
}

/// Replaces the local estimate of the noise by that of whole regions.
///
/// # Errors
/// Cancellation.
pub fn measure(context: &mut Context, scene: &mut Scene) -> Result<()> {
    let local = scene.evidence.sigma;
    let expected = scene.evidence.normal_sigma;
    for round in 0..ROUNDS {
        context.step("noise", round as f64 / ROUNDS as f64)?;
        let mut rows = probe(context, scene, PROBES);
        if rows.is_empty() {
            return Ok(());
        }
        let before = scene.evidence.sigma;
        let sigma = (TRUNCATION * quantile(&mut rows, |row| row.sigma)).max(ROUNDING);
        let correlated = quantile(&mut rows, |row| row.correlation) > CORRELATED;
        // Regions show how good normals are far from creases; near them they are no better than expected.
        let turn = quantile(&mut rows, |row| row.turn).max(expected);
        let known = Evidence { normal_sigma: turn, ..scene.evidence };
        if correlated && sigma > 2.0 * ROUNDING {
            scene.evidence = Evidence { sigma, independent: INDEPENDENT, ..known };
        } else {
            // Independent noise shows in small neighbourhoods already; whole regions can only tell
            // that curvature was mistaken for it.
            scene.evidence = Evidence { sigma: sigma.min(local), independent: 1.0, ..known };
        }
        scene.evidence.general = scene.evidence.sigma < QUIET;
        if (1.0 / SETTLED..SETTLED).contains(&(scene.evidence.sigma / before)) {
            break;
        }
    }
    coarsen(context, scene)
}

/// Seeds that are asked whether a scale explains the mesh, and the least share that must be: less
/// where the mesh is exact, as what is left then are small surfaces.
const ASKED: usize = 64;
const EXPLAINED: f64 = 0.8;
const EXPLAINED_SCAN: f64 = 0.9;
/// How much coarser the next scale is, and the coarsest, in sizes: beyond it all evidence is noise.
const COARSER: f64 = 3.0;
const COARSEST: f64 = 1e-3;

/// Raises sigma until it explains most of the mesh.
///
/// Real meshes may be exact on planes and lie off curved surfaces by the sagitta of the facets that
/// they were made from, or by what a remesher rounded; the planes alone say that there is no noise.
/// The first scale that explains the mesh barely does: the next one is taken.
fn coarsen(context: &mut Context, scene: &mut Scene) -> Result<()> {
    let share = if scene.correlated() { EXPLAINED_SCAN } else { EXPLAINED };
    let mut raised = false;
    let mut explained = false;
    while !explained && scene.evidence.sigma < COARSEST {
        context.step("noise", 1.0)?;
        explained = probe(context, scene, ASKED).len() as f64 >= share * ASKED as f64;
        if explained && !raised {
            return Ok(());
        }
        let sigma = (COARSER * scene.evidence.sigma).min(COARSEST);
        scene.evidence =
            Evidence { sigma, independent: INDEPENDENT, general: sigma < QUIET, ..scene.evidence };
        raised = true;
    }
    Ok(())
}

/// What grows from so many random seeds and is large enough to speak.
fn probe(context: &mut Context, scene: &Scene, seeds: usize) -> Vec<Row> {
    let unlabelled = vec![UNLABELLED; scene.mesh.faces.len()];
    let seeds: Vec<u32> =
        (0..seeds).map(|_| context.rng.random_range(0..unlabelled.len() as u32)).collect();
    seeds
        .into_par_iter()
        .map_init(Workspace::default, |work, seed| propose(scene, seed, &unlabelled, work))
        .flatten()
        .filter(|grown| grown.faces.len() >= FEWEST)
        .map(|grown| scatter(scene, &grown.choice.surface, &grown.faces))
        .collect()
}

/// Root mean square residual over the corners of some faces, and its correlation across edges.
fn scatter(scene: &Scene, surface: &Surface, faces: &[u32]) -> Row {
    let (mut squares, mut products, mut turns) = (0.0, 0.0, 0.0);
    for &face in faces {
        let [a, b, c] =
            scene.mesh.corners(face as usize).map(|p| surface.distance(p).unwrap_or(0.0));
        squares += a * a + b * b + c * c;
        products += a * b + b * c + c * a;
        let normal = surface.normal(scene.geometry.barycentres[face as usize]);
        turns += normal.map_or(0.0, |n| 2.0 - 2.0 * n.dot(&scene.normals[face as usize]).abs());
    }
    let faces = faces.len() as f64;
    let correlation = if squares > 0.0 { products / squares } else { 0.0 };
    Row {
        sigma: (squares / (3.0 * faces)).sqrt(),
        correlation,
        turn: (turns / faces).sqrt(),
        faces,
    }
}

/// The quantile of the rows, each counting as many times as it has faces.
fn quantile(rows: &mut [Row], of: impl Fn(&Row) -> f64) -> f64 {
    rows.sort_by(|a, b| of(a).total_cmp(&of(b)));
    let goal = QUANTILE * rows.iter().map(|row| row.faces).sum::<f64>();
    let mut sum = 0.0;
    rows.iter()
        .find(|row| {
            sum += row.faces;
            sum >= goal
        })
        .map_or(0.0, of)
}
