//! Where regions touch, and whether the surface of one continues that of the other.

use super::assign::Model;
use super::scene::Scene;
use crate::math::{Point, Vector};
use crate::mesh::NONE;
use crate::partition::Regions;
use crate::surface::Surface;

/// Length of the mean normal below which a region goes around: that of three quarters of a cylinder.
const AROUND: f64 = 0.3;

/// Whether each region may be a piece of a free-form patch.
pub fn pieces(scene: &Scene, models: &[Model], regions: &Regions) -> Vec<bool> {
    models.iter().zip(regions.iter()).map(|(model, faces)| is_piece(scene, model, faces)).collect()
}

/// It is curved, but not all the way around.
fn is_piece(scene: &Scene, model: &Model, faces: &[u32]) -> bool {
    if matches!(model.surface, Surface::Plane(_) | Surface::FreeForm) {
        return false;
    }
    let geometry = scene.geometry;
    let area = |&face: &u32| geometry.areas[face as usize];
    let normal = |face: &u32| geometry.normals[*face as usize] * area(face);
    let mean = faces.iter().map(normal).sum::<Vector>() / faces.iter().map(area).sum::<f64>();
    mean.norm() > AROUND
}

/// Where two regions touch.
pub struct Seam {
    pub one: u32,
    pub other: u32,
    pub length: f64,
    /// Mean squared difference of the two surfaces' normals along it.
    turn: f64,
    /// Mean difference of their normal curvatures across it, per size.
    pub jump: f64,
    /// Mean of the larger of these curvatures, per size.
    pub bend: f64,
}

impl Seam {
    fn of(edges: &[Edge]) -> Self {
        let length: f64 = edges.iter().map(|e| e.length).sum();
        let mean =
            |of: fn(&Edge) -> f64| edges.iter().map(|e| e.length * of(e)).sum::<f64>() / length;
        Self {
            one: edges[0].one,
            other: edges[0].other,
            length,
            turn: mean(|e| e.turn),
            jump: mean(|e| (e.curvatures[0] - e.curvatures[1]).abs()),
            bend: mean(|e| e.curvatures[0].abs().max(e.curvatures[1].abs())),
        }
    }

    /// Whether one surface continues the other: their normals differ by less, on the mean.
    pub fn is_smooth(&self, degrees: f64) -> bool {
        self.turn < 2.0 - 2.0 * degrees.to_radians().cos()
    }
}

/// What an edge between two regions adds to their seam.
struct Edge {
    one: u32,
    other: u32,
    length: f64,
    turn: f64,
    curvatures: [f64; 2],
}

/// All seams, by the regions that they part.
pub fn seams(scene: &Scene, models: &[Model], labels: &[u32]) -> Vec<Seam> {
    let mut edges: Vec<Edge> = Vec::new();
    for (face, &one) in labels.iter().enumerate() {
        for (edge, &next) in scene.adjacency.neighbours[face].iter().enumerate() {
            if next == NONE || labels[next as usize] <= one {
                continue;
            }
            let other = labels[next as usize];
            let [a, b] = [edge, (edge + 1) % 3]
                .map(|k| scene.mesh.positions[scene.mesh.faces[face][k] as usize]);
            let middle = nalgebra::center(&a, &b);
            let pair = [one, other].map(|id| &models[id as usize]);
            let across = scene.normals[face].cross(&(b - a));
            let curvatures = pair.map(|model| curvature(model, middle, &across));
            let turn = turn(pair[0], pair[1], middle);
            edges.push(Edge { one, other, length: (a - b).norm(), turn, curvatures });
        }
    }
    edges.sort_by_key(|edge| (edge.one, edge.other));
    edges.chunk_by(|a, b| (a.one, a.other) == (b.one, b.other)).map(Seam::of).collect()
}

/// Squared difference of two surfaces' normals at a point; a free-form one has none to differ.
fn turn(one: &Model, other: &Model, at: Point) -> f64 {
    match (one.surface.normal(at), other.surface.normal(at)) {
        (Some(a), Some(b)) => 2.0 - 2.0 * one.side * other.side * a.dot(&b),
        _ => 0.0,
    }
}

/// Half the distance over which a normal is seen to turn, in sizes.
const STEP: f64 = 1e-4;

/// Curvature of a normal section, positive where the surface bends away from its faces' normals; zero
/// where it is not known, as on a free-form surface.
fn curvature(model: &Model, at: Point, along: &Vector) -> f64 {
    // An edge without length, or a face without area, leads nowhere.
    let Some(step) = along.try_normalize(0.0).map(|along| along * STEP) else { return 0.0 };
    match (model.surface.normal(at + step), model.surface.normal(at - step)) {
        (Some(ahead), Some(behind)) => {
            let turn = ahead.into_inner() - behind.into_inner();
            model.side * turn.dot(&step) / (2.0 * STEP * STEP)
        }
        _ => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Unit;
    use crate::mesh::{Mesh, Working};
    use crate::surface::Cylinder;

    /// Quads about the z axis, so many of a ring of 24.
    fn tube(quads: u32) -> Mesh {
        let at = |i: u32, z: f64| {
            let turn = f64::from(i % 24) * std::f64::consts::TAU / 24.0;
            Point::new(0.3 * turn.cos(), 0.3 * turn.sin(), z)
        };
        let positions = (0..=quads).flat_map(|i| [at(i, 0.0), at(i, 0.2)]).collect();
        let quad = |i: u32| [[2 * i, 2 * i + 2, 2 * i + 1], [2 * i + 1, 2 * i + 2, 2 * i + 3]];
        Mesh { positions, faces: (0..quads).flat_map(quad).collect() }
    }

    #[test]
    fn a_piece_of_a_patch_does_not_go_around() {
        let axis: Unit = Vector::z_axis();
        let bore = Surface::Cylinder(Cylinder { point: Point::origin(), axis, radius: 0.3 });
        for (quads, expected) in [(6, true), (12, true), (24, false)] {
            let working = Working::new(tube(quads));
            let scene = Scene::raw(&working);
            let faces: Vec<u32> = (0..working.len() as u32).collect();
            let model = Model { surface: bore.clone(), side: 1.0 };
            assert_eq!(is_piece(&scene, &model, &faces), expected, "{quads}");
        }
    }
}
