//! Sweeps: surfaces that extend in one direction, or turn about one axis, are curves in a plane.

use super::curve::{Curve, Flat};
use super::{Cone, Cylinder, Plane, Surface, Torus, axis};
use crate::math::{Point, Unit, frame};

/// Directions are one below this sine, and axes nearer than this, in sizes: surfaces are fits themselves.
const ONE: f64 = 0.03;
const NEAR: f64 = 0.004;
/// Planes that meet at a lesser sine have no direction in common that noise would not turn.
const CROSS: f64 = 0.1;

/// How curves in a plane become surfaces.
#[derive(Debug, Clone, Copy)]
pub enum Sweep {
    /// In a direction; with the axes of the plane across it.
    Along {
        /// Of all lines on the surfaces.
        direction: Unit,
        /// First axis of the plane.
        u: Unit,
        /// Second axis of the plane.
        v: Unit,
    },
    /// About an axis; the plane has the distance from it and the height along it.
    About {
        /// Where the height is zero.
        point: Point,
        /// Through that point.
        axis: Unit,
    },
}

impl Sweep {
    /// Every sweep that some surfaces suggest: about the axis of each, along that of a cylinder, along the
    /// edge of each two planes. None twice.
    pub fn suggested(by: &[&Surface]) -> Vec<Self> {
        let mut sweeps: Vec<Self> = Vec::new();
        let mut add = |sweep: Self| {
            if !sweeps.iter().any(|known| known.is_like(&sweep)) {
                sweeps.push(sweep);
            }
        };
        for (i, one) in by.iter().enumerate() {
            if let Some((point, axis)) = axis(one) {
                add(Self::About { point, axis });
            }
            if let Surface::Cylinder(bore) = one {
                add(Self::along(bore.axis));
            }
            for other in &by[i + 1..] {
                if let (Surface::Plane(a), Surface::Plane(b)) = (one, other)
                    && let Some(edge) = Self::edge(a, b)
                {
                    add(edge);
                }
            }
        }
        sweeps
    }

