//! Conforming subdivision until every edge is short (paper, section 4.1).
//!
//! An edge that is too long is cut in the middle, and its halves again: always at the same points,
//! whichever face asks, so that no T-junction can arise. A face with one such edge becomes two,
//! with three four; one with two is cut across like a ladder, because halving a sliver of length n
//! again and again would make n^1.6 faces of it, not n.

use std::collections::HashMap;

use crate::error::{Error, Result};
use crate::mesh::Mesh;

/// Faces that a subdivision may produce: 2 GB of arrays further down the line.
const MOST_FACES: usize = 20_000_000;

/// A subdivided mesh, and where its faces come from.
#[derive(Debug, Clone, Default)]
pub struct Subdivided {
    /// The finer mesh; the vertices of the input come first, in their order.
    pub mesh: Mesh,
    /// The face of the input that every face is a part of.
    pub parents: Vec<u32>,
}

/// Cuts faces until no edge is longer than `max_edge` (in the unit of the mesh).
///
/// # Errors
/// [`Error::Option`] if that would make more than twenty million faces.
pub fn subdivide(mesh: Mesh, max_edge: f64) -> Result<Subdivided> {
    if max_edge.is_nan() || max_edge <= 0.0 {
        return Err(Error::Option(format!("max_edge is {max_edge}: give a length above 0")));
    }
    if least_count(&mesh, max_edge) > MOST_FACES as f64 {
        return Err(too_many(max_edge));
    }
    let count = mesh.faces.len();
    let mut cutter = Cutter { mesh, max_edge, middles: HashMap::new() };
    let mut parents: Vec<u32> = (0..count as u32).collect();
    let mut finished = Vec::new();
    for face in 0..count {
        finished.clear();
        cutter.cut(cutter.mesh.faces[face], &mut finished);
        // The first part takes the place of the whole, the others go to the end.
        cutter.mesh.faces[face] = finished[0];
        cutter.mesh.faces.extend(&finished[1..]);
        parents.resize(cutter.mesh.faces.len(), face as u32);
        if cutter.mesh.faces.len() > MOST_FACES.max(count) {
            return Err(too_many(max_edge));
        }
    }
    Ok(Subdivided { mesh: cutter.mesh, parents })
}

fn too_many(max_edge: f64) -> Error {
    Error::Option(format!(
        "max_edge {max_edge} needs more than {MOST_FACES} faces: give a longer one"
    ))
}

/// No fewer faces can have such short edges: the largest such face is equilateral.
fn least_count(mesh: &Mesh, max_edge: f64) -> f64 {
    let largest = 3f64.sqrt() / 4.0 * max_edge * max_edge;
    let double_area = |face| {
        let [a, b, c] = mesh.corners(face);
        (b - a).cross(&(c - a)).norm()
    };
    (0..mesh.faces.len()).map(double_area).sum::<f64>() / 2.0 / largest
}

struct Cutter {
    mesh: Mesh,
    max_edge: f64,
    /// The middle of every edge that was cut, by its lesser and its greater vertex.
    middles: HashMap<(u32, u32), u32>,
}

impl Cutter {
    /// Appends the parts of a face, each with its orientation.
    fn cut(&mut self, face: [u32; 3], finished: &mut Vec<[u32; 3]>) {
        let mut open = vec![face];
        while let Some(face) = open.pop() {
            let long = [0, 1, 2].map(|i| self.is_long(face[i], face[(i + 1) % 3]));
            match long.iter().filter(|&&is_long| is_long).count() {
                0 => finished.push(face),
                1 => self.halve(turned(face, long, |long| long[0]), &mut open),
                2 => self.ladder(turned(face, long, |long| long[0] && long[2]), &mut open),
                _ => self.quarter(face, &mut open),
            }
        }
    }

    fn halve(&mut self, [a, b, c]: [u32; 3], parts: &mut Vec<[u32; 3]>) {
        let ab = self.middle(a, b);
        parts.extend([[a, ab, c], [ab, b, c]]);
    }

    fn quarter(&mut self, [a, b, c]: [u32; 3], parts: &mut Vec<[u32; 3]>) {
        let [ab, bc, ca] = [self.middle(a, b), self.middle(b, c), self.middle(c, a)];
        parts.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
    }

    /// Rungs between the two long sides, which meet in `a`.
    fn ladder(&mut self, [a, b, c]: [u32; 3], parts: &mut Vec<[u32; 3]>) {
        let (left, right) = (self.chain(a, b), self.chain(a, c));
        parts.push([a, left[1], right[1]]);
        let (mut i, mut j) = (1, 1);
        while i + 1 < left.len() || j + 1 < right.len() {
            let (l, r) = (left[i], right[j]);
            let up_left = left.get(i + 1).map_or(f64::INFINITY, |&next| self.length(next, r));
            let up_right = right.get(j + 1).map_or(f64::INFINITY, |&next| self.length(l, next));
            // The shorter diagonal, so that every new edge is shorter than what was cut.
            if up_left <= up_right {
                parts.push([l, left[i + 1], r]);
                i += 1;
            } else {
                parts.push([l, right[j + 1], r]);
                j += 1;
            }
        }
    }

