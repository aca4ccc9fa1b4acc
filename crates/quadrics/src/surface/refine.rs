//! Orthogonal-distance fits by Levenberg-Marquardt, with their covariance.
//!
//! Every surface is moved by rigid motions about a *foot* (a point of the surface near the data)
//! and by its curvatures there, after Lukács, Martin and Marshall, "Faithful least-squares fitting"
//! (ECCV 1998): as a cylinder flattens its curvature goes to zero and nothing becomes singular,
//! where its radius would go to infinity.

use nalgebra::{Const, DimMin, SMatrix, SVector, UnitQuaternion};

use super::family::Family;
use super::local::{LocalCone, LocalCylinder, LocalPlane, LocalSphere, LocalTorus};
use super::squares::{Local, normal_equations, one_by_one, sum_of_squares};
use super::{Quadric, Shape, Surface};
use crate::math::lanes::{Lanes, Packet};
use crate::math::{Point, Similarity, Vector};

/// A fitted surface and how well it fits.
#[derive(Debug, Clone)]
pub struct Fit {
    /// The surface.
    pub surface: Surface,
    /// Weighted sum of squared orthogonal distances.
    pub cost: f64,
}

/// Most iterations of a fit; 8 are the rule.
const ITERATIONS: usize = 30;
/// A step that changes the cost by less than this fraction is the last one; the parameters are then within
/// a thousandth of what they scatter by.
const PROGRESS: f64 = 1e-8;
/// Marquardt's damping at the start, and what it is multiplied or divided by.
const DAMPING: f64 = 1e-4;
const DAMPING_FACTOR: f64 = 8.0;

/// Covariance of the local unknowns for residuals of unit variance: `(JᵀJ)⁻¹`.
///
/// `None` where the points leave an unknown free.
pub(super) fn covariance<const N: usize, M: Local<N>>(
    model: &M,
    points: &[Point],
) -> Option<SMatrix<f64, N, N>>
where
    Const<N>: DimMin<Const<N>, Output = Const<N>>,
{
    let (matrix, _) = normal_equations(model, points, &[]);
    // Curvatures and angles have different units: the diagonal makes them comparable.
    let scale = matrix.diagonal().map(|value| 1.0 / value.sqrt());
    if !scale.iter().all(|value| value.is_finite()) {
        return None;
    }
    let scale = SMatrix::from_diagonal(&scale);
    let scaled = scale * matrix * scale;
    // A direction without effect (the scale of ten coefficients) is held fast.
    let held = model.gauge().and_then(|g| (scale.try_inverse()? * g).try_normalize(0.0));
    let held = held.map_or(scaled, |g| scaled + g * g.transpose());
    let factor = held.cholesky()?;
    let least = factor.l_dirty().diagonal().min();
    (least * least > FREE).then(|| scale * factor.inverse() * scale)
}

/// Least squared pivot of scaled normal equations that is more than rounding.
const FREE: f64 = 1e-13;

/// Levenberg-Marquardt. Weights default to 1 where there are none.
pub(super) fn minimise<const N: usize, M: Local<N>>(
    mut model: M,
    points: &[Point],
    weights: &[f64],
    iterations: usize,
) -> (M, f64)
where
    Const<N>: DimMin<Const<N>, Output = Const<N>>,
{
    let mut damping = DAMPING;
    let mut cost = sum_of_squares(&model, points, weights);
    // Made where a step needs them: the last model takes none.
    let mut equations = None;
    for _ in 0..iterations {
        let (matrix, gradient) =
            *equations.get_or_insert_with(|| normal_equations(&model, points, weights));
        let mut damped = matrix;
        let floor = 1e-15 * matrix.diagonal().max();
        for i in 0..N {
            damped[(i, i)] += damping * matrix[(i, i)] + floor;
        }
        let candidate = damped.cholesky().and_then(|factor| model.moved(&-factor.solve(&gradient)));
        let trial =
            candidate.map(|candidate| (sum_of_squares(&candidate, points, weights), candidate));
        // What neither falls nor rises by more than rounding has arrived: damping would not help.
        let settled = trial.as_ref().is_some_and(|(now, _)| (cost - now).abs() <= PROGRESS * cost);
        match trial {
            Some((lower, candidate)) if lower <= cost => {
                (model, cost, equations) = (candidate, lower, None);
                damping = (damping / DAMPING_FACTOR).max(1e-12);
            }
            _ => {
                damping *= DAMPING_FACTOR;
                if damping > 1e6 {
                    break;
                }
            }
        }
        if settled {
            break;
        }
    }
    (model, cost)
}

