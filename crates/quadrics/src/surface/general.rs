//! General quadrics by their class: the free fit and one of every family, judged like any type.

use super::family::{Family, HELD};
use super::kind::{Class, kind};
use super::select::{Choice, Evidence, best_of, judge, plausible};
use super::start::{self, Samples};
use super::{Surface, Torus, refine_within};
use crate::math::Point;

/// Fewest points that show a general quadric.
const FEWEST: usize = 14;
/// Iterations of the free fit.
const ITERATIONS: usize = 25;

/// General quadrics of all families that fit, best criterion first.
pub fn choose(samples: Samples, vertices: usize, evidence: Evidence) -> Vec<Choice> {
    free(samples).map_or_else(Vec::new, |free| choose_near(free, samples, vertices, evidence))
}

/// The same from the free fit.
pub fn choose_near(
    free: Surface,
    samples: Samples,
    vertices: usize,
    evidence: Evidence,
) -> Vec<Choice> {
    // Without noise a free fit shows its class by itself; but only what is held is exactly round.
    let asked = |family: &Family| !evidence.general || family.is_revolved();
    let held = free.quadric().into_iter().flat_map(|near| {
        let families = HELD.into_iter().filter(asked);
        families.filter_map(move |family| family.fit(&near, samples).map(Surface::Quadric))
    });
    let sound = |surface: &Surface| {
        !singular(surface, samples.points)
            && proper(surface)
            && plausible(surface, samples, evidence)
    };
    let all = held.chain([free]).filter(sound).chain(sheet(samples, evidence));
    let mut choices: Vec<Choice> =
        all.map(|surface| judge(surface, samples, vertices, evidence)).collect();
    choices.sort_by(|a, b| a.criterion.total_cmp(&b.criterion));
    choices
}

/// The torus that cuts itself; on a clean mesh it is a type like any other.
pub fn sheet(samples: Samples, evidence: Evidence) -> Option<Surface> {
    if evidence.general {
        return None;
    }
    let axes = start::axes(samples);
    let starts = axes.iter().filter_map(|axis| start::torus(samples, axis));
    let sheets = starts.filter(Torus::cuts_itself).map(Surface::Torus);
    best_of(sheets, samples).filter(|fit| fit.is_general() && plausible(fit, samples, evidence))
}

/// The free orthogonal-distance fit.
pub fn free(samples: Samples) -> Option<Surface> {
    if samples.points.len() < FEWEST {
        return None;
    }
    let start = start::quadric(samples)?;
    Some(refine_within(&start, samples.points, &[], ITERATIONS)?.surface)
}

/// Whether a quadric is one of the curved classes and not two planes.
pub(super) fn curved(surface: &Surface) -> bool {
    !matches!(class(surface), Class::Plane | Class::Other)
}

/// Whether a quadric is of a class that no simpler type has.
fn proper(surface: &Surface) -> bool {
    curved(surface) && !matches!(class(surface), Class::Sphere | Class::Cylinder | Class::Cone)
}

fn class(surface: &Surface) -> Class {
    let Surface::Quadric(quadric) = surface else { return Class::Other };
    kind(quadric, 1.0).class
}

/// Whether the gradient vanishes near the points, as it does where two planes meet.
pub(super) fn singular(surface: &Surface, points: &[Point]) -> bool {
    let Surface::Quadric(quadric) = surface else { return false };
    let mut slopes: Vec<f64> = points.iter().map(|&p| quadric.gradient(p).norm()).collect();
    slopes.sort_unstable_by(f64::total_cmp);
    slopes[slopes.len() / 20] < slopes[slopes.len() / 2] / 4.0
}
