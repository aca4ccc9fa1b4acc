//! Small meshes with known regions, for tests.

use std::collections::HashMap;
use std::f64::consts::TAU;

use super::Mesh;
use crate::math::{Point, Vector};

/// A mesh and the true region of every face.
pub(crate) struct Sample {
    pub mesh: Mesh,
    pub labels: Vec<u32>,
}

impl Sample {
    fn empty() -> Self {
        Self { mesh: Mesh::default(), labels: Vec::new() }
    }

    /// A grid of `n` by `m` cells of two faces as one region; `at` takes [0, 1]².
    fn patch(mut self, [n, m]: [u32; 2], at: impl Fn(f64, f64) -> Point) -> Self {
        let label = self.labels.last().map_or(0, |&label| label + 1);
        let first = self.mesh.positions.len() as u32;
        for i in 0..=n {
            for j in 0..=m {
                let (u, v) = (f64::from(i) / f64::from(n), f64::from(j) / f64::from(m));
                self.mesh.positions.push(at(u, v));
            }
        }
        let vertex = |i, j| first + i * (m + 1) + j;
        for i in 0..n {
            for j in 0..m {
                let corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
                let [a, b, c, d] = corners.map(|(i, j)| vertex(i, j));
                self.mesh.faces.extend([[a, b, c], [a, c, d]]);
                self.labels.extend([label; 2]);
            }
        }
        self
    }

    /// Coincident vertices become one, and faces that collapse go.
    fn welded(self) -> Self {
        let mut index = HashMap::new();
        let mut welded = Self::empty();
        let to: Vec<u32> = self
            .mesh
            .positions
            .iter()
            .map(|p| {
                let key = p.coords.map(|x| (x * 1e7).round() as i64);
                *index.entry([key.x, key.y, key.z]).or_insert_with(|| {
                    welded.mesh.positions.push(*p);
                    welded.mesh.positions.len() as u32 - 1
                })
            })
            .collect();
        for (face, label) in self.mesh.faces.iter().zip(self.labels) {
            let [a, b, c] = face.map(|vertex| to[vertex as usize]);
            if a != b && b != c && c != a {
                welded.mesh.faces.push([a, b, c]);
                welded.labels.push(label);
            }
        }
        welded
    }

    /// Both meshes side by side, the other moved along x.
    pub fn beside(mut self, other: Self, along: f64) -> Self {
        let (first, label) = (self.mesh.positions.len() as u32, self.labels.last().unwrap() + 1);
        let moved = other.mesh.positions.iter().map(|p| p + Vector::x() * along);
        self.mesh.positions.extend(moved);
        self.mesh.faces.extend(other.mesh.faces.iter().map(|f| f.map(|v| v + first)));
        self.labels.extend(other.labels.iter().map(|l| l + label));
        self
    }
}

/// The unit cube, `n` cells along each edge: six planes.
pub(crate) fn cube(n: u32) -> Sample {
    let mut sample = Sample::empty();
    for axis in 0..3 {
        for side in [0.0, 1.0] {
            sample = sample.patch([n, n], |u, v| {
                let (u, v) = if side == 1.0 { (u, v) } else { (v, u) };
                let mut p = Point::origin();
                (p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3]) = (side, u, v);
                p
            });
        }
    }
    sample.welded()
}

/// A closed cylinder of radius 0.4 and height 1: side, bottom, top.
pub(crate) fn can(n: u32) -> Sample {
    let at = |angle: f64, radius: f64, height: f64| {
        Point::new(0.5 + radius * (TAU * angle).cos(), 0.5 + radius * (TAU * angle).sin(), height)
    };
    Sample::empty()
        .patch([4 * n, n], |u, v| at(u, 0.4, v))
        .patch([4 * n, n], |u, v| at(u, 0.4 * (1.0 - v), 1.0))
        .patch([n, 4 * n], |u, v| at(v, 0.4 * (1.0 - u), 0.0))
        .welded()
}
