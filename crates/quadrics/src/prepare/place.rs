//! Where the vertices of a coarser mesh of a noisy one belong.
//!
//! Means of the vertices around a crease lie inside the part. Every vertex of the finer mesh says that
//! the surface runs through it, along the filtered normal of the coarser face that is nearest to it: the
//! point that its cell's planes agree on best lies on the crease (quadrics of Garland and Heckbert,
//! SIGGRAPH 1997), and errs by no more than the mean elsewhere.

use nalgebra::Matrix3;
use rayon::prelude::*;

use super::coarsen::Coarse;
use super::nearest::nearest;
use crate::math::{Point, Vector};
use crate::mesh::Working;
use crate::partition::{Regions, UNLABELLED};

/// Weight of the mean of a cell against its planes, per vertex: what filtered normals that err by 0.2
/// radians say along the surface is less, what a crease of 30 degrees says is more.
const MEAN: f64 = 0.05;

/// What the vertices of a cell say of its site.
#[derive(Default)]
struct Cell {
    /// Sum of `n nᵀ` over their planes.
    matrix: Matrix3<f64>,
    /// Sum of `n nᵀ p`.
    through: Vector,
    /// Sum of their positions, and how many there are.
    sum: Vector,
    count: f64,
}

/// The positions of the sites of `coarse`, whose faces have these filtered `normals`.
pub fn place(fine: &Working, coarse: &Coarse, normals: &[Vector]) -> Vec<Point> {
    let nearest = nearest(fine.len(), &coarse.origin, |face, visit| {
        fine.adjacency.across(face as usize).for_each(|other| visit(other as u32));
    });
    let vertices = Regions::new(&coarse.site);
    let site = |(site, &now): (usize, &Point)| {
        let mut cell = Cell::default();
        for &vertex in vertices.faces(site) {
            let position = fine.mesh.positions[vertex as usize];
            let around = fine.adjacency.around(vertex);
            let beside = around.iter().map(|&face| nearest[face as usize]);
            for face in beside.filter(|&face| face != UNLABELLED) {
                let normal = normals[face as usize];
                let weighted = normal / around.len() as f64;
                cell.matrix += weighted * normal.transpose();
                cell.through += weighted * normal.dot(&position.coords);
            }
            cell.sum += position.coords;
            cell.count += 1.0;
        }
        cell.site().unwrap_or(now)
    };
    coarse.mesh.positions.par_iter().enumerate().map(site).collect()
}

impl Cell {
    fn site(&self) -> Option<Point> {
        let matrix = self.matrix + Matrix3::identity() * (MEAN * self.count);
        matrix.try_inverse().map(|inverse| Point::from(inverse * (self.through + MEAN * self.sum)))
    }
}

#[cfg(test)]
mod tests {
    use super::super::coarsen::gather;
    use super::*;
    use crate::synth;

    #[test]
    fn what_means_cut_off_a_box_comes_back() {
        let fine = Working::new(synth::part("plate", 60_000).unwrap().mesh);
        let mut coarse = gather(&fine, 6_000);
        let corner = |points: &[Point]| {
            points.iter().map(|p| p.coords.sum()).fold(f64::NEG_INFINITY, f64::max)
        };
        let corner_of_all = corner(&fine.mesh.positions);
        let before = corner_of_all - corner(&coarse.mesh.positions);
        let normals = Working::new(coarse.mesh.clone()).geometry.normals;
        coarse.mesh.positions = place(&fine, &coarse, &normals);
        let after = corner_of_all - corner(&coarse.mesh.positions);
        assert!(after.abs() < 0.5 * before, "{before} off, then {after}");
    }
}
