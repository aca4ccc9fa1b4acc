//! How much of the mesh a shape explains: an estimate on a random subset, then connected inliers.

use super::marks::Marks;
use crate::math::{Point, Vector};
use crate::mesh::Working;
use crate::partition::UNLABELLED;
use crate::surface::{Shape, Surface};

/// Standard deviations between the estimate on a subset and its upper bound.
const DOUBT: f64 = 2.0;

/// What is compatible with a shape (section 5.1).
#[derive(Debug, Clone, Copy)]
pub struct Tolerance {
    /// Largest distance of a barycentre.
    pub epsilon: f64,
    /// Least cosine between the normals.
    pub alpha: f64,
}

/// A shape, and which of its sides is outside.
#[derive(Debug, Clone)]
pub struct Candidate {
    /// The shape.
    pub surface: Surface,
    /// +1 where the faces' normals agree with the surface's, -1 where they oppose it.
    pub side: f64,
    /// A face that it goes through: its inliers are counted from there.
    pub start: u32,
}

/// The connected inliers of a candidate.
#[derive(Debug, Clone, Default)]
pub struct Inliers {
    /// The faces, in the order in which they were reached.
    pub faces: Vec<u32>,
    /// Their weights, summed.
    pub score: f64,
}

/// What an algorithm needs that is the same for every type: the enum is matched once a call.
macro_rules! for_shape {
    ($surface:expr, $shape:ident => $body:expr, else $otherwise:expr) => {
        match $surface {
            Surface::Plane($shape) => $body,
            Surface::Sphere($shape) => $body,
            Surface::Cylinder($shape) => $body,
            Surface::Cone($shape) => $body,
            Surface::Torus($shape) => $body,
            Surface::Quadric(_) | Surface::FreeForm => $otherwise,
        }
    };
}

impl Candidate {
    /// Outside is where the normal of `start` points; `None` if that face is not compatible.
    pub fn through(
        working: &Working,
        tolerance: &Tolerance,
        surface: Surface,
        start: u32,
    ) -> Option<Self> {
        let (point, normal) = dual(working, start as usize);
        let side = surface.normal(point)?.dot(&normal).signum();
        let found = Self { surface, side, start };
        (found.weight(tolerance, (point, normal)) > 0.0).then_some(found)
    }

    /// 1 on the surface, falling to 0 at ε; 0 for a face that is not compatible.
    ///
    /// Not a mere count: within 2 % of the part a sloppy surface counts as many faces as the true
    /// one and a strip of its neighbour besides.
    pub fn weight(&self, tolerance: &Tolerance, dual: (Point, Vector)) -> f64 {
        for_shape!(&self.surface, shape => weight(shape, self.side, tolerance, dual), else 0.0)
    }

    /// Upper bound of the score, from the compatible ones among `subset` of `whole` faces.
    pub fn bound(
        &self,
        working: &Working,
        tolerance: &Tolerance,
        subset: &[u32],
        whole: usize,
    ) -> f64 {
        let hits: f64 = for_shape!(&self.surface, shape => {
            let of = |&face: &u32| weight(shape, self.side, tolerance, dual(working, face as usize));
            subset.iter().map(of).sum()
        }, else 0.0);
        let share = whole as f64 / subset.len().max(1) as f64;
        // The variance of a count is at most the count; one more for a subset that missed it.
        if share <= 1.0 { hits } else { (hits + DOUBT * (hits + 1.0).sqrt()) * share }
    }

    /// The unlabelled compatible faces that hang together with `start`, across edges and corners:
    /// one noisy face must not cut a surface in two.
    pub fn inliers(
        &self,
        working: &Working,
        tolerance: &Tolerance,
        labels: &[u32],
        marks: &mut Marks,
    ) -> Inliers {
        for_shape!(&self.surface, shape => {
            let weigh = |face: usize| weight(shape, self.side, tolerance, dual(working, face));
            grow(working, labels, self.start, marks, weigh)
        }, else Inliers::default())
    }
}

/// The point of the dual of a face.
pub fn dual(working: &Working, face: usize) -> (Point, Vector) {
    (working.geometry.barycentres[face], working.geometry.normals[face])
}

fn weight(shape: &impl Shape, side: f64, tolerance: &Tolerance, (p, n): (Point, Vector)) -> f64 {
    let off = shape.distance(p) / tolerance.epsilon;
    if off.abs() >= 1.0 {
        return 0.0;
    }
    let cosine = shape.normal(p).map_or(0.0, |normal| side * normal.dot(&n));
    if cosine >= tolerance.alpha { 1.0 - off * off } else { 0.0 }
}

fn grow(
    working: &Working,
    labels: &[u32],
    start: u32,
    marks: &mut Marks,
    weigh: impl Fn(usize) -> f64,
) -> Inliers {
    let mut found = Inliers::default();
    if labels[start as usize] != UNLABELLED {
        return found;
    }
    marks.begin();
    marks.visit_face(start);
    found.score = weigh(start as usize);
    found.faces.push(start);
    let mut next = 0;
    while next < found.faces.len() {
        for corner in working.mesh.faces[found.faces[next] as usize] {
            // All faces of a vertex are looked at from the first of them.
            if !marks.visit_vertex(corner) {
                continue;
            }
            for &face in working.adjacency.around(corner) {
                if labels[face as usize] != UNLABELLED || !marks.visit_face(face) {
                    continue;
                }
                let weight = weigh(face as usize);
                if weight > 0.0 {
                    found.score += weight;
                    found.faces.push(face);
                }
            }
        }
        next += 1;
    }
    found
}
