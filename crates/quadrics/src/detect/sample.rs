//! Draws from one neighbourhood, where nothing is explained yet, and the shapes through them.
//!
//! Every construction is minimal: as few points with normals as determine the shape (Schnabel et
//! al. 2007, section 4.1), so that few draws hit one shape with all of them.

use nalgebra::Matrix3;
use rand::{Rng, RngExt};

use super::marks::Marks;
use crate::math::{Point, Unit, Vector};
use crate::mesh::Working;
use crate::partition::UNLABELLED;
use crate::surface::{Cone, Cylinder, Plane, Sphere, Surface, Torus};

/// A barycentre and the normal of its face.
pub type Dual = (Point, Vector);

/// Faces that a shape of four points is drawn from: fillets have few, large surfaces are found by
/// distant points only.
const NEIGHBOURHOODS: [usize; 5] = [8, 24, 80, 250, 800];
/// Radii above it, in the unit cube, are those of planes.
const LARGEST_RADIUS: f64 = 2.0;
/// Cones outside of these half angles are cylinders and planes.
const HALF_ANGLES_DEG: [f64; 2] = [2.0, 87.0];
/// Sines below it: the directions are parallel as far as the construction goes.
const PARALLEL: f64 = 1e-3;

/// Up to four different faces out of one connected neighbourhood of unlabelled faces around
/// `start`, which is the first of them.
pub fn neighbourhood(
    working: &Working,
    labels: &[u32],
    start: u32,
    rng: &mut impl Rng,
    marks: &mut Marks,
) -> Vec<u32> {
    let size = NEIGHBOURHOODS[rng.random_range(0..NEIGHBOURHOODS.len())];
    let mut found = vec![start];
    marks.begin();
    marks.visit_face(start);
    let mut next = 0;
    while next < found.len() && found.len() < size {
        for other in working.adjacency.across(found[next] as usize) {
            if labels[other] == UNLABELLED && marks.visit_face(other as u32) {
                found.push(other as u32);
            }
        }
        next += 1;
    }
    let wanted = found.len().min(4);
    // The first steps of a shuffle, the start staying where it is.
    for i in 1..wanted {
        let other = rng.random_range(i..found.len());
        found.swap(i, other);
    }
    found.truncate(wanted);
    found
}

/// The shapes through a draw, simplest first; fewer where it determines none of a type.
pub fn shapes(draw: &[Dual]) -> Vec<Surface> {
    let mut shapes = Vec::with_capacity(6);
    if let &[a, b, c, ref rest @ ..] = draw {
        shapes.extend(plane(a, b, c).map(Surface::Plane));
        shapes.extend(sphere(a, b).map(Surface::Sphere));
        shapes.extend(cylinder(a, b).map(Surface::Cylinder));
        shapes.extend(cone(a, b, c).map(Surface::Cone));
        if let &[d, ..] = rest {
            shapes.extend(tori([a, b, c, d]).into_iter().map(Surface::Torus));
        }
    }
    shapes
}

fn plane((a, _): Dual, (b, _): Dual, (c, _): Dual) -> Option<Plane> {
    let (one, other) = ((b - a), (c - a));
    let cross = one.cross(&other);
    let normal = Unit::try_new(cross, PARALLEL * one.norm() * other.norm())?;
    Some(Plane::through(a, normal))
}

/// Centred where the two normal lines come nearest to each other.
fn sphere(a: Dual, b: Dual) -> Option<Sphere> {
    let (one, other) = nearest_on_lines(a, b)?;
    let center = nalgebra::center(&one, &other);
    let radius = ((a.0 - center).norm() + (b.0 - center).norm()) / 2.0;
    (radius > 0.0 && radius < LARGEST_RADIUS).then_some(Sphere { center, radius })
}

