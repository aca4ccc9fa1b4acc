//! General quadrics under noise: found on whole regions, where several simpler ones stand for one.
//!
//! While regions grow out of a noisy mesh a quadric would bridge creases, and simpler surfaces fit
//! any small patch of it. So it starts from a curved region that is known already, grows over what it
//! explains, and must cost less than all regions that it takes in.

use std::cmp::Reverse;

use super::assign::{Model, side_of};
use super::detect::{Candidate, Growth, Workspace, grow, most_misfit};
use super::merge::{merging, smooth};
use super::moves::{LABEL, borders, tidy};
use super::scene::{Gathered, Marks, Scene};
use crate::context::Context;
use crate::error::Result;
use crate::partition::Regions;
use crate::surface::kind::{Class, kind};
use crate::surface::select::{self, Choice, Evidence, QUADRIC_GAIN};
use crate::surface::{Surface, general};

/// Vertices that a fit looks at, which decides between classes that differ by little, and that the
/// first one looks at, which only has to grow.
const SAMPLES: usize = 600;
const START: usize = 200;
/// A region of which the quadric explains this share is a piece of it.
const ABSORBED: f64 = 0.7;
/// Fewest faces of a region that a quadric starts from.
const FEWEST: usize = 60;
/// What a quadric must save, in units of the criterion: under noise an ellipse stands for a slot and
/// an ellipsoid for two cones that meet at ten degrees, which parts have far more often. Measured:
/// true ones save 94 to 972, on scans 72 to 477; such a slot 77, such cones less than 0, on a scan 15.
const MARGIN: f64 = 80.0;
const MARGIN_SCAN: f64 = 40.0;
/// A parabola or hyperbola also fits two planes with a fillet between them, which parts have far
/// more often (up to 42): it must save so many times more.
const OPEN: f64 = 3.0;
/// Most degrees of freedom that a class has less than the free quadric.
const HELD_FREEDOM: f64 = 3.0;

/// Unites regions that one general quadric explains for less; whether there are any.
///
/// # Errors
/// Cancellation.
pub fn unite(
    context: &mut Context,
    scene: &Scene,
    models: &mut Vec<Model>,
    labels: &mut [u32],
) -> Result<bool> {
    let mut uniter = Uniter::new(scene, labels);
    let continued = continued(scene, labels, models.len());
    let mut seeds = uniter.seeds(models);
    seeds.sort_by_key(|&id| (Reverse(uniter.faces[id as usize].len()), id));
    let mut found = false;
    for seed in seeds {
        context.step("merge", 0.0)?;
        // It may have been taken in.
        if !uniter.faces[seed as usize].is_empty() {
            let pieces = if continued[seed as usize] {
                uniter.grown(seed, &models[seed as usize].surface, labels).unwrap_or_default()
            } else {
                vec![seed]
            };
            let united = uniter.attempt(&pieces, models, labels);
            // A sheet of a torus reaches further than the quadric that it was found by.
            if united && matches!(models[pieces[0] as usize].surface, Surface::Torus(_)) {
                let surface = models[pieces[0] as usize].surface.clone();
                let more = uniter.grown(pieces[0], &surface, labels).unwrap_or_default();
                uniter.attempt(&more, models, labels);
            }
            found |= united;
        }
    }
    tidy(models, labels);
    Ok(found)
}

/// Whether a region has a smooth border.
fn continued(scene: &Scene, labels: &[u32], count: usize) -> Vec<bool> {
    let smooth = smooth(scene);
    let mut continued = vec![false; count];
    for (one, other, _) in borders(scene, labels).into_iter().filter(|border| border.2 < smooth) {
        continued[one as usize] = true;
        continued[other as usize] = true;
    }
    continued
}

/// Makes general quadrics of the regions that only they explain.
///
/// # Errors
/// Cancellation.
pub fn recast(
    context: &mut Context,
    scene: &Scene,
    models: &mut [Model],
    labels: &mut [u32],
) -> Result<()> {
    let mut uniter = Uniter::new(scene, labels);
    for seed in uniter.seeds(models) {
        context.step("fit", 0.0)?;
        uniter.attempt(&[seed], models, labels);
    }
    Ok(())
}

/// Whether a patch of a general quadric may have been taken for the surface.
fn is_round(surface: &Surface) -> bool {
    !matches!(surface, Surface::Plane(_) | Surface::Quadric(_) | Surface::FreeForm)
}

struct Uniter<'s, 'm> {
    scene: &'s Scene<'m>,
    evidence: Evidence,
    /// The faces of every region, none where it was taken in.
    faces: Vec<Vec<u32>>,
    work: Workspace,
    marks: Marks,
}

impl<'s, 'm> Uniter<'s, 'm> {
    fn new(scene: &'s Scene<'m>, labels: &[u32]) -> Self {
        let faces = Regions::new(labels).iter().map(<[u32]>::to_vec).collect();
        let evidence = merging(scene.evidence);
        let (work, marks) = (Workspace::default(), Marks::default());
        Self { scene, evidence, faces, work, marks }
    }

    /// Regions that may be patches of a quadric.
    fn seeds(&self, models: &[Model]) -> Vec<u32> {
        let seed = |&id: &u32| {
            self.faces[id as usize].len() >= FEWEST && is_round(&models[id as usize].surface)
        };
        (0..models.len() as u32).filter(seed).collect()
    }

