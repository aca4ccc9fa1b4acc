//! Blends: the cylinder or torus along which a ball rolls that touches two surfaces.
//!
//! Two surfaces that extend in one direction, or turn about one axis, are two curves in a plane, and the
//! ball between them is a circle that touches both. All that is left free is its radius.

use nalgebra::Vector2;

use super::{Cylinder, Surface, Torus, axis};
use crate::math::{Point, Unit, frame};

type Flat = Vector2<f64>;

/// Directions are one below this sine, and axes nearer than this, in sizes: walls are fits themselves.
const ONE: f64 = 0.03;
const NEAR: f64 = 0.004;
/// Planes that meet at a lesser sine have no direction in common that noise would not turn.
const CROSS: f64 = 0.1;
/// Least angle, in radians, by which a blend turns: surfaces that meet so smoothly need none.
const TURN: f64 = 0.3;
/// The largest radius that is tried, in sizes; each is larger by the factor than the one before, and the
/// best is refined so often.
const LARGEST: f64 = 0.5;
const LARGER: f64 = 1.5;
const REFINED: usize = 5;

/// How curves in a plane become surfaces.
#[derive(Debug, Clone, Copy)]
enum Sweep {
    /// In a direction; with the axes of the plane across it.
    Along { direction: Unit, u: Unit, v: Unit },
    /// About an axis; the plane has the distance from it and the height along it.
    About { point: Point, axis: Unit },
}

/// A curve whose distances grow out of the part.
#[derive(Debug, Clone, Copy)]
enum Curve {
    /// `normal · p = offset`.
    Line { normal: Flat, offset: f64 },
    /// `outward` is +1 where the part is inside of the circle, else -1.
    Circle { center: Flat, radius: f64, outward: f64 },
}

/// Two surfaces between which a ball may roll.
#[derive(Debug, Clone)]
pub struct Walls {
    sweep: Sweep,
    curves: [Curve; 2],
}

/// A ball: its centre, its radius and the ways from the centre to where it touches.
struct Ball {
    center: Flat,
    radius: f64,
    touches: [Flat; 2],
}

impl Walls {
    /// Two surfaces near a point, each with +1 where its normals point out of the part, else -1. `None`
    /// where a rolling ball leaves neither a cylinder nor a torus.
    pub fn new(walls: [(&Surface, f64); 2], at: Point) -> Option<Self> {
        let sweep = Sweep::of(walls.map(|(surface, _)| surface))?;
        let [one, other] = walls.map(|(surface, side)| sweep.curve(surface, side, at));
        Some(Self { sweep, curves: [one?, other?] })
    }

    /// The blend that some points lie nearest to, of a radius that is not below `least`.
    pub fn nearest(&self, points: &[Point], least: f64) -> Option<Surface> {
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
        let ball = self.ball(best.1, depth, middle)?;
        self.sweep.surface(&ball)
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
    /// Whether a point is seen from the centre between the places where the ball touches.
    fn spans(&self, point: Flat) -> bool {
        let [from, to] = self.touches;
        let way = point - self.center;
        let turn = from.perp(&to);
        from.perp(&way) * turn > 0.0 && way.perp(&to) * turn > 0.0
    }
}

impl Sweep {
    fn of(walls: [&Surface; 2]) -> Option<Self> {
        match walls {
            [Surface::Plane(a), Surface::Plane(b)] => {
                Some(Self::along(Unit::try_new(a.normal.cross(&b.normal), CROSS)?))
            }
            [Surface::Cylinder(a), Surface::Cylinder(b)]
                if (a.point - b.point).cross(&a.axis).norm() > NEAR =>
            {
                Some(Self::along(a.axis))
            }
            [Surface::Plane(plane), Surface::Cylinder(bore)]
            | [Surface::Cylinder(bore), Surface::Plane(plane)]
                if plane.normal.dot(&bore.axis).abs() < ONE =>
            {
                Some(Self::along(bore.axis))
            }
            [Surface::Plane(plane), Surface::Sphere(dome)]
            | [Surface::Sphere(dome), Surface::Plane(plane)] => {
                Some(Self::About { point: dome.center, axis: plane.normal })
            }
            _ => {
                let (point, axis) = walls.into_iter().find_map(axis)?;
                Some(Self::About { point, axis })
            }
        }
    }

    fn along(direction: Unit) -> Self {
        let (u, v) = frame(&direction);
        Self::Along { direction, u, v }
    }

    fn flat(&self, p: Point) -> Flat {
        match self {
            Self::Along { u, v, .. } => Flat::new(u.dot(&p.coords), v.dot(&p.coords)),
            Self::About { point, axis } => {
                let way = p - point;
                Flat::new(way.cross(axis).norm(), axis.dot(&way))
            }
        }
    }

