//! Free-form patches under noise: where one smooth height field costs less than the surfaces that
//! stand for its pieces.

use std::cmp::Reverse;

use rayon::prelude::*;

use super::assign::Model;
use super::merge::merging;
use super::moves::{LABEL, tidy};
use super::scene::{Gathered, Marks, Scene};
use super::seams::{pieces, seams};
use crate::math::{Point, Vector};
use crate::partition::Regions;
use crate::surface::Surface;
use crate::surface::polynomial::{Heights, coefficients};
use crate::surface::select::{self, Evidence};

/// Vertices that a fit looks at.
const SAMPLES: usize = 600;
/// Fewest of one piece.
const FEWEST: f64 = 8.0;
/// Degrees of the height field. The second is that of a quadric.
const DEGREES: std::ops::RangeInclusive<usize> = 3..=8;
/// Surfaces whose normals differ by less along their seam, on the mean, may be pieces of one patch:
/// patches fitted to noise meet at up to so much (6 leaves out a quarter of one, 15 is the same).
const TANGENT_DEG: f64 = 10.0;
/// What a patch must save, in units of the criterion. Measured: true ones save 72 to 864, rows of narrow
/// fillets up to 22.
const MARGIN: f64 = 40.0;
/// Most pieces of a patch.
const PIECES: usize = 24;

/// Unites curved regions that continue each other where one height field costs less than all of them.
pub fn unite(scene: &Scene, models: &mut Vec<Model>, labels: &mut [u32]) {
    let pieces = Pieces::new(scene, models, labels);
    let mut seeds: Vec<usize> = (0..models.len()).filter(|&id| pieces.may_join(id)).collect();
    seeds.sort_by_key(|&id| (Reverse(pieces.parts[id].total), id));
    let mut into: Vec<Option<u32>> = vec![None; models.len()];
    for seed in seeds {
        if into[seed].is_none() {
            let free = |id: usize| into[id].is_none();
            pieces.patch(seed, free).into_iter().for_each(|id| into[id] = Some(seed as u32));
        }
    }
    for (model, into) in models.iter_mut().zip(&into) {
        if into.is_some() {
            model.surface = Surface::FreeForm;
        }
    }
    labels.iter_mut().for_each(|label| *label = into[*label as usize].unwrap_or(*label));
    tidy(models, labels);
}

/// The regions, as what they may be pieces of sees them.
struct Pieces {
    evidence: Evidence,
    parts: Vec<Gathered>,
    /// Criterion of every region.
    costs: Vec<f64>,
    /// Curved regions that continue a curved region, and the length of the seam.
    continued: Vec<Vec<(usize, f64)>>,
}

impl Pieces {
    fn new(scene: &Scene, models: &[Model], labels: &[u32]) -> Self {
        let evidence = merging(scene.evidence);
        let regions = Regions::new(labels);
        let gather = |marks: &mut Marks, id| scene.samples(regions.faces(id), SAMPLES, marks);
        let parts: Vec<Gathered> =
            (0..models.len()).into_par_iter().map_init(Marks::default, gather).collect();
        let cost = |(model, part): (&Model, &Gathered)| {
            select::judge(model.surface.clone(), part.samples(), part.total, evidence).criterion
        };
        let costs = models.iter().zip(&parts).map(cost).collect();
        let piece = pieces(scene, models, &regions);
        let mut continued = vec![Vec::new(); models.len()];
        for seam in seams(scene, models, labels) {
            let may_join = piece[seam.one as usize] && piece[seam.other as usize];
            if may_join && seam.is_smooth(TANGENT_DEG) {
                continued[seam.one as usize].push((seam.other as usize, seam.length));
                continued[seam.other as usize].push((seam.one as usize, seam.length));
            }
        }
        Self { evidence, parts, costs, continued }
    }

    fn may_join(&self, id: usize) -> bool {
        !self.continued[id].is_empty()
    }

    /// The pieces of the patch around a seed, none where there is no patch: the neighbour with the
    /// longest seam joins, again and again, and those up to the largest gain are it.
    fn patch(&self, seed: usize, free: impl Fn(usize) -> bool) -> Vec<usize> {
        let mut pieces = vec![seed];
        let mut apart = self.costs[seed];
        let mut best = (MARGIN, 0);
        while pieces.len() < PIECES {
            let Some(next) = self.next(&pieces, &free) else { break };
            pieces.push(next);
            apart += self.costs[next] + 2.0 * LABEL;
            let Some(together) = self.together(&pieces) else { break };
            if apart - together > best.0 {
                best = (apart - together, pieces.len());
            }
        }
        pieces.truncate(best.1);
        pieces
    }

    /// The region with the longest smooth seams to some others.
    fn next(&self, pieces: &[usize], free: impl Fn(usize) -> bool) -> Option<usize> {
        let mut seams: Vec<(usize, f64)> = Vec::new();
        for &(other, length) in pieces.iter().flat_map(|&id| &self.continued[id]) {
            match seams.iter_mut().find(|seam| seam.0 == other) {
                Some(seam) => seam.1 += length,
                None if free(other) && !pieces.contains(&other) => seams.push((other, length)),
                None => {}
            }
        }
        seams.into_iter().max_by(|a, b| a.1.total_cmp(&b.1).then(b.0.cmp(&a.0))).map(|s| s.0)
    }

    /// Least criterion of a height field over some pieces.
    fn together(&self, pieces: &[usize]) -> Option<f64> {
        let total: usize = pieces.iter().map(|&id| self.parts[id].total).sum();
        let mut points: Vec<Point> = Vec::new();
        let mut normals: Vec<Vector> = Vec::new();
        let mut weights: Vec<f64> = Vec::new();
        for part in pieces.iter().map(|&id| &self.parts[id]) {
            let share = (SAMPLES as f64 * part.total as f64 / total as f64).max(FEWEST);
            let step = (part.points.len() as f64 / share).round().max(1.0) as usize;
            points.extend(part.points.iter().step_by(step));
            normals.extend(part.normals.iter().step_by(step));
            let weight = part.total as f64 / part.points.iter().step_by(step).len() as f64;
            weights.resize(points.len(), self.evidence.independent * weight);
        }
        let heights = Heights::over(&points, &normals, weights)?;
        let coefficient = 2.0 * self.evidence.samples(total).ln();
        let mut least = f64::INFINITY;
        for degree in DEGREES {
            let price = coefficient * coefficients(degree) as f64;
            if price > least {
                break;
            }
            let Some(misfit) = heights.misfit(degree, self.evidence.sigma) else { break };
            least = least.min(misfit + price);
        }
        least.is_finite().then_some(least)
    }
}
