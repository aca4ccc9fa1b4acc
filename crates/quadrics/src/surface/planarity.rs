//! Planarity: is a region flat enough to be a plane? (paper, eq. 4)
//!
//! `λ₁ / (λ₁ + λ₂ + λ₃)`, with `λ₁ ≤ λ₂ ≤ λ₃` the variances of the points along their principal
//! axes: 0 for a plane, 1/3 for a ball. A ratio, so the same in millimetres and in the unit cube.

use nalgebra::Matrix3;

use crate::math::{Point, Vector};

/// Count, mean and scatter of points; adds up without losing digits, however far from the origin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spread {
    count: f64,
    mean: Point,
    scatter: Matrix3<f64>,
}

impl Default for Spread {
    fn default() -> Self {
        Self { count: 0.0, mean: Point::origin(), scatter: Matrix3::zeros() }
    }
}

impl Spread {
    /// Adds one point.
    pub fn add(&mut self, point: Point) {
        *self = self.joined(&Self { count: 1.0, mean: point, scatter: Matrix3::zeros() });
    }

    /// Adds the corners and the barycentre of a triangle: the points of eq. 4.
    pub fn add_triangle(&mut self, corners: [Point; 3]) {
        let centre = Point::from(corners.iter().map(|p| p.coords).sum::<Vector>() / 3.0);
        // About their barycentre the four points are three offsets.
        let scatter = corners.iter().map(|p| (p - centre) * (p - centre).transpose()).sum();
        *self = self.joined(&Self { count: 4.0, mean: centre, scatter });
    }

    /// The two sets of points together.
    ///
    /// By Chan's formula: `E[x²] - E[x]²` would cancel on a part far from the origin.
    pub fn joined(&self, other: &Self) -> Self {
        let count = self.count + other.count;
        if count == 0.0 {
            return *self;
        }
        let apart = other.mean - self.mean;
        let share = other.count / count;
        Self {
            count,
            mean: self.mean + apart * share,
            scatter: self.scatter
                + other.scatter
                + apart * apart.transpose() * (self.count * share),
        }
    }

    /// Planarity of the points, between 0 and 1/3; 0 where they all coincide.
    pub fn planarity(&self) -> f64 {
        let variances = self.scatter.symmetric_eigenvalues();
        let total = variances.sum();
        // Rounding can push the least variance of a perfect plane below zero.
        if total > 0.0 { variances.min().max(0.0) / total } else { 0.0 }
    }
}

/// Planarity of `points`.
pub fn planarity(points: &[Point]) -> f64 {
    let mut spread = Spread::default();
    points.iter().for_each(|&point| spread.add(point));
    spread.planarity()
}

#[cfg(test)]
mod tests {
    use rand::RngExt;

    use super::*;
    use crate::context::Context;

    #[test]
    fn a_tilted_plane_a_metre_away_is_flat() {
        let grid = (0..100).map(|i| (f64::from(i % 10), f64::from(i / 10)));
        let points: Vec<_> = grid.map(|(x, y)| Point::new(1e3 + x, y, 0.3 * x - 0.7 * y)).collect();
        assert!(planarity(&points) < 1e-12);
        assert_eq!(planarity(&[]), 0.0);
        assert_eq!(planarity(&[points[0]]), 0.0);
    }

    #[test]
    fn the_corners_of_a_box_have_the_planarity_of_its_sides() {
        let corner = |i: u32| {
            let side = |bit: u32, length: f64| if i >> bit & 1 == 1 { length } else { 0.0 };
            Point::new(side(0, 1.0), side(1, 2.0), side(2, 3.0))
        };
        let points: Vec<_> = (0..8).map(corner).collect();
        assert!((planarity(&points) - 1.0 / 14.0).abs() < 1e-15);
    }

    #[test]
    fn a_triangle_is_its_corners_and_barycentre_and_halves_add_up() {
        let mut rng = Context::new(1).rng;
        let mut draw = || Point::from(Vector::from_fn(|_, _| rng.random_range(-1.0..1.0)));
        let (mut whole, mut halves) = (Spread::default(), [Spread::default(); 2]);
        let mut points = Vec::new();
        for i in 0..20 {
            let corners = [draw(), draw(), draw()];
            whole.add_triangle(corners);
            halves[i % 2].add_triangle(corners);
            points.extend(corners);
            points.push(nalgebra::Point::from(
                (corners[0].coords + corners[1].coords + corners[2].coords) / 3.0,
            ));
        }
        assert!((whole.planarity() - planarity(&points)).abs() < 1e-14);
        assert!((halves[0].joined(&halves[1]).planarity() - planarity(&points)).abs() < 1e-14);
    }
}
