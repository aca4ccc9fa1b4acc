//! The simplest surface that the noise explains.
//!
//! A Bayesian information criterion with the mesh's one sigma and the number of *independent*
//! samples: `n mean(min(d²/σ², cap)) + 2 cost(type) ln n`. Costs are not parameter counts: bands
//! around an axis fit spheres as well as cones, so a sphere must cost more than its four parameters.

use super::family::Family;
use super::start::{self, Samples};
use super::tube::tori;
use super::{Shape, Surface, Torus, general, refine_within};
use crate::math::Point;

/// What is known of the noise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Evidence {
    /// Standard deviation of a vertex across the surface.
    pub sigma: f64,
    /// Independent samples over vertices: 1 for independent noise, a few per cent on scans.
    pub independent: f64,
    /// Standard deviation of the (filtered) face normals, in radians.
    pub normal_sigma: f64,
    /// Whether the mesh is clean: a general quadric may be chosen wherever it fits.
    pub general: bool,
}

/// Below so many sizes a mesh is clean, and a quadric that fits is the surface; above, quadrics bridge
/// creases.
const QUIET: f64 = 2e-4;

impl Evidence {
    /// Whether the noise is none to speak of.
    pub fn is_quiet(&self) -> bool {
        self.sigma < QUIET
    }

    /// Independent samples that so many vertices stand for, at least two.
    pub fn samples(&self, vertices: usize) -> f64 {
        (vertices as f64 * self.independent).max(2.0)
    }
}

/// A surface chosen for some points.
#[derive(Debug, Clone)]
pub struct Choice {
    /// The surface.
    pub surface: Surface,
    /// Mean of `min(d²/σ², CAP)` over the points: 1 where only noise is left.
    pub misfit: f64,
    /// The criterion; less is better.
    pub criterion: f64,
}

/// Squared distances count up to this many squared sigmas, so that a few faces of the neighbour do
/// not decide.
pub const CAP: f64 = 9.0;
/// Iterations of a trial fit, and of the one that decides.
const TRIAL_ITERATIONS: usize = 4;
const FINAL_ITERATIONS: usize = 25;
/// Surfaces with a radius above this many sizes are planes (points are in the unit cube).
pub(super) const LARGEST_RADIUS: f64 = 5.0;
/// A torus whose spine is narrower than its tube by more is a sphere.
const NARROWEST: f64 = 20.0;
/// Half angles outside this range, in degrees, are cylinders or planes.
const HALF_ANGLES: (f64, f64) = (0.3, 88.0);
/// Least mean cosine between the normals of the samples and of the surface on a clean mesh: many
/// surfaces fit the two rows of vertices of a narrow strip.
pub const AGREEMENT: f64 = 0.85;
/// Least share by which the normals on one side outnumber the others. On narrow bands filtered
/// normals turn by any angle; only surfaces that run through the cloud must go.
const ONE_SIDED: f64 = 0.3;
/// Part of the noise that is expected to remain whatever is fitted.
const LEAST_MISFIT: f64 = 0.6;

/// What a type costs, in units of `2 ln n` (measured on parts with known truth).
pub fn cost(surface: &Surface) -> f64 {
    match surface {
        Surface::Plane(_) => 3.0,
        Surface::Cylinder(_) => 5.0,
        Surface::Cone(_) => 6.0,
        Surface::Sphere(_) => 6.5,
        Surface::Torus(_) => 8.0,
        // By its degrees of freedom: 9, and less for cones, paraboloids and cylinders.
        Surface::Quadric(s) => Family::of(s).freedom() as f64,
        Surface::FreeForm => 0.0,
    }
}

/// Mean capped squared distance in squared sigmas.
pub fn misfit(surface: &Surface, points: &[Point], sigma: f64) -> f64 {
    fn mean<S: Shape>(shape: &S, points: &[Point], sigma: f64) -> f64 {
        let scale = sigma.powi(-2);
        let sum: f64 = points.iter().map(|&p| (shape.distance(p).powi(2) * scale).min(CAP)).sum();
        sum / points.len().max(1) as f64
    }
    match surface {
        Surface::Plane(s) => mean(s, points, sigma),
        Surface::Sphere(s) => mean(s, points, sigma),
        Surface::Cylinder(s) => mean(s, points, sigma),
        Surface::Cone(s) => mean(s, points, sigma),
        Surface::Torus(s) => mean(s, points, sigma),
        Surface::Quadric(s) => mean(&s.principal(), points, sigma),
        Surface::FreeForm => CAP,
    }
}

/// The criterion of a surface for `vertices` vertices of which `samples` are looked at.
pub fn judge(surface: Surface, samples: Samples, vertices: usize, evidence: Evidence) -> Choice {
    let cost = cost(&surface);
    judge_at(cost, surface, samples.points, vertices, evidence)
}

/// The same at a cost that is not that of its type.
pub fn judge_at(
    cost: f64,
    surface: Surface,
    points: &[Point],
    vertices: usize,
    evidence: Evidence,
) -> Choice {
    let misfit = misfit(&surface, points, evidence.sigma);
    let count = evidence.samples(vertices);
    let criterion = count * misfit + 2.0 * cost * count.ln();
    Choice { surface, misfit, criterion }
}

