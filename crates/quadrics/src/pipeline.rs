//! The stations in order, nothing else.

use std::borrow::Cow;

use crate::baseline::baseline;
use crate::context::Context;
use crate::default::{Task, default};
use crate::describe::{describe, fit_all, neighbours};
use crate::error::{Error, Result};
use crate::impose::impose;
use crate::math::Similarity;
use crate::mesh::{Mesh, Working, repair};
use crate::options::{Method, Options, Preset};
use crate::paper::paper;
use crate::partition::{Labels, UNLABELLED, compact, hand_out};
use crate::prepare::{in_own_cube, in_unit_cube};
use crate::recognise::{Outcome, evidence, scene::Scene};
use crate::result::{Noise, Repair, Segmentation};
use crate::retype::retype;
use crate::surface::Surface;

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
            let task = Task { cube: &cube, options, start: start.as_deref() };
            default(context, &mut scene, task)?
        }
        _ => by_paper(context, &mut scene, options, start.as_deref(), &mut repairs)?,
    };
    let demands = options.constraints.as_ref().filter(|_| options.method == Method::Quadrics);
    let (labels, former) = to_input(&found.labels, &representative);
    let on_clean: Labels = parent.iter().map(|&face| labels[face as usize]).collect();
    let surfaces: Vec<Surface> =
        former.iter().map(|&old| found.surfaces[old as usize].clone()).collect();
    let mut fits =
        context.timed("describe", |context| fit_all(context, &scene, &on_clean, &surfaces))?;
    if demands.is_some() && options.preset == Preset::Default {
        retype(context, &mut scene, &on_clean, &mut fits)?;
    }
    let beside = neighbours(&on_clean, scene.adjacency, fits.len());
    let (relations, dimensions) = match demands {
        Some(demands) => {
            context.timed("constrain", |_| impose(&mut fits, &beside, demands, &out))?
        }
        None => Default::default(),
    };
    // What is said of the vertices is said of those that were given.
    scene.mesh = Cow::Borrowed(&cube.mesh);
    let mut described =
        context.timed("describe", |_| Ok(describe(&scene, &on_clean, &fits, &out)))?;
    described.regions.iter_mut().for_each(|region| region.faces = 0);
    labels.iter().for_each(|&label| described.regions[label as usize].faces += 1);
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

fn by_paper(
    context: &mut Context,
    scene: &mut Scene,
    options: &Options,
    start: Option<&[u32]>,
    repairs: &mut Vec<Repair>,
) -> Result<Outcome> {
    let found = match options.method {
        Method::Quadrics => paper(context, &scene.mesh, options, start)?,
        _ => baseline(context, &scene.mesh, options, start)?,
    };
    context.timed("prepare", |_| {
        scene.filter();
        Ok(())
    })?;
    context.timed("noise", |context| evidence::measure(context, scene))?;
    repairs.extend(found.repairs);
    Ok(Outcome { labels: found.labels, surfaces: found.proxies, energy: found.energy })
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
