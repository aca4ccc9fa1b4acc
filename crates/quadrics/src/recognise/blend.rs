//! Regions that are blends of their neighbours: a fillet between known walls has its radius alone to fit, where
//! noise would let it pass for a plane, a sphere or half of a cylinder.

use super::around::Around;
use super::related::TURNED;
use super::scene::{Gathered, Marks};
use crate::surface::blend::{Blend, Walls};
use crate::surface::select::{self, Choice};
use crate::surface::{Surface, centroid};

/// Least radius of a blend, in edges: the mesh shows no smaller one.
const LEAST: f64 = 0.7;
/// Degrees of freedom of a blend, and of the chamfer between two walls that it may be instead.
const BLEND: f64 = 1.0;
const CHAMFER: f64 = 2.0;
/// A chamfer is taken for one where it is so much likelier than the blend, as a logarithm, and by so much for every
/// vertex: fillets of two rows of faces seem likelier to be chamfers by up to 0.018, chamfers by 0.1 (decision 0002).
const CUT: f64 = 6.0;
const CUT_EACH: f64 = 0.01;
/// Vertices that tell a chamfer from a blend, and how many of the walls' faces have them for one of the band.
const ABOUT: usize = 300;
const WALLS: usize = 2;

impl Around<'_> {
    /// The blend of two neighbours, or the chamfer between them, that a region is rather than its surface, and that
    /// surface, each with the criterion that they were compared by; `gathered` are samples of its faces.
    pub fn rather(
        &self,
        id: usize,
        gathered: &Gathered,
        marks: &mut Marks,
    ) -> Option<(Choice, Choice)> {
        let surface = &self.models[id].surface;
        let flat = matches!(surface, Surface::Plane(_) | Surface::Cone(_));
        let freedom = match surface {
            Surface::Quadric(_) | Surface::FreeForm => return None,
            _ if flat => CHAMFER,
            _ => select::cost(surface) - self.scene.shown.held(surface).0,
        };
        let judge = |surface: Surface, freedom: f64| {
            let Gathered { points, total, .. } = gathered;
            select::judge_at(freedom, surface, points, *total, self.scene.evidence)
        };
        let own = judge(surface.clone(), freedom);
        let agreement = |surface: &Surface| select::agreement(surface, gathered.samples());
        let mut best: Option<Choice> = None;
        let at = centroid(&gathered.points)?;
        for pair in self.walls(id) {
            let walls = pair.map(|k| &self.models[k as usize]);
            let Some(walls) = Walls::new(walls.map(|wall| (&wall.surface, wall.side)), at) else {
                continue;
            };
            let least = LEAST * self.scene.edge;
            let Some(blend) = walls.nearest(&gathered.points, least) else { continue };
            let mut choice = judge(blend.surface.clone(), BLEND);
            let bound = best.as_ref().unwrap_or(&own).criterion;
            if choice.criterion >= bound
                || agreement(&choice.surface) <= agreement(surface) - TURNED
            {
                continue;
            }
            if let Some((chamfer, gain)) = self.chamfer(id, pair, &walls, &blend, marks) {
                if flat {
                    continue;
                }
                choice.surface = chamfer;
                choice.criterion -= 2.0 * gain;
            }
            best = Some(choice);
        }
        best.map(|best| (best, own))
    }

    /// The chamfer that the vertices about a region show rather than the blend, and how sure that is.
    fn chamfer(
        &self,
        id: usize,
        pair: [u32; 2],
        walls: &Walls,
        blend: &Blend,
        marks: &mut Marks,
    ) -> Option<(Surface, f64)> {
        let about = self.about(id, pair, marks);
        let cut = walls.chamfer(blend, &about.points, self.scene.evidence.sigma)?;
        // The sampled vertices stand for all.
        let gain = (cut.gain / about.points.len() as f64 - CUT_EACH) * about.total as f64;
        (gain > CUT).then_some((cut.surface, gain))
    }

    /// Vertices of a region and of the faces of two walls that are nearest to it.
    fn about(&self, id: usize, walls: [u32; 2], marks: &mut Marks) -> Gathered {
        let mut faces = self.regions.faces(id).to_vec();
        let enough = (1 + WALLS) * faces.len();
        marks.clear(self.labels.len());
        faces.iter().for_each(|&face| _ = marks.mark(face));
        let mut at = 0;
        while at < faces.len() && faces.len() < enough {
            for other in self.scene.adjacency.across(faces[at] as usize) {
                if walls.contains(&self.labels[other]) && marks.mark(other as u32) {
                    faces.push(other as u32);
                }
            }
            at += 1;
        }
        self.scene.samples(&faces, ABOUT, marks)
    }

    /// Pairs of neighbours that a region may be between.
    fn walls(&self, id: usize) -> Vec<[u32; 2]> {
        let neighbours = self.neighbours(id);
        let pairs = neighbours.iter().enumerate();
        pairs.flat_map(|(i, one)| neighbours[i + 1..].iter().map(|other| [*one, *other])).collect()
    }
}
