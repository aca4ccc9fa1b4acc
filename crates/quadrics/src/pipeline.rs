//! The stations in order, nothing else.

use crate::baseline::baseline;
use crate::context::Context;
use crate::describe::{describe, fit_all, neighbours};
use crate::error::{Error, Result};
use crate::impose::{equalise, impose};
use crate::math::Similarity;
use crate::mesh::{Mesh, Working, repair};
use crate::options::{self, Method, Options, Preset};
use crate::paper::paper;
use crate::partition::{Labels, Regions, UNLABELLED, compact, hand_out, separate};
use crate::prepare::{
    Coarse, coarsen, in_own_cube, in_unit_cube, is_faceted, labels_back, subdivide,
};
use crate::recognise::assign::{self, Model};
use crate::recognise::detect::side_of;
use crate::recognise::{self, Outcome, carry, evidence, moves, scene::Scene};
use crate::result::{Noise, Repair, Segmentation};
use crate::surface::Surface;
use crate::surface::select::Evidence;

/// Segments a mesh into regions, each with its surface.
///
/// Regions are numbered by their first face. `initial_labels`, one a face in any numbering
/// ([`UNLABELLED`] for none), replaces the detection: the loop starts from any labels.
///
/// # Errors
/// What is wrong with the mesh or the options, or [`Error::Cancelled`].
pub fn segment(
    context: &mut Context,
    mesh: &Mesh,
    options: &Options,
    initial_labels: Option<&[u32]>,
) -> Result<Segmentation> {
    options.check()?;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(options.threads).build();
    let pool = pool.map_err(|e| Error::Option(format!("{} threads: {e}", options.threads)))?;
    pool.install(|| run(context, mesh, options, initial_labels))
}

fn run(
    context: &mut Context,
    mesh: &Mesh,
    options: &Options,
    initial_labels: Option<&[u32]>,
) -> Result<Segmentation> {
    let (clean, mut repairs) = context.timed("repair", |_| Clean::new(mesh, options))?;
    let Clean { cube, parent, representative, out } = clean;
    let start = initial_labels.map(|labels| start(labels, mesh, &parent, &cube)).transpose()?;
    let mut scene = context.timed("prepare", |_| Ok(Scene::raw(&cube)))?;
    let found = match (options.method, options.preset) {
        (Method::Quadrics, Preset::Default) => {
            by_default(context, &cube, &mut scene, options, start.as_deref())?
        }
        _ => by_paper(context, &mut scene, options, start.as_deref())?,
    };
    let demands = options.constraints.as_ref().filter(|_| options.method == Method::Quadrics);
    let (labels, former) = to_input(&found.labels, &representative);
    let on_clean: Labels = parent.iter().map(|&face| labels[face as usize]).collect();
    let surfaces: Vec<Surface> =
        former.iter().map(|&old| found.surfaces[old as usize].clone()).collect();
    let mut fits =
        context.timed("describe", |context| fit_all(context, &scene, &on_clean, &surfaces))?;
    let beside = neighbours(&on_clean, scene.adjacency, fits.len());
    let (relations, dimensions) = match demands {
        Some(demands) => {
            context.timed("constrain", |_| impose(&mut fits, &beside, demands, &out))?
        }
        None => Default::default(),
    };
    let mut described =
        context.timed("describe", |_| Ok(describe(&scene, &on_clean, &fits, &out)))?;
    described.regions.iter_mut().for_each(|region| region.faces = 0);
    labels.iter().for_each(|&label| described.regions[label as usize].faces += 1);
    repairs.extend(found.repairs);
    let position = scene.evidence.sigma * out.scaling();
    Ok(Segmentation {
        labels,
        regions: described.regions,
        relations,
        dimensions,
        noise: Noise { position, normal_deg: described.normal_deg },
        repairs,
        energy: found.energy,
        timing: context.timing().to_vec(),
    })
}

/// Lets the constrained surfaces divide the faces anew (paper, 4.3(5)).
fn regroup(context: &mut Context, scene: &Scene, found: &mut Found) -> Result<()> {
    let mut fits = context
        .timed("describe", |context| fit_all(context, scene, &found.labels, &found.surfaces))?;
    context.timed("constrain", |_| {
        equalise(&mut fits);
        Ok(())
    })?;
    context.timed("assign", |_| {
        let surfaces: Vec<Surface> = fits.into_iter().map(|fit| fit.surface).collect();
        let mut models = models(scene, &found.labels, surfaces);
        assign::expand(scene, &models, &mut found.labels);
        assign::connect(scene, &mut models, &mut found.labels);
        moves::tidy(&mut models, &mut found.labels);
        moves::drop_needless(scene, &models, &mut found.labels);
        moves::tidy(&mut models, &mut found.labels);
        found.surfaces = models.into_iter().map(|model| model.surface).collect();
        Ok(())
    })
}

