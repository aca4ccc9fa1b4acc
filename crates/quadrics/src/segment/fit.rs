//! Surface fitting (paper, section 4.3(2)): a plane where the planarity is small, else a quadric.

use std::sync::OnceLock;

use rayon::prelude::*;

use super::energy::Proxy;
use super::{Metric, Task};
use crate::math::triangle::Triangle;
use crate::math::{Point, Unit, Vector};
use crate::surface::moments::Moments;
use crate::surface::planarity::Spread;
use crate::surface::{Plane, taubin};

/// Quadrics of the algebraic fit that compete.
const CANDIDATES: usize = 3;
/// Faces that they are compared on.
const SAMPLE: usize = 200;

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
    /// `E(t, P)` of every face.
    pub errors: Vec<f64>,
    /// `E(R, P)`: their sum.
    pub error: f64,
    /// Its seed, once somebody has asked: the same as long as the region is the same.
    pub seed: OnceLock<Vec<u32>>,
}

impl Fitted {
    /// A region that is approximated by `proxy`.
    pub fn new(task: &Task, faces: Vec<u32>, patch: Patch, proxy: Proxy) -> Self {
        let errors = task.errors(&proxy, &task.working.triangles(&faces));
        let error = errors.iter().sum();
        Self { faces, patch, proxy, errors, error, seed: OnceLock::new() }
    }

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
        let triangles = task.working.triangles(faces);
        patch.moments.add(&triangles);
        triangles.iter().for_each(|triangle| patch.spread.add_triangle(triangle.corners));
        patch
    }

    /// Both together.
    pub fn joined(&self, other: &Self) -> Self {
        Self {
            moments: self.moments.joined(&other.moments),
            spread: self.spread.joined(&other.spread),
        }
    }

    /// The optimal proxy of these faces: a plane below the planarity limit of eq. 4, else the
    /// quadric of least error among those of the algebraic fit (a plane is one of them).
    pub fn proxy(&self, task: &Task, sample: impl FnOnce() -> Vec<Triangle>) -> Proxy {
        // Faces without area lie anywhere in space: any plane through them does.
        let any = || Plane::through(Point::origin(), Unit::new_unchecked(Vector::z()));
        if task.metric == Metric::Normals {
            // The mean normal is optimal for L2,1 (Cohen-Steiner et al. 2004, section 3.2).
            let normal = Unit::try_new(self.moments.oriented_area(), f64::MIN_POSITIVE);
            let plane = normal.map(|n| Plane::through(self.moments.centroid(), n));
            return Proxy::Plane(plane.unwrap_or_else(any));
        }
        let plane = taubin::plane(&self.moments).unwrap_or_else(any);
        if self.spread.planarity() < task.options.planarity {
            return Proxy::Plane(plane);
        }
        let flat = Proxy::Quadric(plane.quadric());
        let curved = taubin::quadrics(&self.moments).into_iter().take(CANDIDATES);
        let sample = sample();
        let error = |proxy: &Proxy| task.errors(proxy, &sample).iter().sum::<f64>();
        std::iter::once(flat)
            .chain(curved.map(Proxy::Quadric))
            .map(|proxy| (error(&proxy), proxy))
            .min_by(|one, other| one.0.total_cmp(&other.0))
            .expect("there is the plane")
            .1
    }
}

/// About `count` of some faces, evenly.
pub fn sample(task: &Task, faces: &[u32], count: usize) -> Vec<Triangle> {
    task.working.triangles(faces.iter().step_by(step(faces.len(), count)))
}

/// From one face of a sample of about `count` to the next.
pub fn step(faces: usize, count: usize) -> usize {
    (faces / count).max(1)
}

/// Fits a proxy to some faces.
pub fn fit(task: &Task, faces: Vec<u32>) -> Fitted {
    let patch = Patch::new(task, &faces);
    let proxy = patch.proxy(task, || sample(task, &faces, SAMPLE));
    Fitted::new(task, faces, patch, proxy)
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
