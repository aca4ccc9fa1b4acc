//! Where orthogonal-distance fits start: surfaces from points and their normals, in closed form.
//!
//! Surfaces of revolution are found axis first. Candidates for the axis are the principal axes of
//! the normals on the Gauss sphere (a cylinder's normals lie on a great circle, a cone's on a small
//! one), those of the points, and the direction of least curvature of a height field. Given the axis,
//! the normals' lines meet it, which gives its place, and the profile is a line or a circle.

use nalgebra::{Matrix2, Matrix3, SMatrix, SVector, UnitQuaternion, Vector2};

use super::refine::centroid;
use super::{Cone, Cylinder, Plane, Quadric, Sphere, Surface, Torus};
use crate::math::{Point, Similarity, Unit, Vector, frame};

/// Points of a surface, and normals at other points of it.
#[derive(Debug, Clone, Copy)]
pub struct Samples<'a> {
    /// Positions: vertices, which lie on the surface up to the noise.
    pub points: &'a [Point],
    /// Where the normals were taken: barycentres of faces.
    pub barycentres: &'a [Point],
    /// Outward unit normals there.
    pub normals: &'a [Vector],
}

/// The plane of least squares; its normal looks along the mean of the samples' normals.
pub fn plane(samples: Samples) -> Option<Surface> {
    let center = centroid(samples.points)?;
    let eigen = scatter(samples.points.iter().map(|p| p - center)).symmetric_eigen();
    let normal = eigen.eigenvectors.column(eigen.eigenvalues.imin()).into_owned();
    let mean: Vector = samples.normals.iter().sum();
    let normal = if normal.dot(&mean) < 0.0 { -normal } else { normal };
    Some(Surface::Plane(Plane::through(center, Unit::try_new(normal, 0.5)?)))
}

/// The sphere of least squared power `|x - c|² - r²`.
pub fn sphere(samples: Samples) -> Option<Surface> {
    let center = centroid(samples.points)?;
    let mut matrix = Matrix3::zeros();
    let mut right = Vector::zeros();
    let count = samples.points.len() as f64;
    let mean = samples.points.iter().map(|p| (p - center).norm_squared()).sum::<f64>() / count;
    for p in samples.points {
        let x = p - center;
        matrix += x * x.transpose();
        right += x * (x.norm_squared() - mean) / 2.0;
    }
    let shift = matrix.lu().solve(&right)?;
    let radius = (mean + shift.norm_squared()).sqrt();
    (radius.is_finite() && radius > 0.0)
        .then(|| Surface::Sphere(Sphere { center: center + shift, radius }))
}

/// Axes whose cosine exceeds this are one: a start may err by a degree or two, not by ten.
const SAME_AXIS: f64 = 0.9995;

/// Axis directions worth trying, best guesses first, without near repetitions.
pub fn axes(samples: Samples) -> Vec<Unit> {
    let mut found: Vec<Unit> = Vec::new();
    let mut propose = |axis: Vector| {
        if let Some(axis) = Unit::try_new(axis, 1e-9)
            && found.iter().all(|known| known.dot(&axis).abs() < SAME_AXIS)
        {
            found.push(axis);
        }
    };
    let count = samples.normals.len().max(1) as f64;
    let mean = samples.normals.iter().sum::<Vector>() / count;
    let great = scatter(samples.normals.iter().copied()).symmetric_eigen();
    let small = scatter(samples.normals.iter().map(|n| n - mean)).symmetric_eigen();
    propose(great.eigenvectors.column(great.eigenvalues.imin()).into_owned());
    propose(small.eigenvectors.column(small.eigenvalues.imin()).into_owned());
    if let Some(axis) = revolution_axis(samples) {
        propose(axis);
    }
    if let Some((_, directions)) = curvatures(samples) {
        directions.into_iter().for_each(&mut propose);
    }
    if let Some(center) = centroid(samples.points) {
        let spread = scatter(samples.points.iter().map(|p| p - center)).symmetric_eigen();
        for i in 0..3 {
            propose(spread.eigenvectors.column(i).into_owned());
        }
    }
    found
}

/// The direction about which a rotation moves the samples least across themselves.
///
/// The velocity field `c × x + d` is tangent where `c · (x × n) + d · n = 0` (Pottmann and Randrup,
/// "Rotational and helical surface approximation", Computing 1998).
fn revolution_axis(samples: Samples) -> Option<Vector> {
    let center = centroid(samples.barycentres)?;
    let (mut turn, mut mixed, mut shift) = (Matrix3::zeros(), Matrix3::zeros(), Matrix3::zeros());
    for (p, n) in samples.barycentres.iter().zip(samples.normals) {
        let torque = (p - center).cross(n);
        turn += torque * torque.transpose();
        mixed += torque * n.transpose();
        shift += n * n.transpose();
    }
    // A cylinder may be shifted along its axis: the ridge keeps that direction out.
    let ridge = 1e-6 * shift.trace();
    let inverse = (shift + Matrix3::identity() * ridge).try_inverse()?;
    let eigen = (turn - mixed * inverse * mixed.transpose()).symmetric_eigen();
    Some(eigen.eigenvectors.column(eigen.eigenvalues.imin()).into_owned())
}