/// Surfaces with the side of the material.
fn models(scene: &Scene, labels: &[u32], surfaces: Vec<Surface>) -> Vec<Model> {
    let regions = Regions::new(labels);
    let model = |(i, surface)| Model { side: side_of(scene, &surface, regions.faces(i)), surface };
    surfaces.into_iter().enumerate().map(model).collect()
}

/// The mesh that both methods work on, and how it hangs together with the input.
struct Clean {
    /// Repaired, in the unit cube, in its own order.
    cube: Working,
    /// The input face of every face.
    parent: Vec<u32>,
    /// The face whose label every input face takes.
    representative: Vec<u32>,
    /// From the unit cube to the input.
    out: Similarity,
}

impl Clean {
    fn new(mesh: &Mesh, options: &Options) -> Result<(Self, Vec<Repair>)> {
        let repaired = repair(mesh)?;
        // The paper's unit cube is that of the input's axes.
        let (mesh, former, into) = match (options.method, options.preset) {
            (Method::Quadrics, Preset::Default) => in_own_cube(repaired.mesh)?,
            _ => in_unit_cube(repaired.mesh)?,
        };
        let mut new = vec![0; former.len()];
        former.iter().zip(0..).for_each(|(&old, face)| new[old as usize] = face);
        let clean = Self {
            cube: Working::new(mesh),
            parent: former.iter().map(|&old| repaired.parent[old as usize]).collect(),
            representative: repaired.representative.iter().map(|&f| new[f as usize]).collect(),
            out: into.inverse(),
        };
        Ok((clean, repaired.repairs))
    }
}

/// What either method finds on the faces of the clean mesh, in the unit cube.
struct Found {
    labels: Labels,
    /// One for every label.
    surfaces: Vec<Surface>,
    energy: Vec<f64>,
    repairs: Vec<Repair>,
}

/// A mesh of fewer faces is cut into more before surfaces are sought: neighbourhoods need some.
const FEW_FACES: usize = 3000;
/// A piece of a region that lies apart is a region of its own from so many faces on.
const PIECE: u32 = 40;

fn by_default(
    context: &mut Context,
    cube: &Working,
    scene: &mut Scene,
    options: &Options,
    start: Option<&[u32]>,
) -> Result<Found> {
    if cube.len() < FEW_FACES {
        return subdivided(context, cube, scene, options, start);
    }
    if context.timed("prepare", |_| Ok(is_too_fine(cube, scene, options.coarse)))? {
        return coarsened(context, cube, scene, options, start);
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
        regroup(context, scene, &mut found)?;
    }
    Ok(found)
}

