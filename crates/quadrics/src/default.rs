//! `preset="default"`: on the mesh itself, on a finer one where it has few faces, on a coarser one
//! where its own faces hide the surfaces.

use crate::context::Context;
use crate::describe::{Recognised, fit_all};
use crate::error::Result;
use crate::impose::{aligned, equalised};
use crate::mesh::Working;
use crate::options::{self, Options};
use crate::partition::{Labels, Regions, separate};
use crate::prepare::{Coarse, coarsen, is_faceted, labels_back, noise, subdivide};
use crate::recognise::assign::{self, Model, models};
use crate::recognise::means::{Cells, gathered};
use crate::recognise::{
    self, Outcome, bands, carry, evidence, expand, moves, patch, scene::Scene, shreds, unshown,
};
use crate::retype::retype;
use crate::surface::Surface;
use crate::surface::related::Shown;
use crate::surface::select::Evidence;

/// A mesh in its cube, and what is asked of it.
#[derive(Clone, Copy)]
pub struct Task<'a> {
    pub cube: &'a Working,
    pub options: &'a Options,
    /// Labels to begin with, one a face, numbered from 0.
    pub start: Option<&'a [u32]>,
}

/// A mesh of fewer faces is cut into more before surfaces are sought: neighbourhoods need some.
const FEW_FACES: usize = 3000;
/// A piece of a region that lies apart is a region of its own from so many faces on.
const PIECE: u32 = 40;

/// Recognises the surfaces of a mesh; `scene` is that of its faces, and learns the noise.
///
/// # Errors
/// Cancellation, or a mesh that cannot be cut.
pub fn default(context: &mut Context, scene: &mut Scene, task: Task) -> Result<Outcome> {
    let Task { cube, options, start } = task;
    if cube.len() < FEW_FACES && !scene.tessellated {
        return subdivided(context, scene, task);
    }
    if start.is_none() && options.regions.is_none() {
        let sheets = context.timed("sheets", |context| shreds::recognise(context, scene))?;
        if let Some(sheets) = sheets {
            return Ok(sheets);
        }
    }
    if let Some(stand) = stand_ins(context, scene, task)? {
        return coarsened(context, scene, task, stand);
    }
    context.timed("prepare", |_| {
        scene.filter();
        Ok(())
    })?;
    let outcome = recognise::recognise(context, scene, options, start)?;
    let parents: Vec<u32> = (0..cube.len() as u32).collect();
    let mut found = context.timed("back", |_| Ok(back(outcome, cube, &parents, scene)))?;
    // On scans surfaces that hold still tear regions; a number that was asked for stays.
    if options.constraints.is_some() && !scene.correlated() && options.regions.is_none() {
        if start.is_none() && !scene.evidence.general {
            resume(context, scene, &mut found)?;
        }
        regroup(context, scene, &mut found)?;
    }
    // Regions that are given or counted stay; on a clean mesh no height field fits as surfaces do.
    if start.is_none() && options.regions.is_none() && !scene.evidence.general {
        let unite: Change = |scene, models, labels| patch::unite(scene, models, labels);
        change(context, "patches", scene, &mut found, unite)?;
        // Narrow walls show once all others are known.
        if scene.noisy() {
            change(context, "bands", scene, &mut found, bands::find)?;
        }
    }
    Ok(found)
}

/// What changes regions once they are known.
type Change = fn(&mut Scene, &mut Vec<Model>, &mut [u32]);

/// Lets a station change the regions that were found.
fn change(
    context: &mut Context,
    stage: &'static str,
    scene: &mut Scene,
    found: &mut Outcome,
    how: Change,
) -> Result<()> {
    context.timed(stage, |_| {
        let mut models = models(scene, &Regions::new(&found.labels), found.surfaces.iter());
        how(scene, &mut models, &mut found.labels);
        found.surfaces = models.into_iter().map(|model| model.surface).collect();
        Ok(())
    })
}

