//! Families of general quadrics with less freedom: cones, paraboloids, cylinders.
//!
//! A free fit to noisy points is an ellipsoid or a hyperboloid: the other classes miss a coefficient,
//! and under noise none vanishes. Each family is therefore fitted on its own, in a frame that moves
//! while the coefficients that its members miss there stay zero.

use nalgebra::{Const, DimMin, Matrix3, Rotation3, SVector, UnitQuaternion};

use super::refine::{centroid, minimise, taubin_distance};
use super::squares::{Local, one_by_one};
use super::start::{self, Samples};
use super::{Quadric, Surface, revolved};
use crate::math::lanes::{Lanes, Packet};
use crate::math::{Point, Similarity, Unit, Vector, frame};

/// What is held when a quadric is fitted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Family {
    /// Nothing: ellipsoids and hyperboloids.
    General,
    /// Straight lines through one point.
    Cone,
    /// A parabola in the planes through an axis.
    Paraboloid,
    /// Straight along an axis, a conic across.
    Cylinder,
    /// Straight along an axis, a parabola across.
    ParabolicCylinder,
    /// An ellipse or a hyperbola turned about an axis of its own.
    Revolved,
    /// A parabola turned about its axis.
    RevolvedParaboloid,
}

/// Families that hold something.
pub const HELD: [Family; 6] = [
    Family::Cone,
    Family::Paraboloid,
    Family::Cylinder,
    Family::ParabolicCylinder,
    Family::Revolved,
    Family::RevolvedParaboloid,
];

/// Curvatures, slopes and levels below this fraction of the largest curvature of a quadric in the
/// unit cube are held at zero: rounding leaves 1e-14 of them, a free fit to rounded points 1e-7.
const ZERO: f64 = 1e-10;
/// Iterations of a trial from one of several frames, and of the fit that decides.
const TRIAL_ITERATIONS: usize = 4;
const FINAL_ITERATIONS: usize = 25;

/// What may change: a coefficient of the frame, that of x² and y² together, or the frame by a turn or
/// a shift along its axes.
#[derive(Clone, Copy)]
enum Unknown {
    Coefficient(usize),
    Round,
    Turn(usize),
    Shift(usize),
}
use Unknown::{Coefficient as C, Round, Shift, Turn};

/// The coefficients of x² and y², equal where z is an axis of revolution.
const ROUND: [usize; 2] = [4, 7];

// Coefficients count from the constant: 1 to 3 are x, y, z; 4, 5, 7, 9 are x², xy, y², z².
const CONE: [Unknown; 9] = [C(4), C(5), C(6), C(7), C(8), C(9), Shift(0), Shift(1), Shift(2)];
const PARABOLOID: [Unknown; 9] = [C(0), C(1), C(2), C(3), C(4), C(5), C(7), Turn(0), Turn(1)];
const CYLINDER: [Unknown; 8] = [C(0), C(1), C(2), C(4), C(5), C(7), Turn(0), Turn(1)];
const REVOLVED: [Unknown; 8] = [C(0), C(3), Round, C(9), Turn(0), Turn(1), Shift(0), Shift(1)];
const REVOLVED_PARABOLOID: [Unknown; 7] = [C(0), C(3), Round, Turn(0), Turn(1), Shift(0), Shift(1)];
const PARABOLIC_CYLINDER: [Unknown; 7] = [C(0), C(1), C(2), C(4), Turn(0), Turn(1), Turn(2)];

impl Family {
    /// The family that a quadric in the unit cube was held to.
    pub fn of(quadric: &Quadric) -> Self {
        let (constant, linear, form) = quadric.parts();
        let (values, axes) = by_curvature(&form);
        let zero = ZERO * values[0].abs();
        let slopes = axes.map(|axis| axis.dot(&linear));
        let level = |rank: usize| {
            constant - (0..rank).map(|i| slopes[i].powi(2) / (4.0 * values[i])).sum::<f64>()
        };
        let rank = values.iter().filter(|value| value.abs() > zero).count();
        let equal = |i: usize, j: usize| (values[i] - values[j]).abs() <= zero;
        match rank {
            3 if level(3).abs() <= zero => Self::Cone,
            3 if equal(0, 1) || equal(1, 2) || equal(0, 2) => Self::Revolved,
            2 if slopes[2].abs() > zero && equal(0, 1) => Self::RevolvedParaboloid,
            2 if slopes[2].abs() > zero => Self::Paraboloid,
            2 => Self::Cylinder,
            1 => Self::ParabolicCylinder,
            _ => Self::General,
        }
    }

    /// Degrees of freedom.
    pub fn freedom(self) -> usize {
        // The scale of the coefficients is free.
        match self {
            Self::General => 9,
            _ => self.unknowns().len() - 1,
        }
    }

