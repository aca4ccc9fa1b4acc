//! Surfaces seen from a foot: what [`super::refine`] moves.
//!
//! A step is a shift along the normal `m` at the foot `f`, a rotation about it, and a change of
//! curvature. Where a surface moves with velocity `v(x)`, the distance of `x` changes by `-n · v`,
//! `n` being the normal at the foot of `x`; for a rotation `n · (ω × (x - f)) = ω · ((x - f) × n)`.
//! Both are taken in a right-handed frame along the axis, where surfaces of revolution are plane.

use nalgebra::{SVector, UnitQuaternion};

use super::squares::Local;
use super::{Cone, Cylinder, Plane, Shape, Sphere, Surface, Torus};
use crate::math::lanes::{Lanes, Packet};
use crate::math::{Point, Unit, Vector, frame};

/// Surfaces of larger radius, in the unit of the points, are given up: they are planes.
const LARGEST_RADIUS: f64 = 1e4;

fn rotation(step: Vector) -> UnitQuaternion<f64> {
    UnitQuaternion::from_scaled_axis(step)
}

fn radius_of(curvature: f64) -> Option<f64> {
    let radius = 1.0 / curvature.abs();
    (radius.is_finite() && radius < LARGEST_RADIUS && radius > 1.0 / LARGEST_RADIUS.powi(2))
        .then_some(radius)
}

#[derive(Clone)]
pub(super) struct LocalPlane {
    foot: Point,
    normal: Unit,
    tangents: (Unit, Unit),
}

impl LocalPlane {
    pub(super) fn new(plane: &Plane, near: Point) -> Self {
        let foot = near - plane.normal.into_inner() * plane.distance(near);
        Self { foot, normal: plane.normal, tangents: frame(&plane.normal) }
    }

    pub(super) fn surface(&self) -> Option<Surface> {
        Some(Surface::Plane(Plane::through(self.foot, self.normal)))
    }
}

impl Local<3> for LocalPlane {
    #[inline(always)]
    fn residual(&self, points: Packet) -> (Lanes, [Lanes; 3]) {
        // In the frame of the normal and the tangents, where the normal's torque is plain.
        let offset = points.from(&self.foot);
        let (x, y) = (offset.dot(&self.tangents.0), offset.dot(&self.tangents.1));
        (offset.dot(&self.normal), [Lanes::splat(-1.0), -y, x])
    }

    fn moved(&self, step: &SVector<f64, 3>) -> Option<Self> {
        let foot = self.foot + self.normal.into_inner() * step[0];
        let (u, v) = (self.tangents.0.into_inner(), self.tangents.1.into_inner());
        let normal = rotation(u * step[1] + v * step[2]) * self.normal;
        Some(Self { foot, normal, tangents: frame(&normal) })
    }
}

/// Curvature is positive when the centre lies below the foot, against the normal.
#[derive(Clone)]
pub(super) struct LocalSphere {
    foot: Point,
    normal: Unit,
    tangents: (Unit, Unit),
    curvature: f64,
    center: Point,
    radius: f64,
}

impl LocalSphere {
    pub(super) fn new(sphere: &Sphere, near: Point) -> Option<Self> {
        let normal = sphere.normal(near)?;
        let foot = sphere.center + normal.into_inner() * sphere.radius;
        Self::at(foot, normal, 1.0 / sphere.radius)
    }

    fn at(foot: Point, normal: Unit, curvature: f64) -> Option<Self> {
        // A sphere that turned inside out is the one on the other side.
        let normal = if curvature < 0.0 { -normal } else { normal };
        let radius = radius_of(curvature)?;
        let center = foot - normal.into_inner() * radius;
        let curvature = curvature.abs();
        Some(Self { foot, normal, tangents: frame(&normal), curvature, center, radius })
    }

    pub(super) fn surface(&self) -> Option<Surface> {
        Some(Surface::Sphere(Sphere { center: self.center, radius: self.radius }))
    }
}

impl Local<4> for LocalSphere {
    #[inline(always)]
    fn residual(&self, points: Packet) -> (Lanes, [Lanes; 4]) {
        // In the frame of the tangents and the normal, about the centre.
        let offset = points.from(&self.center);
        let (x, y, z) =
            (offset.dot(&self.tangents.0), offset.dot(&self.tangents.1), offset.dot(&self.normal));
        let length = (x * x + y * y + z * z).sqrt();
        let scale = 1.0 / length.at_least(f64::MIN_POSITIVE);
        let lean = z * scale;
        // The foot is a radius above the centre: its torque is that of the offset, less its own.
        let (across, along) = (x * scale * self.radius, y * scale * self.radius);
        let row = [-lean, -along, across, self.radius * self.radius * (1.0 - lean)];
        (length - self.radius, row)
    }

