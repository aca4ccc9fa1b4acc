//! Cells of vertices made alike: about as many vertices in each, and round.
//!
//! Vertices on the border of two cells change over where that lowers the sum of squared distances to
//! the cells' centroids (Valette and Chassery, Eurographics 2004). Cut off breadth first, cells have one
//! to eight vertices where five were asked: their means err by as different amounts.

use rayon::prelude::*;

use crate::math::{Point, Vector};
use crate::mesh::Working;

/// Passes over all edges; 15 give the same (decision 0006).
const PASSES: usize = 6;
/// Means over neighbours before distances say anything, where the noise is as large as the edges.
const SMOOTHED: usize = 2;
/// What a change must save, in squared sizes: less is rounding.
const LEAST: f64 = 1e-12;

/// Sum of the positions of a cell's vertices, and how many there are.
type Cell = (Vector, f64);

/// Lets the vertices of a mesh in the unit cube change between `count` cells; none becomes empty.
pub fn relax(fine: &Working, cell_of: &mut [u32], count: usize) {
    let smooth = smoothed(fine);
    let mut cells: Vec<Cell> = vec![(Vector::zeros(), 0.0); count];
    for (position, &cell) in smooth.iter().zip(cell_of.iter()) {
        cells[cell as usize].0 += position.coords;
        cells[cell as usize].1 += 1.0;
    }
    for _ in 0..PASSES {
        for &[a, b, c] in &fine.mesh.faces {
            // An edge of two faces is met once either way.
            for (p, q) in [(a, b), (b, c), (c, a)].into_iter().filter(|(p, q)| p < q) {
                let [left, right] = [p, q].map(|v| cell_of[v as usize]);
                if left != right {
                    let at = [p, q].map(|v| smooth[v as usize].coords);
                    let saved =
                        [saved(&cells, left, right, at[0]), saved(&cells, right, left, at[1])];
                    let (vertex, from, to, at) = if saved[0] >= saved[1] {
                        (p, left, right, at[0])
                    } else {
                        (q, right, left, at[1])
                    };
                    if saved[0].max(saved[1]) > LEAST {
                        cell_of[vertex as usize] = to;
                        cells[from as usize] = without(cells[from as usize], at);
                        cells[to as usize] = with(cells[to as usize], at);
                    }
                }
            }
        }
    }
}

/// What the squared distances to the centroids fall by when a vertex changes over.
fn saved(cells: &[Cell], from: u32, to: u32, at: Vector) -> f64 {
    let (from, to) = (cells[from as usize], cells[to as usize]);
    if from.1 < 1.5 {
        return 0.0;
    }
    spread(without(from, at)) + spread(with(to, at)) - spread(from) - spread(to)
}

fn with((sum, count): Cell, at: Vector) -> Cell {
    (sum + at, count + 1.0)
}

fn without((sum, count): Cell, at: Vector) -> Cell {
    (sum - at, count - 1.0)
}

/// The squared distances of a cell's vertices to the origin, less those to their centroid.
fn spread((sum, count): Cell) -> f64 {
    sum.norm_squared() / count
}

/// Positions without most of their noise.
fn smoothed(fine: &Working) -> Vec<Point> {
    let mut smooth = fine.mesh.positions.clone();
    for _ in 0..SMOOTHED {
        let mean = |vertex: u32| {
            let (mut sum, mut count) = with((Vector::zeros(), 0.0), smooth[vertex as usize].coords);
            fine.for_each_neighbour(vertex, |other| {
                (sum, count) = with((sum, count), smooth[other as usize].coords);
            });
            Point::from(sum / count)
        };
        let vertices = (0..smooth.len() as u32).into_par_iter().with_min_len(4096);
        smooth = vertices.map(mean).collect();
    }
    smooth
}
