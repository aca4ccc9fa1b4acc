//! Regions that are blends of their neighbours: a fillet between known walls has its radius alone to fit, where
//! noise would let it pass for a plane, a sphere or half of a cylinder.

use super::around::Around;
use super::related::TURNED;
use super::scene::Gathered;
use crate::surface::blend::Walls;
use crate::surface::select::{self, Choice};
use crate::surface::{Surface, centroid};

/// Least radius of a blend, in edges: the mesh shows no smaller one.
const LEAST: f64 = 0.7;
/// Degrees of freedom of a blend, and of the chamfer between two walls that it may be instead.
const BLEND: f64 = 1.0;
const CHAMFER: f64 = 2.0;

impl Around<'_> {
    /// The blend of two neighbours that a region is rather than its surface, and that surface, each with the
    /// criterion that they were compared by; `gathered` are samples of its faces.
    pub fn rather(&self, id: usize, gathered: &Gathered) -> Option<(Choice, Choice)> {
        let surface = &self.models[id].surface;
        let freedom = match surface {
            Surface::Quadric(_) | Surface::FreeForm => return None,
            Surface::Plane(_) | Surface::Cone(_) => CHAMFER,
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
        for [one, other] in self.walls(id) {
            let walls = [one, other].map(|k| &self.models[k as usize]);
            let blend = Walls::new(walls.map(|wall| (&wall.surface, wall.side)), at)
                .and_then(|walls| walls.nearest(&gathered.points, LEAST * self.scene.edge));
            let Some(blend) = blend else { continue };
            let choice = judge(blend, BLEND);
            let bound = best.as_ref().unwrap_or(&own).criterion;
            if choice.criterion < bound && agreement(&choice.surface) > agreement(surface) - TURNED
            {
                best = Some(choice);
            }
        }
        best.map(|best| (best, own))
    }

    /// Pairs of neighbours that a region may be between.
    fn walls(&self, id: usize) -> Vec<[u32; 2]> {
        let neighbours = self.neighbours(id);
        let pairs = neighbours.iter().enumerate();
        pairs.flat_map(|(i, one)| neighbours[i + 1..].iter().map(|other| [*one, *other])).collect()
    }
}
