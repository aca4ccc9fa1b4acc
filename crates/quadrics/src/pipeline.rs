//! The stations in order, nothing else.

use crate::baseline::baseline;
use crate::context::Context;
use crate::describe::{describe, fit_all, neighbours};
use crate::error::{Error, Result};
use crate::impose::{equalise, impose};
use crate::math::Similarity;
use crate::mesh::{Mesh, Working, repair};
use crate::options::{Method, Options, Preset};
use crate::paper::paper;
use crate::partition::{Labels, Regions, UNLABELLED, compact, hand_out, separate};
use crate::prepare::{in_own_cube, in_unit_cube, labels_back, subdivide};
use crate::recognise::assign::{self, Model};
use crate::recognise::detect::side_of;
use crate::recognise::{self, evidence, moves, scene::Scene};
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
    let mut found = match (options.method, options.preset) {
        (Method::Quadrics, Preset::Default) => {
            by_default(context, &cube, options, start.as_deref())?
        }
        _ => by_paper(context, &cube, options, start.as_deref())?,
    };
    // On scans surfaces that hold still tear regions; a number that was asked for stays.
    let regular = found.evidence.independent == 1.0 && options.regions.is_none();
    let fine = options.preset == Preset::Default && cube.len() >= FEW_FACES;
    let demands = options.constraints.as_ref().filter(|_| options.method == Method::Quadrics);
    // By what the data say alone: the user's demands are about the regions that come of it.
    if demands.is_some() && regular && fine {
        regroup(context, &cube, &mut found)?;
    }
    let (labels, former) = to_input(&found.labels, &representative);
    let on_clean: Labels = parent.iter().map(|&face| labels[face as usize]).collect();
    let surfaces: Vec<Surface> =
        former.iter().map(|&old| found.surfaces[old as usize].clone()).collect();
    let mut scene = Scene::new(&cube.mesh);
    scene.evidence = found.evidence;
    let mut fits =
        context.timed("describe", |context| fit_all(context, &scene, &on_clean, &surfaces))?;
    let beside = neighbours(&on_clean, &scene.adjacency, fits.len());
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
    let position = found.evidence.sigma * out.scaling();
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
fn regroup(context: &mut Context, cube: &Working, found: &mut Found) -> Result<()> {
    let mut scene = Scene::new(&cube.mesh);
    scene.evidence = found.evidence;
    let mut fits = context
        .timed("describe", |context| fit_all(context, &scene, &found.labels, &found.surfaces))?;
    context.timed("constrain", |_| {
        equalise(&mut fits);
        Ok(())
    })?;
    context.timed("assign", |_| {
        let regions = Regions::new(&found.labels);
        let mut models: Vec<Model> = fits
            .into_iter()
            .enumerate()
            .map(|(i, fit)| Model {
                side: side_of(&scene, &fit.surface, regions.faces(i)),
                surface: fit.surface,
            })
            .collect();
        assign::expand(&scene, &models, &mut found.labels);
        assign::connect(&scene, &mut models, &mut found.labels);
        moves::tidy(&mut models, &mut found.labels);
        moves::drop_needless(&scene, &models, &mut found.labels);
        moves::tidy(&mut models, &mut found.labels);
        found.surfaces = models.into_iter().map(|model| model.surface).collect();
        Ok(())
    })
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
    evidence: Evidence,
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
    options: &Options,
    start: Option<&[u32]>,
) -> Result<Found> {
    let coarse = cube.len() < FEW_FACES;
    let max_edge = if coarse { options.max_edge } else { f64::INFINITY };
    let fine = context.timed("subdivide", |_| subdivide(cube.mesh.clone(), max_edge))?;
    let start: Option<Labels> =
        start.map(|labels| fine.parents.iter().map(|&face| labels[face as usize]).collect());
    let mut outcome = recognise::recognise(context, &fine.mesh, options, start.as_deref())?;
    context.timed("back", |_| {
        let working = Working::new(fine.mesh);
        let origin = separate(&mut outcome.labels, &working.adjacency, PIECE);
        let back = labels_back(
            &outcome.labels,
            &fine.parents,
            &working.geometry.areas,
            &cube.adjacency,
            &cube.geometry.normals,
            &cube.geometry.areas,
        );
        let surface = |&former: &u32| outcome.surfaces[origin[former as usize] as usize].clone();
        Ok(Found {
            surfaces: back.former.iter().map(surface).collect(),
            labels: back.labels,
            evidence: outcome.evidence,
            energy: outcome.energy.clone(),
            repairs: Vec::new(),
        })
    })
}

fn by_paper(
    context: &mut Context,
    cube: &Working,
    options: &Options,
    start: Option<&[u32]>,
) -> Result<Found> {
    let found = match options.method {
        Method::Quadrics => paper(context, &cube.mesh, options, start)?,
        _ => baseline(context, &cube.mesh, options, start)?,
    };
    let evidence = context.timed("noise", |context| {
        let mut scene = Scene::new(&cube.mesh);
        evidence::measure(context, &mut scene)?;
        Ok(scene.evidence)
    })?;
    let (labels, surfaces) = (found.labels, found.proxies);
    Ok(Found { labels, surfaces, evidence, energy: found.energy, repairs: found.repairs })
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