    fn moved(&self, step: &SVector<f64, 4>) -> Option<Self> {
        let foot = self.foot + self.normal.into_inner() * step[0];
        let (u, v) = (self.tangents.0.into_inner(), self.tangents.1.into_inner());
        let normal = rotation(u * step[1] + v * step[2]) * self.normal;
        Self::at(foot, normal, self.curvature + step[3])
    }
}

#[derive(Clone)]
pub(super) struct LocalCylinder {
    foot: Point,
    normal: Unit,
    axis: Unit,
    across: Vector,
    curvature: f64,
    center: Point,
    radius: f64,
}

impl LocalCylinder {
    pub(super) fn new(cylinder: &Cylinder, near: Point) -> Option<Self> {
        let normal = cylinder.normal(near)?;
        let foot = near - normal.into_inner() * cylinder.distance(near);
        Self::at(foot, normal, cylinder.axis, 1.0 / cylinder.radius)
    }

    fn at(foot: Point, normal: Unit, axis: Unit, curvature: f64) -> Option<Self> {
        let normal = if curvature < 0.0 { -normal } else { normal };
        let radius = radius_of(curvature)?;
        let center = foot - normal.into_inner() * radius;
        let curvature = curvature.abs();
        let across = axis.cross(&normal);
        Some(Self { foot, normal, axis, across, curvature, center, radius })
    }

    pub(super) fn surface(&self) -> Option<Surface> {
        let (point, axis, radius) = (self.center, self.axis, self.radius);
        Some(Surface::Cylinder(Cylinder { point, axis, radius }))
    }
}

impl Local<5> for LocalCylinder {
    #[inline(always)]
    fn residual(&self, points: Packet) -> (Lanes, [Lanes; 5]) {
        // In the frame of normal, across and axis.
        let offset = points.from(&self.foot);
        let (x, y, z) =
            (offset.dot(&self.normal), offset.dot(&self.across), offset.dot(&self.axis));
        let from_axis = x + self.radius;
        let length = (from_axis * from_axis + y * y).sqrt();
        let scale = 1.0 / length.at_least(f64::MIN_POSITIVE);
        let n = [from_axis * scale, y * scale];
        let row = [
            -n[0],
            y * n[0] - x * n[1],
            -z * n[0],
            z * n[1],
            self.radius * self.radius * (1.0 - n[0]),
        ];
        (length - self.radius, row)
    }

    fn moved(&self, step: &SVector<f64, 5>) -> Option<Self> {
        let foot = self.foot + self.normal.into_inner() * step[0];
        let axis = self.axis.into_inner();
        let turn = axis * step[1] + self.across * step[2] + self.normal.into_inner() * step[3];
        let turn = rotation(turn);
        let normal = turn * self.normal;
        // Rounding must not let the axis lean against the normal.
        let axis = turn * axis;
        let axis = Unit::try_new(axis - normal.into_inner() * normal.dot(&axis), 0.5)?;
        Self::at(foot, normal, axis, self.curvature + step[4])
    }
}

/// A cone by its axis, which passes the centre of curvature `f - m/κ`, and its normal at the foot.
///
/// With `s = m · a = -sin α`, `h` and `r` the height and radius of `x` seen from that centre, the
/// signed distance is `r cos α + s h - 1/κ`.
#[derive(Clone)]
pub(super) struct LocalCone {
    foot: Point,
    normal: Unit,
    axis: Unit,
    curvature: f64,
    center: Point,
    sine: f64,
    cosine: f64,
    /// The tangents at the foot: across the generator and along it.
    across: Vector,
    along: Vector,
    /// From the axis towards the normal, at right angles.
    outward: Vector,
}

/// Cones closer to a cylinder or a plane than this (sine or cosine of the half angle) are given up.
const CONE_LIMIT: f64 = 1e-4;

impl LocalCone {
    pub(super) fn new(cone: &Cone, near: Point) -> Option<Self> {
        let normal = cone.normal(near)?;
        let foot = near - normal.into_inner() * cone.distance(near);
        let height = cone.axis.dot(&(foot - cone.apex));
        // Behind the apex there is no generator to hold on to.
        let radius = height * cone.half_angle.tan();
        (radius > 0.0)
            .then(|| Self::at(foot, normal, cone.axis, cone.half_angle.cos() / radius))
            .flatten()
    }

    fn at(foot: Point, normal: Unit, axis: Unit, curvature: f64) -> Option<Self> {
        let normal = if curvature < 0.0 { -normal } else { normal };
        let curvature = curvature.abs();
        radius_of(curvature)?;
        // The axis points from the apex into the nappe: against the outward normal.
        let axis = if axis.dot(&normal) > 0.0 { -axis } else { axis };
        let sine = normal.dot(&axis);
        let cosine = (1.0 - sine * sine).max(0.0).sqrt();
        let center = foot - normal.into_inner() / curvature;
        let across = axis.cross(&normal) / cosine;
        let along = normal.cross(&across);
        let outward = (normal.into_inner() - axis.into_inner() * sine) / cosine;
        let cone =
            Self { foot, normal, axis, curvature, center, sine, cosine, across, along, outward };
        (cosine > CONE_LIMIT).then_some(cone)
    }

