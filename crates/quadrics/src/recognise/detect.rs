//! Surfaces from neighbourhoods: draw where nothing is explained yet, fit, grow, keep the largest.

use rand::RngExt;
use rayon::prelude::*;

use super::assign::{Model, face_cost, side_of};
use super::facets;
use super::open::Waiting;
use super::pool::Pool;
use super::scene::{Marks, Scene};
use crate::context::Context;
use crate::error::Result;
use crate::partition::{Labels, UNLABELLED};
use crate::surface::select::{self, Choice};
use crate::surface::{Shape, Surface, refine_within};

/// Neighbourhood sizes in faces. A fit needs about a dozen vertices to mean anything, and a large
/// neighbourhood is worth trying only where the smaller one was one surface. The vertices of a tessellation
/// are exact: there the first is tried too, for fillets of few facets between planes.
const BALLS: [usize; 6] = [8, 14, 30, 70, 180, 450];
/// Neighbourhoods of fewer faces may be too small for the surface they lie on.
const SHOWS: usize = 70;
/// Seeds that compete for being accepted first.
const BATCH: usize = 12;
/// Adjacent faces whose normals differ more are not in one neighbourhood, in radians; those of bores of six
/// to eight vertices around do, those of a socket of six sides by yet more.
pub const CREASE: f64 = 0.6;
const CREASE_COARSE: f64 = 1.0;
/// Faces within so many sigmas belong to a growing region. Waviness and rounded edges make the
/// residuals of a scan heavy-tailed: less cuts its regions to pieces.
const REACH: f64 = 2.5;
const REACH_SCAN: f64 = 4.0;
/// Facets of a curved surface may turn away from it by so much, in radians. Those of small bores do by
/// more than 0.2; on clean meshes positions tell where the surface ends (decision 0002).
const FACETS: f64 = 0.3;
const FACETS_COARSE: f64 = 0.55;
const FACETS_NOISY: f64 = 0.2;
/// Vertices that a fit looks at while growing.
const SAMPLES: usize = 120;
/// Fewest faces of a region; of a tessellation three times two.
pub const FEWEST: usize = 10;
const FEWEST_EXACT: usize = 6;
/// What a face costs that no surface explains, in nats (8 is as good).
const UNEXPLAINED: f64 = 12.0;
/// A candidate is accepted while this share of what it saved is left by those before it.
const KEPT: f64 = 0.9;
/// Faces that tell how large the noise is: a region that has so many grows no further for that.
const LOOSE: usize = 20_000;
/// Times as far off as half of the others that the middle of a facet may lie.
const STRANGE: f64 = 10.0;
/// Most refits of a growing region.
const REFITS: usize = 8;

/// A surface and the connected faces that it explains.
#[derive(Clone)]
pub struct Candidate {
    /// The surface and how well it fits.
    pub choice: Choice,
    /// Its faces.
    pub faces: Vec<u32>,
    /// +1 where the mesh's normals agree with the surface's, else -1.
    pub side: f64,
}

impl Candidate {
    /// Its surface as a region's.
    pub fn into_model(self) -> Model {
        Model { surface: self.choice.surface, side: self.side }
    }

    /// Leaves out faces whose middles lie much further off than those of the others: all facets of a curved
    /// surface are about as fine, and the corners of a plane beside it lie on many a torus.
    fn drop_strangers(&mut self, scene: &Scene) {
        let off = |&face: &u32| {
            let middle = scene.geometry.barycentres[face as usize];
            self.choice.surface.distance(middle).map_or(f64::INFINITY, f64::abs)
        };
        let distances: Vec<f64> = self.faces.iter().map(off).collect();
        let mut sorted = distances.clone();
        let (_, median, _) = sorted.select_nth_unstable_by(distances.len() / 2, f64::total_cmp);
        let most = STRANGE * median.max(scene.evidence.sigma);
        let mut distances = distances.into_iter();
        self.faces.retain(|_| distances.next().is_some_and(|distance| distance <= most));
    }

    /// What each of the faces costs.
    fn costs(&self, scene: &Scene) -> Vec<f64> {
        let model = Model { surface: self.choice.surface.clone(), side: self.side };
        self.faces.iter().map(|&face| face_cost(scene, &model, face as usize)).collect()
    }

    /// Faces explained for the price of the surface: a torus over several ring bands is worth less
    /// than the largest of them.
    fn worth(&self) -> f64 {
        self.faces.len() as f64 / select::cost(&self.choice.surface)
    }

    /// What the surface costs, in nats, as in the choice of types.
    fn price(&self) -> f64 {
        2.0 * select::cost(&self.choice.surface) * (self.faces.len() as f64).ln()
    }
}

