//! What a segmentation is: plain data, in the frame and units of the input.

use crate::surface::Surface;

/// Noise of a mesh, estimated from the mesh alone.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Noise {
    /// Standard deviation of the vertices across the surface, in input units.
    pub position: f64,
    /// Standard deviation of the face normals, in degrees.
    pub normal_deg: f64,
}

/// Something that was wrong with the input and was mended.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Repair {
    /// A stable name, such as `duplicate_faces`.
    pub kind: &'static str,
    /// How many were mended.
    pub count: usize,
    /// One sentence for people.
    pub detail: String,
}

/// On which side of its surface a region has the material.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// The mesh's normals agree with the surface's: a shaft, a boss.
    Outside,
    /// They oppose it: a bore, a fillet.
    Inside,
}

/// A region and the surface that was recognised in it.
#[derive(Debug, Clone, PartialEq)]
pub struct Region {
    /// Its number: position in [`Segmentation::regions`], and label of its faces.
    pub id: u32,
    /// The surface, in input units.
    pub surface: Surface,
    /// Side of the material.
    pub side: Side,
    /// Probability that type and extent are right, in [0, 1].
    pub confidence: f64,
    /// Type name of the second best surface, where it is not far behind.
    pub runner_up: Option<&'static str>,
    /// Number of input faces.
    pub faces: usize,
    /// Area, in squared input units.
    pub area: f64,
    /// Root mean square orthogonal distance of its faces' vertices; `None` for free-form.
    pub rms: Option<f64>,
    /// Largest such distance.
    pub max_deviation: Option<f64>,
    /// Mean angle between face normals and the surface's normals, in degrees.
    pub mean_normal_deviation_deg: Option<f64>,
    /// Standard deviation of every parameter, by its name; vectors have theirs in degrees.
    pub uncertainty: Vec<(&'static str, f64)>,
    /// Regions that share an edge with it, ascending.
    pub neighbours: Vec<u32>,
}

/// A geometric relation between regions.
#[derive(Debug, Clone, PartialEq)]
pub struct Relation {
    /// Its name in the result files, such as `coaxial`.
    pub kind: &'static str,
    /// The regions it is about; pairs one after the other where it is one of pairs.
    pub regions: Vec<u32>,
    /// `accepted`, `implied` or `refused`.
    pub status: &'static str,
    /// What is equal, such as a radius; in input units or degrees.
    pub value: Option<f64>,
    /// What describes a pattern or a mirror, in the frame and units of the input.
    pub parameters: Vec<(&'static str, Parameter)>,
    /// How far the free fits were from it.
    pub residual_before: f64,
    /// How far the constrained fits are from it.
    pub residual_after: f64,
    /// `deg` or `length`.
    pub residual_unit: &'static str,
    /// Why it was accepted or refused, in numbers.
    pub reason: String,
}

/// A parameter of a relation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Parameter {
    /// A number of things.
    Count(usize),
    /// A length.
    Length(f64),
    /// A place or a direction.
    Vector([f64; 3]),
}

/// A dimension of a drawing.
#[derive(Debug, Clone, PartialEq)]
pub struct Dimension {
    /// `radius`, `major_radius`, `minor_radius`, `half_angle`, `angle` or `distance`.
    pub kind: &'static str,
    /// The regions that have it, or the two that it lies between.
    pub regions: Vec<u32>,
    /// In input units or degrees.
    pub value: f64,
    /// Standard deviation, under the relations.
    pub uncertainty: f64,
    /// Whether it was rounded to the user's grid.
    pub rounded: bool,
}

/// The result of a run.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Segmentation {
    /// Region of every input face.
    pub labels: Vec<u32>,
    /// The regions; region `i` has id `i`.
    pub regions: Vec<Region>,
    /// Relations between regions.
    pub relations: Vec<Relation>,
    /// Dimensions of a drawing; none without constraints.
    pub dimensions: Vec<Dimension>,
    /// Noise of the input.
    pub noise: Noise,
    /// What was mended.
    pub repairs: Vec<Repair>,
    /// Energy (eq. 1) after every iteration.
    pub energy: Vec<f64>,
    /// Seconds per stage.
    pub timing: Vec<(&'static str, f64)>,
}
