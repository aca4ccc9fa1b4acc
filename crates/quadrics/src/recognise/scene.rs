//! What the recognition looks at: a mesh in the unit cube, its neighbourhoods, its noise.

use std::borrow::Cow;

use super::means::Cells;
use crate::math::{Point, Vector};
use crate::mesh::{Adjacency, Geometry, Mesh, Working};
use crate::prepare::noise::{self, ROUNDING};
use crate::prepare::{is_tessellated, normals};
use crate::surface::Shape;
use crate::surface::related::Shown;
use crate::surface::select::Evidence;

/// A mesh in the unit cube and all that is derived from it once.
pub struct Scene<'a> {
    /// Positions and faces; vertices of bands lie on the surfaces beside them.
    pub mesh: Cow<'a, Mesh>,
    /// Areas, raw normals, barycentres.
    pub geometry: &'a Geometry,
    /// Neighbours.
    pub adjacency: &'a Adjacency,
    /// Face normals, filtered as far as the noise asks.
    pub normals: Cow<'a, [Vector]>,
    /// Noise of the vertices.
    pub evidence: Evidence,
    /// Mean edge length.
    pub edge: f64,
    /// Whether the mesh is exact and uneven, as CAD programs and decimation make it.
    pub tessellated: bool,
    /// Faces for one of the mesh that surfaces are sought on: 1 where it is this one.
    pub grain: u32,
    /// Vertices that are taken together, where surfaces are sought on means.
    pub cells: Option<Cells>,
    /// Directions and axes that the surfaces found so far show; none at first.
    pub shown: Shown,
    /// Whether each face was found to be of a band; empty where there is none.
    pub banded: Vec<bool>,
}

/// Normal noise below which nothing is filtered, in radians.
const QUIET: f64 = 0.03;
/// Least standard deviation of normals: facets of a curved surface are not tangent to it.
pub const NORMAL_FLOOR: f64 = 0.04;

/// Rounds of filtering for borders, and how much further apart normals may be that mix.
const BORDER_ROUNDS: usize = 3;
const BORDER_REACH: f64 = 2.0;

/// Normals that are further apart do not mix while surfaces are sought, for raw ones that err by
/// `raw`; both in radians.
fn reach(raw: f64) -> f64 {
    0.2 + 0.55 * raw
}

impl<'a> Scene<'a> {
    /// Looks at a mesh, and filters its normals as far as the noise asks.
    pub fn new(working: &'a Working) -> Self {
        let mut scene = Self::raw(working);
        scene.filter();
        scene
    }

    /// Looks at a mesh and leaves its normals as they are.
    pub fn raw(working: &'a Working) -> Self {
        let Working { mesh, geometry, adjacency } = working;
        let tessellated = is_tessellated(mesh, adjacency);
        let known = if tessellated { 0.0 } else { noise::position(mesh, adjacency) };
        let sigma = known.max(ROUNDING);
        let area = geometry.areas.iter().sum::<f64>() / geometry.areas.len().max(1) as f64;
        // The edge of an equilateral triangle of mean area.
        let edge = (area * 4.0 / 3f64.sqrt()).sqrt();
        let evidence =
            Evidence { sigma, independent: 1.0, normal_sigma: NORMAL_FLOOR, general: true };
        let normals = Cow::Borrowed(&geometry.normals[..]);
        Self {
            mesh: Cow::Borrowed(mesh),
            geometry,
            adjacency,
            normals,
            evidence,
            edge,
            tessellated,
            grain: 1,
            cells: None,
            shown: Shown::default(),
            banded: Vec::new(),
        }
    }

    /// Filters the normals as far as the noise asks.
    pub fn filter(&mut self) {
        let raw = self.raw_turn();
        if raw >= QUIET {
            let rounds = (3.0 + 6.0 * raw).round().min(10.0) as usize;
            self.filter_by(rounds, reach(raw));
            self.evidence.normal_sigma = NORMAL_FLOOR + 0.2 * raw;
        }
    }

    /// Filters the raw normals anew, for dividing faces between surfaces that are known. Whoever seeks
    /// surfaces wants normals that stop at creases; those are flat beside them, too, and a plane would
    /// take half of the fillet that it runs into. The waviness of a scan bends either alike.
    pub fn filter_for_borders(&mut self) {
        let raw = self.raw_turn();
        if raw >= QUIET && !self.correlated() {
            self.filter_by(BORDER_ROUNDS, BORDER_REACH * reach(raw));
        }
    }

    /// How much raw normals err, in radians: about twice the noise over the edge.
    fn raw_turn(&self) -> f64 {
        2.0 * self.evidence.sigma / self.edge
    }

    fn filter_by(&mut self, rounds: usize, reach: f64) {
        let rings = normals::Rings::new(&self.mesh, self.adjacency);
        self.normals = Cow::Owned(normals::filter(self.geometry, &rings, rounds, reach));
    }

    /// Squared distance of a face's corners from a surface, their mean.
    pub fn squared_distance<S: Shape>(&self, shape: &S, face: usize) -> f64 {
        let corners = self.mesh.corners(face);
        corners.into_iter().map(|p| shape.distance(p).powi(2)).sum::<f64>() / 3.0
    }

    /// Squared difference of the filtered normal and the surface's, whose orientation is free when
    /// `side` is zero.
    pub fn normal_deviation<S: Shape>(&self, shape: &S, face: usize, side: f64) -> f64 {
        let Some(normal) = shape.normal(self.geometry.barycentres[face]) else { return 4.0 };
        2.0 - 2.0 * side * normal.dot(&self.normals[face])
    }