    fn unknowns(self) -> &'static [Unknown] {
        match self {
            Self::General => &[],
            Self::Cone => &CONE,
            Self::Paraboloid => &PARABOLOID,
            Self::Cylinder => &CYLINDER,
            Self::ParabolicCylinder => &PARABOLIC_CYLINDER,
            Self::Revolved => &REVOLVED,
            Self::RevolvedParaboloid => &REVOLVED_PARABOLOID,
        }
    }

    /// Whether a coefficient is one of the unknowns.
    fn has(self, coefficient: usize) -> bool {
        self.unknowns().iter().any(|unknown| match unknown {
            C(own) => *own == coefficient,
            Round => ROUND.contains(&coefficient),
            Turn(_) | Shift(_) => false,
        })
    }

    /// Whether the members are surfaces of revolution.
    pub(super) fn is_revolved(self) -> bool {
        matches!(self, Self::Revolved | Self::RevolvedParaboloid)
    }

    /// The member of least squared distance, started near a quadric; `None` where there is none.
    pub fn fit(self, near: &Quadric, samples: Samples) -> Option<Quadric> {
        let trial = |frame: Similarity| {
            let start = start::quadric_in(samples.points, &frame, |i| self.has(i))?;
            self.minimised(&start, frame, samples.points, &[], TRIAL_ITERATIONS)
        };
        let trials = self.frames(near, samples).into_iter().filter_map(trial);
        let (best, frame, _) = trials.min_by(|a, b| a.2.total_cmp(&b.2))?;
        let (local, frame, _) =
            self.minimised(&best, frame, samples.points, &[], FINAL_ITERATIONS)?;
        Some(local.transformed(&frame))
    }

    /// Moves a member to the least weighted sum of squared distances, within the family.
    pub(super) fn refine(
        self,
        quadric: &Quadric,
        points: &[Point],
        weights: &[f64],
        iterations: usize,
    ) -> Option<Surface> {
        let frame = self.own_frame(quadric, points)?;
        let local = quadric.transformed(&frame.inverse());
        let (local, frame, _) = self.minimised(&local, frame, points, weights, iterations)?;
        Some(Surface::Quadric(local.transformed(&frame)))
    }

    fn minimised(
        self,
        local: &Quadric,
        frame: Similarity,
        points: &[Point],
        weights: &[f64],
        iterations: usize,
    ) -> Option<(Quadric, Similarity, f64)> {
        let mut held = SVector::from(local.coefficients);
        (0..10).filter(|&i| !self.has(i)).for_each(|i| held[i] = 0.0);
        if self.is_revolved() {
            let mean = ROUND.map(|i| held[i]).iter().sum::<f64>() / 2.0;
            ROUND.into_iter().for_each(|i| held[i] = mean);
        }
        let coefficients = held.try_normalize(1e-300)?;
        let job = Job { coefficients, frame, points, weights, iterations };
        let found = match self {
            Self::General => return None,
            Self::Cone => job.run(&CONE),
            Self::Paraboloid => job.run(&PARABOLOID),
            Self::Cylinder => job.run(&CYLINDER),
            Self::ParabolicCylinder => job.run(&PARABOLIC_CYLINDER),
            Self::Revolved => job.run(&REVOLVED),
            Self::RevolvedParaboloid => job.run(&REVOLVED_PARABOLOID),
        };
        found.2.is_finite().then_some(found)
    }

    /// The frame in which the coefficients that a member misses are zero.
    fn own_frame(self, quadric: &Quadric, points: &[Point]) -> Option<Similarity> {
        let axes = by_curvature(&quadric.parts().2).1;
        match self {
            Self::General => None,
            Self::Cone => at(apex(quadric)?, UnitQuaternion::identity(), points),
            Self::Paraboloid | Self::Cylinder => at(centroid(points)?, along(axes[2]), points),
            Self::ParabolicCylinder => {
                let slope = quadric.gradient(centroid(points)?);
                let across = slope - axes[0] * axes[0].dot(&slope);
                let across = across.try_normalize(1e-300).unwrap_or(axes[1]);
                let turn = Matrix3::from_columns(&[axes[0], across, axes[0].cross(&across)]);
                let turn = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix(&turn));
                at(centroid(points)?, turn, points)
            }
            Self::Revolved | Self::RevolvedParaboloid => {
                upright(quadric, revolved::odd(&quadric.parts().2), points)
            }
        }
    }

    /// Frames in which members near the points may lie.
    fn frames(self, near: &Quadric, samples: Samples) -> Vec<Similarity> {
        let points = samples.points;
        let mut frames: Vec<Similarity> = self.own_frame(near, points).into_iter().collect();
        match self {
            Self::Cone => {
                let apex = start::common_point(samples);
                frames.extend(apex.and_then(|p| at(p, UnitQuaternion::identity(), points)));
            }
            Self::Paraboloid | Self::Cylinder => {
                let axes = start::axes(samples).into_iter();
                frames.extend(axes.filter_map(|a| at(centroid(points)?, along(*a), points)));
            }
            Self::Revolved | Self::RevolvedParaboloid => {
                let axes = by_curvature(&near.parts().2).1.into_iter();
                frames.extend(axes.filter_map(|axis| upright(near, axis, points)));
            }
            Self::General | Self::ParabolicCylinder => {}
        }
        frames
    }
}