/// The axis is at right angles to both normals, where their lines come nearest.
fn cylinder(a: Dual, b: Dual) -> Option<Cylinder> {
    let axis = Unit::try_new(a.1.cross(&b.1), PARALLEL)?;
    let (one, other) = nearest_on_lines(a, b)?;
    // The nearest points differ along the axis only.
    let radius = ((a.0 - one).norm() + (b.0 - other).norm()) / 2.0;
    (radius > 0.0 && radius < LARGEST_RADIUS).then_some(Cylinder { point: one, axis, radius })
}

fn nearest_on_lines((p, n): Dual, (q, m): Dual) -> Option<(Point, Point)> {
    let (apart, cosine) = (q - p, n.dot(&m));
    let sine_squared = 1.0 - cosine * cosine;
    if sine_squared < PARALLEL * PARALLEL {
        return None;
    }
    let (along_n, along_m) = (apart.dot(&n), apart.dot(&m));
    let t = (along_n - cosine * along_m) / sine_squared;
    let s = (cosine * along_n - along_m) / sine_squared;
    Some((p + n * t, q + m * s))
}

/// The apex is where three tangent planes meet; the axis has one angle to all three rays.
fn cone(a: Dual, b: Dual, c: Dual) -> Option<Cone> {
    let normals = Matrix3::from_rows(&[a.1.transpose(), b.1.transpose(), c.1.transpose()]);
    if normals.determinant().abs() < PARALLEL * PARALLEL {
        return None;
    }
    let offsets = Vector::new(a.1.dot(&a.0.coords), b.1.dot(&b.0.coords), c.1.dot(&c.0.coords));
    let apex = Point::from(normals.try_inverse()? * offsets);
    let ray = |point: Point| Unit::try_new(point - apex, f64::MIN_POSITIVE);
    let rays = [ray(a.0)?, ray(b.0)?, ray(c.0)?].map(Unit::into_inner);
    let axis = (rays[1] - rays[0]).cross(&(rays[2] - rays[0]));
    let axis = Unit::try_new(axis, PARALLEL * PARALLEL)?;
    let axis = if axis.dot(&rays[0]) < 0.0 { -axis } else { axis };
    let half_angle = axis.dot(&rays[0]).clamp(-1.0, 1.0).acos();
    let [least, most] = HALF_ANGLES_DEG.map(f64::to_radians);
    (half_angle > least && half_angle < most).then_some(Cone { apex, axis, half_angle })
}

/// The axis meets all four normal lines; there are up to two such lines.
fn tori(draw: [Dual; 4]) -> Vec<Torus> {
    let [(p0, n0), (p1, n1), ..] = draw;
    let det = |a: &Vector, b: &Vector, c: &Vector| a.dot(&b.cross(c));
    // A line through p0 + s n0 and p1 + t n1 meets the line (p, n) where
    // A + B s + C t + D s t = 0.
    let condition = |(p, n): Dual| {
        let (d, e) = (p1 - p0, p - p0);
        let b = -det(&n0, &n, &e) - det(&d, &n, &n0);
        (det(&d, &n, &e), b, det(&n1, &n, &e), -det(&n1, &n, &n0))
    };
    let (a2, b2, c2, d2) = condition(draw[2]);
    let (a3, b3, c3, d3) = condition(draw[3]);
    // Both solved for t and set equal: a quadratic in s.
    let roots =
        quadratic(b2 * d3 - b3 * d2, a2 * d3 + b2 * c3 - a3 * d2 - b3 * c2, a2 * c3 - a3 * c2);
    let with_axis = |s: f64| {
        let t = -(a2 + b2 * s) / (c2 + d2 * s);
        let (on_axis, other) = (p0 + n0 * s, p1 + n1 * t);
        let axis = Unit::try_new(other - on_axis, 1e-9)?;
        torus_about(on_axis, axis, draw)
    };
    roots.into_iter().filter_map(with_axis).collect()
}