/// How far a region grows.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Growth {
    /// While only noise is left, and over faces that others explain too: what a neighbour took of
    /// a tangent surface comes back.
    Over,
    /// While only noise is left, not over faces that others explain.
    Within,
    /// The same where facets turn by more than those of fine surfaces do: what is left of a clean mesh.
    Coarse,
    /// Past what the noise explains: what is taken in shows how large the noise is.
    Loose,
}

/// Scratch sets that are made once.
#[derive(Default)]
pub struct Workspace {
    /// For vertices.
    pub vertices: Marks,
    /// For faces.
    pub faces: Marks,
}

/// Covers the mesh with surfaces, the planes of a tessellation first, then the largest; faces that nothing
/// explains stay unlabelled. `None` when seeds lead nowhere on more than a `share` of the faces.
///
/// # Errors
/// Cancellation.
pub fn detect(
    context: &mut Context,
    scene: &Scene,
    share: f64,
) -> Result<Option<(Labels, Vec<Model>)>> {
    let mut labels = vec![UNLABELLED; scene.mesh.faces.len()];
    let mut models = Vec::new();
    if scene.tessellated {
        facets::large(scene, &mut models, &mut labels);
    }
    // On a clean mesh neighbours take nothing that is not theirs.
    let growth = if scene.noisy() { Growth::Over } else { Growth::Within };
    let first = models.len() as u32;
    let Some(found) = explain(context, scene, &mut labels, growth, first, share)? else {
        return Ok(None);
    };
    models.extend(found.into_iter().map(Candidate::into_model));
    if scene.evidence.general {
        let first = models.len() as u32;
        let coarse = explain(context, scene, &mut labels, Growth::Coarse, first, 1.0)?;
        models.extend(coarse.into_iter().flatten().map(Candidate::into_model));
        facets::left(scene, &mut models, &mut labels);
    }
    Ok(Some((labels, models)))
}

/// The same for the faces that have no label yet; labels of what is found count from `first`.
///
/// # Errors
/// Cancellation.
pub fn explain(
    context: &mut Context,
    scene: &Scene,
    labels: &mut [u32],
    growth: Growth,
    first: u32,
    share: f64,
) -> Result<Option<Vec<Candidate>>> {
    let mut found: Vec<Candidate> = Vec::new();
    let pool = Pool::default();
    let cost = |&label: &u32| if label == UNLABELLED { UNEXPLAINED } else { 0.0 };
    let mut costs: Vec<f64> = labels.iter().map(cost).collect();
    let mut waiting = Waiting::new(labels);
    if growth == Growth::Coarse {
        let smooth = |&face: &u32| !is_creased(scene, labels, face as usize);
        (0..labels.len() as u32).filter(smooth).for_each(|face| waiting.open.close(face));
    }
    let total = waiting.open.len().max(1) as f64;
    while !waiting.open.is_empty() {
        context.step("detect", 1.0 - waiting.open.len() as f64 / total)?;
        let seeds: Vec<u32> = (0..BATCH)
            .map(|_| waiting.open.nth(context.rng.random_range(0..waiting.open.len())))
            .collect();
        let propose = |&seed: &u32| {
            let candidate = pool.with(|work| propose(scene, seed, labels, growth, work))?;
            let offer = Offer { seed, costs: candidate.costs(scene), candidate };
            let saved = offer.saving(&costs);
            let pays =
                offer.candidate.faces.len() >= fewest(scene) && saved > offer.candidate.price();
            pays.then_some((saved, offer))
        };
        let proposed: Vec<_> = seeds.par_iter().with_max_len(1).map(propose).collect();
        for (&seed, _) in seeds.iter().zip(&proposed).filter(|(_, proposed)| proposed.is_none()) {
            waiting.bury(scene, seed, labels);
        }
        let mut batch: Vec<(f64, Offer)> = proposed.into_iter().flatten().collect();
        let worth =
            |(saved, offer): &(f64, Offer)| saved / select::cost(&offer.candidate.choice.surface);
        batch.sort_by(|a, b| worth(b).total_cmp(&worth(a)));
        for (before, offer) in batch {
            if offer.saving(&costs) >= KEPT * before {
                let id = first + found.len() as u32;
                for (face, cost) in offer.each() {
                    if cost < costs[face as usize] {
                        waiting.take(face, labels);
                        labels[face as usize] = id;
                        costs[face as usize] = cost;
                    }
                }
                // A seed that its own surface does not explain would be drawn for ever.
                if labels[offer.seed as usize] == UNLABELLED {
                    waiting.bury(scene, offer.seed, labels);
                }
                found.push(offer.candidate);
            }
        }
        if waiting.buried as f64 > share * total {
            return Ok(None);
        }
    }
    Ok(Some(found))
}

