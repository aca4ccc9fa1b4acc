//! Merging: two regions that one surface explains become one, best gain first.

use std::collections::BTreeMap;

use rayon::prelude::*;

use super::assign::Model;
use super::moves::{LABEL, SAMPLES, best, borders, tidy};
use super::pool::Pool;
use super::related::priced;
use super::scene::{Marks, Scene};
use crate::context::Context;
use crate::error::Result;
use crate::math::Point;
use crate::partition::Regions;
use crate::surface::Surface;
use crate::surface::select::{self, Choice, Evidence};

/// Regions whose normals differ more across their border, on the mean, are not one surface. Under
/// independent noise normals come filtered so that they differ less.
const SMOOTH_DEG: f64 = 25.0;
const SMOOTH_NOISY_DEG: f64 = 18.0;

/// Squared difference of normals from which a border is no longer smooth.
pub(super) fn smooth(scene: &Scene) -> f64 {
    let degrees = if scene.noisy() { SMOOTH_NOISY_DEG } else { SMOOTH_DEG };
    2.0 - 2.0 * degrees.to_radians().cos()
}

/// What one surface for two regions must save beside its price under independent noise, and two for
/// one: a difference that chance makes is not worth a change (10 and 40 are about as good). On scans,
/// whose waviness tears regions, and on clean meshes one surface may cost more by the price of the labels.
pub(super) const CHANGE: f64 = 20.0;
const CHANGE_ELSE: f64 = -2.0 * LABEL;
/// On scans neighbours err together, and two surfaces follow their waves better than one without there
/// being two: one of their type that leaves less than this misfit, which is noise, is no loss.
const WAVES: f64 = 1.0;

/// Vertices of either region that one surface for both must not fit much worse than the region's own. The
/// samples of both together hold few of a small one beside a large one, so their misfit errs by more than a
/// fillet is worth; the difference on the same vertices does not.
const WITNESSES: usize = 600;
/// How much worse, beside what the prices save, in units of the criterion (30 is as good, decision 0002).
const REFUSED: f64 = 80.0;

/// A pair of adjacent regions and what merging them gains.
struct Union {
    gain: f64,
    choice: Choice,
    vertices: usize,
}

/// What a region is worth as it is.
struct Side {
    criterion: f64,
    vertices: usize,
    /// Under independent noise.
    witness: Option<Witness>,
}

impl Side {
    fn new(
        scene: &Scene,
        evidence: Evidence,
        faces: &[u32],
        (choice, vertices): (&Choice, usize),
        marks: &mut Marks,
    ) -> Self {
        let witness = scene.noisy().then(|| {
            let points = scene.samples(faces, WITNESSES, marks).points;
            let misfit = select::misfit(&choice.surface, &points, evidence.sigma);
            Witness { price: price(choice, vertices, evidence), points, misfit }
        });
        Self { criterion: choice.criterion, vertices, witness }
    }

    /// What its own surface is worth more than another for its vertices, as far as they are asked.
    fn loss(&self, other: &Surface, evidence: Evidence) -> Option<f64> {
        let Witness { price, points, misfit } = self.witness.as_ref()?;
        let worse = select::misfit(other, points, evidence.sigma) - misfit;
        Some(evidence.samples(self.vertices) * worse - price)
    }
}

/// Some vertices of a region.
struct Witness {
    /// What its surface costs, whatever it leaves.
    price: f64,
    points: Vec<Point>,
    /// What its surface leaves on them.
    misfit: f64,
}

/// What a choice costs whatever it leaves of so many vertices.
fn price(choice: &Choice, vertices: usize, evidence: Evidence) -> f64 {
    choice.criterion - evidence.samples(vertices) * choice.misfit
}

/// Regions while they merge; a pair is judged once, and again when one of the two has changed.
struct Merger<'s, 'm> {
    scene: &'s Scene<'m>,
    evidence: Evidence,
    faces: Vec<Vec<u32>>,
    sides: Vec<Side>,
    unions: BTreeMap<(u32, u32), Option<Union>>,
    pool: Pool<Marks>,
}

/// Merges while the criterion falls.
///
/// # Errors
/// Cancellation.
pub fn merge(
    context: &mut Context,
    scene: &Scene,
    models: &mut Vec<Model>,
    labels: &mut [u32],
) -> Result<()> {
    let smooth = smooth(scene);
    let least = if scene.noisy() { CHANGE } else { CHANGE_ELSE };
    let mut merger = Merger::new(scene, models, labels);
    loop {
        context.step("merge", 0.0)?;
        let typed = |id: u32| !matches!(models[id as usize].surface, Surface::FreeForm);
        let pairs = borders(scene, labels).into_iter();
        merger.judge(models, pairs.filter(|b| b.2 < smooth && typed(b.0) && typed(b.1)));
        if merger.apply(models, labels, least, usize::MAX) == 0 {
            break;
        }
    }
    tidy(models, labels);
    Ok(())
}

