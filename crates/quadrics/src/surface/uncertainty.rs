//! How well the parameters of a fitted surface are known.
//!
//! The covariance of the fit's local unknowns (see [`super::refine`]) is carried over to the named
//! parameters by their derivatives, taken by central differences.

use nalgebra::{Const, DMatrix, DVector, DimMin, SMatrix, SVector};

use super::Surface;
use super::kind::kind;
use super::local::{LocalCone, LocalCylinder, LocalPlane, LocalSphere, LocalTorus};
use super::refine::{LocalQuadric, covariance, foothold};
use super::squares::Local;
use crate::math::{Point, Similarity, Vector};

/// Step of the differences: angles in radians, lengths in sizes, curvatures in themselves.
const STEP: f64 = 1e-6;

/// Standard deviation of every parameter of `surface`, fitted to `points` that err by `sigma` each,
/// independently.
///
/// Points lie in the unit cube; the parameters are those in the frame that `out` leads to. Of a
/// vector it is the root mean square angle in degrees, of a point the root mean square distance (to a
/// cylinder's axis, not along it), of semi-axes the root mean square over all. Empty where the points
/// leave the surface undetermined.
pub fn uncertainty(
    surface: &Surface,
    points: &[Point],
    sigma: f64,
    out: &Similarity,
) -> Vec<(&'static str, f64)> {
    of(surface, points, sigma, out).unwrap_or_default()
}

fn of(
    surface: &Surface,
    points: &[Point],
    sigma: f64,
    out: &Similarity,
) -> Option<Vec<(&'static str, f64)>> {
    let near = foothold(surface, points)?;
    let spread = Spread { points, sigma, out };
    match surface {
        Surface::Plane(s) => spread.named(LocalPlane::new(s, near), LocalPlane::surface, [STEP; 3]),
        Surface::Sphere(s) => {
            let steps = [STEP, STEP, STEP, STEP / s.radius];
            spread.named(LocalSphere::new(s, near)?, LocalSphere::surface, steps)
        }
        Surface::Cylinder(s) => {
            let steps = [STEP, STEP, STEP, STEP, STEP / s.radius];
            spread.named(LocalCylinder::new(s, near)?, LocalCylinder::surface, steps)
        }
        Surface::Cone(s) => {
            let curvature =
                s.half_angle.cos() / (s.axis.dot(&(near - s.apex)) * s.half_angle.tan());
            let steps = [STEP, STEP, STEP, STEP, STEP * curvature.abs(), STEP];
            spread.named(LocalCone::new(s, near)?, LocalCone::surface, steps)
        }
        Surface::Torus(s) => spread.named(LocalTorus::new(s), LocalTorus::surface, [STEP; 7]),
        Surface::Quadric(s) => {
            spread.named(LocalQuadric::new(s, points)?, LocalQuadric::surface, [STEP; 10])
        }
        Surface::FreeForm => None,
    }
}

struct Spread<'a> {
    points: &'a [Point],
    sigma: f64,
    out: &'a Similarity,
}

impl Spread<'_> {
    fn named<const N: usize, M: Local<N>>(
        &self,
        model: M,
        surface: impl Fn(&M) -> Option<Surface>,
        steps: [f64; N],
    ) -> Option<Vec<(&'static str, f64)>>
    where
        Const<N>: DimMin<Const<N>, Output = Const<N>>,
    {
        let covariance: SMatrix<f64, N, N> = covariance(&model, self.points)?;
        let covariance = covariance * (self.sigma * self.sigma);
        let covariance = DMatrix::from_column_slice(N, N, covariance.as_slice());
        let moved = |unknown: usize, step: f64| {
            let mut along = SVector::<f64, N>::zeros();
            along[unknown] = step;
            surface(&model.moved(&along)?)
        };
        let both = |unknown: usize| {
            let step = steps[unknown];
            Some(([moved(unknown, step)?, moved(unknown, -step)?], step))
        };
        let moved = (0..N).map(both).collect::<Option<Vec<_>>>()?;
        carried(&surface(&model)?, &moved, &covariance, self.out)
    }
}

/// How a surface moves with its unknowns, and how well those are known.
#[derive(Debug, Clone)]
pub struct Scatter {
    /// Covariance of the unknowns.
    pub covariance: DMatrix<f64>,
    /// The surface after each unknown became larger, and smaller, by [`Scatter::step`].
    pub moved: Vec<[Surface; 2]>,
    /// Step of the differences.
    pub step: f64,
}

impl Scatter {
    /// Standard deviation of every parameter of the surface, as [`uncertainty`] gives it.
    pub fn uncertainty(&self, surface: &Surface, out: &Similarity) -> Vec<(&'static str, f64)> {
        let moved: Vec<_> = self.moved.iter().map(|both| (both.clone(), self.step)).collect();
        carried(surface, &moved, &self.covariance, out).unwrap_or_default()
    }
}