/// On a finer mesh.
fn subdivided(context: &mut Context, scene: &mut Scene, task: Task) -> Result<Outcome> {
    let Task { cube, options, start } = task;
    let fine = context.timed("subdivide", |_| subdivide(cube.mesh.clone(), options.max_edge))?;
    let working = Working::new(fine.mesh);
    let mut finer = context.timed("prepare", |_| {
        scene.filter();
        Ok(Scene::new(&working))
    })?;
    let start: Option<Labels> =
        start.map(|labels| fine.parents.iter().map(|&face| labels[face as usize]).collect());
    let outcome = recognise::recognise(context, &mut finer, options, start.as_deref())?;
    scene.evidence = finer.evidence;
    context.timed("back", |_| Ok(back(outcome, &working, &fine.parents, scene)))
}

/// Faces of the coarser mesh, and how many there must be for each; from how many on it always pays.
const COARSE_FACES: usize = 50_000;
const FACES_FOR_ONE: usize = 2;
const VERY_LARGE: usize = 2_000_000;
/// Means of a scan's vertices say more than these from so many faces on: not yet at 120,000, at 240,000
/// where the mesh breaks into pieces (decision 0006).
const DENSE_SCAN: usize = 200_000;
/// Where half of the faces turn by more against the next, in radians, they say less of the surfaces than
/// means of their vertices.
const NOISY: f64 = 0.5;

/// What the vertices of a coarser mesh are.
#[derive(Clone, Copy, PartialEq)]
enum StandIns {
    /// Vertices of the mesh itself.
    Vertices,
    /// Means of its vertices.
    Means,
}

/// On which coarser mesh surfaces are better sought, if on one; `scene` learns the noise of a dense scan.
fn stand_ins(context: &mut Context, scene: &mut Scene, task: Task) -> Result<Option<StandIns>> {
    let Task { cube, options, .. } = task;
    let few = cube.len() < FACES_FOR_ONE * COARSE_FACES;
    let asked = options.coarse == options::Coarse::On;
    // A tessellation has no vertex to spare.
    let exact = scene.tessellated && !asked;
    if options.coarse == options::Coarse::Off || exact || (few && !asked) {
        return Ok(None);
    }
    let noisy = context.timed("prepare", |_| Ok(noise::turn(cube) > NOISY))?;
    if noisy || (cube.len() >= DENSE_SCAN && is_scan(context, scene)?) {
        return Ok(Some(StandIns::Means));
    }
    let too_fine = asked || cube.len() >= VERY_LARGE || is_faceted(cube);
    Ok(too_fine.then_some(StandIns::Vertices))
}

/// Whether neighbouring vertices err together; a mesh that is quiet from vertex to vertex is not asked.
fn is_scan(context: &mut Context, scene: &mut Scene) -> Result<bool> {
    if scene.evidence.is_quiet() {
        return Ok(false);
    }
    context.timed("noise", |context| {
        scene.filter();
        evidence::measure(context, scene)
    })?;
    Ok(scene.correlated())
}