/// Whether a crease that a coarse surface may have parts a face from the next, both without a label.
fn is_creased(scene: &Scene, labels: &[u32], face: usize) -> bool {
    let mut free = scene.adjacency.across(face).filter(|&other| labels[other] == UNLABELLED);
    labels[face] == UNLABELLED
        && free.any(|other| {
            let turn = scene.normals[face].dot(&scene.normals[other]);
            (CREASE_COARSE.cos()..CREASE.cos()).contains(&turn)
        })
}

/// A candidate, the seed that it grew from, and what its faces would cost.
struct Offer {
    seed: u32,
    candidate: Candidate,
    costs: Vec<f64>,
}

impl Offer {
    fn each(&self) -> impl Iterator<Item = (u32, f64)> {
        self.candidate.faces.iter().copied().zip(self.costs.iter().copied())
    }

    /// What the faces that would cost less save at the `costs` that they have.
    fn saving(&self, costs: &[f64]) -> f64 {
        let saved = |(face, cost): (u32, f64)| (costs[face as usize] - cost).max(0.0);
        self.each().map(saved).sum()
    }
}

/// What grows from the neighbourhoods of a seed, the worthiest of all types.
pub fn propose(
    scene: &Scene,
    seed: u32,
    labels: &[u32],
    growth: Growth,
    work: &mut Workspace,
) -> Option<Candidate> {
    // For every type the largest neighbourhood that it explains.
    let mut starts: Vec<Candidate> = Vec::new();
    for size in BALLS.into_iter().skip(usize::from(!scene.tessellated)) {
        let ball = neighbourhood(scene, seed, size, labels, growth, &mut work.faces);
        if ball.len() * 2 < size && !starts.is_empty() {
            break;
        }
        let choices = fit(scene, &ball, work);
        let fitting: Vec<Choice> =
            choices.into_iter().filter(|c| adequate(c, ball.len())).collect();
        if fitting.is_empty() {
            // A general quadric does not show before there are more vertices than coefficients.
            if starts.is_empty() && size < SHOWS { continue } else { break }
        }
        // The best comes last: it is the one that may change its type while it grows.
        for choice in fitting.into_iter().rev() {
            starts.retain(|start| !start.choice.surface.is_like(&choice.surface));
            let side = side_of(scene, &choice.surface, &ball);
            starts.push(Candidate { choice, faces: ball.clone(), side });
        }
    }
    let free = starts.last().cloned();
    let locked =
        starts.into_iter().filter_map(|start| grow(scene, start, true, labels, growth, work));
    let mut grown: Vec<Candidate> = locked.collect();
    grown.extend(free.and_then(|start| grow(scene, start, false, labels, growth, work)));
    if scene.tessellated {
        grown.iter_mut().for_each(|candidate| candidate.drop_strangers(scene));
    }
    grown.into_iter().max_by(|a, b| a.worth().total_cmp(&b.worth()))
}

/// Breadth first over faces that nothing explains, not across creases.
fn neighbourhood(
    scene: &Scene,
    seed: u32,
    size: usize,
    labels: &[u32],
    growth: Growth,
    seen: &mut Marks,
) -> Vec<u32> {
    let crease = if growth == Growth::Coarse { CREASE_COARSE } else { CREASE };
    let limit = crease.cos();
    seen.clear(labels.len());
    seen.mark(seed);
    let mut ball = vec![seed];
    let mut next = 0;
    while next < ball.len() && ball.len() < size {
        let face = ball[next] as usize;
        next += 1;
        for other in scene.adjacency.across(face) {
            if labels[other] == UNLABELLED
                && scene.normals[face].dot(&scene.normals[other]) > limit
                && seen.mark(other as u32)
            {
                ball.push(other as u32);
            }
        }
    }
    ball
}

fn fit(scene: &Scene, faces: &[u32], work: &mut Workspace) -> Vec<Choice> {
    let gathered = scene.samples(faces, SAMPLES, &mut work.vertices);
    select::choose(gathered.samples(), gathered.total, scene.evidence)
}

/// The same type, fitted to the candidate's faces.
fn fit_again(scene: &Scene, candidate: &Candidate, work: &mut Workspace) -> Option<Choice> {
    let gathered = scene.samples(&candidate.faces, SAMPLES, &mut work.vertices);
    let fit = refine_within(&candidate.choice.surface, &gathered.points, &[], AGAIN)?;
    let choice = select::judge(fit.surface, gathered.samples(), gathered.total, scene.evidence);
    adequate(&choice, candidate.faces.len()).then_some(choice)
}

/// Iterations of a fit that starts from a fit to fewer faces.
const AGAIN: usize = 4;

