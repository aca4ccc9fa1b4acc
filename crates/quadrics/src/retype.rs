//! Types once directions and axes are known.
//!
//! Most surfaces of a part stand along directions that others show, and about axes that others have.
//! A cylinder along a known direction has three degrees of freedom, not five: a narrow fillet that
//! noise let pass for a plane, or a bore that passed for a cone, is told by what it costs less.

use rayon::prelude::*;

use crate::context::Context;
use crate::describe::{Recognised, confidence, is_noteworthy, settled};
use crate::error::Result;
use crate::impose::aligned;
use crate::math::{Point, Unit};
use crate::partition::Regions;
use crate::recognise::scene::{Marks, Scene};
use crate::surface::related::{Related, about, along};
use crate::surface::select::{Choice, agreement, judge, plausible};
use crate::surface::{Surface, axis, direction};

/// Vertices that the choice looks at.
const SAMPLES: usize = 400;
/// So many other surfaces show a direction.
const SHOWN: usize = 2;
/// What another type must save: of the changes that save more 20 of 21 were right (noise5, noise10 and
/// scan of 23 shapes), of those that save less 7 of 21.
const MARGIN: f64 = 3.0;
/// Mean cosine to the face normals that another type may lose: a tube through two rows of vertices
/// fits them, but lies across their faces.
const TURNED: f64 = 0.05;
/// Directions and axes are one when sine and distance are below this, in radians and sizes.
const ONE: f64 = 1e-9;

/// Gives regions the type that their faces and the directions and axes of the others show. On a clean
/// mesh the faces alone suffice.
///
/// # Errors
/// Cancellation.
pub fn retype(
    context: &mut Context,
    scene: &Scene,
    labels: &[u32],
    fits: &mut [Recognised],
) -> Result<()> {
    if scene.evidence.general {
        return Ok(());
    }
    context.timed("retype", |_| {
        let aligned = aligned(fits);
        let known = Known {
            ways: aligned.iter().map(direction).collect(),
            lines: aligned.iter().map(axis).collect(),
        };
        let regions = Regions::new(labels);
        fits.par_iter_mut().enumerate().for_each_init(Marks::default, |marks, (i, fit)| {
            let faces = regions.faces(i);
            if let Some((new, old)) = better(scene, faces, &fit.surface, &known.but(i), marks) {
                let confidence = confidence(&new, Some(&old));
                let runner_up = is_noteworthy(&new, &old).then_some(old.surface);
                let settled = settled(scene, faces, new.surface, marks);
                *fit = Recognised { confidence, runner_up, waves: fit.waves, ..settled };
            }
        });
        Ok(())
    })
}

/// What the surfaces have of normals and axes.
struct Known {
    ways: Vec<Option<Unit>>,
    lines: Vec<Option<(Point, Unit)>>,
}

/// Directions and axes, each once.
struct Shown {
    ways: Vec<Unit>,
    lines: Vec<(Point, Unit)>,
}

impl Known {
    /// What all but one surface show.
    fn but(&self, own: usize) -> Shown {
        let mut ways: Vec<(Unit, usize)> = Vec::new();
        let mut lines: Vec<(Point, Unit)> = Vec::new();
        let others = |i: &usize| *i != own;
        for way in (0..self.ways.len()).filter(others).filter_map(|i| self.ways[i]) {
            match ways.iter_mut().find(|(known, _)| known.cross(&way).norm() < ONE) {
                Some((_, count)) => *count += 1,
                None => ways.push((way, 1)),
            }
        }
        for (point, way) in (0..self.lines.len()).filter(others).filter_map(|i| self.lines[i]) {
            let is_one = |(at, known): &(Point, Unit)| {
                known.cross(&way).norm() < ONE && (at - point).cross(&way).norm() < ONE
            };
            if !lines.iter().any(is_one) {
                lines.push((point, way));
            }
        }
        let shown = ways.into_iter().filter(|(_, count)| *count >= SHOWN);
        Shown { ways: shown.map(|(way, _)| way).collect(), lines }
    }
}

/// The plane or cylinder of another type that is shown by more than the surface, and the surface, each
/// with the criterion that they were compared by.
fn better(
    scene: &Scene,
    faces: &[u32],
    surface: &Surface,
    shown: &Shown,
    marks: &mut Marks,
) -> Option<(Choice, Choice)> {
    if matches!(surface, Surface::FreeForm | Surface::Quadric(_)) {
        return None;
    }
    let gathered = scene.samples(faces, SAMPLES, marks);
    let (samples, total, evidence) = (gathered.samples(), gathered.total, scene.evidence);
    let price = 2.0 * evidence.samples(total).ln();
    let least = agreement(surface, samples) - TURNED;
    let mut own = judge(surface.clone(), samples, total, evidence);
    let mut best: Option<Choice> = None;
    let mut ask = |Related { surface, held }: Related, among: usize| {
        let mut choice = judge(surface, samples, total, evidence);
        // One of so many directions was chosen.
        choice.criterion += 2.0 * (among as f64).ln() - held * price;
        if choice.surface.is_like(&own.surface) {
            own.criterion = own.criterion.min(choice.criterion);
        } else if best.as_ref().is_none_or(|best| choice.criterion < best.criterion)
            && plausible(&choice.surface, samples, evidence)
            && agreement(&choice.surface, samples) > least
        {
            best = Some(choice);
        }
    };
    for way in &shown.ways {
        along(&gathered.points, way).into_iter().for_each(|new| ask(new, shown.ways.len()));
    }
    for (point, way) in &shown.lines {
        about(&gathered.points, *point, way)
            .into_iter()
            .for_each(|new| ask(new, shown.lines.len()));
    }
    best.filter(|best| best.criterion + MARGIN < own.criterion).map(|best| (best, own))
}
