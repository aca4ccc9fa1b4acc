//! Gathers vertices and polygons into a [`Loaded`], whatever the format.

use super::{InputFaces, Loaded, error};
use crate::error::{Error, Result};
use crate::math::Point;
use crate::mesh::{Mesh, check_indices};
use crate::result::Repair;

/// Half-edges are numbered in 32 bits.
pub(super) const MOST_FACES: usize = u32::MAX as usize / 3;
/// Triangles that a file may have beyond those that it spells out, as copies of a part.
const MOST_COPIES: usize = 10_000_000;

#[derive(Debug)]
pub(super) struct Builder {
    format: &'static str,
    pub positions: Vec<Point>,
    faces: Vec<[u32; 3]>,
    parent: Vec<u32>,
    /// Faces of the file so far.
    count: usize,
    polygons: usize,
    stunted: usize,
    most: usize,
}

impl Builder {
    /// `vertices` and `faces` are what the file is known to have room for.
    pub fn new(format: &'static str, vertices: usize, faces: usize) -> Self {
        Self {
            format,
            positions: Vec::with_capacity(vertices),
            faces: Vec::with_capacity(faces),
            parent: Vec::with_capacity(faces),
            count: 0,
            polygons: 0,
            stunted: 0,
            most: MOST_FACES,
        }
    }

    /// For formats that may name one part many times: `own` is what the file can hold without copies.
    pub fn limit_copies(&mut self, own: usize) {
        self.most = MOST_FACES.min(own.saturating_add(MOST_COPIES));
    }

    /// That there may be so many vertices or triangles.
    pub fn check_limit(&self, count: usize) -> Result<()> {
        if count > self.most {
            let what = format!("more than {} triangles or vertices: split the mesh", self.most);
            return Err(error(self.format, what));
        }
        Ok(())
    }

    pub fn vertex(&mut self, position: [f64; 3]) {
        // Adding zero turns -0.0 into 0.0.
        self.positions.push(Point::from(position.map(|x| x + 0.0)));
    }

    /// A face of the file, cut into a fan around its first corner.
    ///
    /// What has fewer than three corners becomes a triangle without area, so that it has a label, too.
    pub fn polygon(&mut self, corners: &[u32]) -> Result<()> {
        self.check_limit(self.faces.len() + corners.len())?;
        match *corners {
            [] => self.triangle([0; 3]),
            [a] => self.triangle([a; 3]),
            [a, b] => self.triangle([a, b, b]),
            [a, b, c] => self.triangle([a, b, c]),
            [a, ref rest @ ..] => {
                rest.windows(2).for_each(|pair| self.triangle([a, pair[0], pair[1]]))
            }
        }
        self.stunted += usize::from(corners.len() < 3);
        self.polygons += usize::from(corners.len() > 3);
        self.count += 1;
        Ok(())
    }

    fn triangle(&mut self, corners: [u32; 3]) {
        self.faces.push(corners);
        self.parent.push(self.count as u32);
    }

    /// How many faces of the file there are so far.
    pub fn count(&self) -> usize {
        self.count
    }

    /// An index as the file has it, for a face that is about to be added.
    pub fn index(&self, index: i64) -> Result<u32> {
        // Whether the vertex comes later in the file is seen at the end.
        u32::try_from(index).ok().filter(|&index| index < u32::MAX).ok_or(Error::IndexOutOfRange {
            face: self.count,
            vertex: index,
            vertices: self.positions.len(),
        })
    }

    pub fn finish(self) -> Result<Loaded> {
        if self.positions.len() >= u32::MAX as usize {
            return Err(error(self.format, "more vertices than 32 bits can count: split the mesh"));
        }
        let number = |face: usize| self.parent[face] as usize;
        check_indices(&self.faces, self.positions.len()).map_err(|error| match error {
            Error::IndexOutOfRange { face, vertex, vertices } => {
                Error::IndexOutOfRange { face: number(face), vertex, vertices }
            }
            other => other,
        })?;
        let mut repairs = Vec::new();
        let mut note = |kind, count, what: &str| {
            if count > 0 {
                repairs.push(Repair { kind, count, detail: format!("{what}: {count}") });
            }
        };
        note("polygons", self.polygons, "faces of more than three corners, cut into triangles");
        note("stunted_faces", self.stunted, "faces of fewer than three corners, without area");
        Ok(Loaded {
            mesh: Mesh { positions: self.positions, faces: self.faces },
            input_faces: InputFaces { of_triangle: self.parent, count: self.count },
            units: None,
            repairs,
        })
    }
}