fn fewest(scene: &Scene) -> usize {
    if scene.tessellated { FEWEST_EXACT } else { FEWEST }
}

/// Whether nothing but noise is left: the mean square of `n` residuals scatters by `sqrt(2/n)`.
fn adequate(choice: &Choice, faces: usize) -> bool {
    choice.misfit < most_misfit(faces)
}

/// The largest misfit that noise alone leaves on a region of so many faces.
pub fn most_misfit(faces: usize) -> f64 {
    let vertices = faces as f64 / 2.0 + 3.0;
    1.2 + 3.0 * (2.0 / vertices).sqrt()
}

/// Alternates between taking the connected faces near the surface and fitting it to them.
pub(super) fn grow(
    scene: &Scene,
    start: Candidate,
    keep_type: bool,
    labels: &[u32],
    growth: Growth,
    work: &mut Workspace,
) -> Option<Candidate> {
    let mut current = start;
    let mut fitted = current.faces.len();
    for _ in 0..REFITS {
        let faces = connected_inliers(scene, &current, labels, growth, &mut work.faces);
        if faces.len() < fewest(scene) {
            return None;
        }
        let grown = faces.len() as f64 / fitted as f64;
        let shrunk = faces.len() < current.faces.len();
        let before = std::mem::replace(&mut current.faces, faces);
        if !(0.97..1.03).contains(&grown) && !shrunk {
            fitted = current.faces.len();
            let strict = growth != Growth::Loose;
            let choice = if keep_type {
                fit_again(scene, &current, work)
            } else {
                let best = fit(scene, &current.faces, work).into_iter().next();
                best.filter(|choice| !strict || adequate(choice, current.faces.len()))
            };
            let Some(choice) = choice else {
                if strict {
                    current.faces = before;
                }
                break;
            };
            current.side = side_of(scene, &choice.surface, &current.faces);
            current.choice = choice;
        } else {
            break;
        }
    }
    Some(current)
}

/// Faces that the surface explains and that hang together with the candidate's.
fn connected_inliers(
    scene: &Scene,
    candidate: &Candidate,
    labels: &[u32],
    growth: Growth,
    seen: &mut Marks,
) -> Vec<u32> {
    match &candidate.choice.surface {
        Surface::Plane(s) => inliers_of(scene, s, candidate, labels, growth, seen),
        Surface::Sphere(s) => inliers_of(scene, s, candidate, labels, growth, seen),
        Surface::Cylinder(s) => inliers_of(scene, s, candidate, labels, growth, seen),
        Surface::Cone(s) => inliers_of(scene, s, candidate, labels, growth, seen),
        Surface::Torus(s) => inliers_of(scene, s, candidate, labels, growth, seen),
        Surface::Quadric(s) => inliers_of(scene, &s.principal(), candidate, labels, growth, seen),
        Surface::FreeForm => Vec::new(),
    }
}

fn inliers_of<S: Shape>(
    scene: &Scene,
    shape: &S,
    candidate: &Candidate,
    labels: &[u32],
    growth: Growth,
    seen: &mut Marks,
) -> Vec<u32> {
    let reach = if scene.correlated() { REACH_SCAN } else { REACH };
    let near = (reach * scene.evidence.sigma).powi(2);
    let facets = match growth {
        Growth::Coarse => FACETS_COARSE,
        _ if scene.evidence.general => FACETS,
        _ => FACETS_NOISY,
    };
    let turn = (REACH * scene.evidence.normal_sigma).max(facets).powi(2);
    let limit = if growth == Growth::Loose { LOOSE } else { usize::MAX };
    let explains = |face: usize| {
        (growth == Growth::Over || labels[face] == UNLABELLED)
            && scene.squared_distance(shape, face) < near
            && scene.normal_deviation(shape, face, candidate.side) < turn
    };
    seen.clear(labels.len());
    let mut faces: Vec<u32> = Vec::with_capacity(candidate.faces.len() * 2);
    // Only the largest connected part counts: a grown region may have been cut by a refit.
    let mut best: (usize, usize) = (0, 0);
    for &start in &candidate.faces {
        if seen.has(start) || !explains(start as usize) {
            continue;
        }
        seen.mark(start);
        let from = faces.len();
        faces.push(start);
        let mut next = from;
        while next < faces.len() && faces.len() < limit {
            let face = faces[next] as usize;
            next += 1;
            for other in scene.adjacency.across(face) {
                if !seen.has(other as u32) && explains(other) {
                    seen.mark(other as u32);
                    faces.push(other as u32);
                }
            }
        }
        if faces.len() - from > best.1 - best.0 {
            best = (from, faces.len());
        }
    }
    faces[best.0..best.1].to_vec()
}