fn quadratic(a: f64, b: f64, c: f64) -> Vec<f64> {
    let root = (b * b - 4.0 * a * c).sqrt();
    // Without cancellation: the root of larger size first, the other by their product.
    let q = -(b + root.copysign(b)) / 2.0;
    [q / a, c / q].into_iter().filter(|x| x.is_finite()).collect()
}

/// The circle through three of the points in the half plane of height and radius.
fn torus_about(on_axis: Point, axis: Unit, draw: [Dual; 4]) -> Option<Torus> {
    let flat = |(p, _): Dual| {
        let offset = p - on_axis;
        let height = axis.dot(&offset);
        ((offset - axis.into_inner() * height).norm(), height)
    };
    let [(x, y), (x1, y1), (x2, y2), (x3, y3)] = draw.map(flat);
    let ((x1, y1), (x2, y2)) = ((x1 - x, y1 - y), (x2 - x, y2 - y));
    let twice = 2.0 * (x1 * y2 - x2 * y1);
    let (s1, s2) = (x1 * x1 + y1 * y1, x2 * x2 + y2 * y2);
    let (u, v) = ((y2 * s1 - y1 * s2) / twice, (x1 * s2 - x2 * s1) / twice);
    let (major_radius, height, minor_radius) = (x + u, y + v, u.hypot(v));
    let off = ((x3 - major_radius).hypot(y3 - height) - minor_radius).abs();
    let ring = minor_radius > 0.0 && minor_radius < major_radius && major_radius < LARGEST_RADIUS;
    let center = on_axis + axis.into_inner() * height;
    (ring && off < minor_radius).then_some(Torus { center, axis, major_radius, minor_radius })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::context::Context;
    use crate::surface::Shape;

    fn close(one: &Surface, other: &Surface, points: &[Dual]) -> bool {
        one.type_name() == other.type_name()
            && points.iter().all(|&(p, _)| {
                let off = one.distance(p + Vector::new(0.01, 0.02, -0.01)).unwrap()
                    - other.distance(p + Vector::new(0.01, 0.02, -0.01)).unwrap();
                off.abs() < 1e-6
            })
    }

    #[test]
    fn points_drawn_from_a_shape_give_it_back() {
        let axis = Unit::new_normalize(Vector::new(0.3, -0.5, 0.8));
        let center = Point::new(0.4, 0.6, 0.5);
        let truth = [
            Surface::Sphere(Sphere { center, radius: 0.3 }),
            Surface::Cylinder(Cylinder { point: center, axis, radius: 0.2 }),
            Surface::Cone(Cone { apex: center - axis.into_inner() * 0.5, axis, half_angle: 0.4 }),
            Surface::Torus(Torus { center, axis, major_radius: 0.4, minor_radius: 0.1 }),
        ];
        let mut rng = Context::new(3).rng;
        for surface in truth {
            let mut hits = 0;
            for _ in 0..100 {
                let draw: Vec<Dual> = (0..4)
                    .map(|_| {
                        let p = Point::from(Vector::from_fn(|_, _| rng.random_range(0.2..0.8)));
                        let foot = surface.project(p).unwrap();
                        (foot, surface.normal(foot).unwrap().into_inner())
                    })
                    .collect();
                hits += usize::from(shapes(&draw).iter().any(|s| close(s, &surface, &draw)));
            }
            // Some draws are degenerate: two points on one ruling.
            assert!(hits >= 90, "{surface:?}: {hits}");
        }
    }

    #[test]
    fn a_plane_goes_through_its_points_and_collinear_ones_have_none() {
        let dual = |x: f64, y: f64| (Point::new(x, y, 0.5), Vector::z());
        let found = plane(dual(0.1, 0.0), dual(0.3, 0.1), dual(0.0, 0.4)).unwrap();
        assert!(found.distance(Point::new(9.0, 9.0, 0.5)).abs() < 1e-12);
        assert_eq!(plane(dual(0.0, 0.0), dual(0.1, 0.1), dual(0.2, 0.2)), None);
    }
}