/// On a finer mesh.
fn subdivided(
    context: &mut Context,
    cube: &Working,
    scene: &mut Scene,
    options: &Options,
    start: Option<&[u32]>,
) -> Result<Found> {
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
/// Where sigma is above this share of an edge, faces say less of the surfaces than a coarser mesh.
const NOISY: f64 = 1.0 / 3.0;

/// Whether surfaces are better sought on a coarser mesh.
fn is_too_fine(cube: &Working, scene: &Scene, choice: options::Coarse) -> bool {
    let count = cube.len();
    match choice {
        options::Coarse::Off => false,
        options::Coarse::On => true,
        options::Coarse::Auto if count < FACES_FOR_ONE * COARSE_FACES => false,
        options::Coarse::Auto => {
            count >= VERY_LARGE || scene.evidence.sigma > NOISY * scene.edge || is_faceted(cube)
        }
    }
}

/// On a coarser mesh; then the faces choose among its surfaces.
fn coarsened(
    context: &mut Context,
    cube: &Working,
    scene: &mut Scene,
    options: &Options,
    start: Option<&[u32]>,
) -> Result<Found> {
    let noise = scene.evidence.sigma / scene.edge;
    let Coarse { mesh, site, origin, averaged } = context.timed("coarsen", |_| {
        Ok(coarsen(cube, COARSE_FACES.min(cube.len() / FACES_FOR_ONE), noise))
    })?;
    let working = Working::new(mesh);
    let mut coarse = context.timed("prepare", |_| Ok(Scene::raw(&working)))?;
    let start: Option<Labels> =
        start.map(|labels| origin.iter().map(|&face| labels[face as usize]).collect());
    let options = Options { coarse: options::Coarse::Off, ..options.clone() };
    let found = by_default(context, &working, &mut coarse, &options, start.as_deref())?;
    let (mut models, mut labels) = context.timed("carry", |_| {
        scene.grain = (cube.len() / working.len().max(1)).max(1) as u32;
        if averaged > 1 {
            scene.normals = carry::normals(scene, &coarse, &site).into();
            scene.evidence.normal_sigma = coarse.evidence.normal_sigma;
        } else {
            scene.filter();
        }
        let normal_sigma = scene.evidence.normal_sigma.max(coarse.evidence.normal_sigma);
        scene.evidence = Evidence { normal_sigma, ..coarse.evidence };
        let mut models = models(&coarse, &found.labels, found.surfaces);
        let labels = &found.labels;
        let labels = carry::carry(scene, &working.adjacency, &site, labels, &mut models);
        let surfaces: Vec<Surface> = models.iter().map(|model| model.surface.clone()).collect();
        evidence::carried(scene, &surfaces, &labels, averaged > 1);
        Ok((models, labels))
    })?;
    // What noise hides from means of vertices, single ones do not show.
    if averaged == 1 && options.regions.is_none() {
        context.timed("complete", |context| {
            carry::complete(context, scene, &mut models, &mut labels)
        })?;
    }
    context.timed("settle", |_| {
        carry::settle(scene, &mut models, &mut labels);
        let surfaces: Vec<Surface> = models.into_iter().map(|model| model.surface).collect();
        let parents: Vec<u32> = (0..cube.len() as u32).collect();
        let outcome = Outcome { labels, surfaces, energy: found.energy };
        Ok(back(outcome, cube, &parents, scene))
    })
}

/// Regions that hang together, on the faces of `scene` that those of `working` are parts of.
fn back(mut outcome: Outcome, working: &Working, parents: &[u32], scene: &Scene) -> Found {
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
    Found {
        surfaces: back.former.iter().map(surface).collect(),
        labels: back.labels,
        energy: outcome.energy,
        repairs: Vec::new(),
    }
}

fn by_paper(
    context: &mut Context,
    scene: &mut Scene,
    options: &Options,
    start: Option<&[u32]>,
) -> Result<Found> {
    let found = match options.method {
        Method::Quadrics => paper(context, scene.mesh, options, start)?,
        _ => baseline(context, scene.mesh, options, start)?,
    };
    context.timed("prepare", |_| {
        scene.filter();
        Ok(())
    })?;
    context.timed("noise", |context| evidence::measure(context, scene))?;
    let (labels, surfaces) = (found.labels, found.proxies);
    Ok(Found { labels, surfaces, energy: found.energy, repairs: found.repairs })
}

/// The user's labels on the clean mesh, numbered from 0; faces that have none go to a neighbour.
fn start(labels: &[u32], mesh: &Mesh, parent: &[u32], cube: &Working) -> Result<Labels> {
    let (given, faces) = (labels.len(), mesh.faces.len());
    if given != faces {
        let text = format!("{given} initial labels for {faces} faces: give one each");
        return Err(Error::Option(text));
    }
    let mut known: Vec<u32> = labels.iter().copied().filter(|&l| l != UNLABELLED).collect();
    known.sort_unstable();
    known.dedup();
    let number = |face: &u32| known.binary_search(&labels[*face as usize]);
    let mut start: Labels =
        parent.iter().map(|face| number(face).map_or(UNLABELLED, |n| n as u32)).collect();
    hand_out(&mut start, &cube.adjacency, &cube.geometry.normals);
    compact(&mut start);
    Ok(start)
}

/// Labels of the input's faces, numbered by first face, and the number that every region had.
fn to_input(labels: &[u32], representative: &[u32]) -> (Labels, Vec<u32>) {
    let old: Labels = representative.iter().map(|&face| labels[face as usize]).collect();
    let mut new = old.clone();
    let count = compact(&mut new);
    let mut former = vec![UNLABELLED; count];
    new.iter().zip(old).for_each(|(&label, old)| former[label as usize] = old);
    (new, former)
}
