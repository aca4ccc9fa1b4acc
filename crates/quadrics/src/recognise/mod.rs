//! `preset="default"`: the surfaces of a part, whatever its noise, with nothing to tune.

pub mod around;
pub mod assign;
pub mod bands;
pub mod blend;
pub mod carry;
mod cells;
pub mod count;
mod cut;
pub mod detect;
pub mod evidence;
pub mod expand;
mod facets;
mod free_form;
mod general;
mod levels;
pub mod means;
pub mod merge;
pub mod moves;
mod open;
pub mod patch;
mod pool;
mod profile;
pub mod related;
pub mod scene;
mod seams;
mod sheets;
pub mod shreds;
mod split;
mod standing;
pub mod unshown;

use rayon::prelude::*;

use crate::context::Context;
use crate::error::Result;
use crate::math::{Point, Vector};
use crate::options::Options;
use crate::partition::{Labels, UNLABELLED, components, region_count};
use crate::surface::{Plane, Surface};
use assign::Model;
use scene::Scene;

/// Labels of all faces, and a surface for every label.
pub struct Outcome {
    /// Region of every face.
    pub labels: Labels,
    /// Surface of every region, in the frame of the mesh.
    pub surfaces: Vec<Surface>,
    /// Mean cost of a face after every round, in nats.
    pub energy: Vec<f64>,
}

/// Recognises the surfaces of a mesh that lies in the unit cube, and learns its noise.
///
/// # Errors
/// Cancellation.
pub fn recognise(
    context: &mut Context,
    scene: &mut Scene,
    options: &Options,
    initial_labels: Option<&[u32]>,
) -> Result<Outcome> {
    context.timed("noise", |context| evidence::measure(context, scene))?;
    let (mut labels, mut models) = match initial_labels {
        Some(labels) => given(context, scene, labels)?,
        None => start(context, scene)?,
    };
    scene.filter_for_borders();
    let scene = &*scene;
    let mut energies: Vec<f64> = Vec::new();
    // Regions that the user gives are not united.
    let unite = initial_labels.is_none();
    optimise(context, scene, &mut models, &mut labels, &mut energies, unite, ROUNDS)?;
    // On a clean mesh quadrics have grown like any other surface.
    if unite && !scene.evidence.general {
        let found = context
            .timed("merge", |context| general::unite(context, scene, &mut models, &mut labels))?;
        if found {
            optimise(context, scene, &mut models, &mut labels, &mut energies, unite, AFTER)?;
        }
    }
    if let Some(goal) = options.regions {
        context.timed("count", |context| {
            count::reach(context, scene, &mut models, &mut labels, goal)
        })?;
    }
    let surfaces = models.into_iter().map(|m| m.surface).collect();
    Ok(Outcome { labels, surfaces, energy: energies })
}

/// Goes on where more is known of the scene than before.
///
/// # Errors
/// Cancellation.
pub fn resume(
    context: &mut Context,
    scene: &Scene,
    mut models: Vec<Model>,
    found: &mut Outcome,
) -> Result<()> {
    let Outcome { labels, surfaces, energy } = found;
    optimise(context, scene, &mut models, labels, energy, true, AFTER)?;
    *surfaces = models.into_iter().map(|model| model.surface).collect();
    Ok(())
}

/// Rounds of assigning, fitting and merging, until the energy settles.
fn optimise(
    context: &mut Context,
    scene: &Scene,
    models: &mut Vec<Model>,
    labels: &mut Labels,
    energies: &mut Vec<f64>,
    unite: bool,
    rounds: usize,
) -> Result<()> {
    let mut unsplit = split::Unsplit::default();
    for round in 0..rounds {
        context.step("optimise", round as f64 / rounds as f64)?;
        context.timed("assign", |_| {
            expand::expand(scene, models, labels);
            assign::connect(scene, models, labels);
            moves::tidy(models, labels);
            moves::drop_needless(scene, models, labels);
            moves::tidy(models, labels);
            Ok(())
        })?;
        context.timed("fit", |_| {
            moves::fit(scene, models, labels);
            Ok(())
        })?;
        if unite {
            context.timed("merge", |context| {
                merge::merge(context, scene, models, labels)?;
                if scene.evidence.general {
                    free_form::unite(scene, models, labels);
                }
                Ok(())
            })?;
            // The last round leaves what the cut has made straight.
            if round + 1 < rounds {
                context.timed("split", |context| {
                    split::split(context, scene, models, labels, &mut unsplit)
                })?;
            }
        }
        energies.push(energy(scene, models, labels));
        if let [.., before, now] = energies[..]
            && (before - now).abs() <= CONVERGED * before
        {
            break;
        }
    }
    Ok(())
}