    /// All vertices of a cut edge, from `a` to `b`.
    fn chain(&mut self, a: u32, b: u32) -> Vec<u32> {
        let mut chain = vec![a];
        let mut ends = vec![b];
        while let Some(&end) = ends.last() {
            let start = chain[chain.len() - 1];
            if self.is_long(start, end) {
                ends.push(self.middle(start, end));
            } else {
                chain.push(end);
                ends.pop();
            }
        }
        chain
    }

    fn middle(&mut self, a: u32, b: u32) -> u32 {
        *self.middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
            let positions = &mut self.mesh.positions;
            positions.push(nalgebra::center(&positions[a as usize], &positions[b as usize]));
            positions.len() as u32 - 1
        })
    }

    fn is_long(&self, a: u32, b: u32) -> bool {
        self.length(a, b) > self.max_edge
    }

    fn length(&self, a: u32, b: u32) -> f64 {
        let at = |vertex: u32| self.mesh.positions[vertex as usize];
        // From the lesser index to the greater: the same rounding on both sides of the edge.
        (at(a.min(b)) - at(a.max(b))).norm()
    }
}

/// The same face, turned so that its long edges lie as wanted.
fn turned(mut face: [u32; 3], mut long: [bool; 3], wanted: impl Fn([bool; 3]) -> bool) -> [u32; 3] {
    while !wanted(long) {
        face.rotate_left(1);
        long.rotate_left(1);
    }
    face
}

#[cfg(test)]
mod tests {
    use rand::RngExt;

    use super::*;
    use crate::context::Context;
    use crate::math::Point;
    use crate::mesh::{Geometry, Working};

    /// A closed octahedron with random corners: long edges, short ones, slivers.
    fn octahedron(seed: u64) -> Mesh {
        let mut rng = Context::new(seed).rng;
        let mut draw = |x: f64| x * rng.random_range(0.01..1.0f64);
        let positions = [1.0, -1.0]
            .into_iter()
            .flat_map(|s| {
                [
                    Point::new(draw(s), 0.0, 0.0),
                    Point::new(0.0, draw(s), 0.0),
                    Point::new(0.0, 0.0, draw(s)),
                ]
            })
            .collect();
        let faces = vec![
            [0, 1, 2],
            [1, 3, 2],
            [3, 4, 2],
            [4, 0, 2],
            [1, 0, 5],
            [3, 1, 5],
            [4, 3, 5],
            [0, 4, 5],
        ];
        Mesh { positions, faces }
    }

    #[test]
    fn edges_are_short_the_surface_is_the_same_and_closed() {
        for seed in 0..50 {
            let coarse = octahedron(seed);
            let before = Geometry::new(&coarse);
            let fine = subdivide(coarse, 0.1).unwrap();
            let work = Working::new(fine.mesh);
            for face in &work.mesh.faces {
                for i in 0..3 {
                    let [a, b] = [face[i], face[(i + 1) % 3]].map(|v| v as usize);
                    let length = (work.mesh.positions[a] - work.mesh.positions[b]).norm();
                    assert!(length < 0.1 * (1.0 + 1e-12));
                }
            }
            // A T-junction would leave a border.
            assert!(work.adjacency.neighbours.iter().flatten().all(|&n| n != crate::mesh::NONE));
            let mut areas = vec![0.0; before.areas.len()];
            for (face, &parent) in fine.parents.iter().enumerate() {
                areas[parent as usize] += work.geometry.areas[face];
                let turn = work.geometry.normals[face].dot(&before.normals[parent as usize]);
                assert!((turn - 1.0).abs() < 1e-6);
            }
            for (here, there) in areas.iter().zip(&before.areas) {
                assert!((here - there).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn a_long_sliver_is_cut_across_only() {
        let positions =
            vec![Point::origin(), Point::new(100.0, 0.0, 0.0), Point::new(0.0, 0.001, 0.0)];
        let fine = subdivide(Mesh { positions, faces: vec![[0, 1, 2]] }, 1.0).unwrap();
        assert!(fine.mesh.faces.len() < 400, "{}", fine.mesh.faces.len());
    }

    #[test]
    fn without_a_limit_nothing_happens() {
        let mesh = octahedron(1);
        let same = subdivide(mesh.clone(), f64::INFINITY).unwrap();
        assert_eq!((same.mesh, same.parents), (mesh, (0..8).collect()));
    }

    #[test]
    fn an_absurd_limit_is_refused_before_memory_is_gone() {
        assert!(matches!(subdivide(octahedron(1), 1e-9), Err(Error::Option(_))));
        assert!(matches!(subdivide(octahedron(1), 0.0), Err(Error::Option(_))));
    }
}