/// From the covariance of unknowns to the parameters: `moved` has the surface on both sides of every
/// unknown, and the step to them.
fn carried(
    surface: &Surface,
    moved: &[([Surface; 2], f64)],
    covariance: &DMatrix<f64>,
    out: &Similarity,
) -> Option<Vec<(&'static str, f64)>> {
    let seen = |surface: &Surface| parameters(&surface.transformed(out), out.scaling());
    let here = seen(surface);
    let zero = DVector::<f64>::zeros(moved.len());
    let mut derivatives: Vec<Vec<DVector<f64>>> =
        here.iter().map(|known| vec![zero.clone(); known.numbers.len()]).collect();
    for (unknown, ([more, less], step)) in moved.iter().enumerate() {
        let (more, less) = (seen(more), seen(less));
        for (known, rows) in derivatives.iter_mut().enumerate() {
            for (number, row) in rows.iter_mut().enumerate() {
                let of = |there: &[Named]| there.get(known)?.numbers.get(number).copied();
                row[unknown] = (of(&more)? - of(&less)?) / (2.0 * step);
            }
        }
    }
    let deviation = |(known, rows): (&Named, &Vec<DVector<f64>>)| {
        let rows = across(known, rows);
        let variance: f64 = rows.iter().map(|row| row.dot(&(covariance * row))).sum();
        (known.name, (variance / known.share()).max(0.0).sqrt() * known.unit())
    };
    let found: Vec<_> = here.iter().zip(&derivatives).map(deviation).collect();
    found.iter().all(|(_, value)| value.is_finite()).then_some(found)
}

/// What the numbers of a parameter are.
enum What {
    Direction,
    Position,
    /// A point that may slide along a direction.
    OnAxis(Vector),
    Length,
    Angle,
}

/// A parameter by its name in the result files, radians for angles.
struct Named {
    name: &'static str,
    what: What,
    numbers: Vec<f64>,
}

impl Named {
    fn new(name: &'static str, what: What, numbers: &[f64]) -> Self {
        Self { name, what, numbers: numbers.to_vec() }
    }

    /// Degrees for what is an angle.
    fn unit(&self) -> f64 {
        match self.what {
            What::Direction | What::Angle => 1f64.to_degrees(),
            _ => 1.0,
        }
    }

    /// The variances of several lengths are averaged, those of coordinates summed.
    fn share(&self) -> f64 {
        if matches!(self.what, What::Length) { self.numbers.len() as f64 } else { 1.0 }
    }
}

/// Derivatives without their part along the axis that a point may slide on.
fn across(known: &Named, rows: &[DVector<f64>]) -> Vec<DVector<f64>> {
    let What::OnAxis(axis) = known.what else { return rows.to_vec() };
    let along = &rows[0] * axis.x + &rows[1] * axis.y + &rows[2] * axis.z;
    rows.iter().zip(axis.iter()).map(|(row, part)| row - &along * *part).collect()
}

/// Every parameter of a surface in a part of that size.
fn parameters(surface: &Surface, size: f64) -> Vec<Named> {
    let direction = |name, v: &Vector| Named::new(name, What::Direction, v.as_slice());
    let position = |name, p: &Point| Named::new(name, What::Position, p.coords.as_slice());
    let length = |name, value: f64| Named::new(name, What::Length, &[value]);
    match surface {
        Surface::Plane(s) => vec![direction("normal", &s.normal), length("offset", s.offset)],
        Surface::Sphere(s) => vec![position("center", &s.center), length("radius", s.radius)],
        Surface::Cylinder(s) => vec![
            Named::new("point", What::OnAxis(s.axis.into_inner()), s.point.coords.as_slice()),
            direction("axis", &s.axis),
            length("radius", s.radius),
        ],
        Surface::Cone(s) => vec![
            position("apex", &s.apex),
            direction("axis", &s.axis),
            Named::new("half_angle_deg", What::Angle, &[s.half_angle]),
        ],
        Surface::Torus(s) => vec![
            position("center", &s.center),
            direction("axis", &s.axis),
            length("major_radius", s.major_radius),
            length("minor_radius", s.minor_radius),
        ],
        Surface::Quadric(s) => {
            let kind = kind(s, size);
            let center = kind.center.iter().map(|p| position("center", p));
            let semi_axes = (!kind.semi_axes.is_empty())
                .then(|| Named::new("semi_axes", What::Length, &kind.semi_axes));
            center.chain(semi_axes).collect()
        }
        Surface::FreeForm => Vec::new(),
    }
}