/// Moves a surface to the least sum of squared orthogonal distances.
///
/// `weights` may be empty for equal weights. `None` where the fit degenerates (a radius that
/// vanishes or passes all bounds) or the surface is free-form.
pub fn refine(surface: &Surface, points: &[Point], weights: &[f64]) -> Option<Fit> {
    refine_within(surface, points, weights, ITERATIONS)
}

/// [`refine`] with at most so many iterations.
pub fn refine_within(
    surface: &Surface,
    points: &[Point],
    weights: &[f64],
    iterations: usize,
) -> Option<Fit> {
    let foot = foothold(surface, points)?;
    let (surface, cost) = match surface {
        Surface::Plane(s) => {
            let (m, cost) = minimise(LocalPlane::new(s, foot), points, weights, iterations);
            (m.surface()?, cost)
        }
        Surface::Sphere(s) => {
            let (m, cost) = minimise(LocalSphere::new(s, foot)?, points, weights, iterations);
            (m.surface()?, cost)
        }
        Surface::Cylinder(s) => {
            let (m, cost) = minimise(LocalCylinder::new(s, foot)?, points, weights, iterations);
            (m.surface()?, cost)
        }
        Surface::Cone(s) => {
            let (m, cost) = minimise(LocalCone::new(s, foot)?, points, weights, iterations);
            (m.surface()?, cost)
        }
        Surface::Torus(s) => {
            let (m, cost) = minimise(LocalTorus::new(s), points, weights, iterations);
            (m.surface()?, cost)
        }
        Surface::Quadric(s) => refine_quadric(s, points, weights, iterations)?,
        Surface::FreeForm => return None,
    };
    cost.is_finite().then_some(Fit { surface, cost })
}

/// Where a fit holds on to a surface: above the middle of the points, or, where that lies on an axis or
/// at a centre (after a full turn), at one of them. There normals are rounding, and a cone whose
/// normal is not at right angles to its generators comes out wrong by as much.
pub(super) fn foothold(surface: &Surface, points: &[Point]) -> Option<Point> {
    let middle = centroid(points)?;
    let radius = match surface {
        Surface::Sphere(s) => s.radius,
        Surface::Cylinder(s) => s.radius,
        Surface::Cone(s) => s.axis.dot(&(middle - s.apex)) * s.half_angle.sin(),
        _ => return Some(middle),
    };
    let inside = surface.distance(middle)? < -DEEP * radius;
    Some(if inside { points[points.len() / 2] } else { middle })
}

/// Share of the radius below the surface from which on a point lies on the axis.
const DEEP: f64 = 0.99;

/// The mean of the points; `None` without any.
pub fn centroid(points: &[Point]) -> Option<Point> {
    let sum: Vector = points.iter().map(|p| p.coords).sum();
    (!points.is_empty()).then(|| Point::from(sum / points.len() as f64))
}

/// A quadric near the data, whose distances are `f / |∇f|` (Taubin 1991): exact to first order, and
/// on points near the surface the orthogonal distance.
#[derive(Clone)]
pub(super) struct LocalQuadric {
    centre: Point,
    scale: f64,
    coefficients: SVector<f64, 10>,
}

