//! A face on its own, and four of them at a time.

use std::array::from_fn;

use super::lanes::{LANES, Lanes, Packet};
use super::{Point, Vector};

/// A triangle in space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Triangle {
    /// Its corners.
    pub corners: [Point; 3],
    /// Its unit normal; zero without area.
    pub normal: Vector,
    /// Its area.
    pub area: f64,
}

impl Triangle {
    /// What follows from its corners.
    #[inline]
    pub fn new(corners: [Point; 3]) -> Self {
        let [a, b, c] = corners;
        let cross = (b - a).cross(&(c - a));
        let length = cross.norm();
        let normal = if length > 0.0 { cross / length } else { Vector::zeros() };
        Self { corners, normal, area: length / 2.0 }
    }

    /// The mean of its corners.
    pub fn barycentre(&self) -> Point {
        let [a, b, c] = self.corners;
        Point::from((a.coords + b.coords + c.coords) / 3.0)
    }
}

/// [`LANES`] triangles.
#[derive(Debug, Clone, Copy)]
pub struct Triangles {
    /// Their first, second and third corners.
    pub corners: [Packet; 3],
    /// Their unit normals.
    pub normals: Packet,
    /// Their areas.
    pub areas: Lanes,
}

impl Triangles {
    /// One to [`LANES`] triangles; where they are fewer the last one again, without area.
    #[inline(always)]
    pub fn new(triangles: &[Triangle]) -> Self {
        let of = |i: usize| &triangles[i.min(triangles.len() - 1)];
        let corners = |c: usize| Packet::new(&from_fn::<Point, LANES, _>(|i| of(i).corners[c]));
        let area = |i: usize| if i < triangles.len() { triangles[i].area } else { 0.0 };
        Self {
            corners: from_fn(corners),
            normals: Packet::new(&from_fn::<Point, LANES, _>(|i| of(i).normal.into())),
            areas: Lanes(from_fn(area)),
        }
    }
}
