//! Merging: two regions that one surface explains become one, best gain first.

use std::collections::BTreeMap;

use rayon::prelude::*;

use super::assign::Model;
use super::moves::{LABEL, SAMPLES, best, borders, tidy};
use super::related::priced;
use super::scene::{Marks, Scene};
use crate::context::Context;
use crate::error::Result;
use crate::partition::Regions;
use crate::surface::Surface;
use crate::surface::select::Evidence;

/// Regions whose normals differ more across their border, on the mean, are not one surface. Under
/// independent noise normals come filtered so that they differ less.
const SMOOTH_DEG: f64 = 25.0;
const SMOOTH_NOISY_DEG: f64 = 18.0;

/// Squared difference of normals from which a border is no longer smooth.
pub(super) fn smooth(scene: &Scene) -> f64 {
    let degrees = if scene.noisy() { SMOOTH_NOISY_DEG } else { SMOOTH_DEG };
    2.0 - 2.0 * degrees.to_radians().cos()
}

/// What one surface for two regions must save beside its price under independent noise, and two for
/// one: a difference that chance makes is not worth a change (10 and 40 are about as good). On scans,
/// whose waviness tears regions, and on clean meshes one surface may cost more by the price of the labels.
pub(super) const CHANGE: f64 = 20.0;
const CHANGE_ELSE: f64 = -2.0 * LABEL;
/// On scans neighbours err together, and two surfaces follow their waves better than one without there
/// being two: one of their type that leaves less than this misfit, which is noise, is no loss.
const WAVES: f64 = 1.0;

/// A pair of adjacent regions and what merging them gains.
struct Union {
    gain: f64,
    surface: Surface,
    side: Side,
}

/// What a region is worth as it is.
#[derive(Clone, Copy)]
struct Side {
    criterion: f64,
    vertices: usize,
}

/// Regions while they merge; a pair is judged once, and again when one of the two has changed.
struct Merger<'s, 'm> {
    scene: &'s Scene<'m>,
    evidence: Evidence,
    faces: Vec<Vec<u32>>,
    sides: Vec<Side>,
    unions: BTreeMap<(u32, u32), Option<Union>>,
}

/// Merges while the criterion falls.
///
/// # Errors
/// Cancellation.
pub fn merge(
    context: &mut Context,
    scene: &Scene,
    models: &mut Vec<Model>,
    labels: &mut [u32],
) -> Result<()> {
    let smooth = smooth(scene);
    let least = if scene.noisy() { CHANGE } else { CHANGE_ELSE };
    let mut merger = Merger::new(scene, models, labels);
    loop {
        context.step("merge", 0.0)?;
        let typed = |id: u32| !matches!(models[id as usize].surface, Surface::FreeForm);
        let pairs = borders(scene, labels).into_iter();
        merger.judge(models, pairs.filter(|b| b.2 < smooth && typed(b.0) && typed(b.1)));
        if merger.apply(models, labels, least, usize::MAX) == 0 {
            break;
        }
    }
    tidy(models, labels);
    Ok(())
}

/// Merges the pairs of least increase until `goal` regions are left, or no two touch.
///
/// # Errors
/// Cancellation.
pub fn merge_down(
    context: &mut Context,
    scene: &Scene,
    models: &mut Vec<Model>,
    labels: &mut [u32],
    goal: usize,
) -> Result<()> {
    let mut merger = Merger::new(scene, models, labels);
    let mut count = models.len();
    while count > goal {
        context.step("merge", 0.0)?;
        merger.judge(models, borders(scene, labels).into_iter());
        let merged = merger.apply(models, labels, f64::NEG_INFINITY, 1);
        if merged == 0 {
            break;
        }
        count -= merged;
    }
    tidy(models, labels);
    Ok(())
}

impl<'s, 'm> Merger<'s, 'm> {
    fn new(scene: &'s Scene<'m>, models: &[Model], labels: &[u32]) -> Self {
        let faces: Vec<Vec<u32>> = Regions::new(labels).iter().map(<[u32]>::to_vec).collect();
        let evidence = merging(scene.evidence);
        let sides = faces
            .par_iter()
            .zip(models)
            .map_init(Marks::default, |marks, (faces, model)| {
                let gathered = scene.samples(faces, SAMPLES, marks);
                let choice = priced(scene, model.surface.clone(), &gathered, evidence);
                Side { criterion: choice.criterion, vertices: gathered.total }
            })
            .collect();
        Self { scene, evidence, faces, sides, unions: BTreeMap::new() }
    }

    /// Fits one surface to both regions of every pair that is not known yet.
    fn judge(&mut self, models: &[Model], pairs: impl Iterator<Item = (u32, u32, f64)>) {
        let unknown: Vec<(u32, u32)> =
            pairs.map(|(a, b, _)| (a, b)).filter(|pair| !self.unions.contains_key(pair)).collect();
        let judged: Vec<Option<Union>> = unknown
            .par_iter()
            .map_init(Marks::default, |marks, &(a, b)| {
                let gathered = self.scene.samples(&self.joined(a, b), SAMPLES, marks);
                let choice = best(self.scene, &gathered, self.evidence)?;
                let [one, other] = [a, b].map(|id| &self.sides[id as usize]);
                let mut gain = one.criterion + other.criterion - choice.criterion;
                if self.scene.noisy() {
                    // Vertices on the border have counted on both sides.
                    let shared = one.vertices + other.vertices - gathered.total;
                    gain -= shared as f64 * choice.misfit.min(1.0);
                }
                let alike = |id: u32| models[id as usize].surface.is_like(&choice.surface);
                if self.scene.correlated() && choice.misfit < WAVES && alike(a) && alike(b) {
                    gain = gain.max(0.0);
                }
                let side = Side { criterion: choice.criterion, vertices: gathered.total };
                Some(Union { gain, surface: choice.surface, side })
            })
            .collect();
        self.unions.extend(unknown.into_iter().zip(judged));
    }

    fn joined(&self, a: u32, b: u32) -> Vec<u32> {
        [self.faces[a as usize].as_slice(), &self.faces[b as usize]].concat()
    }

    /// Carries out the best unions above `least`, each region in one at most; how many.
    fn apply(
        &mut self,
        models: &mut [Model],
        labels: &mut [u32],
        least: f64,
        most: usize,
    ) -> usize {
        let known = self.unions.iter().filter_map(|(&pair, union)| Some((pair, union.as_ref()?)));
        let mut best: Vec<((u32, u32), f64)> = known
            .map(|(pair, union)| (pair, union.gain))
            .filter(|&(_, gain)| gain > least)
            .collect();
        best.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
        let mut busy = vec![false; models.len()];
        let mut merged = 0;
        for ((a, b), _) in best {
            if merged == most || busy[a as usize] || busy[b as usize] {
                continue;
            }
            busy[a as usize] = true;
            busy[b as usize] = true;
            merged += 1;
            let Some(Some(union)) = self.unions.remove(&(a, b)) else { continue };
            let faces = self.joined(a, b);
            models[a as usize] = Model::new(self.scene, union.surface, &faces);
            self.sides[a as usize] = union.side;
            self.faces[b as usize].iter().for_each(|&f| labels[f as usize] = a);
            self.faces[a as usize] = faces;
            self.faces[b as usize].clear();
        }
        self.unions.retain(|&(a, b), _| !busy[a as usize] && !busy[b as usize]);
        merged
    }
}

/// Merging discounts correlated samples less than the choice of types does: a misfit that is too
/// large to be noise counts, however few samples are independent.
pub(super) fn merging(evidence: Evidence) -> Evidence {
    Evidence { independent: evidence.independent.sqrt(), ..evidence }
}