    /// Points and normals of at most `limit` vertices of some faces, evenly spread over them.
    ///
    /// On scans, vertices that another region shares lie several sigmas off both: they are left out
    /// where enough others remain.
    pub fn samples(&self, faces: &[u32], limit: usize, seen: &mut Marks) -> Gathered {
        let mut vertices = seen.vertices_of(&self.mesh, faces);
        if self.correlated() {
            let inner =
                |&(v, _): &(u32, u32)| seen.count(v) == self.adjacency.around(v).len() as u32;
            let inside: Vec<_> = vertices.iter().copied().filter(inner).collect();
            if inside.len() >= ENOUGH {
                vertices = inside;
            }
        }
        let total = vertices.len();
        let mut gathered = Gathered { total, ..Gathered::default() };
        for &(vertex, face) in picked(&vertices, limit) {
            gathered.points.push(self.mesh.positions[vertex as usize]);
            gathered.barycentres.push(self.geometry.barycentres[face as usize]);
            gathered.normals.push(self.normals[face as usize]);
        }
        gathered
    }

    /// The regions beside one, some of whose faces these are: one for every edge of its border.
    pub fn beside(&self, id: u32, faces: &[u32], labels: &[u32]) -> impl Iterator<Item = u32> {
        let across = faces.iter().flat_map(|&face| self.adjacency.across(face as usize));
        across.map(|face| labels[face]).filter(move |&label| label != id)
    }

    /// Whether some faces are a band: a wall that is no wider than its noise, whose normals say more than its
    /// vertices.
    pub fn is_band(&self, faces: &[u32]) -> bool {
        let banded = |&&face: &&u32| self.banded[face as usize];
        !self.banded.is_empty() && 2 * faces.iter().filter(banded).count() > faces.len()
    }

    /// Whether every vertex errs on its own, and that shows.
    pub fn noisy(&self) -> bool {
        !self.evidence.general && !self.correlated()
    }

    /// Whether the noise is that of a scan: neighbours err together.
    pub fn correlated(&self) -> bool {
        self.evidence.independent < 1.0
    }
}

/// At most `limit` of a list, evenly spread over it.
pub(super) fn picked<T>(list: &[T], limit: usize) -> impl Iterator<Item = &T> {
    let step = (list.len() as f64 / limit as f64).max(1.0);
    (0..).map_while(move |i| list.get((f64::from(i) * step) as usize))
}

/// Inner vertices that suffice for a fit.
const ENOUGH: usize = 15;

/// Samples of a set of faces.
#[derive(Default)]
pub struct Gathered {
    /// Positions of the sampled vertices.
    pub points: Vec<Point>,
    /// Barycentre of a face at each.
    pub barycentres: Vec<Point>,
    /// Filtered normal of that face.
    pub normals: Vec<Vector>,
    /// Vertices of all the faces.
    pub total: usize,
}

impl Gathered {
    /// Divided into so many sets, which stand for themselves, by where the points are.
    pub fn divided(&self, count: usize, part: impl Fn(Point) -> usize) -> Vec<Self> {
        let mut sets: Vec<Self> = (0..count).map(|_| Self::default()).collect();
        for (i, &point) in self.points.iter().enumerate() {
            let set = &mut sets[part(point)];
            set.points.push(point);
            set.barycentres.push(self.barycentres[i]);
            set.normals.push(self.normals[i]);
            set.total += 1;
        }
        sets
    }

    /// As the fits want them.
    pub fn samples(&self) -> crate::surface::Samples<'_> {
        crate::surface::Samples {
            points: &self.points,
            barycentres: &self.barycentres,
            normals: &self.normals,
        }
    }
}

/// Counts per index, all zeroed in constant time.
#[derive(Default)]
pub struct Marks {
    stamp: u32,
    stamps: Vec<u32>,
    counts: Vec<u32>,
}

impl Marks {
    /// Zeroes everything and makes room for `count` indices.
    pub fn clear(&mut self, count: usize) {
        self.stamps.resize(count.max(self.stamps.len()), 0);
        self.counts.resize(count.max(self.counts.len()), 0);
        self.stamp += 1;
    }

    /// Counts an index; whether it is new.
    pub fn mark(&mut self, index: u32) -> bool {
        let i = index as usize;
        let new = self.stamps[i] != self.stamp;
        self.stamps[i] = self.stamp;
        self.counts[i] = if new { 1 } else { self.counts[i] + 1 };
        new
    }

    /// Whether an index was counted.
    pub fn has(&self, index: u32) -> bool {
        self.stamps[index as usize] == self.stamp
    }

    /// How often.
    pub fn count(&self, index: u32) -> u32 {
        if self.has(index) { self.counts[index as usize] } else { 0 }
    }

    /// The vertices of some faces, each with the first face that has it, counting their faces.
    pub fn vertices_of(&mut self, mesh: &Mesh, faces: &[u32]) -> Vec<(u32, u32)> {
        self.clear(mesh.positions.len());
        let mut vertices = Vec::with_capacity(faces.len());
        for &face in faces {
            for &vertex in &mesh.faces[face as usize] {
                if self.mark(vertex) {
                    vertices.push((vertex, face));
                }
            }
        }
        vertices
    }
}