/// The loop ends when the energy changes by less than this fraction.
const CONVERGED: f64 = 1e-3;

/// Area-weighted mean of what the faces cost, in nats.
fn energy(scene: &Scene, models: &[Model], labels: &[u32]) -> f64 {
    let cost = |(face, &label): (usize, &u32)| {
        scene.geometry.areas[face] * assign::face_cost(scene, &models[label as usize], face)
    };
    let total = scene.geometry.areas.iter().sum::<f64>();
    // In chunks of one size: the last digit must not depend on the number of threads.
    let of_chunk =
        |(chunk, labels): (usize, &[u32])| (chunk * CHUNK..).zip(labels).map(cost).sum::<f64>();
    let sums: Vec<f64> = labels.par_chunks(CHUNK).enumerate().map(of_chunk).collect();
    sums.into_iter().sum::<f64>() / total
}

/// Faces whose costs are summed by one thread.
const CHUNK: usize = 8192;

/// The user's labels, each with the surface that fits it.
fn given(context: &mut Context, scene: &Scene, labels: &[u32]) -> Result<(Labels, Vec<Model>)> {
    let unknown = Plane::through(Point::origin(), Vector::z_axis());
    let model = Model { surface: Surface::Plane(unknown), side: 1.0 };
    let mut models = vec![model; region_count(labels)];
    moves::fit(scene, &mut models, labels);
    let mut labels = labels.to_vec();
    if !scene.evidence.general {
        general::recast(context, scene, &mut models, &mut labels)?;
    }
    Ok((labels, models))
}

/// Rounds of the loop, and those after general quadrics were found, or directions: neighbours give
/// back what they had taken and may go (one leaves them, four drift).
const ROUNDS: usize = 4;
const AFTER: usize = 2;
/// Connected faces that no surface explains and that are more than this are free-form.
const FREE_FORM: u32 = 60;

/// A scale that leaves more than this share of the faces unexplained is too fine for the mesh.
const UNEXPLAINED: f64 = 0.1;

/// Detection, at a coarser scale where the first one explains too little.
fn start(context: &mut Context, scene: &mut Scene) -> Result<(Labels, Vec<Model>)> {
    loop {
        let coarsest = scene.evidence.sigma >= evidence::COARSEST;
        let exact = coarsest || scene.correlated() || scene.tessellated;
        let share = if exact { 1.0 } else { UNEXPLAINED };
        match context.timed("detect", |context| detect::detect(context, scene, share))? {
            Some((labels, found)) => return Ok(hand_out(scene, labels, found)),
            None => context.timed("noise", |context| evidence::coarsen(context, scene))?,
        }
    }
}

/// What detection left: large rests are free-form, the others join a neighbour.
fn hand_out(scene: &Scene, mut labels: Labels, mut models: Vec<Model>) -> (Labels, Vec<Model>) {
    let rest = free_form::rest(scene, &labels);
    let marks: Vec<u32> = rest.iter().map(|&rest| u32::from(rest)).collect();
    let (component, sizes) = components(&marks, scene.adjacency);
    let mut own = vec![UNLABELLED; sizes.len()];
    for face in (0..labels.len()).filter(|&face| rest[face]) {
        let piece = component[face] as usize;
        if sizes[piece] >= FREE_FORM || models.is_empty() {
            if own[piece] == UNLABELLED {
                own[piece] = models.len() as u32;
                models.push(Model { surface: Surface::FreeForm, side: 1.0 });
            }
            labels[face] = own[piece];
        }
    }
    assign::flood(scene, &models, &mut labels);
    assign::name_the_rest(scene, &mut models, &mut labels);
    (labels, models)
}