/// Merges the pairs of least increase until `goal` regions are left, or no two touch.
///
/// # Errors
/// Cancellation.
pub fn merge_down(
    context: &mut Context,
    scene: &Scene,
    models: &mut Vec<Model>,
    labels: &mut [u32],
    goal: usize,
) -> Result<()> {
    let mut merger = Merger::new(scene, models, labels);
    let mut count = models.len();
    while count > goal {
        context.step("merge", 0.0)?;
        merger.judge(models, borders(scene, labels).into_iter());
        let merged = merger.apply(models, labels, f64::NEG_INFINITY, 1);
        if merged == 0 {
            break;
        }
        count -= merged;
    }
    tidy(models, labels);
    Ok(())
}

impl<'s, 'm> Merger<'s, 'm> {
    fn new(scene: &'s Scene<'m>, models: &[Model], labels: &[u32]) -> Self {
        let faces: Vec<Vec<u32>> = Regions::new(labels).iter().map(<[u32]>::to_vec).collect();
        let evidence = merging(scene.evidence);
        let pool = Pool::<Marks>::default();
        let side = |(faces, model): (&Vec<u32>, &Model)| {
            pool.with(|marks| {
                let gathered = scene.samples(faces, SAMPLES, marks);
                let choice = priced(scene, model.surface.clone(), &gathered, evidence);
                Side::new(scene, evidence, faces, (&choice, gathered.total), marks)
            })
        };
        let sides = faces.par_iter().zip(models).map(side).collect();
        Self { scene, evidence, faces, sides, unions: BTreeMap::new(), pool }
    }

    /// Fits one surface to both regions of every pair that is not known yet.
    fn judge(&mut self, models: &[Model], pairs: impl Iterator<Item = (u32, u32, f64)>) {
        let unknown: Vec<(u32, u32)> =
            pairs.map(|(a, b, _)| (a, b)).filter(|pair| !self.unions.contains_key(pair)).collect();
        let judged: Vec<Option<Union>> = unknown
            .par_iter()
            .with_max_len(1)
            .map(|&(a, b)| {
                let joined = self.joined(a, b);
                let gathered = self.pool.with(|marks| self.scene.samples(&joined, SAMPLES, marks));
                let choice = best(self.scene, &gathered, self.evidence)?;
                let [one, other] = [a, b].map(|id| &self.sides[id as usize]);
                let mut gain = one.criterion + other.criterion - choice.criterion;
                if self.scene.noisy() {
                    // Vertices on the border have counted on both sides.
                    let shared = one.vertices + other.vertices - gathered.total;
                    gain -= shared as f64 * choice.misfit.min(1.0);
                    let own = one.loss(&choice.surface, self.evidence)?
                        + other.loss(&choice.surface, self.evidence)?;
                    let loss = own + price(&choice, gathered.total, self.evidence);
                    if loss > REFUSED {
                        gain = gain.min(-loss);
                    }
                }
                // A large facet and a fillet have all of their vertices on one torus, but not their faces.
                if self.scene.evidence.general && gain > CHANGE_ELSE {
                    let may = |id: u32| {
                        self.agrees(id, &choice.surface)
                            && self.may_bend(&models[id as usize].surface, &choice.surface)
                    };
                    gain = if may(a) && may(b) { gain } else { CHANGE_ELSE };
                }
                let alike = |id: u32| models[id as usize].surface.is_like(&choice.surface);
                if self.scene.correlated() && choice.misfit < WAVES && alike(a) && alike(b) {
                    gain = gain.max(0.0);
                }
                Some(Union { gain, choice, vertices: gathered.total })
            })
            .collect();
        self.unions.extend(unknown.into_iter().zip(judged));
    }

    /// Planes of a tessellation are exact; the corners of two of them lie on a cylinder.
    fn may_bend(&self, from: &Surface, to: &Surface) -> bool {
        !(self.scene.tessellated && matches!(from, Surface::Plane(_))) || from.is_like(to)
    }

    /// Whether the faces of a region lie as a surface does.
    fn agrees(&self, id: u32, surface: &Surface) -> bool {
        let faces = &self.faces[id as usize];
        let gathered = self.pool.with(|marks| self.scene.samples(faces, SAMPLES, marks));
        select::agreement(surface, gathered.samples()) > select::AGREEMENT
    }

