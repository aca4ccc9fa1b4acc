//! What surfaces cost that stand in directions and about axes that others show: a narrow fillet that noise let
//! pass for a plane, or a bore that passed for a cone, is told by that.

use super::scene::{Gathered, Scene};
use crate::surface::Surface;
use crate::surface::select::{Choice, Evidence, agreement, judge, plausible};

/// Mean cosine to the face normals that a related surface may lose: a tube through two rows of
/// vertices fits them, but lies across their faces.
const TURNED: f64 = 0.05;

/// The criterion of a surface, less what the scene shows of it.
pub fn priced(scene: &Scene, surface: Surface, gathered: &Gathered, evidence: Evidence) -> Choice {
    let (held, among) = scene.shown.held(&surface);
    let mut choice = judge(surface, gathered.samples(), gathered.total, evidence);
    // Whoever picks one of several pays for the choice.
    let price = held * evidence.samples(gathered.total).ln() - (among as f64).ln();
    choice.criterion -= 2.0 * price;
    choice
}

/// The best of the related surfaces that `counts`, if it is better than `bound` and the faces' normals agree
/// with it nearly as well as with `than`.
pub fn best(
    scene: &Scene,
    gathered: &Gathered,
    evidence: Evidence,
    than: &Surface,
    mut bound: f64,
    counts: impl Fn(&Surface) -> bool,
) -> Option<Choice> {
    let samples = gathered.samples();
    let least = agreement(than, samples) - TURNED;
    let mut best = None;
    for surface in scene.shown.nearest(samples.points).filter(counts) {
        let choice = priced(scene, surface, gathered, evidence);
        if choice.criterion < bound
            && plausible(&choice.surface, samples, evidence)
            && agreement(&choice.surface, samples) > least
        {
            bound = choice.criterion;
            best = Some(choice);
        }
    }
    best
}