    /// Replaces regions by one quadric if that costs less; whether it did.
    fn attempt(&mut self, pieces: &[u32], models: &mut [Model], labels: &mut [u32]) -> bool {
        let Some(&into) = pieces.first() else { return false };
        let faces: Vec<u32> =
            pieces.iter().flat_map(|&id| self.faces[id as usize].iter().copied()).collect();
        let Some(surface) = self.better(&faces, pieces, models) else { return false };
        models[into as usize] = Model::new(self.scene, surface, &faces);
        faces.iter().for_each(|&face| labels[face as usize] = into);
        pieces.iter().for_each(|&id| self.faces[id as usize].clear());
        self.faces[into as usize] = faces;
        true
    }

    /// The regions that the free quadric of one grows over.
    fn grown(&mut self, seed: u32, surface: &Surface, labels: &[u32]) -> Option<Vec<u32>> {
        let faces = self.faces[seed as usize].clone();
        let gathered = self.scene.samples(&faces, START, &mut self.marks);
        let own = Some(surface).filter(|own| own.is_general()).cloned();
        let surface = own.or_else(|| general::free(gathered.samples()))?;
        let choice = self.judge(surface, &gathered);
        if choice.misfit > most_misfit(faces.len()) {
            return None;
        }
        let side = side_of(self.scene, &choice.surface, &faces);
        let start = Candidate { choice, faces, side };
        let grown = grow(self.scene, start, true, labels, Growth::Over, &mut self.work)?;
        Some(self.absorbed(&grown.faces, labels))
    }

    /// Regions that lie mostly within some faces.
    fn absorbed(&self, faces: &[u32], labels: &[u32]) -> Vec<u32> {
        let mut shared = vec![0usize; self.faces.len()];
        faces.iter().for_each(|&face| shared[labels[face as usize] as usize] += 1);
        let within = |&id: &usize| {
            shared[id] > 0 && shared[id] as f64 >= ABSORBED * self.faces[id].len() as f64
        };
        (0..shared.len()).filter(within).map(|id| id as u32).collect()
    }

    /// The quadric of some faces that no simpler surface explains, where it costs clearly less than
    /// their pieces do. Under independent noise a simpler surface may leave little more than noise and
    /// still be far worse; on scans what it leaves may be waviness.
    fn better(&mut self, faces: &[u32], pieces: &[u32], models: &[Model]) -> Option<Surface> {
        let most = most_misfit(faces.len());
        let apart = self.apart(pieces, models);
        let gathered = self.samples(faces);
        let (samples, total, evidence) = (gathered.samples(), gathered.total, self.evidence);
        let free = self.judge(general::free(samples)?, &gathered);
        let correlated = self.scene.correlated();
        let explained = |simple: f64, quadric: &Choice| {
            simple < most && (correlated || quadric.misfit > QUADRIC_GAIN * simple)
        };
        if pieces.len() == 1 && explained(apart.misfit, &free) {
            return None;
        }
        // The free fit costs most and fits best: what it cannot win by far, no class wins.
        let margin = if correlated { MARGIN_SCAN } else { MARGIN };
        let held = 2.0 * HELD_FREEDOM * evidence.samples(total).ln();
        let hopeless = free.misfit > most || apart.gain(&free, total, evidence) + held < margin;
        let choice = if hopeless {
            self.judge(general::sheet(samples, evidence)?, &gathered)
        } else {
            general::choose_near(free.surface, samples, total, evidence).into_iter().next()?
        };
        let margin = if is_open(&choice.surface) { OPEN * margin } else { margin };
        if choice.misfit > most || apart.gain(&choice, total, evidence) < margin {
            return None;
        }
        let simple = select::choose(samples, total, evidence);
        let explained = simple.first().is_some_and(|simple| explained(simple.misfit, &choice));
        (!explained).then_some(choice.surface)
    }

    /// The pieces as they are.
    fn apart(&mut self, pieces: &[u32], models: &[Model]) -> Apart {
        let mut apart = Apart { parts: Vec::new(), cost: 0.0, misfit: 0.0 };
        for &id in pieces {
            let part = self.scene.samples(&self.faces[id as usize], SAMPLES, &mut self.marks);
            let choice = self.judge(models[id as usize].surface.clone(), &part);
            let label = if apart.parts.is_empty() { 0.0 } else { 2.0 * LABEL };
            apart.cost += choice.criterion + label;
            apart.misfit = apart.misfit.max(choice.misfit);
            apart.parts.push(part);
        }
        apart
    }

    fn judge(&self, surface: Surface, gathered: &Gathered) -> Choice {
        select::judge(surface, gathered.samples(), gathered.total, self.evidence)
    }

    fn samples(&mut self, faces: &[u32]) -> Gathered {
        self.scene.samples(faces, SAMPLES, &mut self.marks)
    }
}

/// Regions that may be one.
struct Apart {
    parts: Vec<Gathered>,
    /// What they cost, with a label for all but one of them.
    cost: f64,
    /// The worst misfit.
    misfit: f64,
}

impl Apart {
    /// What one surface with so many vertices saves.
    fn gain(&self, choice: &Choice, vertices: usize, evidence: Evidence) -> f64 {
        let price = choice.criterion - evidence.samples(vertices) * choice.misfit;
        // A vertex between two parts counts for both, before and after.
        let misfit = |part: &Gathered| {
            let misfit = select::misfit(&choice.surface, &part.points, evidence.sigma);
            evidence.samples(part.total) * misfit
        };
        self.cost - price - self.parts.iter().map(misfit).sum::<f64>()
    }
}

/// Whether a quadric is straight along an axis and bends once across it.
fn is_open(surface: &Surface) -> bool {
    let Surface::Quadric(quadric) = surface else { return false };
    matches!(kind(quadric, 1.0).class, Class::ParabolicCylinder | Class::HyperbolicCylinder)
}