    /// The curve of a surface; at a point where it does not quite extend or turn like that.
    fn curve(&self, surface: &Surface, side: f64, at: Point) -> Option<Curve> {
        let line = |normal: Flat, offset: f64| Curve::Line {
            normal: normal * side,
            offset: offset * side,
        };
        let circle = |center, radius| Curve::Circle { center, radius, outward: side };
        match self {
            Self::Along { direction, u, v } => match surface {
                Surface::Plane(s) if s.normal.dot(direction).abs() < ONE => {
                    let normal = Flat::new(u.dot(&s.normal), v.dot(&s.normal)).normalize();
                    let foot = at - s.normal.into_inner() * (s.normal.dot(&at.coords) - s.offset);
                    Some(line(normal, normal.dot(&self.flat(foot))))
                }
                Surface::Cylinder(s) if is_parallel(&s.axis, direction) => {
                    let foot = s.point + s.axis.into_inner() * s.axis.dot(&(at - s.point));
                    Some(circle(self.flat(foot), s.radius))
                }
                _ => None,
            },
            Self::About { point, axis } => {
                let height = |p: Point| axis.dot(&(p - point));
                let is_on = |p: Point| (p - point).cross(axis).norm() < NEAR;
                match surface {
                    Surface::Plane(s) if is_parallel(&s.normal, axis) => {
                        let sign = s.normal.dot(axis).signum();
                        Some(line(Flat::new(0.0, sign), s.offset - s.normal.dot(&point.coords)))
                    }
                    Surface::Cylinder(s) if is_parallel(&s.axis, axis) && is_on(s.point) => {
                        Some(line(Flat::x(), s.radius))
                    }
                    Surface::Cone(s) if is_parallel(&s.axis, axis) && is_on(s.apex) => {
                        let (sin, cos) = s.half_angle.sin_cos();
                        let normal = Flat::new(cos, -sin * s.axis.dot(axis).signum());
                        Some(line(normal, normal.y * height(s.apex)))
                    }
                    Surface::Torus(s) if is_parallel(&s.axis, axis) && is_on(s.center) => {
                        Some(circle(Flat::new(s.major_radius, height(s.center)), s.minor_radius))
                    }
                    Surface::Sphere(s) if is_on(s.center) => {
                        Some(circle(Flat::new(0.0, height(s.center)), s.radius))
                    }
                    _ => None,
                }
            }
        }
    }

    fn surface(&self, ball: &Ball) -> Option<Surface> {
        let Ball { center, radius, .. } = *ball;
        match *self {
            Self::Along { direction, u, v } => {
                let point = Point::from(u.into_inner() * center.x + v.into_inner() * center.y);
                Some(Surface::Cylinder(Cylinder { point, axis: direction, radius }))
            }
            Self::About { point, axis } => (center.x > radius).then(|| {
                let center_point = point + axis.into_inner() * center.y;
                let (major_radius, minor_radius) = (center.x, radius);
                Surface::Torus(Torus { center: center_point, axis, major_radius, minor_radius })
            }),
        }
    }
}

fn is_parallel(one: &Unit, other: &Unit) -> bool {
    one.cross(other).norm() < ONE
}

impl Curve {
    fn distance(&self, p: Flat) -> f64 {
        match self {
            Self::Line { normal, offset } => normal.dot(&p) - offset,
            Self::Circle { center, radius, outward } => outward * ((p - center).norm() - radius),
        }
    }

    /// All points at this distance; none where the circle would have vanished.
    fn offset(&self, by: f64) -> Option<Self> {
        match *self {
            Self::Line { normal, offset } => Some(Self::Line { normal, offset: offset + by }),
            Self::Circle { center, radius, outward } => {
                let radius = radius + outward * by;
                (radius > 0.0).then_some(Self::Circle { center, radius, outward })
            }
        }
    }

    fn foot(&self, p: Flat) -> Flat {
        match self {
            Self::Line { normal, .. } => p - normal * self.distance(p),
            Self::Circle { center, radius, .. } => center + (p - center).normalize() * *radius,
        }
    }
}

/// Where two curves meet.
fn meets(one: &Curve, other: &Curve) -> [Option<Flat>; 2] {
    match (*one, *other) {
        (Curve::Line { normal: n, offset: a }, Curve::Line { normal: m, offset: b }) => {
            let turn = n.perp(&m);
            let at = Flat::new(a * m.y - b * n.y, b * n.x - a * m.x) / turn;
            [(turn.abs() > CROSS).then_some(at), None]
        }
        (Curve::Line { normal, offset }, Curve::Circle { center, radius, .. })
        | (Curve::Circle { center, radius, .. }, Curve::Line { normal, offset }) => {
            beside(center, normal, offset - normal.dot(&center), radius)
        }
        (
            Curve::Circle { center, radius, .. },
            Curve::Circle { center: second, radius: other, .. },
        ) => {
            let way = second - center;
            let far = way.norm();
            let along = (far * far + radius * radius - other * other) / (2.0 * far);
            beside(center, way / far, along, radius)
        }
    }
}

/// The points of a circle at a distance from its centre along a direction; none where there are none.
fn beside(center: Flat, direction: Flat, along: f64, radius: f64) -> [Option<Flat>; 2] {
    let square = radius * radius - along * along;
    if square.is_nan() || square < 0.0 {
        return [None; 2];
    }
    let aside = Flat::new(-direction.y, direction.x) * square.sqrt();
    let middle = center + direction * along;
    [Some(middle + aside), Some(middle - aside)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Vector;
    use crate::surface::{Cone, Plane, Sphere};

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
        let found = walls.nearest(&points, 0.01).unwrap();
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