/// Principal curvatures of a height field over the plane of least squares, and their directions,
/// least absolute curvature first; curvature is positive where the surface bends away from the
/// mean normal.
pub fn curvatures(samples: Samples) -> Option<([f64; 2], [Vector; 2])> {
    let Surface::Plane(base) = plane(samples)? else { return None };
    let center = centroid(samples.points)?;
    let (u, v) = frame(&base.normal);
    let mut matrix = SMatrix::<f64, 6, 6>::zeros();
    let mut right = SVector::<f64, 6>::zeros();
    for p in samples.points {
        let d = p - center;
        let (x, y, z) = (u.dot(&d), v.dot(&d), base.normal.dot(&d));
        let row = SVector::<f64, 6>::from([1.0, x, y, x * x / 2.0, x * y, y * y / 2.0]);
        matrix += row * row.transpose();
        right += row * z;
    }
    let c = matrix.lu().solve(&right)?;
    let eigen = Matrix2::new(-c[3], -c[4], -c[4], -c[5]).symmetric_eigen();
    let order =
        if eigen.eigenvalues[0].abs() <= eigen.eigenvalues[1].abs() { [0, 1] } else { [1, 0] };
    let direction = |i: usize| {
        let e = eigen.eigenvectors.column(i);
        u.into_inner() * e[0] + v.into_inner() * e[1]
    };
    Some((order.map(|i| eigen.eigenvalues[i]), order.map(direction)))
}

/// The point of an axis of known direction that the normals' lines come nearest to.
fn axis_point(samples: Samples, axis: &Unit) -> Option<Point> {
    let center = centroid(samples.barycentres)?;
    let (u, v) = frame(axis);
    let mut matrix = Matrix2::zeros();
    let mut right = Vector2::zeros();
    for (p, n) in samples.barycentres.iter().zip(samples.normals) {
        // In the plane across the axis: (c - p) × n = 0.
        let across = Vector2::new(v.dot(n), -u.dot(n));
        let d = p - center;
        let at = Vector2::new(u.dot(&d), v.dot(&d));
        matrix += across * across.transpose();
        right += across * across.dot(&at);
    }
    let c = matrix.lu().solve(&right)?;
    Some(center + u.into_inner() * c[0] + v.into_inner() * c[1])
}

/// The circle of least squared power in the plane across the axis.
pub fn cylinder(samples: Samples, axis: &Unit) -> Option<Surface> {
    let center = centroid(samples.points)?;
    let (u, v) = frame(axis);
    let flat = |p: &Point| {
        let d = p - center;
        Vector2::new(u.dot(&d), v.dot(&d))
    };
    let (c, radius) = circle(samples.points.iter().map(flat))?;
    let point = center + u.into_inner() * c.x + v.into_inner() * c.y;
    Some(Surface::Cylinder(Cylinder { point, axis: *axis, radius }))
}

/// Centre and radius of the circle of least squared power.
pub(super) fn circle(
    points: impl Iterator<Item = Vector2<f64>> + Clone,
) -> Option<(Vector2<f64>, f64)> {
    let count = points.clone().count() as f64;
    let mid = points.clone().sum::<Vector2<f64>>() / count;
    let mean = points.clone().map(|p| (p - mid).norm_squared()).sum::<f64>() / count;
    let mut matrix = Matrix2::zeros();
    let mut right = Vector2::zeros();
    for p in points {
        let x = p - mid;
        matrix += x * x.transpose();
        right += x * (x.norm_squared() - mean) / 2.0;
    }
    let shift = matrix.lu().solve(&right)?;
    let radius = (mean + shift.norm_squared()).sqrt();
    (radius.is_finite() && radius > 0.0).then_some((mid + shift, radius))
}

/// Height and radius of the points about an axis.
fn profile<'a>(
    samples: Samples<'a>,
    axis: &'a Unit,
    on_axis: Point,
) -> impl Iterator<Item = Vector2<f64>> + Clone + 'a {
    samples.points.iter().map(move |p| {
        let d = p - on_axis;
        let height = axis.dot(&d);
        Vector2::new(height, (d.norm_squared() - height * height).max(0.0).sqrt())
    })
}