/// All types that fit, best criterion first.
///
/// Types are tried from the simplest; one is skipped when it could not win even if it left nothing
/// but noise.
pub fn choose(samples: Samples, vertices: usize, evidence: Evidence) -> Vec<Choice> {
    let mut choices: Vec<Choice> = Vec::new();
    let consider = |choices: &mut Vec<Choice>, surface: Surface| {
        let asked = evidence.general || !surface.is_general();
        if asked && plausible(&surface, samples, evidence) {
            let choice = judge(surface, samples, vertices, evidence);
            insert(choices, choice);
        }
        choices.first().map_or(f64::INFINITY, |best| best.criterion)
    };
    let count = evidence.samples(vertices);
    let bound = |cost: f64| count * LEAST_MISFIT + 2.0 * cost * count.ln();
    let mut best = f64::INFINITY;
    if let Some(plane) = start::plane(samples) {
        best = consider(&mut choices, plane);
    }
    if samples.points.len() < 6 || best <= bound(5.0) {
        return choices;
    }
    let axes = start::axes(samples);
    if let Some(cylinder) =
        best_of(axes.iter().filter_map(|a| start::cylinder(samples, a)), samples)
    {
        best = consider(&mut choices, cylinder);
    }
    if best > bound(6.0)
        && let Some(cone) = best_of(axes.iter().filter_map(|a| start::cone(samples, a)), samples)
    {
        best = consider(&mut choices, cone);
    }
    if best > bound(6.5)
        && let Some(sphere) = best_of(start::sphere(samples).into_iter(), samples)
    {
        best = consider(&mut choices, sphere);
    }
    if best > bound(8.0) && samples.points.len() >= 10 {
        let turned = axes.iter().filter_map(|axis| start::torus(samples, axis));
        let asked =
            |torus: &Torus| torus.major_radius > 0.0 || (evidence.general && is_of_size(torus));
        let turned = turned.filter(asked).map(Surface::Torus);
        // Under noise curvatures say little, and a probe that may bend mistakes its neighbours for noise.
        let bent = evidence.is_quiet().then(|| tori(samples)).into_iter().flatten();
        if let Some(torus) = best_of(turned.chain(bent), samples) {
            best = consider(&mut choices, torus);
        }
    }
    let simple = choices.first().map_or(CAP, |best| best.misfit);
    if evidence.general
        && best > bound(9.0)
        && simple > QUADRIC_FROM
        && let Some(quadric) = general::free(samples)
        && !general::singular(&quadric, samples.points)
        && general::curved(&quadric)
    {
        let choice = judge(quadric, samples, vertices, evidence);
        if choice.misfit < QUADRIC_GAIN * simple {
            insert(&mut choices, choice);
        }
    }
    choices
}

/// A general quadric is asked only where simpler surfaces leave more than noise.
const QUADRIC_FROM: f64 = 2.0;
/// It must leave less than this share of what the best of them leaves: it fits two planes, and any
/// patch that bends twice.
pub const QUADRIC_GAIN: f64 = 0.8;

fn insert(choices: &mut Vec<Choice>, choice: Choice) {
    let at = choices.partition_point(|known| known.criterion <= choice.criterion);
    choices.insert(at, choice);
}

/// The best orthogonal-distance fit from several starts: a few iterations each, the winner to the end.
pub(super) fn best_of(starts: impl Iterator<Item = Surface>, samples: Samples) -> Option<Surface> {
    let trials = starts.filter_map(|s| refine_within(&s, samples.points, &[], TRIAL_ITERATIONS));
    let best = trials.min_by(|a, b| a.cost.total_cmp(&b.cost))?;
    Some(refine_within(&best.surface, samples.points, &[], FINAL_ITERATIONS)?.surface)
}

/// Whether a surface is of sensible size and seen from one side.
pub fn plausible(surface: &Surface, samples: Samples, evidence: Evidence) -> bool {
    let sensible = match surface {
        Surface::Sphere(s) => s.radius < LARGEST_RADIUS,
        Surface::Cylinder(s) => s.radius < LARGEST_RADIUS,
        Surface::Cone(s) => {
            (HALF_ANGLES.0..HALF_ANGLES.1).contains(&s.half_angle.to_degrees())
                && samples.points.iter().filter(|p| s.axis.dot(&(*p - s.apex)) < 0.0).count() * 20
                    < samples.points.len()
        }
        Surface::Torus(s) => is_of_size(s),
        _ => true,
    };
    sensible && one_sided(surface, samples, evidence)
}

fn is_of_size(torus: &Torus) -> bool {
    let spine = torus.major_radius.abs();
    spine < LARGEST_RADIUS && torus.minor_radius < LARGEST_RADIUS.min(spine * NARROWEST)
}

/// Whether the samples' normals agree with the surface's, up to one sign: a tube as thin as the
/// noise runs through the cloud with both its sides.
fn one_sided(surface: &Surface, samples: Samples, evidence: Evidence) -> bool {
    if evidence.general {
        return agreement(surface, samples) > AGREEMENT;
    }
    mean(cosines(surface, samples).map(f64::signum)).abs() > ONE_SIDED
}

/// Mean cosine between the samples' normals and the surface's, up to one sign.
pub fn agreement(surface: &Surface, samples: Samples) -> f64 {
    mean(cosines(surface, samples)).abs()
}

fn cosines(surface: &Surface, samples: Samples) -> impl ExactSizeIterator<Item = f64> {
    let pairs = samples.barycentres.iter().zip(samples.normals);
    pairs.map(|(p, n)| surface.normal(*p).map_or(0.0, |m| m.dot(n)))
}

fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len().max(1) as f64;
    values.sum::<f64>() / count
}
