//! The noise seen by whole regions: its standard deviation and its correlation.
//!
//! Small neighbourhoods miss the waviness of a scan and mistake curvature for noise; regions grown
//! from probes tell both apart. The estimate is repeated until what it grows agrees with it.

use rand::RngExt;
use rayon::prelude::*;

use super::detect::{Candidate, Growth, most_misfit, propose};
use super::pool::Pool;
use super::scene::Scene;
use crate::context::Context;
use crate::error::Result;
use crate::math::Point;
use crate::partition::{Regions, UNLABELLED};
use crate::prepare::noise::ROUNDING;
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
/// Correlation of residuals across an edge below which noise is independent: it leaves about 0.05,
/// waviness that a small neighbourhood does not show 0.25 and more.
const UNCORRELATED: f64 = 0.2;
/// Noise is independent where so many of the grown regions scatter no more than the local estimate
/// and do not correlate. Measured, three seeds on parts that are hard to tell: 0.22 and more with
/// independent noise (one part 0.06 to 0.13), at most 0.19 on scans.
const PLAIN: f64 = 0.2;
/// Correlation above which the noise of regions that are known is that of a scan.
const CORRELATED: f64 = 0.3;
/// Independent samples over vertices on scans; the choice of types hardly depends on it.
const INDEPENDENT: f64 = 0.05;

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
    if scene.tessellated {
        return Ok(());
    }
    let local = scene.evidence.sigma;
    let expected = scene.evidence.normal_sigma;
    let mut correlated = false;
    for round in 0..ROUNDS {
        context.step("noise", round as f64 / ROUNDS as f64)?;
        let mut rows: Vec<Row> = probe(scene, &seeds(context, scene, PROBES))
            .into_par_iter()
            .flatten()
            .filter(|grown| grown.faces.len() >= FEWEST)
            .map(|grown| scatter(scene, &grown.choice.surface, &grown.faces))
            .collect();
        if rows.is_empty() {
            return Ok(());
        }
        let before = scene.evidence.sigma;
        let sigma = (TRUNCATION * quantile(&mut rows, |row| row.sigma)).max(ROUNDING);
        if round == 0 {
            let together = quantile(&mut rows, |row| row.correlation) > UNCORRELATED;
            correlated = together && !independent(&rows, before);
        }
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
        scene.evidence.general = scene.evidence.is_quiet();
        if (1.0 / SETTLED..SETTLED).contains(&(scene.evidence.sigma / before)) {
            break;
        }
    }
    if scene.correlated() && scene.evidence.sigma < EXACT && !explained(context, scene)? {
        coarsen(context, scene)?;
    }
    Ok(())
}

/// Whether the estimate of small neighbourhoods speaks for whole regions. Each counts once: a large
/// one may have taken in its neighbours.
fn independent(rows: &[Row], sigma: f64) -> bool {
    let plain = |row: &&Row| {
        (row.sigma / sigma).powi(2) < most_misfit(row.faces as usize)
            && row.correlation < UNCORRELATED
    };
    rows.iter().filter(plain).count() as f64 > PLAIN * rows.len() as f64
}

/// Faces of a region that are asked how they err.
const HEARD: usize = 2000;
/// From the median absolute deviation to the standard deviation.
const MEDIAN: f64 = 1.4826;
/// Residuals beyond so many sigmas are not of the region.
const REACH: f64 = 2.5;

/// Distance from its surface that this share of the vertices of each region keep; none of a small one.
pub fn distances(scene: &Scene, surfaces: &[Surface], labels: &[u32], share: f64) -> Vec<f64> {
    let regions = Regions::new(labels);
    let of_region = |(faces, surface): (&[u32], &Surface)| {
        if faces.len() < FEWEST || matches!(surface, Surface::FreeForm) {
            return 0.0;
        }
        let corner = |face: &u32| scene.mesh.corners(*face as usize)[0];
        let heard = faces.iter().step_by((faces.len() / HEARD).max(1));
        let mut distances: Vec<f64> = heard.map(|f| away(surface, corner(f))).collect();
        let at = (share * distances.len() as f64) as usize;
        *distances.select_nth_unstable_by(at, f64::total_cmp).1
    };
    let pairs: Vec<_> = regions.iter().zip(surfaces).collect();
    pairs.into_par_iter().map(of_region).collect()
}

fn away(surface: &Surface, point: Point) -> f64 {
    surface.distance(point).map_or(f64::INFINITY, f64::abs)
}

/// A vertex that is farther from its surface than this share of its region is another one's.
const MOST: f64 = 0.95;