/// The cone of a known axis direction: the profile is a line.
pub fn cone(samples: Samples, axis: &Unit) -> Option<Surface> {
    let on_axis = axis_point(samples, axis)?;
    let line = profile(samples, axis, on_axis);
    let count = samples.points.len() as f64;
    let mid = line.clone().sum::<Vector2<f64>>() / count;
    let (mut hh, mut hr) = (0.0, 0.0);
    for p in line {
        hh += (p.x - mid.x).powi(2);
        hr += (p.x - mid.x) * (p.y - mid.y);
    }
    let slope = hr / hh;
    let apex = mid.x - mid.y / slope;
    let axis = if slope < 0.0 { -*axis } else { *axis };
    let half_angle = slope.abs().atan();
    let apex = on_axis + axis.into_inner() * if slope < 0.0 { -apex } else { apex };
    (half_angle.is_finite() && half_angle > 1e-3 && apex.coords.norm().is_finite())
        .then_some(Surface::Cone(Cone { apex, axis, half_angle }))
}

/// The torus of a known axis direction: the profile is a circle.
pub fn torus(samples: Samples, axis: &Unit) -> Option<Torus> {
    let on_axis = axis_point(samples, axis)?;
    let (c, minor_radius) = circle(profile(samples, axis, on_axis))?;
    let center = on_axis + axis.into_inner() * c.x;
    Some(Torus { center, axis: *axis, major_radius: c.y, minor_radius })
}

/// The general quadric of Taubin's fit (1991): least `Σ f²` at `Σ |∇f|² = 1`.
pub fn quadric(samples: Samples) -> Option<Surface> {
    let center = centroid(samples.points)?;
    let spread = samples.points.iter().map(|p| (p - center).norm_squared()).sum::<f64>();
    let scale = (spread / samples.points.len() as f64).sqrt().max(1e-300);
    let frame = Similarity::from_parts(center.coords.into(), UnitQuaternion::identity(), scale);
    let local = quadric_in(samples.points, &frame, |_| true)?;
    Some(Surface::Quadric(local.transformed(&frame)))
}

/// The same in a frame, where only the coefficients of which `free` is true may differ from zero.
pub fn quadric_in(
    points: &[Point],
    frame: &Similarity,
    free: impl Fn(usize) -> bool,
) -> Option<Quadric> {
    let mut values = SMatrix::<f64, 10, 10>::zeros();
    let mut slopes = SMatrix::<f64, 10, 10>::zeros();
    for p in points {
        let p = frame.inverse_transform_point(p);
        let (x, y, z) = (p.x, p.y, p.z);
        let f = SVector::from([1.0, x, y, z, x * x, x * y, x * z, y * y, y * z, z * z]);
        values += f * f.transpose();
        for g in [
            [0.0, 1.0, 0.0, 0.0, 2.0 * x, y, z, 0.0, 0.0, 0.0],
            [0.0, 0.0, 1.0, 0.0, 0.0, x, 0.0, 2.0 * y, z, 0.0],
            [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, x, 0.0, y, 2.0 * z],
        ] {
            let g = SVector::from(g);
            slopes += g * g.transpose();
        }
    }
    // Without slope a coefficient has no part in the largest μ below.
    for held in (0..10).filter(|&i| !free(i)) {
        for matrix in [&mut values, &mut slopes] {
            matrix.fill_row(held, 0.0);
            matrix.fill_column(held, 0.0);
        }
        values[(held, held)] = 1.0;
    }
    // The largest μ of slopes c = μ values c is the least of the inverse problem; the values'
    // matrix may be singular (points exactly on a quadric), hence the ridge.
    let ridge = 1e-13 * values.trace();
    let factor = (values + SMatrix::identity() * ridge).cholesky()?;
    let lower = factor.l();
    let inner = lower.solve_lower_triangular(&slopes)?;
    let inner = lower.solve_lower_triangular(&inner.transpose())?;
    let eigen = ((inner + inner.transpose()) / 2.0).symmetric_eigen();
    let best = eigen.eigenvectors.column(eigen.eigenvalues.imax()).into_owned();
    let local = lower.transpose().solve_upper_triangular(&best)?;
    Some(Quadric { coefficients: local.try_normalize(1e-300)?.into() })
}

/// The point that the tangent planes come nearest to: the apex of a cone of any section.
pub fn common_point(samples: Samples) -> Option<Point> {
    let center = centroid(samples.barycentres)?;
    let pull = |(p, n): (&Point, &Vector)| n * n.dot(&(p - center));
    let pull: Vector = samples.barycentres.iter().zip(samples.normals).map(pull).sum();
    let shift = scatter(samples.normals.iter().copied()).lu().solve(&pull)?;
    shift.iter().all(|c| c.is_finite()).then(|| center + shift)
}

fn scatter(vectors: impl Iterator<Item = Vector>) -> Matrix3<f64> {
    vectors.map(|v| v * v.transpose()).sum()
}
