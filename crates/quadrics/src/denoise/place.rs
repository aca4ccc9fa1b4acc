//! The point nearest to a vertex that lies on all surfaces of its regions.

use nalgebra::{DMatrix, DVector};

use crate::math::{Point, Vector};
use crate::surface::Surface;

/// A surface, and how far off it the vertex belongs.
#[derive(Clone, Copy)]
pub struct Goal<'a> {
    pub surface: &'a Surface,
    /// Signed distance that the vertex should have.
    pub offset: f64,
}

/// Gauss-Newton steps; two or three do, a grazing pair takes more.
const STEPS: usize = 20;
/// Two normals whose sine is below about this are one for the noise: their curve cannot be told, and a
/// step towards it would slide the vertex away along both.
const GRAZING: f64 = 0.2;
/// Converged, as a fraction of the reach.
const SETTLED: f64 = 1e-6;

/// Where a vertex goes, at most `reach` away.
///
/// Where the surfaces do not meet within reach, the one furthest off is left out, until one is left;
/// of that the vertex comes as near as the reach allows.
pub fn place(vertex: Point, goals: &[Goal], reach: f64) -> Point {
    let mut goals = goals.to_vec();
    while goals.len() > 1 {
        if let Some(point) = meet(vertex, &goals, reach)
            && (point - vertex).norm() <= reach
        {
            return point;
        }
        let off = |goal: &Goal| {
            goal.surface.distance(vertex).map_or(f64::INFINITY, |d| (d - goal.offset).abs())
        };
        let far = (0..goals.len()).max_by(|&i, &j| off(&goals[i]).total_cmp(&off(&goals[j])));
        goals.remove(far.expect("there are two"));
    }
    let Some(goal) = goals.first() else { return vertex };
    match (goal.surface.distance(vertex), goal.surface.normal(vertex)) {
        (Some(distance), Some(normal)) => {
            vertex - normal.into_inner() * (distance - goal.offset).clamp(-reach, reach)
        }
        // On an axis or in a centre no way is shorter than the others.
        _ => vertex,
    }
}

/// The point of all surfaces nearest to the vertex, by Gauss-Newton with steps of least norm.
///
/// With the distances linearised at `x` the nearest point is `v + J⁺ (J (x - v) - d(x))`.
/// Singular values of grazing surfaces are left out of the inverse: such surfaces are met half-way.
fn meet(vertex: Point, goals: &[Goal], reach: f64) -> Option<Point> {
    let mut point = vertex;
    for _ in 0..STEPS {
        let mut normals = DMatrix::zeros(goals.len(), 3);
        let mut wanted = DVector::zeros(goals.len());
        for (row, goal) in goals.iter().enumerate() {
            let normal = goal.surface.normal(point)?;
            normals.row_mut(row).copy_from(&normal.transpose());
            wanted[row] =
                goal.offset - goal.surface.distance(point)? + normal.dot(&(point - vertex));
        }
        let step = normals.svd(true, true).solve(&wanted, GRAZING).ok()?;
        let next = vertex + Vector::new(step[0], step[1], step[2]);
        let moved = (next - point).norm();
        point = next;
        if (point - vertex).norm() > 2.0 * reach {
            return None;
        }
        if moved <= SETTLED * reach {
            return Some(point);
        }
    }
    Some(point)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Unit;
    use crate::surface::{Cylinder, Plane, Sphere};

    fn plane(normal: [f64; 3], offset: f64) -> Surface {
        Surface::Plane(Plane { normal: Unit::new_normalize(normal.into()), offset })
    }

    fn goals(surfaces: &[Surface]) -> Vec<Goal<'_>> {
        surfaces.iter().map(|surface| Goal { surface, offset: 0.0 }).collect()
    }

    #[test]
    fn three_surfaces_meet_in_a_point_and_two_in_the_nearest_of_a_curve() {
        let round = Surface::Cylinder(Cylinder {
            point: Point::origin(),
            axis: Vector::z_axis(),
            radius: 1.0,
        });
        let top = plane([0.0, 0.0, 1.0], 2.0);
        let side = plane([0.0, 1.0, 0.0], 0.0);
        let vertex = Point::new(1.05, 0.04, 1.97);
        let surfaces = [round, top, side];
        let corner = place(vertex, &goals(&surfaces), 1.0);
        assert!((corner - Point::new(1.0, 0.0, 2.0)).norm() < 1e-9, "{corner}");
        let on_curve = place(vertex, &goals(&surfaces[..2]), 1.0);
        let outward = Vector::new(1.05, 0.04, 0.0).normalize();
        assert!((on_curve - Point::from(outward + Vector::z() * 2.0)).norm() < 1e-6, "{on_curve}");
    }

    #[test]
    fn tangent_surfaces_are_met_half_way() {
        let fillet = Surface::Cylinder(Cylinder {
            point: Point::new(0.0, 0.0, -1.01),
            axis: Vector::y_axis(),
            radius: 1.0,
        });
        let flat = plane([0.0, 0.0, 1.0], 0.0);
        let vertex = Point::new(0.0, 0.0, 0.02);
        let point = place(vertex, &goals(&[fillet, flat]), 0.1);
        assert!((point - Point::new(0.0, 0.0, -0.005)).norm() < 1e-9, "{point}");
    }

    #[test]
    fn what_does_not_meet_within_reach_is_left_out() {
        let far = Surface::Sphere(Sphere { center: Point::new(0.0, 0.0, 9.0), radius: 1.0 });
        let flat = plane([0.0, 0.0, 1.0], 0.0);
        let surfaces = [far, flat];
        let point = place(Point::new(0.0, 0.0, 0.02), &goals(&surfaces), 0.1);
        assert!((point - Point::origin()).norm() < 1e-12);
        let short = place(Point::new(0.0, 0.0, 0.3), &goals(&surfaces[1..]), 0.1);
        assert!((short - Point::new(0.0, 0.0, 0.2)).norm() < 1e-12);
        assert_eq!(place(Point::origin(), &[], 1.0), Point::origin());
    }
}
