//! Splitting: a region that several surfaces explain better becomes several, the reverse of merging.
//!
//! Under noise a growing region may take in its neighbour, a torus over a cylinder and the chamfer
//! beside it, as long as nothing but noise seems to be left; no seed is drawn there again. So every
//! region is asked whether its profile breaks, and in a few places whether another surface explains
//! the faces there better.

use rayon::prelude::*;

use super::around::Around;
use super::assign::{Model, border_cost, face_cost};
use super::cut::Cut;
use super::merge::CHANGE;
use super::moves::{choose, judge, tidy};
use super::pool::Pool;
use super::profile::{CHEAPEST, Parts};
use super::scene::{Marks, Scene};
use crate::context::Context;
use crate::error::Result;
use crate::mesh::NONE;
use crate::partition::Regions;
use crate::surface::Surface;
use crate::surface::select::{self, Choice};

/// Places in a region where another surface is sought (24 split more, and not better).
const PLACES: usize = 8;
/// Faces of the neighbourhoods there.
const BALLS: [usize; 3] = [40, 120, 360];
/// Neighbourhoods, those that gain most, whose surface competes for the whole region.
const TRIED: usize = 2;
/// Rounds of dividing the region and fitting both surfaces.
const REGROUP: usize = 3;
/// A region that shares so many of its faces with one that was tried is that one.
const SAME: f64 = 0.95;
/// Fewest faces of either part.
const FEWEST: usize = 12;

/// Splits regions under independent noise while the criterion of merging falls, each once, and those
/// that were left `unsplit` before only where they have changed.
///
/// Without noise regions take in nothing that is not theirs, and on scans the waviness would part them.
///
/// # Errors
/// Cancellation.
pub fn split(
    context: &mut Context,
    scene: &Scene,
    models: &mut Vec<Model>,
    labels: &mut [u32],
    unsplit: &mut Unsplit,
) -> Result<()> {
    if !scene.noisy() {
        return Ok(());
    }
    context.step("split", 0.0)?;
    let regions = Regions::new(labels);
    let around = Around { scene, models, labels, regions: &regions };
    let pool = Pool::<Marks>::default();
    let split: Vec<Option<Parts>> = models
        .par_iter()
        .enumerate()
        .with_max_len(1)
        .map(|(id, model)| {
            let faces = regions.faces(id);
            if unsplit.has(faces) {
                return None;
            }
            pool.with(|marks| {
                let parts = around.parts(id, marks);
                let halves = Region { scene, labels, id: id as u32, faces, marks }.split(model);
                parts.into_iter().chain(halves).max_by(|a, b| a.gain.total_cmp(&b.gain))
            })
        })
        .collect();
    *unsplit = Unsplit::new(labels, &split);
    for (id, Parts { parts, .. }) in (0..).zip(split).filter_map(|(id, parts)| Some((id, parts?))) {
        for (k, (faces, model)) in parts.into_iter().enumerate() {
            let label = if k == 0 { id } else { models.len() };
            faces.iter().for_each(|&face| labels[face as usize] = label as u32);
            match models.get_mut(label) {
                Some(known) => *known = model,
                None => models.push(model),
            }
        }
    }
    tidy(models, labels);
    Ok(())
}

/// The regions that were tried last and stayed whole.
#[derive(Default)]
pub struct Unsplit {
    /// The region that a face was in.
    regions: Vec<u32>,
    /// Faces of every region; none of one that was split.
    sizes: Vec<usize>,
}

impl Unsplit {
    fn new(labels: &[u32], split: &[Option<Parts>]) -> Self {
        let mut sizes = vec![0; split.len()];
        for &label in labels.iter().filter(|&&label| split[label as usize].is_none()) {
            sizes[label as usize] += 1;
        }
        Self { regions: labels.to_vec(), sizes }
    }

    /// Whether a region of these faces was tried.
    fn has(&self, faces: &[u32]) -> bool {
        let Some(&then) = self.regions.get(faces[faces.len() / 2] as usize) else { return false };
        let same = faces.iter().filter(|&&face| self.regions[face as usize] == then).count();
        let size = self.sizes[then as usize];
        size > 0 && same as f64 >= SAME * faces.len().max(size) as f64
    }
}

/// A region that may be split.
struct Region<'s, 'm> {
    scene: &'s Scene<'m>,
    labels: &'s [u32],
    id: u32,
    /// Ascending.
    faces: &'s [u32],
    marks: &'s mut Marks,
}

impl Region<'_, '_> {
    fn split(&mut self, model: &Model) -> Option<Parts> {
        if matches!(model.surface, Surface::FreeForm) {
            return None;
        }
        let whole = self.judge(&model.surface, self.faces).criterion;
        let mut starts = self.starts(&model.surface);
        starts.sort_by(|a, b| b.0.total_cmp(&a.0));
        let halves = starts.into_iter().take(TRIED).filter_map(|(_, ball, choice)| {
            let new = Model::new(self.scene, choice.surface, &ball);
            self.divide([model.clone(), new], ball, whole)
        });
        halves.max_by(|a, b| a.gain.total_cmp(&b.gain)).filter(|halves| halves.gain > CHANGE)
    }

