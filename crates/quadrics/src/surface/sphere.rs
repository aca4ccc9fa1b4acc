//! Spheres.

use nalgebra::Matrix3;

use super::{Quadric, Shape};
use crate::math::{Point, Similarity, Unit};

/// The points at one distance from a centre.
#[derive(Debug, Clone, PartialEq)]
pub struct Sphere {
    /// The centre.
    pub center: Point,
    /// The radius, positive.
    pub radius: f64,
}

impl Sphere {
    /// As ten coefficients.
    pub fn quadric(&self) -> Quadric {
        let level = -self.radius * self.radius;
        Quadric::about(self.center, level, Matrix3::identity())
    }

    /// The same sphere in another frame.
    pub fn transformed(&self, by: &Similarity) -> Self {
        Self { center: by * self.center, radius: by.scaling() * self.radius }
    }
}

impl Shape for Sphere {
    const PARAMETERS: usize = 4;

    fn distance(&self, point: Point) -> f64 {
        (point - self.center).norm() - self.radius
    }

    fn normal(&self, point: Point) -> Option<Unit> {
        Unit::try_new(point - self.center, f64::MIN_POSITIVE)
    }
}
