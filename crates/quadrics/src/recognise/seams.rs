//! Where regions touch, and whether the surface of one continues that of the other.

use super::assign::Model;
use super::scene::Scene;
use crate::math::Point;
use crate::mesh::NONE;

/// Where two regions touch.
pub struct Seam {
    pub one: u32,
    pub other: u32,
    pub length: f64,
    /// Mean squared difference of the two surfaces' normals along it.
    turn: f64,
}

impl Seam {
    /// Whether one surface continues the other: their normals differ by less, on the mean.
    pub fn is_smooth(&self, degrees: f64) -> bool {
        self.turn < 2.0 - 2.0 * degrees.to_radians().cos()
    }
}

/// All seams, by the regions that they part.
pub fn seams(scene: &Scene, models: &[Model], labels: &[u32]) -> Vec<Seam> {
    let mut edges: Vec<(u32, u32, f64, f64)> = Vec::new();
    for (face, &label) in labels.iter().enumerate() {
        for (edge, &next) in scene.adjacency.neighbours[face].iter().enumerate() {
            if next == NONE || labels[next as usize] <= label {
                continue;
            }
            let other = labels[next as usize];
            let [a, b] = [edge, (edge + 1) % 3]
                .map(|k| scene.mesh.positions[scene.mesh.faces[face][k] as usize]);
            let middle = nalgebra::center(&a, &b);
            let turn = turn(&models[label as usize], &models[other as usize], middle);
            edges.push((label, other, (a - b).norm(), turn));
        }
    }
    edges.sort_by_key(|edge| (edge.0, edge.1));
    let seam = |same: &[(u32, u32, f64, f64)]| {
        let length: f64 = same.iter().map(|e| e.2).sum();
        let turn: f64 = same.iter().map(|e| e.2 * e.3).sum();
        Seam { one: same[0].0, other: same[0].1, length, turn: turn / length }
    };
    edges.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)).map(seam).collect()
}

/// Squared difference of two surfaces' normals at a point; a free-form one has none to differ.
fn turn(one: &Model, other: &Model, at: Point) -> f64 {
    match (one.surface.normal(at), other.surface.normal(at)) {
        (Some(a), Some(b)) => 2.0 - 2.0 * one.side * other.side * a.dot(&b),
        _ => 0.0,
    }
}