    fn is_like(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Along { direction: a, .. }, Self::Along { direction: b, .. }) => {
                is_parallel(a, b)
            }
            (Self::About { point: p, axis: a }, Self::About { point: q, axis: b }) => {
                is_parallel(a, b) && (p - q).cross(a).norm() < NEAR
            }
            _ => false,
        }
    }

    /// The one between two surfaces on which a ball may roll along both.
    pub fn between(walls: [&Surface; 2]) -> Option<Self> {
        match walls {
            [Surface::Plane(a), Surface::Plane(b)] => Self::edge(a, b),
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

    /// Along the edge of two planes.
    fn edge(a: &Plane, b: &Plane) -> Option<Self> {
        edge(a, b).map(Self::along)
    }

    fn along(direction: Unit) -> Self {
        let (u, v) = frame(&direction);
        Self::Along { direction, u, v }
    }

    /// Where a point lies in the plane.
    pub fn flat(&self, p: Point) -> Flat {
        match self {
            Self::Along { u, v, .. } => Flat::new(u.dot(&p.coords), v.dot(&p.coords)),
            Self::About { point, axis } => {
                let way = p - point;
                Flat::new(way.cross(axis).norm(), axis.dot(&way))
            }
        }
    }

    /// The curve of a surface; at a point where it does not quite extend or turn like that.
    pub fn curve(&self, surface: &Surface, side: f64, at: Point) -> Option<Curve> {
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

    /// The surface of a curve: a plane, a cylinder, a cone or a torus. `None` for a circle that the axis meets.
    pub fn surface(&self, curve: &Curve) -> Option<Surface> {
        match (*self, *curve) {
            (Self::Along { direction, u, v }, Curve::Circle { center, radius, .. }) => {
                let point = Point::from(u.into_inner() * center.x + v.into_inner() * center.y);
                Some(Surface::Cylinder(Cylinder { point, axis: direction, radius }))
            }
            (Self::Along { u, v, .. }, Curve::Line { normal, offset }) => {
                let normal = u.into_inner() * normal.x + v.into_inner() * normal.y;
                Some(Surface::Plane(Plane { normal: Unit::new_normalize(normal), offset }))
            }
            (Self::About { point, axis }, Curve::Circle { center, radius, .. }) => {
                (center.x > radius).then(|| {
                    let center_point = point + axis.into_inner() * center.y;
                    let (major_radius, minor_radius) = (center.x, radius);
                    Surface::Torus(Torus { center: center_point, axis, major_radius, minor_radius })
                })
            }
            (Self::About { point, axis }, Curve::Line { normal, offset }) => {
                let height = |height: f64| point + axis.into_inner() * height;
                if normal.x.abs() < ONE {
                    return Some(Surface::Plane(Plane::through(height(offset / normal.y), axis)));
                }
                if normal.y.abs() < ONE {
                    let radius = (offset / normal.x).abs();
                    return Some(Surface::Cylinder(Cylinder { point, axis, radius }));
                }
                // The way along the axis on which the line leaves it.
                let slope = -normal.y / normal.x;
                let (apex, half_angle) = (height(offset / normal.y), slope.abs().atan());
                let axis = if slope > 0.0 { axis } else { -axis };
                Some(Surface::Cone(Cone { apex, axis, half_angle }))
            }
        }
    }
}

/// The direction of the edge of two planes.
pub fn edge(a: &Plane, b: &Plane) -> Option<Unit> {
    Unit::try_new(a.normal.cross(&b.normal), CROSS)
}

fn is_parallel(one: &Unit, other: &Unit) -> bool {
    one.cross(other).norm() < ONE
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Vector;

    /// A surface, its curve, and the surface of that.
    fn returns(sweep: &Sweep, surface: &Surface, at: Point) {
        let curve = sweep.curve(surface, 1.0, at).unwrap();
        let again = sweep.surface(&curve).unwrap();
        assert!(again.is_like(surface), "{again:?}");
        assert!(
            (again.distance(at).unwrap().abs() - surface.distance(at).unwrap().abs()).abs() < 1e-12
        );
    }

    #[test]
    fn a_surface_is_the_sweep_of_its_curve() {
        let (axis, at) =
            (Unit::new_normalize(Vector::new(0.3, -0.2, 1.0)), Point::new(0.6, 0.4, 0.9));
        let point = Point::new(0.5, 0.5, 0.2);
        let cylinder = Surface::Cylinder(Cylinder { point, axis, radius: 0.1 });
        let cone = |axis| Surface::Cone(Cone { apex: point, axis, half_angle: 0.4 });
        let torus = Torus { center: point, axis, major_radius: 0.2, minor_radius: 0.05 };
        let about = Sweep::About { point: point + axis.into_inner() * 0.3, axis };
        let top = Surface::Plane(Plane::through(point, axis));
        for surface in [cylinder.clone(), cone(axis), cone(-axis), Surface::Torus(torus), top] {
            returns(&about, &surface, at);
        }
        let along = Sweep::along(axis);
        let wall = Surface::Plane(Plane::through(point, frame(&axis).0));
        for surface in [cylinder, wall] {
            returns(&along, &surface, at);
        }
    }

    #[test]
    fn surfaces_suggest_every_sweep_once() {
        let bore = |x| {
            let point = Point::new(x, 0.0, 0.0);
            Surface::Cylinder(Cylinder { point, axis: Vector::z_axis(), radius: 0.1 })
        };
        let wall = |normal| Surface::Plane(Plane::through(Point::origin(), normal));
        let all = [bore(0.0), bore(0.0), bore(0.5), wall(Vector::x_axis()), wall(Vector::y_axis())];
        // About two axes, and along z, which is also the edge of the planes.
        assert_eq!(Sweep::suggested(&all.each_ref()).len(), 3);
    }
}
