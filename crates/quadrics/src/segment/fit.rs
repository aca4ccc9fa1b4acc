//! Surface fitting (paper, section 4.3(2)): a plane where the planarity is small, else a quadric.

use rayon::prelude::*;

use super::Task;
use super::energy::Proxy;
use crate::math::{Point, Unit, Vector};
use crate::surface::moments::Moments;
use crate::surface::planarity::Spread;
use crate::surface::{Plane, taubin};

/// All that a fit needs to know of a region; two of them add up.
#[derive(Debug, Clone, PartialEq)]
pub struct Patch {
    moments: Moments,
    spread: Spread,
}

/// A region: its faces (ascending), its proxy, and how well it fits.
#[derive(Debug, Clone, PartialEq)]
pub struct Fitted {
    /// The faces, ascending.
    pub faces: Vec<u32>,
    /// Sums over the faces.
    pub patch: Patch,
    /// What approximates them.
    pub proxy: Proxy,
    /// `E(R, P)`: the errors of the faces, summed.
    pub error: f64,
}

impl Fitted {
    /// Area of the region.
    pub fn area(&self) -> f64 {
        self.patch.moments.area()
    }

    /// `E / A`, by which 4.3(4) finds the worst region; 0 without area.
    pub fn mean_error(&self) -> f64 {
        if self.area() > 0.0 { self.error / self.area() } else { 0.0 }
    }
}

impl Patch {
    /// Sums over some faces, in their order.
    pub fn new(task: &Task, faces: &[u32]) -> Self {
        let geometry = &task.working.geometry;
        let (mut weighted, mut area) = (Vector::zeros(), 0.0);
        for face in faces.iter().map(|&face| face as usize) {
            weighted += geometry.barycentres[face].coords * geometry.areas[face];
            area += geometry.areas[face];
        }
        let middle = if area > 0.0 { weighted / area } else { Vector::zeros() };
        let mut patch = Self { moments: Moments::about(middle.into()), spread: Spread::default() };
        for face in faces.iter().map(|&face| face as usize) {
            let corners = task.working.mesh.corners(face);
            patch.moments.add_triangle(corners, geometry.normals[face], geometry.areas[face]);
            patch.spread.add_triangle(corners);
        }
        patch
    }

    /// Both together.
    pub fn joined(&self, other: &Self) -> Self {
        Self {
            moments: self.moments.joined(&other.moments),
            spread: self.spread.joined(&other.spread),
        }
    }

    /// The optimal proxy: a plane below the planarity limit of eq. 4, else a quadric.
    pub fn proxy(&self, planarity_limit: f64) -> Proxy {
        if self.spread.planarity() >= planarity_limit
            && let Some(quadric) = taubin::quadric(&self.moments)
        {
            return Proxy::Quadric(quadric);
        }
        // Faces without area lie anywhere in space: any plane through them does.
        let fallback = || Plane::through(Point::origin(), Unit::new_unchecked(Vector::z()));
        Proxy::Plane(taubin::plane(&self.moments).unwrap_or_else(fallback))
    }
}

/// Fits a proxy to some faces.
pub fn fit(task: &Task, faces: Vec<u32>) -> Fitted {
    let patch = Patch::new(task, &faces);
    let proxy = patch.proxy(task.options.planarity);
    let error = task.total_error(&proxy, &faces);
    Fitted { faces, patch, proxy, error }
}

/// Fits a proxy to every region. A region whose faces are those of `before` keeps what it had:
/// late rounds change few.
pub fn fit_all(task: &Task, faces: Vec<Vec<u32>>, before: &[Fitted]) -> Vec<Fitted> {
    faces
        .into_par_iter()
        .enumerate()
        .map(|(region, faces)| match before.get(region) {
            Some(same) if same.faces == faces => same.clone(),
            _ => fit(task, faces),
        })
        .collect()
}
