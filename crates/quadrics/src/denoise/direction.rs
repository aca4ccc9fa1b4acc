//! The direction that noise acts in, the normal of the shape, and how far a vertex sticks out in it.

use super::Task;
use super::place::Noisy;
use crate::math::Vector;
use crate::mesh::Working;
use crate::surface::Surface;

/// For every region 1 or -1: whether its faces look the way its surface does.
pub fn sides(working: &Working, labels: &[u32], surfaces: &[Surface]) -> Vec<f64> {
    let mut sums = vec![0.0; surfaces.len()];
    let geometry = &working.geometry;
    for (face, &label) in labels.iter().enumerate() {
        let surface = surfaces.get(label as usize);
        if let Some(normal) = surface.and_then(|s| s.normal(geometry.barycentres[face])) {
            sums[label as usize] += normal.dot(&geometry.normals[face]) * geometry.areas[face];
        }
    }
    sums.iter().map(|sum| f64::signum(*sum)).collect()
}

impl Task<'_> {
    /// A vertex with what the noise explains there.
    pub fn noisy(&self, vertex: u32, reach: f64) -> Noisy {
        let outward = self.outward(vertex);
        let height = self.above_neighbours(vertex).dot(&outward);
        let position = self.working.mesh.positions[vertex as usize];
        Noisy { position, outward, height, sigma: self.sigma, reach }
    }

    /// The unit normal of a vertex, faces weighted by area as in eq. 5, each with the normal of its
    /// surface: its own errs by 30 degrees. Zero where there is none.
    fn outward(&self, vertex: u32) -> Vector {
        let (here, geometry) =
            (self.working.mesh.positions[vertex as usize], &self.working.geometry);
        let around = self.working.adjacency.around(vertex).iter().map(|&face| face as usize);
        let normal = |face: usize| {
            let region = self.labels[face] as usize;
            let of_surface = self.surfaces.get(region).and_then(|s| s.normal(here));
            let own = geometry.normals[face];
            of_surface.map_or(own, |normal| normal.into_inner() * self.sides[region])
        };
        let sum: Vector = around.map(|face| normal(face) * geometry.areas[face]).sum();
        sum.try_normalize(f64::MIN_POSITIVE).unwrap_or_default()
    }

    /// From the middle of the neighbours of a vertex to itself.
    fn above_neighbours(&self, vertex: u32) -> Vector {
        let here = self.working.mesh.positions[vertex as usize];
        let around = self.working.adjacency.around(vertex).iter();
        let corners = around.flat_map(|&face| self.working.mesh.faces[face as usize]);
        let ways = corners
            .filter(|&corner| corner != vertex)
            .map(|corner| here - self.working.mesh.positions[corner as usize]);
        let (sum, count) = ways.fold((Vector::zeros(), 0), |(sum, n), way| (sum + way, n + 1));
        sum / f64::from(count.max(1))
    }
}
