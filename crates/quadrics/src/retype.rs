//! Types once directions, axes and neighbours are known.

use rayon::prelude::*;

use crate::context::Context;
use crate::describe::{Recognised, confidence, is_noteworthy, settled};
use crate::error::Result;
use crate::impose::aligned;
use crate::partition::Regions;
use crate::recognise::around::Around;
use crate::recognise::assign::models;
use crate::recognise::related;
use crate::recognise::scene::{Gathered, Marks, Scene};
use crate::surface::Surface;
use crate::surface::related::Shown;
use crate::surface::select::{Choice, Evidence};

/// Vertices that the choice looks at.
const SAMPLES: usize = 400;
/// What another type must save: of the changes that save more 20 of 21 were right (noise5, noise10 and
/// scan of 23 shapes), of those that save less 7 of 21.
const MARGIN: f64 = 3.0;

/// Learns the directions and axes that the surfaces show, and makes planes, cylinders and cones of the
/// regions that stand there; under independent noise also blends of those between two walls. On a clean mesh the
/// faces alone tell the type.
///
/// # Errors
/// Cancellation.
pub fn retype(
    context: &mut Context,
    scene: &mut Scene,
    labels: &[u32],
    fits: &mut [Recognised],
) -> Result<()> {
    if scene.evidence.general {
        return Ok(());
    }
    context.timed("retype", |_| {
        scene.shown = Shown::by(&aligned(fits));
        let (scene, regions) = (&*scene, Regions::new(labels));
        let models = models(scene, &regions, fits.iter().map(|fit| &fit.surface));
        let around = Around { scene, models: &models, labels, regions: &regions };
        fits.par_iter_mut().enumerate().for_each_init(Marks::default, |marks, (i, fit)| {
            let faces = regions.faces(i);
            if scene.is_band(faces) {
                return;
            }
            let (gathered, evidence) = scene.means(faces, SAMPLES, marks);
            // Every vertex counts in the section of a blend: on means there are too many.
            let single = scene.cells.is_none();
            let blend =
                (single && scene.noisy()).then(|| around.rather(i, &gathered, marks)).flatten();
            let blend = blend.filter(|(new, old)| !new.surface.is_like(&old.surface));
            let found = blend.or_else(|| better(scene, &gathered, evidence, &fit.surface));
            if let Some((new, old)) = found {
                let confidence = confidence(&new, Some(&old));
                let runner_up = is_noteworthy(&new, &old).then_some(old.surface);
                let settled = settled(scene, faces, new.surface.clone(), marks);
                // Means lie off curved surfaces by the sagitta of their cells.
                let surface = if single {
                    told(scene, &gathered, &new, &settled)
                } else {
                    settled.surface.clone()
                };
                *fit = Recognised { surface, confidence, runner_up, waves: fit.waves, ..settled };
            }
        });
        Ok(())
    })
}

/// The surface of a new type: a free fit of few noisy vertices leaves the direction or the axis that the
/// type was told by, unless it is better by more than that is worth.
fn told(scene: &Scene, gathered: &Gathered, new: &Choice, settled: &Recognised) -> Surface {
    let price = |surface| related::priced(scene, surface, gathered, scene.evidence);
    // The inliers say best where on the axis.
    let placed = scene.shown.nearest(&settled.support);
    let placed = placed.filter(|other| other.is_like(&new.surface)).map(price);
    let free = price(settled.surface.clone());
    let all = placed.chain([new.clone(), free]);
    let best = all.min_by(|a, b| a.criterion.total_cmp(&b.criterion));
    best.map_or_else(|| settled.surface.clone(), |best| best.surface)
}

/// The plane, cylinder or cone of another type that is shown by more than the surface, and the surface, each
/// with the criterion that they were compared by.
fn better(
    scene: &Scene,
    gathered: &Gathered,
    evidence: Evidence,
    surface: &Surface,
) -> Option<(Choice, Choice)> {
    if surface.is_general() || matches!(surface, Surface::FreeForm) {
        return None;
    }
    let (like, unlike): (Vec<_>, Vec<_>) =
        scene.shown.nearest(&gathered.points).partition(|new| new.is_like(surface));
    let best = |bound: f64, related: Vec<Surface>| {
        related::best(scene, gathered, evidence, surface, bound, related.into_iter())
    };
    let mut own = related::priced(scene, surface.clone(), gathered, evidence);
    if let Some(like) = best(own.criterion, like) {
        own.criterion = like.criterion;
    }
    best(own.criterion - MARGIN, unlike).map(|new| (new, own))
}
