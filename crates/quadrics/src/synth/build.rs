//! Putting parts together: regions, vertices and faces, and planar faces between closed loops.

use super::curve::Point2;
use super::part::Part;
use super::sheet;
use crate::math::{Point, Unit, Vector};
use crate::mesh::Mesh;
use crate::surface::{Plane, Surface};

/// A right-handed frame in space.
#[derive(Debug, Clone, Copy)]
pub(super) struct Frame {
    pub(super) origin: Point,
    pub(super) x: Unit,
    pub(super) y: Unit,
    pub(super) z: Unit,
}

impl Frame {
    /// The frame with two given axes, at right angles to each other.
    pub(super) fn new(origin: [f64; 3], x: Vector, z: Vector) -> Self {
        let (x, z) = (Unit::new_normalize(x), Unit::new_normalize(z));
        Self { origin: origin.into(), x, y: Unit::new_unchecked(z.cross(&x)), z }
    }

    /// Parallel to the frame of the part, upright.
    pub(super) fn upright(x: f64, y: f64, z: f64) -> Self {
        Self::new([x, y, z], Vector::x(), Vector::z())
    }

    /// From coordinates to a point in space.
    pub(super) fn at(&self, [x, y, z]: [f64; 3]) -> Point {
        self.origin + self.x.into_inner() * x + self.y.into_inner() * y + self.z.into_inner() * z
    }

    /// From coordinates to a direction.
    pub(super) fn direction(&self, [x, y, z]: [f64; 3]) -> Unit {
        let v = self.x.into_inner() * x + self.y.into_inner() * y + self.z.into_inner() * z;
        Unit::new_normalize(v)
    }

    /// The frame seen from behind: turned about its x axis by half a turn.
    pub(super) fn reversed(&self) -> Self {
        Self { y: -self.y, z: -self.z, ..*self }
    }

    /// The same axes at another place.
    pub(super) fn moved(&self, to: [f64; 3]) -> Self {
        Self { origin: self.at(to), ..*self }
    }

    /// First two coordinates of a point.
    pub(super) fn flat(&self, point: Point) -> Point2 {
        let offset = point - self.origin;
        [self.x.dot(&offset), self.y.dot(&offset)]
    }
}

/// A closed chain of vertices along an edge of the part.
pub(super) type Loop = Vec<u32>;

/// A part in the making.
pub(super) struct Builder {
    /// Length of the edges to make, about.
    pub(super) spacing: f64,
    positions: Vec<Point>,
    faces: Vec<[u32; 3]>,
    labels: Vec<u32>,
    surfaces: Vec<Surface>,
}

impl Builder {
    pub(super) fn new(spacing: f64) -> Self {
        let (positions, faces, labels, surfaces) = Default::default();
        Self { spacing, positions, faces, labels, surfaces }
    }

    /// The finished part.
    pub(super) fn part(self) -> Part {
        let mesh = Mesh { positions: self.positions, faces: self.faces };
        Part { mesh, labels: self.labels, surfaces: self.surfaces }
    }

    /// Begins a region.
    pub(super) fn region(&mut self, surface: Surface) -> u32 {
        self.surfaces.push(surface);
        self.surfaces.len() as u32 - 1
    }

    /// Adds a vertex.
    pub(super) fn vertex(&mut self, position: Point) -> u32 {
        self.positions.push(position);
        self.positions.len() as u32 - 1
    }

    /// Where a vertex is.
    pub(super) fn position(&self, vertex: u32) -> Point {
        self.positions[vertex as usize]
    }

    /// Adds a face to a region.
    pub(super) fn face(&mut self, region: u32, corners: [u32; 3]) {
        self.faces.push(corners);
        self.labels.push(region);
    }

    /// How many edges a curve of this length is divided into, and not fewer than `least`.
    pub(super) fn divisions(&self, length: f64, least: usize) -> usize {
        ((length / self.spacing).round() as usize).max(least)
    }

    /// Closes the figure between loops of the frame's xy plane with a planar region whose outward
    /// normal is the frame's z; the first loop is the outer one.
    pub(super) fn plane(&mut self, frame: &Frame, loops: &[Loop]) {
        let region = self.region(Surface::Plane(Plane::through(frame.origin, frame.z)));
        self.lifted(region, frame, loops, |[x, y]| frame.at([x, y, 0.0]));
    }

    /// The same for a region that lies above the plane as `lift` says.
    pub(super) fn lifted(
        &mut self,
        region: u32,
        frame: &Frame,
        loops: &[Loop],
        lift: impl Fn(Point2) -> Point,
    ) {
        let flat = |&v: &u32| frame.flat(self.position(v));
        let outlines: Vec<Vec<_>> = loops.iter().map(|l| l.iter().map(flat).collect()).collect();
        self.patch(region, &loops.concat(), &outlines, lift);
    }

    /// Fills outlines in a parameter plane, whose vertices exist already; `lift` takes parameters
    /// to the surface, counter-clockwise seen from outside.
    pub(super) fn patch(
        &mut self,
        region: u32,
        boundary: &[u32],
        outlines: &[Vec<Point2>],
        lift: impl Fn(Point2) -> Point,
    ) {
        let sheet = sheet::fill(outlines, self.spacing);
        let first = self.positions.len() as u32;
        self.positions.extend(sheet.interior.into_iter().map(lift));
        let known = boundary.len() as u32;
        let vertex = |v: u32| if v < known { boundary[v as usize] } else { first + v - known };
        self.faces.extend(sheet.faces.iter().map(|corners| corners.map(vertex)));
        self.labels.resize(self.faces.len(), region);
    }
}