    pub(super) fn surface(&self) -> Option<Surface> {
        if self.sine > -CONE_LIMIT {
            return None;
        }
        let apex = self.center + self.axis.into_inner() / (self.curvature * self.sine);
        let half_angle = (-self.sine).atan2(self.cosine);
        Some(Surface::Cone(Cone { apex, axis: self.axis, half_angle }))
    }
}

impl Local<6> for LocalCone {
    #[inline(always)]
    fn residual(&self, points: Packet) -> (Lanes, [Lanes; 6]) {
        // In the frame of outward, across and axis.
        let offset = points.from(&self.center);
        let (x, y, h) =
            (offset.dot(&self.outward), offset.dot(&self.across), offset.dot(&self.axis));
        let (sine, cosine, radius) = (self.sine, self.cosine, 1.0 / self.curvature);
        let r = (x * x + y * y).sqrt().at_least(f64::MIN_POSITIVE);
        let distance = r * cosine + sine * h - radius;
        let scale = cosine / r;
        let n = Packet { x: x * scale, y: y * scale, z: Lanes::splat(sine) };
        let torque = Packet { x: x - cosine * radius, y, z: h - sine * radius }.cross(n);
        let lift = 1.0 - (cosine * n.x + sine * sine);
        let row = [
            lift - 1.0,
            sine * torque.x - cosine * torque.z,
            -torque.y,
            -cosine * torque.x - sine * torque.z,
            lift * radius * radius,
            // The axis turns about the centre, towards the normal: the half angle changes alone.
            cosine * h - sine * r + (sine - h * scale) * x,
        ];
        (distance, row)
    }

    fn moved(&self, step: &SVector<f64, 6>) -> Option<Self> {
        let (axis, m) = (self.axis.into_inner(), self.normal.into_inner());
        let foot = self.foot + m * step[0];
        let turn = rotation(self.along * step[1] + self.across * step[2] + m * step[3]);
        let axis = Unit::try_new(axis + self.outward * step[5].clamp(-0.5, 0.5), 0.1)?;
        Self::at(foot, turn * self.normal, turn * axis, self.curvature + step[4])
    }
}

#[derive(Clone)]
pub(super) struct LocalTorus {
    torus: Torus,
    tangents: (Unit, Unit),
}

impl LocalTorus {
    pub(super) fn new(torus: &Torus) -> Self {
        Self { tangents: frame(&torus.axis), torus: torus.clone() }
    }

    pub(super) fn surface(&self) -> Option<Surface> {
        Some(Surface::Torus(self.torus.clone()))
    }
}

impl Local<7> for LocalTorus {
    #[inline(always)]
    fn residual(&self, points: Packet) -> (Lanes, [Lanes; 7]) {
        // In the frame of the tangents and the axis.
        let torus = &self.torus;
        let offset = points.from(&torus.center);
        let (u, v) = (&self.tangents.0, &self.tangents.1);
        let (x, y, h) = (offset.dot(u), offset.dot(v), offset.dot(&torus.axis));
        let r = (x * x + y * y).sqrt().at_least(f64::MIN_POSITIVE);
        let across = r - torus.major_radius;
        let tube = (across * across + h * h).sqrt();
        let inverse = 1.0 / tube.at_least(f64::MIN_POSITIVE);
        let outward = across * inverse;
        let scale = outward / r;
        let n = [x * scale, y * scale, h * inverse];
        let along = |axis: usize| u[axis] * n[0] + v[axis] * n[1] + torus.axis[axis] * n[2];
        let turn = [h * n[1] - y * n[2], x * n[2] - h * n[0]];
        let row = [-along(0), -along(1), -along(2), turn[0], turn[1], -outward, Lanes::splat(-1.0)];
        (tube - torus.minor_radius, row)
    }

    fn moved(&self, step: &SVector<f64, 7>) -> Option<Self> {
        let center = self.torus.center + step.fixed_rows::<3>(0);
        let (u, v) = (self.tangents.0.into_inner(), self.tangents.1.into_inner());
        let axis = rotation(u * step[3] + v * step[4]) * self.torus.axis;
        let major_radius = self.torus.major_radius + step[5];
        let minor_radius = self.torus.minor_radius + step[6];
        radius_of(1.0 / minor_radius)?;
        radius_of(1.0 / major_radius)?;
        // From one sheet to the other leads a sphere, which is another type.
        (major_radius * self.torus.major_radius > 0.0 && minor_radius > 0.0)
            .then(|| Self::new(&Torus { center, axis, major_radius, minor_radius }))
    }
}
