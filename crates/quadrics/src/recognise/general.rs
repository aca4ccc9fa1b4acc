//! General quadrics under noise: found on whole regions, where several simpler ones stand for one.
//!
//! While regions grow out of a noisy mesh a quadric would bridge creases, and simpler surfaces fit
//! any small patch of it. So it starts from a curved region that is known already, grows over what it
//! explains, and must cost less than all regions that it takes in.

use super::assign::Model;
use super::detect::{Candidate, Growth, Workspace, grow, most_misfit, side_of};
use super::merge::merging;
use super::moves::{LABEL, tidy};
use super::scene::{Gathered, Marks, Scene};
use crate::context::Context;
use crate::error::Result;
use crate::partition::Regions;
use crate::surface::kind::{Class, kind};
use crate::surface::select::{self, Choice, Evidence};
use crate::surface::{Surface, general};

/// Vertices that a fit looks at: classes differ by little.
const SAMPLES: usize = 600;
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
    let mut found = false;
    let mut uniter = Uniter::new(scene, labels);
    let mut seeds: Vec<u32> = (0..models.len() as u32).collect();
    seeds.sort_by_key(|&id| (std::cmp::Reverse(uniter.faces[id as usize].len()), id));
    for seed in seeds {
        context.step("merge", 0.0)?;
        if uniter.faces[seed as usize].len() >= FEWEST && is_round(&models[seed as usize].surface) {
            found |= uniter.attempt(seed, models, labels);
        }
    }
    tidy(models, labels);
    Ok(found)
}

/// Makes general quadrics of the regions that only they explain.
///
/// # Errors
/// Cancellation.
pub fn recast(
    context: &mut Context,
    scene: &Scene,
    models: &mut [Model],
    labels: &[u32],
) -> Result<()> {
    let mut uniter = Uniter::new(scene, labels);
    for id in 0..models.len() as u32 {
        context.step("fit", 0.0)?;
        let faces = uniter.faces[id as usize].clone();
        if faces.len() >= FEWEST
            && is_round(&models[id as usize].surface)
            && let Some(surface) = uniter.better(&faces, &[id], models)
        {
            let side = side_of(scene, &surface, &faces);
            models[id as usize] = Model { surface, side };
        }
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

    /// Replaces a region, and all that its quadric grows over, by the quadric if that costs less;
    /// whether it did.
    fn attempt(&mut self, seed: u32, models: &mut [Model], labels: &mut [u32]) -> bool {
        let Some(candidate) = self.grown(seed, labels) else { return false };
        let pieces = self.absorbed(&candidate.faces, labels);
        let Some(&into) = pieces.first() else { return false };
        let faces: Vec<u32> =
            pieces.iter().flat_map(|&id| self.faces[id as usize].iter().copied()).collect();
        let Some(surface) = self.better(&faces, &pieces, models) else { return false };
        let side = side_of(self.scene, &surface, &faces);
        models[into as usize] = Model { surface, side };
        faces.iter().for_each(|&face| labels[face as usize] = into);
        pieces.iter().for_each(|&id| self.faces[id as usize].clear());
        self.faces[into as usize] = faces;
        true
    }

    /// The free quadric of a region and the connected faces that it explains.
    fn grown(&mut self, seed: u32, labels: &[u32]) -> Option<Candidate> {
        let faces = self.faces[seed as usize].clone();
        let gathered = self.samples(&faces);
        let surface = general::free(gathered.samples())?;
        let choice = self.judge(surface, &gathered);
        if choice.misfit > most_misfit(faces.len()) {
            return None;
        }
        let side = side_of(self.scene, &choice.surface, &faces);
        let start = Candidate { choice, faces, side };
        grow(self.scene, start, true, labels, Growth::Over, &mut self.work)
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
    /// their pieces do.
    fn better(&mut self, faces: &[u32], pieces: &[u32], models: &[Model]) -> Option<Surface> {
        let gathered = self.samples(faces);
        let choices = general::choose(gathered.samples(), gathered.total, self.evidence);
        let choice = choices.into_iter().next()?;
        let most = most_misfit(faces.len());
        if choice.misfit > most {
            return None;
        }
        let price = |choice: &Choice, vertices: usize| {
            choice.criterion - self.evidence.samples(vertices) * choice.misfit
        };
        let mut gain = 2.0 * LABEL * (pieces.len() - 1) as f64 - price(&choice, gathered.total);
        for &id in pieces {
            let own = self.scene.samples(&self.faces[id as usize], SAMPLES, &mut self.marks);
            let apart = self.judge(models[id as usize].surface.clone(), &own);
            let united = self.judge(choice.surface.clone(), &own);
            gain += apart.criterion - self.evidence.samples(own.total) * united.misfit;
        }
        let margin = if self.scene.correlated() { MARGIN_SCAN } else { MARGIN };
        let margin = if is_open(&choice.surface) { OPEN * margin } else { margin };
        if gain < margin {
            return None;
        }
        let simple = select::choose(gathered.samples(), gathered.total, self.evidence);
        let explained = simple.first().is_some_and(|simple| simple.misfit < most);
        (!explained).then_some(choice.surface)
    }

    fn judge(&self, surface: Surface, gathered: &Gathered) -> Choice {
        select::judge(surface, gathered.samples(), gathered.total, self.evidence)
    }

    fn samples(&mut self, faces: &[u32]) -> Gathered {
        self.scene.samples(faces, SAMPLES, &mut self.marks)
    }
}

/// Whether a quadric is straight along an axis and bends once across it.
fn is_open(surface: &Surface) -> bool {
    let Surface::Quadric(quadric) = surface else { return false };
    matches!(kind(quadric, 1.0).class, Class::ParabolicCylinder | Class::HyperbolicCylinder)
}