    fn joined(&self, a: u32, b: u32) -> Vec<u32> {
        [self.faces[a as usize].as_slice(), &self.faces[b as usize]].concat()
    }

    /// Carries out the best unions above `least`, each region in one at most; how many.
    fn apply(
        &mut self,
        models: &mut [Model],
        labels: &mut [u32],
        least: f64,
        most: usize,
    ) -> usize {
        let known = self.unions.iter().filter_map(|(&pair, union)| Some((pair, union.as_ref()?)));
        let mut best: Vec<((u32, u32), f64)> = known
            .map(|(pair, union)| (pair, union.gain))
            .filter(|&(_, gain)| gain > least)
            .collect();
        best.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
        let mut busy = vec![false; models.len()];
        let mut merged = 0;
        for ((a, b), _) in best {
            if merged == most || busy[a as usize] || busy[b as usize] {
                continue;
            }
            busy[a as usize] = true;
            busy[b as usize] = true;
            merged += 1;
            let Some(Some(union)) = self.unions.remove(&(a, b)) else { continue };
            let faces = self.joined(a, b);
            let worth = (&union.choice, union.vertices);
            let side =
                |marks: &mut Marks| Side::new(self.scene, self.evidence, &faces, worth, marks);
            self.sides[a as usize] = self.pool.with(side);
            models[a as usize] = Model::new(self.scene, union.choice.surface, &faces);
            self.faces[b as usize].iter().for_each(|&f| labels[f as usize] = a);
            self.faces[a as usize] = faces;
            self.faces[b as usize].clear();
        }
        self.unions.retain(|&(a, b), _| !busy[a as usize] && !busy[b as usize]);
        merged
    }
}

/// Merging discounts correlated samples less than the choice of types does: a misfit that is too
/// large to be noise counts, however few samples are independent.
pub(super) fn merging(evidence: Evidence) -> Evidence {
    Evidence { independent: evidence.independent.sqrt(), ..evidence }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Vector;
    use crate::mesh::{Mesh, Working};
    use crate::recognise::moves;
    use crate::surface::Plane;
    use crate::synth::{self, Noise};

    /// Vertices along a side of the sheet, and those across the strip that bends.
    const SIDE: u32 = 80;
    const STRIP: u32 = 8;
    const SIGMA: f64 = 0.004;
    /// How far the strip bends away, in the end.
    const DEPTH: f64 = 0.008;

    /// A flat sheet with a strip along one side that bends away from it; labels 0 and 1.
    fn sheet() -> (Mesh, Vec<u32>) {
        let at = |i: u32, j: u32| {
            let bent = f64::from((i + STRIP).saturating_sub(SIDE - 1)) / f64::from(STRIP);
            let [x, y] = [i, j].map(|k| f64::from(k) / f64::from(SIDE));
            Point::new(x, y, -DEPTH * bent.powi(2))
        };
        let corner = |i: u32, j: u32| i * SIDE + j;
        let quads = (0..SIDE - 1).flat_map(|i| (0..SIDE - 1).map(move |j| (i, j)));
        let faces = quads.clone().flat_map(|(i, j)| {
            let [a, b, c, d] =
                [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| corner(i, j));
            [[a, b, c], [a, c, d]]
        });
        let positions = (0..SIDE).flat_map(|i| (0..SIDE).map(move |j| at(i, j))).collect();
        let labels = quads.flat_map(|(i, _)| [u32::from(i + STRIP >= SIDE - 1); 2]).collect();
        (Mesh { positions, faces: faces.collect() }, labels)
    }

    #[test]
    fn a_narrow_strip_that_bends_stays_apart_from_a_large_plane_whatever_the_noise() {
        let (mesh, labels) = sheet();
        for seed in 0..20 {
            let noise = Noise::uniform(SIGMA, 1.0);
            let mesh = synth::add_noise(&mut Context::new(seed), &mesh, &noise).unwrap();
            let working = Working::new(mesh);
            let mut scene = Scene::raw(&working);
            scene.evidence.general = false;
            scene.evidence.sigma = SIGMA / 3f64.sqrt();
            scene.filter_for_borders();
            let plane = Surface::Plane(Plane::through(Point::origin(), Vector::z_axis()));
            let mut models = vec![Model { surface: plane, side: 1.0 }; 2];
            moves::fit(&scene, &mut models, &labels);
            let mut merged = labels.clone();
            merge(&mut Context::new(seed), &scene, &mut models, &mut merged).unwrap();
            assert_eq!(models.len(), 2, "seed {seed}");
        }
    }
}