    /// Neighbourhoods that another surface explains better, it, and by how much.
    fn starts(&mut self, surface: &Surface) -> Vec<(f64, Vec<u32>, Choice)> {
        let mut starts = Vec::new();
        for place in 0..PLACES {
            let seed = self.faces[(2 * place + 1) * self.faces.len() / (2 * PLACES)];
            for size in BALLS.into_iter().filter(|&size| size * 2 < self.faces.len()) {
                let ball = self.ball(seed, size);
                let vertices = ball.len() as f64 / 2.0;
                let misfit = self.judge(surface, &ball).misfit;
                // Noise alone leaves 1, give or take; what cannot save the simplest surface is no start.
                let noise = 1.0 - (2.0 / vertices).sqrt();
                if (misfit - noise) * vertices < CHEAPEST {
                    continue;
                }
                let Some(choice) = choose(self.scene, &ball, self.scene.evidence, self.marks)
                else {
                    continue;
                };
                let gain = (misfit - choice.misfit) * vertices;
                if gain > select::cost(&choice.surface) {
                    starts.push((gain, ball, choice));
                }
            }
        }
        starts
    }

    /// The region's faces around one of them, breadth first.
    fn ball(&mut self, seed: u32, size: usize) -> Vec<u32> {
        self.marks.clear(self.labels.len());
        self.marks.mark(seed);
        let mut ball = vec![seed];
        let mut next = 0;
        while next < ball.len() && ball.len() < size {
            for other in self.scene.adjacency.across(ball[next] as usize) {
                if self.labels[other] == self.id && self.marks.mark(other as u32) {
                    ball.push(other as u32);
                }
            }
            next += 1;
        }
        ball
    }

    /// Divides the faces between two surfaces and fits both anew, in turn.
    fn divide(&mut self, mut pair: [Model; 2], mut part: Vec<u32>, whole: f64) -> Option<Parts> {
        let mut gain = f64::NEG_INFINITY;
        let mut rest = Vec::new();
        for _ in 0..REGROUP {
            let grown = self.cut(&pair, &part);
            if grown.len() < FEWEST || grown.len() + FEWEST > self.faces.len() {
                return None;
            }
            let settled = grown == part;
            part = grown;
            self.marks.clear(self.labels.len());
            part.iter().for_each(|&face| {
                self.marks.mark(face);
            });
            rest = self.faces.iter().copied().filter(|&f| !self.marks.has(f)).collect::<Vec<_>>();
            let (one, first) = self.fit(&rest)?;
            let (other, second) = self.fit(&part)?;
            gain = whole - first - second;
            pair = [one, other];
            if settled {
                break;
            }
        }
        let [one, other] = pair;
        Some(Parts { parts: vec![(rest, one), (part, other)], gain })
    }

    /// The best surface for some faces, and its criterion.
    fn fit(&mut self, faces: &[u32]) -> Option<(Model, f64)> {
        let Choice { surface, criterion, .. } =
            choose(self.scene, faces, self.scene.evidence, self.marks)?;
        Some((Model::new(self.scene, surface, faces), criterion))
    }

    fn judge(&mut self, surface: &Surface, faces: &[u32]) -> Choice {
        judge(self.scene, surface, faces, self.scene.evidence, self.marks)
    }

    /// The faces that a least cut gives to the second surface: the largest connected part that has
    /// some of `part`.
    fn cut(&mut self, pair: &[Model; 2], part: &[u32]) -> Vec<u32> {
        let scene = self.scene;
        let mut cut = Cut::new(self.faces.len());
        for (i, &face) in self.faces.iter().enumerate() {
            let face = face as usize;
            let [stay, come] = [0, 1].map(|k| face_cost(scene, &pair[k], face));
            cut.node(i, stay, come);
            for (edge, &other) in scene.adjacency.neighbours[face].iter().enumerate() {
                if other != NONE
                    && let Ok(j) = self.faces.binary_search(&other)
                    && j > i
                {
                    let cost = border_cost(scene, face, edge);
                    cut.edge(i, j, cost, cost);
                }
            }
        }
        let stays = cut.solve();
        let comes = |face: u32| self.faces.binary_search(&face).is_ok_and(|i| !stays[i]);
        self.marks.clear(self.labels.len());
        let mut largest: Vec<u32> = Vec::new();
        for &start in part {
            if !comes(start) || !self.marks.mark(start) {
                continue;
            }
            let mut piece = vec![start];
            let mut next = 0;
            while next < piece.len() {
                for other in scene.adjacency.across(piece[next] as usize) {
                    if comes(other as u32) && self.marks.mark(other as u32) {
                        piece.push(other as u32);
                    }
                }
                next += 1;
            }
            if piece.len() > largest.len() {
                largest = piece;
            }
        }
        largest.sort_unstable();
        largest
    }
}
