//! Regions of several surfaces that extend in one direction or turn about one axis: noise lets a torus pass for a
//! face, the chamfer beside it and a piece of the shaft, but not their profile.

use super::around::Around;
use super::assign::Model;
use super::merge::CHANGE;
use super::moves::best;
use super::related::{TURNED, priced};
use super::scene::{Gathered, Marks};
use crate::surface::profile::{Limits, Profile};
use crate::surface::select::{self, Choice, agreement, plausible};
use crate::surface::sweep::Sweep;
use crate::surface::{Surface, refine};

/// Vertices that a profile is made of. They stand for themselves alone: a surface that has been fitted to some
/// vertices fits them better than all the others.
const SAMPLES: usize = 1000;
/// Sweeps, those that gain most, whose parts are fitted as surfaces.
const TRIED: usize = 2;
/// Least radius of an arc, in sigmas and in edges, and least length of a part: noise makes shorter ones.
const RADIUS_SIGMAS: f64 = 4.0;
const RADIUS_EDGES: f64 = 2.0;
const LENGTH_EDGES: f64 = 1.5;
/// What a profile may cost more than the region as it is, and its parts be worth fitting: directions and axes that the
/// scene shows are free, and no profile knows that.
const WORSE: f64 = 20.0;
/// What the simplest surface costs.
pub(super) const CHEAPEST: f64 = 3.0;
/// What a cut must save beside the price of the surfaces: there are many profiles to choose from.
const CUT: f64 = 2.0 * CHANGE;
/// Fewest faces of a part.
const FEWEST: usize = 12;

/// A region in parts: the faces of each and its surface, and what that saves.
pub struct Parts {
    /// Faces and surface of every part.
    pub parts: Vec<(Vec<u32>, Model)>,
    /// In units of the criterion.
    pub gain: f64,
}

impl Around<'_> {
    /// The parts that a region is cut into where its profile breaks, as far as that pays.
    pub fn parts(&self, id: usize, marks: &mut Marks) -> Option<Parts> {
        let surface = &self.models[id].surface;
        if matches!(surface, Surface::FreeForm) {
            return None;
        }
        let mut gathered = self.scene.samples(self.regions.faces(id), SAMPLES, marks);
        gathered.total = gathered.points.len();
        let profiles = self.profiles(id, &gathered);
        if profiles.is_empty() {
            return None;
        }
        // Fitted to the same vertices as the parts will be.
        let whole = self.fit(&gathered, Some(surface.clone()))?;
        let cut =
            |(sweep, profile): &(Sweep, Profile)| self.cut(id, &gathered, &whole, sweep, profile);
        let all = profiles.iter().filter_map(cut);
        all.max_by(|a, b| a.gain.total_cmp(&b.gain))
    }

    /// The most promising profiles of a region.
    fn profiles(&self, id: usize, gathered: &Gathered) -> Vec<(Sweep, Profile)> {
        let surface = &self.models[id].surface;
        let neighbours = self.neighbours(id);
        let around = neighbours.iter().map(|&other| &self.models[other as usize].surface);
        let by: Vec<&Surface> = [surface].into_iter().chain(around).collect();
        let (evidence, edge) = (self.scene.evidence, self.scene.edge);
        let (square, log) = (evidence.sigma.powi(2), (gathered.total.max(2) as f64).ln());
        let limits = Limits {
            freedom: 2.0 * log * square,
            part: CHANGE * square,
            radius: (RADIUS_SIGMAS * evidence.sigma).max(RADIUS_EDGES * edge),
            length: LENGTH_EDGES * edge,
        };
        let misfit = select::misfit(surface, &gathered.points, evidence.sigma);
        let most = gathered.total as f64 * misfit + 2.0 * CHEAPEST * log + WORSE;
        let profile = |sweep: Sweep| {
            let flat: Vec<_> = gathered.points.iter().map(|p| sweep.flat(*p)).collect();
            Some((sweep, Profile::of(&flat, &limits)?))
        };
        let all = Sweep::suggested(&by).into_iter().filter_map(profile);
        let mut found: Vec<_> = all.filter(|(_, p)| p.total < most * square).collect();
        found.sort_by(|a, b| a.1.total.total_cmp(&b.1.total));
        found.truncate(TRIED);
        found
    }

    /// A region cut by a profile, its parts fitted.
    fn cut(
        &self,
        id: usize,
        gathered: &Gathered,
        whole: &Choice,
        sweep: &Sweep,
        profile: &Profile,
    ) -> Option<Parts> {
        let count = profile.curves.len();
        let mut faces: Vec<Vec<u32>> = vec![Vec::new(); count];
        for &face in self.regions.faces(id) {
            let at = self.scene.geometry.barycentres[face as usize];
            faces[profile.part(sweep.flat(at))].push(face);
        }
        if faces.iter().any(|faces| faces.len() < FEWEST) {
            return None;
        }
        let samples = gathered.divided(count, |p| profile.part(sweep.flat(p)));
        let mut gain = whole.criterion;
        let mut parts = Vec::with_capacity(count);
        for ((faces, samples), curve) in faces.into_iter().zip(&samples).zip(&profile.curves) {
            let choice = self.fit(samples, sweep.surface(curve))?;
            let turned = agreement(&whole.surface, samples.samples());
            if agreement(&choice.surface, samples.samples()) < turned - TURNED {
                return None;
            }
            gain -= choice.criterion;
            parts.push((faces, choice.surface));
        }
        let model = |(faces, surface): (Vec<u32>, Surface)| {
            let model = Model::new(self.scene, surface, &faces);
            (faces, model)
        };
        (gain > CUT * (count - 1) as f64)
            .then(|| Parts { parts: parts.into_iter().map(model).collect(), gain })
    }

    /// The best surface for some samples, among them one that is known, as it is and fitted.
    fn fit(&self, gathered: &Gathered, known: Option<Surface>) -> Option<Choice> {
        let evidence = self.scene.evidence;
        let free = best(self.scene, gathered, evidence)?;
        let fitted = known.as_ref().and_then(|s| refine(s, &gathered.points, &[]));
        let known = known.into_iter().chain(fitted.map(|fit| fit.surface));
        let known = known.filter(|surface| plausible(surface, gathered.samples(), evidence));
        let choices = known.map(|surface| priced(self.scene, surface, gathered, evidence));
        choices.chain([free]).min_by(|a, b| a.criterion.total_cmp(&b.criterion))
    }
}