impl LocalQuadric {
    pub(super) fn new(quadric: &Quadric, points: &[Point]) -> Option<Self> {
        let centre = centroid(points)?;
        let spread = points.iter().map(|p| (p - centre).norm_squared()).sum::<f64>();
        let scale = (spread / points.len() as f64).sqrt().max(1e-12);
        let local = quadric.transformed(&frame_at(centre, scale).inverse());
        let coefficients = SVector::from(local.coefficients).try_normalize(1e-300)?;
        Some(Self { centre, scale, coefficients })
    }

    pub(super) fn surface(&self) -> Option<Surface> {
        let local = Quadric { coefficients: self.coefficients.into() };
        Some(Surface::Quadric(local.transformed(&frame_at(self.centre, self.scale))))
    }
}

/// `1, x, y, z, x², xy, xz, y², yz, z²`.
fn monomials(p: Vector) -> SVector<f64, 10> {
    let (x, y, z) = (p.x, p.y, p.z);
    SVector::from([1.0, x, y, z, x * x, x * y, x * z, y * y, y * z, z * z])
}

/// `f / |∇f|` of a quadric at a point, the direction of the gradient, and the derivatives by the
/// coefficients.
pub(super) fn taubin_distance(c: &SVector<f64, 10>, p: Vector) -> (f64, Vector, SVector<f64, 10>) {
    let (x, y, z) = (p.x, p.y, p.z);
    let gradient = Vector::new(
        c[1] + 2.0 * c[4] * x + c[5] * y + c[6] * z,
        c[2] + c[5] * x + 2.0 * c[7] * y + c[8] * z,
        c[3] + c[6] * x + c[8] * y + 2.0 * c[9] * z,
    );
    let length = gradient.norm().max(1e-12);
    let monomials = monomials(p);
    let distance = c.dot(&monomials) / length;
    let n = gradient / length;
    // d/dc of f/|∇f|: the gradient's length changes with the coefficients too.
    let turn = SVector::from([
        0.0,
        n.x,
        n.y,
        n.z,
        2.0 * x * n.x,
        y * n.x + x * n.y,
        z * n.x + x * n.z,
        2.0 * y * n.y,
        z * n.y + y * n.z,
        2.0 * z * n.z,
    ]);
    (distance, n, (monomials - turn * distance) / length)
}

impl Local<10> for LocalQuadric {
    #[inline]
    fn residual(&self, points: Packet) -> (Lanes, [Lanes; 10]) {
        one_by_one(points, |point| {
            let p = (point - self.centre) / self.scale;
            let (distance, _, row) = taubin_distance(&self.coefficients, p);
            (distance * self.scale, row * self.scale)
        })
    }

    fn moved(&self, step: &SVector<f64, 10>) -> Option<Self> {
        // The scale of the coefficients is free: keep it at one.
        let coefficients = (self.coefficients + step).try_normalize(1e-12)?;
        Some(Self { coefficients, ..self.clone() })
    }

    fn gauge(&self) -> Option<SVector<f64, 10>> {
        Some(self.coefficients)
    }
}

/// World = centre + scale * local.
fn frame_at(centre: Point, scale: f64) -> Similarity {
    Similarity::from_parts(centre.coords.into(), UnitQuaternion::identity(), scale)
}

/// Within the family of the quadric.
fn refine_quadric(
    quadric: &Quadric,
    points: &[Point],
    weights: &[f64],
    iterations: usize,
) -> Option<(Surface, f64)> {
    let surface = match Family::of(quadric) {
        Family::General => {
            let start = LocalQuadric::new(quadric, points)?;
            minimise(start, points, weights, iterations).0.surface()?
        }
        held => held.refine(quadric, points, weights, iterations)?,
    };
    let weight = |i: usize| weights.get(i).copied().unwrap_or(1.0);
    let fitted = surface.quadric()?;
    let principal = fitted.principal();
    let square = |p: &Point| principal.distance(*p).powi(2);
    let cost = points.iter().enumerate().map(|(i, p)| weight(i) * square(p)).sum();
    Some((surface, cost))
}
