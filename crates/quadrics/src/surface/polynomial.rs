//! Heights over a plane as polynomials of rising degree: what a smooth patch costs that no surface is.

use nalgebra::{DMatrix, DVector};

use super::select::CAP;
use crate::math::{Point, Unit, Vector, frame};

/// Normals whose cosine with the mean one is less lean too far for heights, and the largest share of them.
const LEAN: f64 = 0.4;
const LEANING: f64 = 0.02;
/// Least cosine by which a height becomes a distance.
const STEEPEST: f64 = 0.3;
/// Added to the diagonal, where points alone may not determine the coefficients.
const RIDGE: f64 = 1e-9;
/// Fits, of which each hears less of the points that the one before leaves far off, and how much.
const FITS: usize = 2;
const OUTLIER: f64 = 0.1;

/// Points over a plane, scaled to the square from -1 to 1.
pub struct Heights {
    points: Vec<[f64; 2]>,
    heights: Vec<f64>,
    /// Cosine between the plane's normal and that of the surface.
    cosines: Vec<f64>,
    weights: Vec<f64>,
}

impl Heights {
    /// Over the plane across the mean of the normals, one a point; `None` where some lean too far for
    /// the surface to be a height field. `weights` are the vertices that each point stands for.
    pub fn over(points: &[Point], normals: &[Vector], weights: Vec<f64>) -> Option<Self> {
        let up = Unit::try_new(normals.iter().sum(), f64::EPSILON)?;
        let cosines: Vec<f64> = normals.iter().map(|normal| normal.dot(&up)).collect();
        let leaning = cosines.iter().filter(|&&cosine| cosine < LEAN).count();
        if leaning as f64 > LEANING * cosines.len() as f64 {
            return None;
        }
        let (u, v) = frame(&up);
        let centre = super::centroid(points)?;
        let along = |axis: &Unit| -> Vec<f64> {
            points.iter().map(|point| axis.dot(&(point - centre))).collect()
        };
        let scaled = |axis: &Unit| {
            let mut all = along(axis);
            let half = all.iter().fold(f64::MIN_POSITIVE, |most, x| most.max(x.abs()));
            all.iter_mut().for_each(|x| *x /= half);
            all
        };
        let points = scaled(&u).into_iter().zip(scaled(&v)).map(|(x, y)| [x, y]).collect();
        let cosines = cosines.into_iter().map(|cosine| cosine.max(STEEPEST)).collect();
        Some(Self { points, heights: along(&up), cosines, weights })
    }

    /// Weighted sum of the squared distances in squared sigmas, each up to [`CAP`], that a polynomial of
    /// some total degree leaves; `None` where there are too few points.
    pub fn misfit(&self, degree: usize, sigma: f64) -> Option<f64> {
        let count = coefficients(degree);
        if self.points.len() < 2 * count {
            return None;
        }
        let rows: Vec<_> = self.points.iter().map(|&[x, y]| row(x, y, degree)).collect();
        let mut heard = vec![1.0; rows.len()];
        let mut misfit = 0.0;
        for _ in 0..FITS {
            let mut normal = DMatrix::identity(count, count) * RIDGE;
            let mut right = DVector::zeros(count);
            for (i, row) in rows.iter().enumerate() {
                let weight = heard[i] * self.weights[i] * self.cosines[i].powi(2);
                normal.ger(weight, row, row, 1.0);
                right.axpy(weight * self.heights[i], row, 1.0);
            }
            let solution = normal.cholesky()?.solve(&right);
            misfit = 0.0;
            for (i, row) in rows.iter().enumerate() {
                let distance = (self.heights[i] - row.dot(&solution)) * self.cosines[i];
                let square = (distance / sigma).powi(2);
                misfit += self.weights[i] * square.min(CAP);
                heard[i] = if square < CAP { 1.0 } else { OUTLIER };
            }
        }
        Some(misfit)
    }
}

/// Coefficients of a polynomial of some total degree in two unknowns.
pub fn coefficients(degree: usize) -> usize {
    (degree + 1) * (degree + 2) / 2
}

/// Products of Chebyshev polynomials up to a total degree.
fn row(x: f64, y: f64, degree: usize) -> DVector<f64> {
    let (in_x, in_y) = (chebyshev(x, degree), chebyshev(y, degree));
    let of = |(i, x): (usize, &f64)| in_y[..=degree - i].iter().map(|y| x * y).collect::<Vec<_>>();
    DVector::from_vec(in_x.iter().enumerate().flat_map(of).collect())
}

fn chebyshev(x: f64, degree: usize) -> Vec<f64> {
    let mut all = vec![1.0, x];
    for i in 2..=degree {
        all.push(2.0 * x * all[i - 1] - all[i - 2]);
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A wave of third degree over a tilted plane, seen by 20 by 20 points.
    fn wave() -> (Vec<Point>, Vec<Vector>) {
        let at = |i: i32| (f64::from(i % 20) / 10.0 - 0.95, f64::from(i / 20) / 10.0 - 0.95);
        let height = |x: f64, y: f64| 0.3 * x + 0.1 * x * x * y - 0.05 * y.powi(3);
        let slope = |x: f64, y: f64| (0.3 + 0.2 * x * y, 0.1 * x * x - 0.15 * y * y);
        let point = |i: i32| {
            let (x, y) = at(i);
            Point::new(x, y, height(x, y))
        };
        let normal = |i: i32| {
            let (x, y) = at(i);
            let (dx, dy) = slope(x, y);
            Vector::new(-dx, -dy, 1.0).normalize()
        };
        ((0..400).map(point).collect(), (0..400).map(normal).collect())
    }

    #[test]
    fn a_smooth_patch_needs_some_degree_and_no_more() {
        let (points, normals) = wave();
        let heights = Heights::over(&points, &normals, vec![1.0; 400]).unwrap();
        let left = |degree| heights.misfit(degree, 1e-3).unwrap();
        assert!(left(2) > 400.0 && left(5) < 10.0, "{} {}", left(2), left(5));
        assert!(heights.misfit(20, 1e-3).is_none(), "more coefficients than points");
    }

    #[test]
    fn a_few_points_far_off_do_not_bend_it() {
        let (mut points, normals) = wave();
        (0..400).step_by(41).for_each(|i| points[i].z += 0.02);
        let heights = Heights::over(&points, &normals, vec![1.0; 400]).unwrap();
        let left = heights.misfit(5, 1e-3).unwrap();
        assert!(left < 10.0 * CAP + 40.0, "{left}");
    }

    #[test]
    fn a_sphere_is_no_height_field() {
        let direction = |i: i32| {
            let (a, b) = (f64::from(i) * 0.7, f64::from(i) * 0.31);
            Vector::new(a.cos() * b.sin(), a.sin() * b.sin(), b.cos() + 0.1).normalize()
        };
        let normals: Vec<Vector> = (0..100).map(direction).collect();
        let points: Vec<Point> = normals.iter().map(|&n| Point::from(n)).collect();
        assert!(Heights::over(&points, &normals, vec![1.0; 100]).is_none());
    }
}
