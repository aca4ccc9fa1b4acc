//! Planes, cylinders and cones that stand in a known direction or about a known axis: fits of less freedom.
//!
//! Most surfaces of a part stand along directions that others show, and about axes that others have.
//! A cylinder along a known direction has three degrees of freedom, not five; a cone about a known axis,
//! as the chamfers of a bore or of a nut, two, not six.

use nalgebra::{Matrix2, Matrix3, Vector2, Vector3};

use super::curve::Curve;
use super::sweep::{Sweep, edge};
use super::{Cylinder, Plane, Surface, axis, direction, start};
use crate::math::{Point, Unit, frame};

/// Iterations of a circle's fit, and the step, in sizes, after which it has converged.
const ITERATIONS: usize = 15;
const SETTLED: f64 = 1e-9;

/// Directions and axes are one when sine and distance are below this, in radians and sizes.
const ONE: f64 = 1e-9;
/// A direction is shown by so many surfaces, an axis by so many.
const WAYS: usize = 3;
const LINES: usize = 2;

/// Directions and axes that several surfaces show.
#[derive(Debug, Clone, Default)]
pub struct Shown {
    ways: Vec<Unit>,
    lines: Vec<(Point, Unit)>,
}

impl Shown {
    /// What aligned surfaces show.
    pub fn by(surfaces: &[Surface]) -> Self {
        Self {
            ways: repeated(surfaces.iter().filter_map(direction), is_parallel, WAYS),
            lines: repeated(surfaces.iter().filter_map(axis), is_coaxial, LINES),
        }
    }

    /// All that some surfaces have, and the edges of their planes.
    pub fn of(surfaces: &[Surface]) -> Self {
        let planes: Vec<&Plane> = surfaces
            .iter()
            .filter_map(
                |surface| if let Surface::Plane(plane) = surface { Some(plane) } else { None },
            )
            .collect();
        let pairs = planes.iter().enumerate();
        let edges = pairs.flat_map(|(i, a)| planes[..i].iter().filter_map(move |b| edge(a, b)));
        Self {
            ways: repeated(surfaces.iter().filter_map(direction).chain(edges), is_parallel, 1),
            lines: repeated(surfaces.iter().filter_map(axis), is_coaxial, 1),
        }
    }

    /// The nearest planes, cylinders and cones that stand in what is shown.
    pub fn nearest(&self, points: &[Point]) -> impl Iterator<Item = Surface> {
        let along = self.ways.iter().flat_map(|way| along(points, way));
        along.chain(self.lines.iter().flat_map(|(point, way)| about(points, *point, way)))
    }

    /// How many degrees of freedom of a surface are shown, and among how many directions or axes.
    pub fn held(&self, surface: &Surface) -> (f64, usize) {
        let among = |ways: fn(&Unit, &Unit) -> bool, way| self.ways.iter().any(|w| ways(w, &way));
        let directions = self.ways.len();
        match surface {
            Surface::Plane(s) if among(is_parallel, s.normal) => (2.0, directions),
            Surface::Plane(s) if among(is_upright, s.normal) => (1.0, directions),
            Surface::Cylinder(s)
                if self.lines.iter().any(|l| is_coaxial(l, &(s.point, s.axis))) =>
            {
                (4.0, self.lines.len())
            }
            Surface::Cylinder(s) if among(is_parallel, s.axis) => (2.0, directions),
            Surface::Cone(s) if self.lines.iter().any(|l| is_coaxial(l, &(s.apex, s.axis))) => {
                (4.0, self.lines.len())
            }
            _ => (0.0, 1),
        }
    }
}

fn is_parallel(one: &Unit, other: &Unit) -> bool {
    one.cross(other).norm() < ONE
}

fn is_upright(one: &Unit, other: &Unit) -> bool {
    one.dot(other).abs() < ONE
}

fn is_coaxial((p, one): &(Point, Unit), (q, other): &(Point, Unit)) -> bool {
    is_parallel(one, other) && (p - q).cross(one).norm() < ONE
}

/// What comes at least so often, each once, in the order of the first.
fn repeated<T>(all: impl Iterator<Item = T>, same: fn(&T, &T) -> bool, least: usize) -> Vec<T> {
    let mut counted: Vec<(T, usize)> = Vec::new();
    for new in all {
        match counted.iter_mut().find(|(known, _)| same(known, &new)) {
            Some((_, count)) => *count += 1,
            None => counted.push((new, 1)),
        }
    }
    counted.into_iter().filter(|(_, count)| *count >= least).map(|(known, _)| known).collect()
}

