//! The noise seen by whole regions: its standard deviation and its correlation.
//!
//! Small neighbourhoods miss the waviness of a scan and mistake curvature for noise; regions grown
//! from probes tell both apart. The estimate is repeated until what it grows agrees with it.

use rand::RngExt;

use super::detect::{Workspace, propose};
use super::scene::{ROUNDING, Scene};
use crate::context::Context;
use crate::error::Result;
use crate::partition::UNLABELLED;
use crate::surface::Surface;
use crate::surface::select::Evidence;

/// Regions that are grown per round, and rounds.
const PROBES: usize = 48;
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

/// What a probe saw: deviation, correlation across edges, faces.
struct Row {
    sigma: f64,
    correlation: f64,
    faces: f64,
}

/// Replaces the local estimate of the noise by that of whole regions.
///
/// # Errors
/// Cancellation.
pub fn measure(context: &mut Context, scene: &mut Scene) -> Result<()> {
    let local = scene.evidence.sigma;
    for round in 0..ROUNDS {
        context.step("noise", round as f64 / ROUNDS as f64)?;
        let mut rows = probe(context, scene);
        if rows.is_empty() {
            return Ok(());
        }
        let before = scene.evidence.sigma;
        let sigma = (TRUNCATION * quantile(&mut rows, |row| row.sigma)).max(ROUNDING);
        let correlated = quantile(&mut rows, |row| row.correlation) > CORRELATED;
        if correlated && sigma > 2.0 * ROUNDING {
            scene.evidence = Evidence { sigma, independent: INDEPENDENT };
        } else {
            // Independent noise shows in small neighbourhoods already; whole regions can only tell
            // that curvature was mistaken for it.
            scene.evidence = Evidence { sigma: sigma.min(local), independent: 1.0 };
        }
        if (1.0 / SETTLED..SETTLED).contains(&(scene.evidence.sigma / before)) {
            break;
        }
    }
    Ok(())
}

fn probe(context: &mut Context, scene: &Scene) -> Vec<Row> {
    let unlabelled = vec![UNLABELLED; scene.mesh.faces.len()];
    let mut work = Workspace::default();
    let seeds: Vec<u32> =
        (0..PROBES).map(|_| context.rng.random_range(0..unlabelled.len() as u32)).collect();
    let grown = seeds.into_iter().filter_map(|seed| propose(scene, seed, &unlabelled, &mut work));
    grown
        .filter(|grown| grown.faces.len() >= FEWEST)
        .map(|grown| scatter(scene, &grown.choice.surface, &grown.faces))
        .collect()
}

/// Root mean square residual over the corners of some faces, and its correlation across edges.
fn scatter(scene: &Scene, surface: &Surface, faces: &[u32]) -> Row {
    let (mut squares, mut products) = (0.0, 0.0);
    for &face in faces {
        let [a, b, c] =
            scene.mesh.corners(face as usize).map(|p| surface.distance(p).unwrap_or(0.0));
        squares += a * a + b * b + c * c;
        products += a * b + b * c + c * a;
    }
    let faces = faces.len() as f64;
    let correlation = if squares > 0.0 { products / squares } else { 0.0 };
    Row { sigma: (squares / (3.0 * faces)).sqrt(), correlation, faces }
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
