//! A simulated scan: triangles that cross the edges of the part, errors that are alike at
//! neighbouring points, holes.

use rand::RngExt;

use super::crumbs::{RESOLVED, regions};
use super::field::Field;
use super::noise::{gaussian, vertex_normals};
use super::part::Part;
use super::resample::resample;
use crate::context::Context;
use crate::error::{Error, Result};
use crate::math::Vector;
use crate::mesh::{Adjacency, Geometry, Mesh};
use crate::partition::components;

/// How far a vertex on an edge of the part moves towards the mean of its neighbours: the spot of
/// a scanner rounds the edges that its triangles cross, which would else be saw-toothed.
const ROUNDING: f64 = 0.5;

/// How ragged the rim of a hole is: standard deviation of its radius, relative.
const RAGGED: f64 = 0.25;

/// Correlation lengths below this fraction of the size are none, and 1 / 0 is no wave.
const SHORTEST: f64 = 1e-9;

/// A scan is made from a mesh up to forty times finer, whose half-edges 32 bits must number.
const MOST_FACES: usize = 30_000_000;

/// What a scanner does to a part. Lengths are fractions of the longest side of the part.
#[derive(Debug, Clone, PartialEq)]
pub struct Scanner {
    /// Triangles, about.
    pub faces: usize,
    /// Standard deviation of the errors that neighbouring points share.
    pub waviness: f64,
    /// Correlation length of those.
    pub wavelength: f64,
    /// Standard deviation of the error that every vertex has on its own.
    pub jitter: f64,
    /// Relative variation of the distance between vertices.
    pub density: f64,
    /// Fewest and most holes.
    pub holes: (usize, usize),
    /// Least and greatest radius of a hole.
    pub hole_radius: (f64, f64),
}

impl Default for Scanner {
    /// A good scanner: 50,000 triangles, errors of a thousandth of the size, two to four holes.
    fn default() -> Self {
        Self {
            faces: 50_000,
            waviness: 0.001,
            wavelength: 0.06,
            jitter: 0.0005,
            density: 0.15,
            holes: (2, 4),
            hole_radius: (0.02, 0.05),
        }
    }
}

impl Scanner {
    fn check(&self) -> Result<()> {
        let (low, high) = self.hole_radius;
        for (name, value) in [
            ("waviness", self.waviness),
            ("wavelength", self.wavelength),
            ("jitter", self.jitter),
            ("density", self.density),
            ("hole_radius", low),
        ] {
            if !(value >= 0.0 && value.is_finite()) {
                let text = format!("{name} is {value}: give a fraction of the size, such as 0.01");
                return Err(Error::Option(text));
            }
        }
        if self.faces > MOST_FACES {
            let text = format!("{} faces are too many: {MOST_FACES} is the most", self.faces);
            return Err(Error::Option(text));
        }
        if self.faces == 0 || self.holes.0 > self.holes.1 || !(low <= high && high.is_finite()) {
            let text = "a scanner needs a face, and its ranges the lesser number first";
            return Err(Error::Option(text.into()));
        }
        Ok(())
    }
}

/// A scan of a part: a new mesh, the true region of each of its faces and their true surfaces.
///
/// Every region is connected: what a hole cuts in two is two regions with the same surface, and
/// pieces of a dozen faces and less belong to a neighbour. Its surfaces are those of the part,
/// which the vertices miss by the errors of the scanner.
///
/// # Errors
/// [`Error::Empty`] if the part has no face, [`Error::Option`] if the scanner makes no sense or a
/// face of the part no surface, [`Error::Cancelled`] if the listener asks to stop.
pub fn scan(context: &mut Context, part: &Part, scanner: &Scanner) -> Result<Part> {
    scanner.check()?;
    if part.mesh.faces.is_empty() {
        return Err(Error::Empty);
    }
    let known = |&label: &u32| (label as usize) < part.surfaces.len();
    if part.labels.len() != part.mesh.faces.len() || !part.labels.iter().all(known) {
        return Err(Error::Option("a part needs a label for every face and its surface".into()));
    }
    let size = part.mesh.size();
    let mut scan = resample(context, part, scanner.faces, scanner.density)?;
    round_edges(&mut scan);
    displace(context, &mut scan.mesh, scanner, size);
    context.step("scan", 0.9)?;
    let lost = missing(context, &scan.mesh, scanner, size);
    let keep: Vec<bool> = lost.iter().map(|lost| !lost).collect();
    select(&mut scan, &keep);
    regions(&mut scan);
    Ok(scan)
}

