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

/// How much further than the reach a joint may be, since the noise of few vertices reaches further.
const SLACK: f64 = 1.25;
/// Standard deviations that a way may lead aside of the direction of the noise: surfaces and labels err.
const ASIDE: f64 = 0.7;
/// Standard deviations that a vertex may stick out more than before: its neighbours have noise too.
const MORE: f64 = 0.7;
/// Standard deviations that a vertex on its surface may stick out: three of the mean of six neighbours.
const OUT: f64 = 1.2;

/// A vertex, and what the noise explains there.
#[derive(Clone, Copy)]
pub struct Noisy {
    pub position: Point,
    /// The direction that noise acts in.
    pub outward: Vector,
    /// How far above the middle of its neighbours it lies.
    pub height: f64,
    /// Standard deviation of the noise.
    pub sigma: f64,
    /// How far it may move.
    pub reach: f64,
}

impl Noisy {
    /// Where all surfaces meet, or as near as the reach allows, if the noise explains the way there.
    ///
    /// A vertex of a chamfer that nobody saw is off one surface for the noise, off the other for
    /// the chamfer: their curve is aside.
    pub fn joint(&self, goals: &[Goal]) -> Option<Point> {
        let way = meet(self.position, goals, self.reach)? - self.position;
        let aside = way - self.outward * self.outward.dot(&way);
        let explained = way.norm() <= SLACK * self.reach && aside.norm() <= ASIDE * self.sigma;
        // A corner has no neighbours along it that could bear witness.
        let trusted = goals.len() < 3 || !self.sticks_out(way, MORE);
        (explained && trusted).then(|| self.position + way.cap_magnitude(self.reach))
    }

    /// As near as the reach allows to the one surface that brings it nearest to its neighbours; it
    /// stays where all of them carry it away from them.
    pub fn alone(&self, goals: &[Goal]) -> Point {
        let ways = goals.iter().filter_map(|goal| self.way(goal));
        let best = ways.min_by(|one, other| self.left(*one).total_cmp(&self.left(*other)));
        let way = best.filter(|way| goals.len() == 1 || !self.sticks_out(*way, 0.0));
        self.position + way.unwrap_or_default()
    }

    /// A way, cut where it carries the vertex further off its `usual` height above its neighbours
    /// than their noise explains.
    pub fn held(&self, way: Vector, usual: f64) -> Vector {
        let start = self.height - usual;
        let allowed = start.abs().max(OUT * self.sigma);
        let cut = (start + way.dot(&self.outward)).abs() - allowed;
        if cut > 0.0 { way * (1.0 - cut / way.norm().max(cut)) } else { way }
    }

    /// Whether a way carries the vertex away from its neighbours, by so many standard deviations.
    fn sticks_out(&self, way: Vector, deviations: f64) -> bool {
        self.left(way) > self.height.abs() + deviations * self.sigma
    }

    /// How far off the middle of its neighbours a way leaves it.
    fn left(&self, way: Vector) -> f64 {
        (self.height + way.dot(&self.outward)).abs()
    }

    /// `None` on an axis or in a centre, where no way is shorter than the others.
    fn way(&self, goal: &Goal) -> Option<Vector> {
        let off = goal.surface.distance(self.position)? - goal.offset;
        let normal = goal.surface.normal(self.position)?.into_inner();
        Some(-normal * off.clamp(-self.reach, self.reach))
    }
}

/// The place of the goal that a point is furthest off.
pub fn furthest(point: Point, goals: &[Goal]) -> usize {
    let off = |goal: &Goal| {
        goal.surface.distance(point).map_or(f64::INFINITY, |d| (d - goal.offset).abs())
    };
    let by_distance = |&i: &usize, &j: &usize| off(&goals[i]).total_cmp(&off(&goals[j]));
    (0..goals.len()).max_by(by_distance).unwrap_or(0)
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

    /// A vertex that sticks out of its neighbours by as much as noise moved it.
    fn noisy(position: Point, outward: Vector, height: f64, reach: f64) -> Noisy {
        Noisy { position, outward: outward.normalize(), height, sigma: reach / 2.0, reach }
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
        let way = Vector::new(0.05, 0.04, 0.05);
        let vertex = noisy(Point::new(1.0, 0.0, 2.0) + way, way, way.norm(), 1.0);
        let surfaces = [round, top, side];
        let corner = vertex.joint(&goals(&surfaces)).unwrap();
        assert!((corner - Point::new(1.0, 0.0, 2.0)).norm() < 1e-9, "{corner}");
        let on_curve = vertex.joint(&goals(&surfaces[..2])).unwrap();
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
        let vertex = noisy(Point::new(0.0, 0.0, 0.02), Vector::z(), 0.02, 0.1);
        let point = vertex.joint(&goals(&[fillet, flat])).unwrap();
        assert!((point - Point::new(0.0, 0.0, -0.005)).norm() < 1e-9, "{point}");
    }

    #[test]
    fn a_curve_out_of_reach_or_aside_is_not_explained() {
        let far = Surface::Sphere(Sphere { center: Point::new(0.0, 0.0, 9.0), radius: 1.0 });
        let flat = plane([0.0, 0.0, 1.0], 0.0);
        let upright = plane([1.0, 0.0, 0.0], 0.06);
        let vertex = noisy(Point::new(0.0, 0.0, 0.02), Vector::z(), 0.02, 0.1);
        assert_eq!(vertex.joint(&goals(&[far, flat.clone()])), None);
        assert_eq!(vertex.joint(&goals(&[flat, upright])), None);
    }

    #[test]
    fn alone_a_vertex_goes_to_the_surface_that_its_neighbours_are_at() {
        let surfaces = [plane([0.0, 0.0, 1.0], 0.0), plane([0.0, 0.0, 1.0], 0.21)];
        let at = |z, height| noisy(Point::new(0.0, 0.0, z), Vector::z(), height, 0.1);
        assert_eq!(at(0.11, 0.11).alone(&goals(&surfaces)), Point::new(0.0, 0.0, 0.11 - 0.1));
        let short = at(0.3, 0.3).alone(&goals(&surfaces[..1]));
        assert!((short - Point::new(0.0, 0.0, 0.2)).norm() < 1e-12);
        // Both surfaces are above, and it sticks out already: it stays.
        assert_eq!(
            at(0.15, 0.1).alone(&goals(&[surfaces[1].clone(), surfaces[1].clone()])).z,
            0.15
        );
        assert_eq!(at(0.15, 0.1).alone(&[]).z, 0.15);
    }

    #[test]
    fn a_way_is_cut_where_it_leads_out_of_the_usual_height() {
        let vertex = noisy(Point::origin(), Vector::z(), 0.3, 2.0);
        let allowed = OUT * vertex.sigma;
        assert!(
            (vertex.held(Vector::z() * 1.5, 0.0) - Vector::z() * (allowed - 0.3)).norm() < 1e-12
        );
        assert_eq!(vertex.held(Vector::z() * -0.6, 0.0), Vector::z() * -0.6);
        // Along a crease that sticks out by as much it may go there.
        assert_eq!(vertex.held(Vector::z() * 1.4, 1.7), Vector::z() * 1.4);
        // What sticks out already may come back, however far that is.
        let far = noisy(Point::origin(), Vector::z(), 9.0, 2.0);
        assert_eq!(far.held(Vector::z() * -2.0, 0.0), Vector::z() * -2.0);
        assert_eq!(far.held(Vector::z(), 0.0).norm(), 0.0);
    }
}
