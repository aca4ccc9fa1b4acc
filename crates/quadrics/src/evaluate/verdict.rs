//! Is a matched pair the same surface? Extent, type and distance, each on its own.

use std::borrow::Cow;

use super::parameters::parameter_errors;
use super::{Answer, Named, Pair};
use crate::math::Point;
use crate::mesh::{Geometry, Mesh};
use crate::surface::{Cone, Surface, Torus, kind::kind};

/// Least overlap (IoU) of a recognised region.
const IOU: f64 = 0.6;
/// Largest RMS distance of a recognised surface from the true one, as a fraction of the size.
pub const TOLERANCE: f64 = 0.01;
/// Faces of a region that surfaces are compared at, at most.
const SAMPLES: usize = 2000;

/// What became of one matched pair.
#[derive(Debug, Clone, PartialEq)]
pub struct Verdict {
    /// The pair, by places.
    pub pair: Pair,
    /// Types of both sides; a quadric by its class.
    pub kinds: (String, String),
    /// Whether the types are the same.
    pub type_right: bool,
    /// Whether the surfaces lie close enough to one another.
    pub surface_right: bool,
    /// RMS distance of the true surface from the found one, as a fraction of the size; `None` where
    /// there is no surface to measure.
    pub rms: Option<f64>,
    /// Errors of the parameters where the type is right, by name.
    pub errors: Vec<(&'static str, f64)>,
}

impl Verdict {
    /// Right in extent and surface, whatever its type is called.
    pub fn is_geometry(&self) -> bool {
        self.pair.iou >= IOU && self.surface_right
    }

    /// Right in extent, surface and type.
    pub fn is_hit(&self) -> bool {
        self.is_geometry() && self.type_right
    }
}

/// What is needed to judge a pair.
pub struct Judge<'a> {
    pub mesh: &'a Mesh,
    pub geometry: &'a Geometry,
    pub found: &'a Answer,
    pub truth: &'a Answer,
    pub tolerance: f64,
    pub size: f64,
}

impl Judge<'_> {
    pub fn judge(&self, pair: Pair) -> Verdict {
        let found = &self.found.regions[pair.found as usize];
        let truth = &self.truth.regions[pair.truth as usize];
        let named = self.name(found);
        let near = truth.near.as_ref().filter(|(near, _)| *near == named);
        let (true_name, true_surface) = match near {
            Some((name, surface)) => (name.clone(), Some(surface)),
            None => (self.name(truth), truth.surface.as_ref()),
        };
        let (free, truly_free) = (is_shapeless(&named), is_shapeless(&true_name));
        let type_right = named == true_name || (free && truly_free);
        let mut verdict = Verdict {
            pair,
            kinds: (named, true_name),
            type_right,
            surface_right: free && truly_free,
            rms: None,
            errors: Vec::new(),
        };
        let Some(surface) = found.surface.as_ref().filter(|_| !free) else { return verdict };
        let points = self.points(pair.truth, true_surface);
        let square = |(point, weight): &(Point, f64)| weight * distance(surface, *point).powi(2);
        let rms = points.iter().map(square).sum::<f64>().sqrt() / self.size;
        if rms.is_finite() {
            verdict.rms = Some(rms);
            verdict.surface_right = rms < self.tolerance;
            if let Some(true_surface) = true_surface.filter(|_| type_right) {
                let middle = points.iter().map(|(p, w)| p.coords * *w).sum();
                verdict.errors = parameter_errors(surface, true_surface, middle, self.size);
            }
        }
        verdict
    }

    /// The type of a region; of a quadric without a name the class of its coefficients.
    fn name(&self, region: &Named) -> String {
        match (&region.surface, region.kind.as_str()) {
            (Some(Surface::Quadric(quadric)), "quadric" | "general_quadric") => {
                kind(quadric, self.size).class.name().into()
            }
            _ => region.kind.clone(),
        }
    }

    /// Corners and barycentres of the faces of a true region on its surface, with weights by area
    /// that add up to one. On the surface, so that noise of the mesh is no part of the distance.
    fn points(&self, region: u32, surface: Option<&Surface>) -> Vec<(Point, f64)> {
        let owned = |face: &usize| self.truth.labels[*face] == region;
        let faces: Vec<usize> = (0..self.mesh.faces.len()).filter(owned).collect();
        let faces = faces.iter().step_by(faces.len().div_ceil(SAMPLES).max(1));
        let mut points = Vec::new();
        let mut total = 0.0;
        for &face in faces {
            let [a, b, c] = self.mesh.corners(face);
            let area = self.geometry.areas[face];
            let onto = |point| surface.map_or(point, |surface| project(surface, point));
            points.extend(
                [a, b, c, self.geometry.barycentres[face]].map(|point| (onto(point), area)),
            );
            total += 4.0 * area;
        }
        points.iter_mut().for_each(|(_, weight)| *weight /= total);
        points
    }
}

fn is_shapeless(kind: &str) -> bool {
    matches!(kind, "freeform" | "bspline")
}

/// Unsigned distance; NaN where there is no surface.
fn distance(surface: &Surface, point: Point) -> f64 {
    let point = if let Surface::Cone(cone) = surface { mirrored(cone, point) } else { point };
    outer(surface).distance(point).map_or(f64::NAN, f64::abs)
}

/// The nearest point of the surface; the point itself where there is no nearest one.
fn project(surface: &Surface, point: Point) -> Point {
    if let Surface::Cone(cone) = surface {
        let foot = surface.project(mirrored(cone, point)).unwrap_or(point);
        return if behind(cone, point) { mirror(cone, foot) } else { foot };
    }
    outer(surface).project(point).unwrap_or(point)
}

/// Truths do not tell which sheet of a torus that cuts itself they mean: tori are compared by the outer ones.
fn outer(surface: &Surface) -> Cow<'_, Surface> {
    match surface {
        Surface::Torus(s) if s.major_radius < 0.0 => {
            Cow::Owned(Surface::Torus(Torus { major_radius: -s.major_radius, ..s.clone() }))
        }
        _ => Cow::Borrowed(surface),
    }
}

// Cones are compared as double cones: an axis that points the wrong way is an error of its own.

fn behind(cone: &Cone, point: Point) -> bool {
    cone.axis.dot(&(point - cone.apex)) < 0.0
}

fn mirror(cone: &Cone, point: Point) -> Point {
    point - cone.axis.into_inner() * (2.0 * cone.axis.dot(&(point - cone.apex)))
}

fn mirrored(cone: &Cone, point: Point) -> Point {
    if behind(cone, point) { mirror(cone, point) } else { point }
}