/// Keeps some faces, and the vertices that they use.
pub(super) fn select(part: &mut Part, keep: &[bool]) {
    let mut kept = keep.iter();
    part.labels.retain(|_| kept.next() == Some(&true));
    let mut kept = keep.iter();
    part.mesh.faces.retain(|_| kept.next() == Some(&true));
    let mut used = vec![false; part.mesh.positions.len()];
    part.mesh.faces.iter().flatten().for_each(|&v| used[v as usize] = true);
    let mut number = vec![u32::MAX; used.len()];
    let mut count = 0;
    for (v, _) in used.iter().enumerate().filter(|(_, used)| **used) {
        number[v] = count;
        part.mesh.positions[count as usize] = part.mesh.positions[v];
        count += 1;
    }
    part.mesh.positions.truncate(count as usize);
    part.mesh.faces.iter_mut().flatten().for_each(|v| *v = number[*v as usize]);
}

/// Moves the vertices between regions towards their neighbours.
fn round_edges(scan: &mut Part) {
    let count = scan.mesh.positions.len();
    let adjacency = Adjacency::new(&scan.mesh.faces, count);
    let before = scan.mesh.positions.clone();
    for v in 0..count as u32 {
        let around = adjacency.around(v);
        let label = |face: &u32| scan.labels[*face as usize];
        if around.iter().all(|face| label(face) == label(&around[0])) {
            continue;
        }
        let mut sum = Vector::zeros();
        let corners = around.iter().flat_map(|&face| scan.mesh.faces[face as usize]);
        // Every neighbour twice, but for those of a border: no matter to a mean.
        let mut weight = 0.0;
        for other in corners.filter(|&other| other != v) {
            sum += before[other as usize] - before[v as usize];
            weight += 1.0;
        }
        scan.mesh.positions[v as usize] += sum * (ROUNDING / weight);
    }
}

fn displace(context: &mut Context, mesh: &mut Mesh, scanner: &Scanner, size: f64) {
    let field = Field::new(context, scanner.wavelength.max(SHORTEST) * size);
    let normals = vertex_normals(mesh);
    for (position, normal) in mesh.positions.iter_mut().zip(normals) {
        let error = scanner.waviness * field.at(*position) + scanner.jitter * gaussian(context);
        *position += normal * (size * error);
    }
}

/// The faces that the scanner did not see: ragged patches, and fragments that these cut off.
fn missing(context: &mut Context, mesh: &Mesh, scanner: &Scanner, size: f64) -> Vec<bool> {
    let adjacency = Adjacency::new(&mesh.faces, mesh.positions.len());
    let geometry = Geometry::new(mesh);
    let mut lost = vec![false; mesh.faces.len()];
    let count = context.rng.random_range(scanner.holes.0..=scanner.holes.1);
    for _ in 0..count {
        let seed = by_area(context, &geometry.areas);
        let (low, high) = scanner.hole_radius;
        let radius = size * context.rng.random_range(low..=high);
        let ragged = Field::new(context, (radius / 2.0).max(SHORTEST * size));
        let center = geometry.barycentres[seed];
        let inside = |face: usize| {
            let place = geometry.barycentres[face];
            (place - center).norm() < radius * (1.0 + RAGGED * ragged.at(place))
        };
        let mut stack = vec![seed];
        while let Some(face) = stack.pop() {
            if !std::mem::replace(&mut lost[face], true) {
                stack.extend(adjacency.across(face).filter(|&next| !lost[next] && inside(next)));
            }
        }
    }
    let marks: Vec<u32> = lost.iter().map(|&lost| u32::from(lost)).collect();
    let (component, sizes) = components(&marks, &adjacency);
    let fragment = |face: usize| (sizes[component[face] as usize] as usize) < RESOLVED;
    (0..lost.len()).map(|face| lost[face] || fragment(face)).collect()
}

/// A random face, large ones more often.
fn by_area(context: &mut Context, areas: &[f64]) -> usize {
    let mut left = context.rng.random_range(0.0..1.0) * areas.iter().sum::<f64>();
    let found = areas.iter().position(|area| {
        left -= area;
        left < 0.0
    });
    // Rounding may leave a little beyond the last face.
    found.unwrap_or(areas.len() - 1)
}

#[cfg(test)]
mod tests;
