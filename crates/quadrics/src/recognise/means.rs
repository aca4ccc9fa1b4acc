//! Means of noisy vertices: the coarser mesh that surfaces are sought on, and what regions are judged by.

use super::scene::{Gathered, Marks, Scene, picked};
use crate::math::{Point, Vector};
use crate::mesh::Working;
use crate::prepare::{Coarse, gather, place};
use crate::surface::select::Evidence;

/// Vertices in a mean for sigma as large as an edge: with fewer the means err by too much of their own
/// edges, with more narrow faces are lost (7 and 10 give the same, decision 0006).
const VERTICES: f64 = 10.0;
/// Fewest and most faces of means.
const FACES: (f64, f64) = (30_000.0, 100_000.0);
/// Rounds of filtering normals and placing the means by them; four give the same.
const PLACED: usize = 2;

/// A coarser mesh of means, on creases where there are some, of a mesh whose sigma is so many edges.
pub fn gathered(fine: &Working, noise: f64) -> Coarse {
    let faces = (fine.len() as f64 / (VERTICES * noise)).clamp(FACES.0, FACES.1);
    let mut coarse = gather(fine, (faces as usize).min(fine.len() / 2));
    for _ in 0..PLACED {
        let working = Working::new(coarse.mesh.clone());
        coarse.mesh.positions = place(fine, &coarse, &Scene::new(&working).normals);
    }
    coarse
}

/// Which vertices are taken together.
#[derive(Debug, Clone)]
pub struct Cells {
    /// Cell of every vertex.
    pub of_vertex: Vec<u32>,
    /// Mean number of vertices in one.
    pub size: f64,
}

/// A vertex, its cell before it and a face of the region after it.
type Member = (u32, u32, u32);

/// Fewest means that say more than single vertices.
const FEWEST: usize = 8;
/// Means away from the border say more alone where there are so many, and this share of all: those of a
/// narrow region do not show how it bends.
const ENOUGH: usize = 15;
const INNER: f64 = 0.5;
/// Independent samples in a whole scan, however dense: its waves are as long as before. 160 and 300 give
/// the same (decision 0006).
const WAVES: f64 = 200.0;

impl Scene<'_> {
    /// Points and normals that a region is judged by, at most `limit`, and how they err: means over
    /// cells where there are cells, its vertices otherwise.
    pub fn means(&self, faces: &[u32], limit: usize, seen: &mut Marks) -> (Gathered, Evidence) {
        if let Some(cells) = &self.cells
            && let Some(means) = self.of_cells(cells, faces, limit, seen)
        {
            return means;
        }
        (self.samples(faces, limit, seen), self.errors(1.0, 1.0))
    }

    fn of_cells(
        &self,
        cells: &Cells,
        faces: &[u32],
        limit: usize,
        seen: &mut Marks,
    ) -> Option<(Gathered, Evidence)> {
        let vertices = seen.vertices_of(&self.mesh, faces).into_iter();
        let mut members: Vec<Member> = vertices
            .map(|(vertex, face)| (cells.of_vertex[vertex as usize], vertex, face))
            .collect();
        members.sort_unstable();
        let full = |group: &&[Member]| 2.0 * group.len() as f64 >= cells.size;
        let mut groups: Vec<&[Member]> = members.chunk_by(|a, b| a.0 == b.0).filter(full).collect();
        let inside = |&(_, v, _): &Member| seen.count(v) == self.adjacency.around(v).len() as u32;
        let inner: Vec<&[Member]> =
            groups.iter().copied().filter(|group| group.iter().all(inside)).collect();
        if inner.len() >= ENOUGH && inner.len() as f64 >= INNER * groups.len() as f64 {
            groups = inner;
        }
        (groups.len() >= FEWEST).then(|| self.averaged(cells, &groups, limit))
    }

    fn averaged(&self, cells: &Cells, groups: &[&[Member]], limit: usize) -> (Gathered, Evidence) {
        let mut gathered = Gathered { total: groups.len(), ..Gathered::default() };
        let mut variance = 0.0;
        for group in picked(groups, limit) {
            let count = group.len() as f64;
            let mean =
                |of: &dyn Fn(&Member) -> Vector| group.iter().map(of).sum::<Vector>() / count;
            let point = mean(&|m| self.mesh.positions[m.1 as usize].coords);
            let barycentre = mean(&|m| self.geometry.barycentres[m.2 as usize].coords);
            let normal = mean(&|m| self.normals[m.2 as usize]);
            gathered.points.push(Point::from(point));
            gathered.barycentres.push(Point::from(barycentre));
            gathered.normals.push(normal.try_normalize(f64::MIN_POSITIVE).unwrap_or(normal));
            variance += 1.0 / count;
        }
        let variance = variance / gathered.points.len() as f64;
        (gathered, self.errors(cells.size, variance))
    }

    /// How points err of which each stands for so many vertices; independent errors have this share of
    /// the variance left in it.
    fn errors(&self, vertices: f64, variance: f64) -> Evidence {
        if self.correlated() {
            let seen = WAVES / self.mesh.positions.len() as f64;
            let independent = vertices * self.evidence.independent.min(seen);
            return Evidence { independent, ..self.evidence };
        }
        Evidence { sigma: self.evidence.sigma * variance.sqrt(), ..self.evidence }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synth;

    #[test]
    fn a_denser_scan_has_no_more_independent_samples() {
        let seen = |faces| {
            let working = Working::new(synth::part("shaft", faces).unwrap().mesh);
            let mut scene = Scene::raw(&working);
            scene.evidence.independent = 0.05;
            let all: Vec<u32> = (0..working.len() as u32).collect();
            let mut marks = Marks::default();
            let (gathered, evidence) = scene.means(&all, 100, &mut marks);
            evidence.samples(gathered.total)
        };
        let (sparse, dense) = (seen(20_000), seen(80_000));
        assert!((dense / sparse - 1.0).abs() < 1e-9, "{sparse}, {dense}");
    }
}
