//! Quadrics of revolution by their axis and profile.

use nalgebra::{Matrix2, Matrix3, Vector2};

use super::Quadric;
use super::family::Family;
use crate::math::{Point, Unit, Vector, frame};

/// `ρ² + profile(z) = 0`, where `ρ` is the distance from the axis and `z` the height above `point`.
#[derive(Debug, Clone, PartialEq)]
pub struct Revolved {
    /// A point on the axis.
    pub point: Point,
    /// Direction of the axis.
    pub axis: Unit,
    /// Coefficients of 1, z and z²; of a paraboloid of 1 and z.
    pub profile: Vec<f64>,
    /// Coefficient of `ρ²` in the quadric; its sign says which side is outside.
    pub factor: f64,
}

/// Of an axis the direction on this side is its direction: at right angles to no axis that a part
/// stands along.
const ASIDE: Vector = Vector::new(0.83, 0.51, 0.23);

impl Revolved {
    /// A quadric in the unit cube by its axis, at the foot of the origin; `None` where it is none of
    /// revolution, or one of the simpler types.
    pub fn of(quadric: &Quadric) -> Option<Self> {
        let family = Family::of(quadric);
        if !family.is_revolved() {
            return None;
        }
        let (_, _, form) = quadric.parts();
        let axis = Unit::try_new(odd(&form), 1e-300)?;
        let axis = if axis.dot(&ASIDE) < 0.0 { -axis } else { axis };
        let point = foot(quadric, &axis, Point::origin())?;
        let factor = (form.trace() - axis.dot(&(form * axis.into_inner()))) / 2.0;
        let mut profile =
            vec![quadric.value(point) / factor, axis.dot(&quadric.gradient(point)) / factor];
        if family == Family::Revolved {
            profile.push(axis.dot(&(form * axis.into_inner())) / factor);
        }
        Some(Self { point, axis, profile, factor })
    }

    /// The same with the direction of its axis on the side of another.
    pub fn along(self, direction: &Vector) -> Self {
        if self.axis.dot(direction) >= 0.0 {
            return self;
        }
        let turned = |(power, value): (usize, f64)| if power == 1 { -value } else { value };
        let profile = self.profile.into_iter().enumerate().map(turned).collect();
        Self { axis: -self.axis, profile, ..self }
    }

    /// The same with heights above another point of the axis.
    pub fn from(self, point: Point) -> Self {
        let up = self.axis.dot(&(point - self.point));
        let bend = self.profile.get(2).copied().unwrap_or_default();
        let mut profile = self.profile;
        profile[0] += (profile[1] + bend * up) * up;
        profile[1] += 2.0 * bend * up;
        Self { point, profile, ..self }
    }

    /// Its ten coefficients.
    pub fn quadric(&self) -> Quadric {
        let axis = self.axis.into_inner();
        let bend = self.profile.get(2).copied().unwrap_or_default();
        let form = Matrix3::identity() + axis * axis.transpose() * (bend - 1.0);
        let at = self.point.coords;
        let linear = axis * self.profile[1] - form * at * 2.0;
        let constant = self.profile[0] - self.profile[1] * axis.dot(&at) + at.dot(&(form * at));
        Quadric::from_parts(constant * self.factor, linear * self.factor, form * self.factor)
    }
}

/// The principal direction whose curvature differs most from the other two.
pub(super) fn odd(form: &Matrix3<f64>) -> Vector {
    let eigen = form.symmetric_eigen();
    let value = |i: usize| eigen.eigenvalues[i % 3];
    let apart = |i: &usize| (value(i + 1) - value(i + 2)).abs();
    let most = (0..3).min_by(|i, j| apart(i).total_cmp(&apart(j))).unwrap_or(2);
    eigen.eigenvectors.column(most).into_owned()
}

/// The point of a quadric's principal axis of that direction nearest to another; `None` where the
/// quadric has no such axis.
pub(super) fn foot(quadric: &Quadric, direction: &Unit, near: Point) -> Option<Point> {
    let (_, _, form) = quadric.parts();
    let (u, v) = frame(direction);
    let across = [u.into_inner(), v.into_inner()];
    let bent = Matrix2::from_fn(|i, j| across[i].dot(&(form * across[j])));
    let slope = quadric.gradient(near);
    let shift = bent.lu().solve(&Vector2::from(across.map(|axis| -axis.dot(&slope) / 2.0)))?;
    shift.iter().all(|s| s.is_finite()).then(|| near + across[0] * shift.x + across[1] * shift.y)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn revolved(profile: &[f64]) -> Revolved {
        let axis = Unit::new_normalize(Vector::new(0.3, -0.2, 1.0));
        let point = foot_of_origin(Point::new(0.4, 0.5, 0.6), axis);
        Revolved { point, axis, profile: profile.to_vec(), factor: -2.0 }
    }

    fn foot_of_origin(point: Point, axis: Unit) -> Point {
        point - axis.into_inner() * axis.dot(&point.coords)
    }

    #[test]
    fn axis_and_profile_come_back() {
        for profile in [&[-0.04, 0.02, 0.5][..], &[-0.04, 0.1, -0.7], &[-0.01, 0.3]] {
            let made = revolved(profile);
            let found = Revolved::of(&made.quadric()).unwrap().along(&made.axis);
            assert!((found.point - made.point).norm() < 1e-9);
            assert!((found.axis.into_inner() - made.axis.into_inner()).norm() < 1e-9);
            assert_eq!(found.profile.len(), profile.len());
            assert!(found.profile.iter().zip(profile).all(|(a, b)| (a - b).abs() < 1e-9));
            assert!((found.factor - made.factor).abs() < 1e-9);
        }
    }

    #[test]
    fn what_it_is_told_from_does_not_change_it() {
        let made = revolved(&[-0.04, 0.02, 0.5]);
        let there = made.clone().from(made.point + made.axis.into_inner() * 0.3);
        let back = there.clone().along(&-made.axis.into_inner());
        for other in [there, back] {
            let pairs = other.quadric().coefficients.into_iter().zip(made.quadric().coefficients);
            assert!(pairs.into_iter().all(|(a, b)| (a - b).abs() < 1e-12));
        }
    }

    #[test]
    fn an_ellipsoid_of_three_axes_has_none() {
        let form = Matrix3::from_diagonal(&Vector::new(1.0, 2.0, 3.0));
        assert!(Revolved::of(&Quadric::about(Point::origin(), -1.0, form)).is_none());
    }
}
