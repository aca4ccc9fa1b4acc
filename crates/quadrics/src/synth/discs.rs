//! Discs along a surface that keep random points at a distance from each other.

use crate::math::Point;
use crate::mesh::{Adjacency, Mesh};

/// Which vertices are too near to a point to become one.
pub(super) struct Discs {
    /// By vertex.
    pub(super) covered: Vec<bool>,
    seen: Vec<u32>,
    stack: Vec<u32>,
    count: u32,
}

impl Discs {
    pub(super) fn new(vertices: usize) -> Self {
        let (covered, seen) = (vec![false; vertices], vec![0; vertices]);
        Self { covered, seen, stack: Vec::new(), count: 0 }
    }

    /// Covers the vertices around `start` that are nearer to `point` than `radius`.
    pub(super) fn cover(
        &mut self,
        mesh: &Mesh,
        adjacency: &Adjacency,
        start: u32,
        point: Point,
        radius: f64,
    ) {
        self.count += 1;
        self.stack.push(start);
        self.seen[start as usize] = self.count;
        // In any case: every point must take a vertex out of the game.
        self.covered[start as usize] = true;
        while let Some(vertex) = self.stack.pop() {
            for &next in adjacency.around(vertex).iter().flat_map(|&f| &mesh.faces[f as usize]) {
                let (seen, place) = (&mut self.seen[next as usize], mesh.positions[next as usize]);
                if *seen != self.count && (place - point).norm_squared() < radius * radius {
                    *seen = self.count;
                    self.covered[next as usize] = true;
                    self.stack.push(next);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::part;
    use super::*;

    #[test]
    fn a_disc_covers_what_is_near_along_the_surface_and_nothing_else() {
        let mesh = part("plate:0", 4_000).unwrap().mesh;
        let adjacency = Adjacency::new(&mesh.faces, mesh.positions.len());
        let middle = |p: &&Point| (p.x - 10.0).abs() < 1.0 && (p.y - 10.0).abs() < 1.0;
        let top = |p: &Point| p.z == 10.0;
        let start = mesh.positions.iter().position(|p| middle(&p) && top(p)).unwrap();
        let mut discs = Discs::new(mesh.positions.len());
        // The plate is 20 wide: a disc of radius 12 would wrap around, one of 8.5 stays on top.
        let (radius, center) = (8.5, mesh.positions[start]);
        discs.cover(&mesh, &adjacency, start as u32, center, radius);
        for (p, &covered) in mesh.positions.iter().zip(&discs.covered) {
            assert_eq!(covered, top(p) && (p - center).norm() < radius, "{p}");
        }
    }
}
