//! Blends: the cylinder or torus along which a ball rolls that touches two surfaces.
//!
//! Two surfaces that extend in one direction, or turn about one axis, are two curves in a plane, and the
//! ball between them is a circle that touches both. All that is left free is its radius.

use super::Surface;
use super::chamfer::Section;
use super::curve::{Curve, Flat, meets};
use super::sweep::Sweep;
use crate::math::Point;

/// Least angle, in radians, by which a blend turns: surfaces that meet so smoothly need none.
const TURN: f64 = 0.3;
/// The largest radius that is tried, in sizes; each is larger by the factor than the one before, and the
/// best is refined so often.
const LARGEST: f64 = 0.5;
const LARGER: f64 = 1.5;
const REFINED: usize = 5;

/// Two surfaces between which a ball may roll.
#[derive(Debug, Clone)]
pub struct Walls {
    sweep: Sweep,
    curves: [Curve; 2],
}

/// A ball: its centre, its radius and the ways from the centre to where it touches.
pub(super) struct Ball {
    pub center: Flat,
    pub radius: f64,
    pub touches: [Flat; 2],
}

/// The blend of two walls that some points lie nearest to.
pub struct Blend {
    /// A cylinder or a torus.
    pub surface: Surface,
    /// Of the ball that leaves it.
    pub radius: f64,
    /// -1 where it rounds an edge, +1 where it fills a corner.
    depth: f64,
    /// The middle of the points.
    middle: Flat,
}

/// What may be there instead of a blend.
pub struct Chamfer {
    /// A plane, a cone or a cylinder.
    pub surface: Surface,
    /// Logarithm of how much likelier it is than the blend.
    pub gain: f64,
}

impl Walls {
    /// Two surfaces near a point, each with +1 where its normals point out of the part, else -1. `None`
    /// where a rolling ball leaves neither a cylinder nor a torus.
    pub fn new(walls: [(&Surface, f64); 2], at: Point) -> Option<Self> {
        let sweep = Sweep::between(walls.map(|(surface, _)| surface))?;
        let [one, other] = walls.map(|(surface, side)| sweep.curve(surface, side, at));
        Some(Self { sweep, curves: [one?, other?] })
    }

    /// The blend that some points lie nearest to, of a radius that is not below `least`.
    pub fn nearest(&self, points: &[Point], least: f64) -> Option<Blend> {
        let flat: Vec<Flat> = points.iter().map(|p| self.sweep.flat(*p)).collect();
        let middle = flat.iter().sum::<Flat>() / flat.len() as f64;
        // What rounds an edge lies inside of both walls, what fills a corner outside.
        let inside = self.curves.iter().map(|curve| curve.distance(middle)).sum::<f64>() < 0.0;
        let depth = if inside { -1.0 } else { 1.0 };
        let misfit = |radius: f64| {
            let ball = self.ball(radius, depth, middle)?;
            let away = |p: &Flat| ((p - ball.center).norm() - radius).powi(2);
            Some((flat.iter().map(away).sum::<f64>(), radius))
        };
        let better = |a: &(f64, f64), b: &(f64, f64)| a.0.total_cmp(&b.0);
        let radii = std::iter::successors(Some(least), |radius| Some(radius * LARGER));
        let radii = radii.take_while(|radius| *radius < LARGEST);
        let mut best = radii.filter_map(misfit).min_by(better)?;
        let mut factor = LARGER;
        for _ in 0..REFINED {
            factor = factor.sqrt();
            let beside = [best.1 / factor, best.1 * factor].into_iter().filter_map(misfit);
            best = beside.chain([best]).min_by(better)?;
        }
        let Ball { center, radius, .. } = self.ball(best.1, depth, middle)?;
        let surface = self.sweep.surface(&Curve::Circle { center, radius, outward: 1.0 })?;
        Some(Blend { surface, radius, depth, middle })
    }

    /// The likeliest chamfer where a blend was found, by points of the band and of both walls that stray by
    /// sigma. `None` where the walls do not meet.
    pub fn chamfer(&self, blend: &Blend, points: &[Point], sigma: f64) -> Option<Chamfer> {
        let &Blend { radius, depth, middle, .. } = blend;
        let ball = |radius| self.ball(radius, depth, middle);
        let corners = meets(&self.curves[0], &self.curves[1]).into_iter().flatten();
        let apart = |corner: &Flat| (corner - middle).norm_squared();
        let corner = corners.min_by(|a, b| apart(a).total_cmp(&apart(b)))?;
        let flat = points.iter().map(|p| self.sweep.flat(*p)).collect();
        let (chord, gain) = Section::new(&ball, radius, corner, flat, sigma)?.cut()?;
        Some(Chamfer { surface: self.sweep.surface(&chord)?, gain })
    }

    /// The ball at a depth of so many radii that touches both walls and spans the way past a point.
    fn ball(&self, radius: f64, depth: f64, near: Flat) -> Option<Ball> {
        let [one, other] = self.curves.map(|curve| curve.offset(radius * depth));
        let apart = |center: &Flat| (center - near).norm_squared();
        let centers = meets(&one?, &other?).into_iter().flatten();
        let center = centers.min_by(|a, b| apart(a).total_cmp(&apart(b)))?;
        let touches = self.curves.map(|curve| curve.foot(center) - center);
        let ball = Ball { center, radius, touches };
        (ball.touches[0].angle(&ball.touches[1]) > TURN && ball.spans(near)).then_some(ball)
    }
}