/// On a coarser mesh; then the faces choose among its surfaces.
fn coarsened(
    context: &mut Context,
    scene: &mut Scene,
    task: Task,
    stand: StandIns,
) -> Result<Outcome> {
    let Task { cube, options, start } = task;
    let means = stand == StandIns::Means;
    let Coarse { mesh, site, origin } = context.timed("coarsen", |_| {
        Ok(if means {
            gathered(cube, scene.evidence.sigma / scene.edge)
        } else {
            coarsen(cube, COARSE_FACES.min(cube.len() / FACES_FOR_ONE))
        })
    })?;
    let working = Working::new(mesh);
    let mut coarse = context.timed("prepare", |_| Ok(Scene::raw(&working)))?;
    let start: Option<Labels> =
        start.map(|labels| origin.iter().map(|&face| labels[face as usize]).collect());
    let options = Options { coarse: options::Coarse::Off, ..options.clone() };
    let coarser = Task { cube: &working, options: &options, start: start.as_deref() };
    let found = default(context, &mut coarse, coarser)?;
    let (mut models, mut labels) = context.timed("carry", |_| {
        scene.grain = (cube.len() / working.len().max(1)).max(1) as u32;
        if means {
            let size = site.len() as f64 / working.mesh.positions.len() as f64;
            scene.cells = Some(Cells { of_vertex: site.clone(), size });
            scene.normals = carry::normals(scene, &coarse, &site).into();
            scene.evidence.normal_sigma = coarse.evidence.normal_sigma;
        } else {
            scene.filter();
        }
        let normal_sigma = scene.evidence.normal_sigma.max(coarse.evidence.normal_sigma);
        scene.evidence = Evidence { normal_sigma, ..coarse.evidence };
        let regions = Regions::new(&found.labels);
        let mut models = models(&coarse, &regions, found.surfaces.iter());
        let labels = &found.labels;
        let labels = carry::carry(scene, &working.adjacency, &site, labels, &mut models);
        let surfaces: Vec<Surface> = models.iter().map(|model| model.surface.clone()).collect();
        evidence::carried(scene, &surfaces, &labels, means);
        Ok((models, labels))
    })?;
    // What noise hides from means of vertices, single ones do not show.
    if !means && options.regions.is_none() {
        context.timed("complete", |context| {
            carry::complete(context, scene, &mut models, &mut labels, is_faceted(cube))
        })?;
    }
    context.timed("settle", |_| {
        if means && options.regions.is_none() {
            unshown::drop_unshown(scene, &mut models, &mut labels);
        }
        carry::settle(scene, &mut models, &mut labels);
        let surfaces: Vec<Surface> = models.into_iter().map(|model| model.surface).collect();
        let parents: Vec<u32> = (0..cube.len() as u32).collect();
        let outcome = Outcome { labels, surfaces, energy: found.energy };
        Ok(back(outcome, cube, &parents, scene))
    })
}

/// Regions that hang together, on the faces of `scene` that those of `working` are parts of.
fn back(mut outcome: Outcome, working: &Working, parents: &[u32], scene: &Scene) -> Outcome {
    let origin = separate(&mut outcome.labels, &working.adjacency, PIECE * scene.grain);
    let back = labels_back(
        &outcome.labels,
        parents,
        &working.geometry.areas,
        scene.adjacency,
        &scene.geometry.normals,
        &scene.geometry.areas,
    );
    let surface = |&former: &u32| outcome.surfaces[origin[former as usize] as usize].clone();
    Outcome {
        surfaces: back.former.iter().map(surface).collect(),
        labels: back.labels,
        energy: outcome.energy,
    }
}

/// Goes on with the directions and axes that the surfaces show.
fn resume(context: &mut Context, scene: &mut Scene, found: &mut Outcome) -> Result<()> {
    let aligned = aligned(&refit(context, scene, found)?);
    // New types show more.
    scene.shown = Shown::by(&aligned);
    let models = models(scene, &Regions::new(&found.labels), aligned.iter());
    recognise::resume(context, scene, models, found)
}

/// The surfaces of the regions by the directions and axes that the scene learns from them.
fn refit(context: &mut Context, scene: &mut Scene, found: &Outcome) -> Result<Vec<Recognised>> {
    let mut fits = context
        .timed("describe", |context| fit_all(context, scene, &found.labels, &found.surfaces))?;
    retype(context, scene, &found.labels, &mut fits)?;
    Ok(fits)
}

/// Lets the constrained surfaces divide the faces anew (paper, 4.3(5)); where that tears regions,
/// all stays as it was.
fn regroup(context: &mut Context, scene: &mut Scene, found: &mut Outcome) -> Result<()> {
    let fits = refit(context, scene, found)?;
    let surfaces = context.timed("constrain", |_| Ok(equalised(&fits)))?;
    context.timed("assign", |_| {
        let mut labels = found.labels.clone();
        let regions = Regions::new(&labels);
        let mut models = models(scene, &regions, surfaces.iter());
        expand::expand(scene, &models, &mut labels);
        assign::connect(scene, &mut models, &mut labels);
        moves::tidy(&mut models, &mut labels);
        moves::drop_needless(scene, &models, &mut labels);
        moves::tidy(&mut models, &mut labels);
        if models.len() <= found.surfaces.len() {
            found.labels = labels;
            found.surfaces = models.into_iter().map(|model| model.surface).collect();
        }
        Ok(())
    })
}