/// A frame that stands on an axis of a quadric, beside the points.
fn upright(quadric: &Quadric, axis: Vector, points: &[Point]) -> Option<Similarity> {
    let axis = Unit::try_new(axis, 1e-300)?;
    at(revolved::foot(quadric, &axis, centroid(points)?)?, along(axis.into_inner()), points)
}

/// Eigenvalues of a form and their directions, the largest first, whatever their signs.
fn by_curvature(form: &Matrix3<f64>) -> ([f64; 3], [Vector; 3]) {
    let eigen = form.symmetric_eigen();
    let size = |i: usize| eigen.eigenvalues[i].abs();
    let mut order = [0, 1, 2];
    order.sort_by(|&i, &j| size(j).total_cmp(&size(i)).then(i.cmp(&j)));
    let axis = |i: usize| eigen.eigenvectors.column(i).into_owned();
    (order.map(|i| eigen.eigenvalues[i]), order.map(axis))
}

/// The centre of a quadric, which is the apex where it is a cone.
fn apex(quadric: &Quadric) -> Option<Point> {
    let (_, linear, form) = quadric.parts();
    let center = form.lu().solve(&(linear / -2.0))?;
    center.iter().all(|c| c.is_finite()).then(|| Point::from(center))
}

/// Turns the third axis of a frame to a direction.
fn along(axis: Vector) -> UnitQuaternion<f64> {
    let axis = Unit::new_normalize(axis);
    let (u, v) = frame(&axis);
    let turn = Matrix3::from_columns(&[u.into_inner(), v.into_inner(), axis.into_inner()]);
    UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(turn))
}

/// A frame in which the points are of unit size.
fn at(centre: Point, turn: UnitQuaternion<f64>, points: &[Point]) -> Option<Similarity> {
    let middle = centroid(points)?;
    let spread = points.iter().map(|p| (p - middle).norm_squared()).sum::<f64>();
    let scale = (spread / points.len() as f64).sqrt().max(1e-12);
    Some(Similarity::from_parts(centre.coords.into(), turn, scale))
}

/// A fit to be done.
struct Job<'a> {
    coefficients: SVector<f64, 10>,
    frame: Similarity,
    points: &'a [Point],
    weights: &'a [f64],
    iterations: usize,
}

impl Job<'_> {
    fn run<const N: usize>(self, unknowns: &'static [Unknown; N]) -> (Quadric, Similarity, f64)
    where
        Const<N>: DimMin<Const<N>, Output = Const<N>>,
    {
        let model = Held { coefficients: self.coefficients, frame: self.frame, unknowns };
        let (model, cost) = minimise(model, self.points, self.weights, self.iterations);
        (Quadric { coefficients: model.coefficients.into() }, model.frame, cost)
    }
}

/// A member in its frame, whose distances are `f / |∇f|` as those of a free quadric.
#[derive(Clone)]
struct Held<const N: usize> {
    coefficients: SVector<f64, 10>,
    frame: Similarity,
    unknowns: &'static [Unknown; N],
}

impl<const N: usize> Local<N> for Held<N> {
    #[inline]
    fn residual(&self, points: Packet) -> (Lanes, [Lanes; N]) {
        one_by_one(points, |point| {
            let p = self.frame.inverse_transform_point(&point).coords;
            let (distance, normal, row) = taubin_distance(&self.coefficients, p);
            let torque = p.cross(&normal);
            let slope = |unknown: Unknown| match unknown {
                C(i) => row[i],
                Round => ROUND.map(|i| row[i]).iter().sum(),
                Turn(axis) => -torque[axis],
                Shift(axis) => -normal[axis],
            };
            let scale = self.frame.scaling();
            (distance * scale, SVector::from_fn(|i, _| slope(self.unknowns[i]) * scale))
        })
    }

    fn moved(&self, step: &SVector<f64, N>) -> Option<Self> {
        let mut coefficients = self.coefficients;
        let (mut turn, mut shift) = (Vector::zeros(), Vector::zeros());
        for (unknown, step) in self.unknowns.iter().zip(step.iter()) {
            match *unknown {
                C(i) => coefficients[i] += step,
                Round => ROUND.into_iter().for_each(|i| coefficients[i] += step),
                Turn(axis) => turn[axis] = *step,
                Shift(axis) => shift[axis] = *step,
            }
        }
        let isometry =
            nalgebra::Isometry3::from_parts(shift.into(), UnitQuaternion::from_scaled_axis(turn));
        // The scale of the coefficients is free: keep it at one.
        let coefficients = coefficients.try_normalize(1e-12)?;
        Some(Self { coefficients, frame: self.frame * isometry, unknowns: self.unknowns })
    }
}
