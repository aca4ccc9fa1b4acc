//! Planes and cylinders that stand in a known direction or about a known axis: fits of less freedom.

use nalgebra::{Matrix2, Matrix3, Vector2, Vector3};

use super::{Cylinder, Plane, Surface, start};
use crate::math::{Point, Unit, frame};

/// Iterations of a circle's fit, and the step, in sizes, after which it has converged.
const ITERATIONS: usize = 15;
const SETTLED: f64 = 1e-9;

/// The surface of its kind that is nearest to some points.
pub struct Related {
    /// The surface.
    pub surface: Surface,
    /// How many of its degrees of freedom are known.
    pub held: f64,
}

/// The planes across and along a direction and the cylinder along it.
pub fn along(points: &[Point], direction: &Unit) -> Vec<Related> {
    let (u, v) = frame(direction);
    let flat: Vec<_> =
        points.iter().map(|p| Vector2::new(u.dot(&p.coords), v.dot(&p.coords))).collect();
    let beside = |at: Vector2<f64>| u.into_inner() * at.x + v.into_inner() * at.y;
    let wall = line(&flat).map(|(normal, offset)| {
        let normal = Unit::new_normalize(beside(normal));
        Related { surface: Surface::Plane(Plane { normal, offset }), held: 1.0 }
    });
    let bore = circle(&flat).map(|(center, radius)| {
        let point = Point::from(beside(center));
        let surface = Surface::Cylinder(Cylinder { point, axis: *direction, radius });
        Related { surface, held: 2.0 }
    });
    [across(points, direction)].into_iter().chain(wall).chain(bore).collect()
}

/// The plane across an axis and the cylinder about it.
pub fn about(points: &[Point], point: Point, axis: &Unit) -> [Related; 2] {
    let far = |p: &Point| (p - point).cross(axis).norm();
    let radius = mean(points.iter().map(far));
    let surface = Surface::Cylinder(Cylinder { point, axis: *axis, radius });
    [across(points, axis), Related { surface, held: 4.0 }]
}

fn across(points: &[Point], direction: &Unit) -> Related {
    let offset = mean(points.iter().map(|p| direction.dot(&p.coords)));
    Related { surface: Surface::Plane(Plane { normal: *direction, offset }), held: 2.0 }
}

fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len() as f64;
    values.sum::<f64>() / count
}

/// Normal and offset of the line of least squared distance.
fn line(points: &[Vector2<f64>]) -> Option<(Vector2<f64>, f64)> {
    let middle = points.iter().sum::<Vector2<f64>>() / points.len() as f64;
    let scatter: Matrix2<f64> =
        points.iter().map(|p| (p - middle) * (p - middle).transpose()).sum();
    let eigen = scatter.symmetric_eigen();
    let normal = eigen.eigenvectors.column(eigen.eigenvalues.imin()).into_owned();
    normal.iter().all(|n| n.is_finite()).then(|| (normal, normal.dot(&middle)))
}

/// Centre and radius of the circle of least squared distance, by Gauss-Newton.
fn circle(points: &[Vector2<f64>]) -> Option<(Vector2<f64>, f64)> {
    let (mut center, mut radius) = start::circle(points.iter().copied())?;
    for _ in 0..ITERATIONS {
        let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
        for way in points.iter().map(|p| p - center) {
            let far = way.norm().max(f64::MIN_POSITIVE);
            let slope = Vector3::new(way.x / far, way.y / far, 1.0);
            normal += slope * slope.transpose();
            right += slope * (far - radius);
        }
        let step = normal.try_inverse()? * right;
        center += step.xy();
        radius += step.z;
        if step.norm() < SETTLED {
            break;
        }
    }
    (radius.is_finite() && radius > 0.0).then_some((center, radius))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Vector;

    fn axis() -> Unit {
        Unit::new_normalize(Vector::new(0.3, -0.2, 1.0))
    }

    /// Points of a quarter of a cylinder, or of its tangent plane.
    fn points(radius: Option<f64>) -> Vec<Point> {
        let (u, v) = frame(&axis());
        let at = |i: i32, j: i32| {
            let (turn, up) = (f64::from(i) * 0.05, f64::from(j) * 0.02);
            let flat = match radius {
                Some(r) => u.into_inner() * (r * turn.cos()) + v.into_inner() * (r * turn.sin()),
                None => u.into_inner() * 0.2 + v.into_inner() * (0.2 * turn),
            };
            Point::new(0.5, 0.5, 0.5) + flat + axis().into_inner() * up
        };
        (0..30).flat_map(|i| (0..10).map(move |j| at(i, j))).collect()
    }

    fn worst(found: &Related, points: &[Point]) -> f64 {
        points.iter().map(|p| found.surface.distance(*p).unwrap().abs()).fold(0.0, f64::max)
    }

    #[test]
    fn what_lies_along_a_direction_is_found_exactly() {
        let round = points(Some(0.2));
        let [_, _, bore] = &along(&round, &axis())[..] else { panic!() };
        assert!(worst(bore, &round) < 1e-9);
        let flat = points(None);
        let [top, wall, ..] = &along(&flat, &axis())[..] else { panic!() };
        assert!(worst(wall, &flat) < 1e-12);
        assert!(worst(top, &flat) > 0.05);
    }

    #[test]
    fn a_bore_about_its_axis_needs_a_radius_only() {
        let round = points(Some(0.2));
        let [_, bore] = about(&round, Point::new(0.5, 0.5, 0.5), &axis());
        assert!(worst(&bore, &round) < 1e-12);
    }
}