impl Ball {
    /// Where it touches.
    pub fn feet(&self) -> [Flat; 2] {
        self.touches.map(|touch| self.center + touch)
    }

    /// Whether a point is seen from the centre between the places where the ball touches.
    fn spans(&self, point: Flat) -> bool {
        let [from, to] = self.touches;
        let way = point - self.center;
        let turn = from.perp(&to);
        from.perp(&way) * turn > 0.0 && way.perp(&to) * turn > 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Unit, Vector};
    use crate::surface::{Cone, Cylinder, Plane, Sphere, Torus};

    const RADIUS: f64 = 0.05;

    fn plane(normal: Vector, offset: f64) -> Surface {
        Surface::Plane(Plane { normal: Unit::new_normalize(normal), offset })
    }

    fn bore(radius: f64) -> Surface {
        Surface::Cylinder(Cylinder { point: Point::origin(), axis: Vector::z_axis(), radius })
    }

    /// Points of a surface within some turns: where it is nearest to points around them.
    fn points(blend: &Surface, around: Point) -> Vec<Point> {
        let steps = || (-3..=3).map(|i| f64::from(i) * 0.004);
        let cloud = steps().flat_map(|x| steps().map(move |y| (x, y)));
        let cloud = cloud.flat_map(|(x, y)| steps().map(move |z| around + Vector::new(x, y, z)));
        let onto = |p: Point| {
            let normal = blend.normal(p).unwrap();
            p - normal.into_inner() * blend.distance(p).unwrap()
        };
        cloud.map(onto).collect()
    }

    fn is_found(walls: [(Surface, f64); 2], blend: &Surface, around: Point) {
        let walls = Walls::new([0, 1].map(|k| (&walls[k].0, walls[k].1)), around).unwrap();
        let points = points(blend, around);
        let found = walls.nearest(&points, 0.01).unwrap().surface;
        let worst = points.iter().map(|p| found.distance(*p).unwrap().abs()).fold(0.0, f64::max);
        assert!(found.is_like(blend) && worst < 1e-4, "{found:?} {worst}");
    }

    #[test]
    fn fillets_between_planes_are_cylinders_on_edges_and_in_corners() {
        let walls = |side| [(plane(Vector::x(), 0.5), side), (plane(Vector::y(), 0.3), side)];
        let fillet = |x, y| {
            let point = Point::new(x, y, 0.0);
            Surface::Cylinder(Cylinder { point, axis: Vector::z_axis(), radius: RADIUS })
        };
        is_found(walls(1.0), &fillet(0.45, 0.25), Point::new(0.485, 0.285, 0.1));
        is_found(walls(-1.0), &fillet(0.45, 0.25), Point::new(0.485, 0.285, 0.1));
    }

    #[test]
    fn what_turns_about_one_axis_meets_in_a_torus() {
        let torus = |major_radius, height| {
            let center = Point::new(0.0, 0.0, height);
            let axis = Vector::z_axis();
            Surface::Torus(Torus { center, axis, major_radius, minor_radius: RADIUS })
        };
        let rim = [(bore(0.3), 1.0), (plane(Vector::z(), 0.4), 1.0)];
        is_found(rim, &torus(0.25, 0.35), Point::new(0.285, 0.0, 0.385));
        let foot = [(bore(0.3), 1.0), (plane(Vector::z(), 0.4), 1.0)];
        is_found(foot, &torus(0.35, 0.45), Point::new(0.315, 0.0, 0.415));
        // A cone of 45 degrees on the same axis, and a dome.
        let (axis, apex) = (Vector::z_axis(), Point::origin());
        let cone = Surface::Cone(Cone { apex, axis, half_angle: std::f64::consts::FRAC_PI_4 });
        let away = RADIUS * 2f64.sqrt();
        let edge = [(cone, 1.0), (plane(Vector::z(), 0.4), 1.0)];
        is_found(edge, &torus(0.4 - RADIUS - away, 0.35), Point::new(0.34, 0.0, 0.375));
        let dome = Surface::Sphere(Sphere { center: Point::new(0.0, 0.0, 0.2), radius: 0.3 });
        let top = [(dome, 1.0), (plane(Vector::z(), 0.3), 1.0)];
        let major = (0.25f64.powi(2) - 0.05f64.powi(2)).sqrt();
        is_found(top, &torus(major, 0.25), Point::new(0.265, 0.0, 0.285));
    }

    #[test]
    fn a_flat_along_a_round_wall_meets_it_in_a_cylinder() {
        // A key's flat cut off a shaft: the ball is inside of both.
        let walls = [(bore(0.3), 1.0), (plane(Vector::x(), 0.2), 1.0)];
        let (x, y) = (0.2 - RADIUS, (0.25f64.powi(2) - 0.15f64.powi(2)).sqrt());
        let point = Point::new(x, y, 0.0);
        let fillet = Surface::Cylinder(Cylinder { point, axis: Vector::z_axis(), radius: RADIUS });
        is_found(walls, &fillet, Point::new(0.188, y + 0.03, 0.1));
    }

    #[test]
    fn crossing_bores_have_no_such_blend() {
        let across = Cylinder { point: Point::origin(), axis: Vector::x_axis(), radius: 0.2 };
        let walls = [bore(0.3), Surface::Cylinder(across)];
        assert!(Walls::new([(&walls[0], 1.0), (&walls[1], 1.0)], Point::origin()).is_none());
    }
}
