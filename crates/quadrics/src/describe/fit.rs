//! The last fit of a region: its type by few samples, its parameters by all of its vertices.

use crate::math::Point;
use crate::prepare::noise::ROUNDING;
use crate::recognise::scene::{Marks, Scene};
use crate::surface::select::{self, Choice};
use crate::surface::{Scatter, Shape, Surface, Waves, general, refine};

use super::confidence::{confidence, is_noteworthy};

/// Confidence in the type of a band: 71 of 101 and 24 of 36 were right (decision 0002).
const BAND: f64 = 0.7;
/// Vertices that the choice of a type looks at, and those that the parameters come from.
const CHOICE: usize = 400;
const PARAMETERS: usize = 5000;
/// A surface whose mean squared distance is above so many squared sigmas is not explained by noise.
const EXPLAINED: f64 = 2.5;
/// Rounds of reweighting, and Tukey's constant (95 % efficient under Gaussian noise).
const ROUNDS: usize = 8;
const TUKEY: f64 = 4.685;
/// From the median absolute distance to the standard deviation.
const MEDIAN: f64 = 1.4826;

/// The surface of a region, in the unit cube.
pub struct Recognised {
    /// Type and parameters.
    pub surface: Surface,
    /// Probability of the type.
    pub confidence: f64,
    /// The second best type, if it is not far behind.
    pub runner_up: Option<Surface>,
    /// The vertices that determine the parameters.
    pub support: Vec<Point>,
    /// Standard deviation of one of them, as if they erred independently.
    pub sigma: f64,
    /// How they err on a scan, where that could be measured.
    pub waves: Option<Waves>,
    /// How it may still move under the relations, once those hold.
    pub scatter: Option<Scatter>,
}

impl Recognised {
    /// Free-form, as far as we know.
    fn without_support(surface: Surface) -> Self {
        Self {
            surface,
            confidence: 0.5,
            runner_up: None,
            support: Vec::new(),
            sigma: 0.0,
            waves: None,
            scatter: None,
        }
    }
}

/// Fits the faces of one region anew. `known` is the surface that it was recognised by; it stays
/// where the noise explains no type.
pub fn fit(scene: &Scene, faces: &[u32], known: &Surface, marks: &mut Marks) -> Recognised {
    if scene.is_band(faces) {
        return kept(scene, faces, known.clone(), marks);
    }
    let mut choices = candidates(scene, faces, known, marks);
    let explained = choices.first().is_some_and(|best| best.misfit <= EXPLAINED);
    let chosen = |choice: &Choice| explained || choice.surface.is_like(known);
    let Some(at) = choices.iter().position(chosen) else {
        return Recognised::without_support(known.clone());
    };
    let best = choices.remove(at);
    let second = choices.into_iter().find(|other| !other.surface.is_like(&best.surface));
    let confidence = confidence(&best, second.as_ref());
    let runner_up = second.filter(|second| is_noteworthy(&best, second)).map(|c| c.surface);
    Recognised { confidence, runner_up, ..settled(scene, faces, best.surface, marks) }
}

/// A band's surface as it was found: its vertices alone would turn it.
fn kept(scene: &Scene, faces: &[u32], surface: Surface, marks: &mut Marks) -> Recognised {
    let support = scene.samples(faces, PARAMETERS, marks).points;
    let sigma = deviation(scene, &surface, &support);
    Recognised { support, sigma, confidence: BAND, ..Recognised::without_support(surface) }
}

/// The surface of that type that most vertices of a region agree on; nothing says how sure the type is.
pub fn settled(scene: &Scene, faces: &[u32], start: Surface, marks: &mut Marks) -> Recognised {
    let gathered = scene.samples(faces, PARAMETERS, marks);
    let (surface, support) = settle(start, gathered.points, scene.evidence.sigma / 4.0);
    let sigma = deviation(scene, &surface, &support);
    // The samples stand for all vertices, of which so many err independently.
    let independent = independent(gathered.total as f64, scene.evidence.independent);
    let sigma = sigma * (support.len() as f64 / independent.max(1.0)).sqrt();
    Recognised { support, sigma, ..Recognised::without_support(surface) }
}

/// Fewest and most independent samples of a region on a scan, whose waves are long: a small region
/// rides on one of them, a large one does not see more of them than fit into the part.
const WAVES: (f64, f64) = (12.0, 30.0);

/// How many of so many vertices err independently, when in the mesh this fraction does.
fn independent(vertices: f64, fraction: f64) -> f64 {
    if fraction < 1.0 {
        (vertices * fraction).clamp(WAVES.0, WAVES.1).min(vertices)
    } else {
        vertices
    }
}

/// All types that fit, the known surface among them, best criterion first.
fn candidates(scene: &Scene, faces: &[u32], known: &Surface, marks: &mut Marks) -> Vec<Choice> {
    let (gathered, evidence) = scene.means(faces, CHOICE, marks);
    let samples = gathered.samples();
    let mut choices = select::choose(samples, gathered.total, evidence);
    if known.is_general() {
        choices.extend(general::choose(samples, gathered.total, evidence));
    }
    if let Some(fit) = refine(known, samples.points, &[]) {
        choices.push(select::judge(fit.surface, samples, gathered.total, evidence));
    }
    choices.sort_by(|a, b| a.criterion.total_cmp(&b.criterion));
    choices
}

/// The surface that most of the points agree on, and the points that do: iterated reweighting, so that
/// faces of a neighbour do not pull.
fn settle(mut surface: Surface, points: Vec<Point>, floor: f64) -> (Surface, Vec<Point>) {
    let mut weights = vec![1.0; points.len()];
    let mut last = f64::INFINITY;
    for _ in 0..ROUNDS {
        let Some(fit) = refine(&surface, &points, &weights) else { break };
        surface = fit.surface;
        let distances = distances(&surface, &points);
        let mut sorted = distances.clone();
        let middle = sorted.len() / 2;
        let median = *sorted.select_nth_unstable_by(middle, f64::total_cmp).1;
        let reach = TUKEY * (MEDIAN * median).max(floor);
        let tukey = |d: &f64| (1.0 - (d / reach).powi(2)).max(0.0).powi(2);
        weights = distances.iter().map(tukey).collect();
        if (last - median).abs() <= 1e-3 * median {
            break;
        }
        last = median;
    }
    let kept = points.iter().zip(weights).filter(|(_, weight)| *weight > 0.0);
    let support = kept.map(|(point, _)| *point).collect();
    (surface, support)
}

/// Absolute distances from a surface.
fn distances(surface: &Surface, points: &[Point]) -> Vec<f64> {
    fn all<S: Shape>(shape: &S, points: &[Point]) -> Vec<f64> {
        points.iter().map(|p| shape.distance(*p).abs()).collect()
    }
    match surface {
        Surface::Plane(s) => all(s, points),
        Surface::Sphere(s) => all(s, points),
        Surface::Cylinder(s) => all(s, points),
        Surface::Cone(s) => all(s, points),
        Surface::Torus(s) => all(s, points),
        Surface::Quadric(s) => all(&s.principal(), points),
        Surface::FreeForm => vec![0.0; points.len()],
    }
}

/// Standard deviation of the support: that of the whole mesh, or more where this region has more.
fn deviation(scene: &Scene, surface: &Surface, support: &[Point]) -> f64 {
    let squares: f64 = distances(surface, support).iter().map(|d| d * d).sum();
    let own = (squares / support.len().max(1) as f64).sqrt();
    // A clean mesh has no noise of its own, only a floor that nothing may undercut.
    if scene.evidence.sigma <= ROUNDING { own } else { own.max(scene.evidence.sigma) }
}