/// The noise of a mesh whose surfaces are known from a coarser one: its sigma, where that of the
/// coarser one is of means of its vertices, and whether its neighbours err together.
pub fn carried(scene: &mut Scene, surfaces: &[Surface], labels: &[u32], means: bool) {
    let regions = Regions::new(labels);
    let deviations: Vec<f64> = if means {
        // Some vertices may not err at all: the median says nothing of the others.
        let most = distances(scene, surfaces, labels, MOST);
        let all: Vec<_> = regions.iter().zip(surfaces).zip(most).collect();
        all.into_par_iter().map(|((faces, s), most)| deviation(scene, s, faces, most)).collect()
    } else {
        distances(scene, surfaces, labels, 0.5).into_iter().map(|d| MEDIAN * d).collect()
    };
    let hear = |((faces, surface), sigma): ((&[u32], &Surface), f64)| {
        let near = |face: &u32| {
            let corners = scene.mesh.corners(*face as usize);
            corners.iter().all(|p| away(surface, *p) <= REACH * sigma)
        };
        let heard = faces.iter().step_by((faces.len() / HEARD).max(1));
        let heard: Vec<u32> = heard.copied().filter(near).collect();
        (heard.len() >= FEWEST).then(|| Row { sigma, ..scatter(scene, surface, &heard) })
    };
    let all: Vec<_> = regions.iter().zip(surfaces).zip(deviations).collect();
    let known = all.into_par_iter().filter(|row| row.1 > 0.0);
    let mut rows: Vec<Row> = known.filter_map(hear).collect();
    let sigma = quantile(&mut rows, |row| row.sigma).max(ROUNDING);
    if means && !rows.is_empty() {
        scene.evidence.sigma = sigma;
    }
    if sigma > 2.0 * ROUNDING && quantile(&mut rows, |row| row.correlation) > CORRELATED {
        // What is measured on the means of cells holds for the vertices of each together.
        let together = if means { f64::from(scene.grain) } else { 1.0 };
        scene.evidence.independent = INDEPENDENT / together;
    }
}

/// Root mean square distance of a region's vertices, each at most `most`.
fn deviation(scene: &Scene, surface: &Surface, faces: &[u32], most: f64) -> f64 {
    let heard = faces.iter().step_by((faces.len() / HEARD).max(1));
    let away = |&face: &u32| away(surface, scene.mesh.corners(face as usize)[0]).min(most);
    let squares: Vec<f64> = heard.map(|face| away(face).powi(2)).collect();
    (squares.iter().sum::<f64>() / squares.len().max(1) as f64).sqrt()
}

/// Where whole regions scatter by more, in sizes, it is noise and not the facets of some of them.
const EXACT: f64 = 0.5 * COARSEST;
/// How much coarser the next scale is.
const COARSER: f64 = 3.0;
/// The coarsest scale, in sizes: beyond it all evidence is noise.
pub const COARSEST: f64 = 1e-3;

/// Raises sigma until it explains most of the mesh.
///
/// Real meshes may be exact on planes and lie off curved surfaces by the sagitta of the facets that
/// they were made from, or by what a remesher rounded; the planes alone say that there is no noise.
/// The first scale that explains the mesh barely does: the next one is taken.
///
/// # Errors
/// Cancellation.
pub fn coarsen(context: &mut Context, scene: &mut Scene) -> Result<()> {
    loop {
        let enough = scene.correlated() && explained(context, scene)?;
        let sigma = (COARSER * scene.evidence.sigma).min(COARSEST);
        scene.evidence = Evidence { sigma, independent: INDEPENDENT, ..scene.evidence };
        scene.evidence.general = scene.evidence.is_quiet();
        if enough || sigma >= COARSEST {
            return Ok(());
        }
    }
}

/// Seeds that are asked at once whether a scale explains the mesh, and how often at most.
const ASKED: usize = 64;
const TIMES: usize = 6;
/// The least share of them that must lie in the region of some size that grows from them.
const EXPLAINED: f64 = 0.9;
/// A share that is so many of its standard deviations away from that needs no more seeds.
const DOUBT: f64 = 2.5;

/// Whether most faces lie in the region that grows from them, and it is of some size.
///
/// A face that only the region of another seed covers does not count: how many there are depends on
/// the seeds that were drawn.
fn explained(context: &mut Context, scene: &Scene) -> Result<bool> {
    let (mut grown, mut asked) = (0.0, 0.0);
    for round in 0..TIMES {
        context.step("noise", round as f64 / TIMES as f64)?;
        let seeds = seeds(context, scene, ASKED);
        let explains = |(seed, grown): (&u32, Option<Candidate>)| {
            grown.is_some_and(|g| g.faces.len() >= FEWEST && g.faces.contains(seed))
        };
        let large = seeds.iter().zip(probe(scene, &seeds)).map(explains).filter(|&yes| yes).count();
        asked += seeds.len() as f64;
        grown += large as f64;
        let deviation = (EXPLAINED * (1.0 - EXPLAINED) / asked).sqrt();
        if (grown / asked - EXPLAINED).abs() > DOUBT * deviation {
            break;
        }
    }
    Ok(grown >= EXPLAINED * asked)
}

fn seeds(context: &mut Context, scene: &Scene, count: usize) -> Vec<u32> {
    let faces = scene.mesh.faces.len() as u32;
    (0..count).map(|_| context.rng.random_range(0..faces)).collect()
}

/// What grows from each seed.
fn probe(scene: &Scene, seeds: &[u32]) -> Vec<Option<Candidate>> {
    let unlabelled = vec![UNLABELLED; scene.mesh.faces.len()];
    let pool = Pool::default();
    let grow =
        |&seed: &u32| pool.with(|work| propose(scene, seed, &unlabelled, Growth::Loose, work));
    seeds.par_iter().with_max_len(1).map(grow).collect()
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