/// The nearest planes across and along a direction and the nearest cylinder along it.
fn along(points: &[Point], direction: &Unit) -> impl Iterator<Item = Surface> + use<> {
    let (u, v) = frame(direction);
    let flat: Vec<_> =
        points.iter().map(|p| Vector2::new(u.dot(&p.coords), v.dot(&p.coords))).collect();
    let beside = |at: Vector2<f64>| u.into_inner() * at.x + v.into_inner() * at.y;
    let wall = line(&flat).map(|(normal, offset)| {
        Surface::Plane(Plane { normal: Unit::new_normalize(beside(normal)), offset })
    });
    let bore = circle(&flat).map(|(center, radius)| {
        let point = Point::from(beside(center));
        Surface::Cylinder(Cylinder { point, axis: *direction, radius })
    });
    [Some(across(points, direction)), wall, bore].into_iter().flatten()
}

/// The nearest plane across an axis and the nearest cylinder and cone about it.
fn about(points: &[Point], point: Point, axis: &Unit) -> impl Iterator<Item = Surface> + use<> {
    let sweep = Sweep::About { point, axis: *axis };
    let flat: Vec<_> = points.iter().map(|p| sweep.flat(*p)).collect();
    let radius = mean(flat.iter().map(|p| p.x));
    let bore = Surface::Cylinder(Cylinder { point, axis: *axis, radius });
    // A line along the axis or across it is one of the other two.
    let cone = line(&flat)
        .and_then(|(normal, offset)| sweep.surface(&Curve::Line { normal, offset }))
        .filter(|surface| matches!(surface, Surface::Cone(_)));
    [Some(across(points, axis)), Some(bore), cone].into_iter().flatten()
}

fn across(points: &[Point], direction: &Unit) -> Surface {
    let offset = mean(points.iter().map(|p| direction.dot(&p.coords)));
    Surface::Plane(Plane { normal: *direction, offset })
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
    use super::super::Cone;
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

    fn worst(found: &Surface, points: &[Point]) -> f64 {
        points.iter().map(|p| found.distance(*p).unwrap().abs()).fold(0.0, f64::max)
    }

    #[test]
    fn what_stands_along_a_direction_is_found_exactly() {
        let round = points(Some(0.2));
        assert!(along(&round, &axis()).any(|s| worst(&s, &round) < 1e-9));
        let flat = points(None);
        assert!(along(&flat, &axis()).any(|s| worst(&s, &flat) < 1e-12));
        let top: Vec<_> =
            (0..9).map(|i| Point::from(frame(&axis()).0.into_inner() * f64::from(i))).collect();
        assert!(along(&top, &axis()).any(|s| worst(&s, &top) < 1e-12));
    }

    #[test]
    fn a_piece_of_a_cone_about_an_axis_is_found_exactly() {
        let (apex, half_angle) = (Point::new(0.5, 0.5, 0.2), 0.6);
        let cone = Surface::Cone(Cone { apex, axis: axis(), half_angle });
        // What is bent about the axis, laid onto the cone.
        let onto = |p: Point| {
            let normal = cone.normal(p).unwrap().into_inner();
            p - normal * cone.distance(p).unwrap()
        };
        let piece: Vec<_> = points(Some(0.2)).into_iter().map(onto).collect();
        let found = about(&piece, apex, &axis()).find(|s| matches!(s, Surface::Cone(_))).unwrap();
        assert!(worst(&found, &piece) < 1e-9, "{found:?}");
        let bores = [0.1, 0.2].map(|radius| Cylinder { point: apex, axis: axis(), radius });
        let shown = Shown::by(&bores.map(Surface::Cylinder));
        assert_eq!(shown.held(&found), (4.0, 1));
    }

    #[test]
    fn what_is_shown_costs_less() {
        let bore = |radius| {
            let point = Point::new(0.5, 0.5, 0.5);
            Surface::Cylinder(Cylinder { point, axis: axis(), radius })
        };
        let top = Surface::Plane(Plane::through(Point::origin(), axis()));
        let shown = Shown::by(&[bore(0.1), bore(0.2), top.clone()]);
        assert_eq!(shown.held(&top), (2.0, 1));
        assert_eq!(shown.held(&bore(0.3)), (4.0, 1));
        let wall = Surface::Plane(Plane::through(Point::origin(), frame(&axis()).0));
        assert_eq!(shown.held(&wall).0, 1.0);
        let oblique = Unit::new_normalize(Vector::new(0.7, 0.1, 1.0));
        assert_eq!(shown.held(&Surface::Plane(Plane::through(Point::origin(), oblique))).0, 0.0);
        assert_eq!(Shown::by(&[bore(0.1), top.clone()]).held(&top).0, 0.0);
        assert!(shown.nearest(&points(Some(0.2))).any(|s| worst(&s, &points(Some(0.2))) < 1e-9));
    }
}
