//! What a region's points say of its surface, condensed to a small quadratic form.
//!
//! Near the free fit the sum of squared distances over their variance grows as `δᵀ H δ`, where `δ`
//! says how far another surface of the same type lies from it. Whoever moves the surface needs `H`
//! only, however many points it came from.

use nalgebra::{DMatrix, DVector};

use super::waves::Waves;
use super::{Revolved, Shape, Surface, axis, centroid, direction};
use crate::math::{Point, Unit, Vector, frame};

/// A fitted surface, and what deviating from it costs.
///
/// The coordinates `δ` of another surface are, in the frame `(u, v, d)` of this one at the foot `F`
/// of the points' centroid:
///
/// | type | coordinates |
/// | --- | --- |
/// | plane | tilt along u and v; shift along the normal at F |
/// | cylinder | tilt; shift of the axis along u and v at F; radius |
/// | cone | tilt; shift of the axis at F; radius at F; half angle |
/// | torus | tilt; shift of the centre along u, v and d; major and minor radius |
/// | sphere | shift of the centre along u, v and d; radius |
/// | quadric of revolution | tilt; shift of the axis at F; coefficients of its profile from F |
#[derive(Debug, Clone)]
pub struct Condensed {
    /// The free fit.
    pub surface: Surface,
    /// The foot `F`.
    pub foot: Point,
    /// `H`: the inverse of the covariance of `δ`.
    pub information: DMatrix<f64>,
    frame: [Vector; 3],
}

impl Condensed {
    /// Condenses points that err by `sigma` each, independently. `None` for surfaces without such
    /// coordinates, without points, or where the points leave it undetermined.
    pub fn new(surface: &Surface, points: &[Point], sigma: f64) -> Option<Self> {
        let mut condensed = Self::at(surface, points)?;
        let mut sum: Option<DMatrix<f64>> = None;
        for &point in points {
            let Some(row) = condensed.derivatives(point) else { continue };
            let row = DVector::from_vec(row);
            sum.get_or_insert_with(|| DMatrix::zeros(row.len(), row.len()))
                .ger(1.0, &row, &row, 1.0);
        }
        condensed.information = sum? / (sigma * sigma);
        condensed.known()
    }

    /// Condenses points that err as on a scan: the fit is that of independent errors, its covariance
    /// that of errors which neighbours share (the "sandwich" of generalised least squares).
    pub fn under(surface: &Surface, points: &[Point], waves: &Waves) -> Option<Self> {
        let mut condensed = Self::at(surface, points)?;
        let (rows, heard) = condensed.rows(points, HEARD)?;
        let normal = rows.transpose() * &rows;
        let spread = rows.transpose() * waves.covariance(&heard, points.len()) * &rows;
        let misfit = waves.misfit(surface, points).max(1.0);
        condensed.information = &normal * spread.cholesky()?.inverse() * &normal / misfit;
        condensed.known()
    }

    /// The frame that coordinates refer to; nothing is known yet.
    fn at(surface: &Surface, points: &[Point]) -> Option<Self> {
        let center = centroid(points)?;
        let direction = direction(surface).unwrap_or(Vector::z_axis());
        let foot = match surface {
            Surface::Plane(s) => center - s.normal.into_inner() * s.distance(center),
            Surface::Torus(s) => s.center,
            Surface::Sphere(s) => s.center,
            _ => {
                let (point, axis) = axis(surface)?;
                point + axis.into_inner() * axis.dot(&(center - point))
            }
        };
        let (u, v) = frame(&direction);
        let frame = [u.into_inner(), v.into_inner(), direction.into_inner()];
        let information = DMatrix::zeros(0, 0);
        Some(Self { surface: surface.clone(), foot, information, frame })
    }

    fn known(self) -> Option<Self> {
        (self.determined() && self.small()).then_some(self)
    }

    /// Derivatives at no more than so many of the points, one row each, and those points.
    fn rows(&self, points: &[Point], most: usize) -> Option<(DMatrix<f64>, Vec<Point>)> {
        let step = points.len().div_ceil(most).max(1);
        let each = |point: &Point| Some((self.derivatives(*point)?, *point));
        let (rows, heard): (Vec<Vec<f64>>, Vec<Point>) =
            points.iter().step_by(step).filter_map(each).unzip();
        let columns = rows.first()?.len();
        Some((DMatrix::from_row_iterator(rows.len(), columns, rows.into_iter().flatten()), heard))
    }

    /// Derivatives of the distance of a point by the coordinates.
    fn derivatives(&self, point: Point) -> Option<Vec<f64>> {
        let n = self.surface.normal(point)?.into_inner();
        let [u, v, d] = self.frame;
        let torque = (point - self.foot).cross(&n);
        let tilt = [-torque.dot(&d.cross(&u)), -torque.dot(&d.cross(&v))];
        let [a, b, c] = self.frame.map(|axis| -axis.dot(&n));
        Some(match &self.surface {
            Surface::Plane(_) => vec![tilt[0], tilt[1], c],
            Surface::Cylinder(_) => vec![tilt[0], tilt[1], a, b, -1.0],
            Surface::Cone(s) => {
                let cosine = s.half_angle.cos();
                let height = d.dot(&(point - self.foot));
                vec![tilt[0], tilt[1], a, b, -cosine, -height / cosine]
            }
            Surface::Torus(s) => {
                let offset = point - s.center;
                let radial = offset - d * d.dot(&offset);
                let outward = radial / radial.norm().max(f64::MIN_POSITIVE);
                vec![tilt[0], tilt[1], a, b, c, -outward.dot(&n), -1.0]
            }
            Surface::Sphere(_) => vec![a, b, c, -1.0],
            Surface::Quadric(s) => {
                let own = Revolved::of(s)?;
                let slope = s.gradient(self.surface.project(point)?).norm();
                let height = d.dot(&(point - self.foot));
                let powers = (0..own.profile.len()).map(|power| height.powi(power as i32));
                let profile = powers.map(|monomial| own.factor * monomial / slope);
                [tilt[0], tilt[1], a, b].into_iter().chain(profile).collect()
            }
            Surface::FreeForm => return None,
        })
    }

    /// The coordinates of another surface of the same type, whose direction agrees in sign.
    pub fn coordinates(&self, other: &Surface) -> Option<DVector<f64>> {
        let [u, v, d] = self.frame;
        let tilt = |axis: &Unit| [u.dot(axis), v.dot(axis)];
        // Where a line passes the plane through the foot.
        let pierced = |point: Point, axis: &Unit| {
            let along = d.dot(&(self.foot - point)) / d.dot(axis);
            point + axis.into_inner() * along
        };
        let values = match (&self.surface, other) {
            (Surface::Plane(_), Surface::Plane(s)) => {
                let [a, b] = tilt(&s.normal);
                vec![a, b, -s.distance(self.foot) / d.dot(&s.normal)]
            }
            (Surface::Cylinder(own), Surface::Cylinder(s)) => {
                let [a, b] = tilt(&s.axis);
                let shift = pierced(s.point, &s.axis) - self.foot;
                vec![a, b, u.dot(&shift), v.dot(&shift), s.radius - own.radius]
            }
            (Surface::Cone(own), Surface::Cone(s)) => {
                let [a, b] = tilt(&s.axis);
                let at = pierced(s.apex, &s.axis);
                let radius = s.axis.dot(&(at - s.apex)) * s.half_angle.tan();
                let before = d.dot(&(self.foot - own.apex)) * own.half_angle.tan();
                let opening = s.half_angle - own.half_angle;
                let shift = at - self.foot;
                vec![a, b, u.dot(&shift), v.dot(&shift), radius - before, opening]
            }
            (Surface::Torus(own), Surface::Torus(s)) => {
                let [a, b] = tilt(&s.axis);
                let [x, y, z] = self.frame.map(|axis| axis.dot(&(s.center - self.foot)));
                let sizes = [s.major_radius - own.major_radius, s.minor_radius - own.minor_radius];
                vec![a, b, x, y, z, sizes[0], sizes[1]]
            }
            (Surface::Sphere(own), Surface::Sphere(s)) => {
                let [x, y, z] = self.frame.map(|axis| axis.dot(&(s.center - self.foot)));
                vec![x, y, z, s.radius - own.radius]
            }
            (Surface::Quadric(own), Surface::Quadric(s)) => {
                let (own, other) = (Revolved::of(own)?, Revolved::of(s)?.along(&d));
                let [a, b] = tilt(&other.axis);
                let at = pierced(other.point, &other.axis);
                let shift = at - self.foot;
                let (own, other) = (own.from(self.foot).profile, other.from(at).profile);
                let moved = other.iter().zip(&own).map(|(new, old)| new - old);
                [a, b, u.dot(&shift), v.dot(&shift)].into_iter().chain(moved).collect()
            }
            _ => return None,
        };
        Some(DVector::from_vec(values))
    }

    /// The direction of the free fit, and the covariance of its tilt, a 3 x 3 form.
    pub fn direction(&self) -> Option<(Unit, nalgebra::Matrix3<f64>)> {
        let direction = direction(&self.surface)?;
        let covariance = self.information.clone().cholesky()?.inverse();
        let [u, v, _] = self.frame;
        let across = nalgebra::Matrix3x2::from_columns(&[u, v]);
        let tilt = covariance.fixed_view::<2, 2>(0, 0);
        Some((direction, across * tilt * across.transpose()))
    }

    /// Whether the fit is known so well that its surroundings look flat: a cylinder of sizes across
    /// may as well be a plane.
    fn small(&self) -> bool {
        let Some(factor) = self.information.clone().cholesky() else { return false };
        factor.inverse().diagonal().iter().all(|variance| *variance < VAGUE * VAGUE)
    }

    /// Whether no direction of the form is free, after scaling its diagonal to one.
    fn determined(&self) -> bool {
        let scale = self.information.diagonal().map(|value| 1.0 / value.sqrt());
        if !scale.iter().all(|value| value.is_finite()) {
            return false;
        }
        let scale = DMatrix::from_diagonal(&scale);
        (&scale * &self.information * &scale).symmetric_eigenvalues().min() > 1e-9
    }
}

/// The derivatives at some of the points of a surface, and those points, for whoever looks at residuals.
pub fn rows(
    surface: &Surface,
    points: &[Point],
    most: usize,
) -> Option<(DMatrix<f64>, Vec<Point>)> {
    Condensed::at(surface, points)?.rows(points, most)
}

/// Points of a region that speak for all where errors go together: every pair of them counts.
const HEARD: usize = 150;
/// Standard deviation, in radians and sizes, from which on a fit is no small neighbourhood.
const VAGUE: f64 = 0.5;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::{Cone, Cylinder, Plane, Sphere, Torus};

    const SIGMA: f64 = 1e-4;

    fn axis() -> Unit {
        Unit::new_normalize(Vector::new(0.3, -0.2, 1.0))
    }

    fn shapes() -> Vec<(Surface, Surface)> {
        let moved = Unit::new_normalize(axis().into_inner() + Vector::new(2e-6, 1e-6, 0.0));
        let (center, there) = (Point::new(0.4, 0.5, 0.6), Point::new(0.400001, 0.5, 0.600002));
        let (axis, half_angle) = (axis(), 0.4);
        let (major_radius, minor_radius) = (0.3, 0.1);
        vec![
            (
                Surface::Plane(Plane::through(center, axis)),
                Surface::Plane(Plane::through(there, moved)),
            ),
            (
                Surface::Cylinder(Cylinder { point: center, axis, radius: 0.2 }),
                Surface::Cylinder(Cylinder { point: there, axis: moved, radius: 0.200003 }),
            ),
            (
                Surface::Cone(Cone { apex: center, axis, half_angle }),
                Surface::Cone(Cone { apex: there, axis: moved, half_angle: half_angle + 2e-6 }),
            ),
            (
                Surface::Torus(Torus { center, axis, major_radius, minor_radius }),
                Surface::Torus(Torus {
                    center: there,
                    axis: moved,
                    major_radius: major_radius + 1e-6,
                    minor_radius: minor_radius - 2e-6,
                }),
            ),
            (
                Surface::Sphere(Sphere { center, radius: 0.3 }),
                Surface::Sphere(Sphere { center: there, radius: 0.300002 }),
            ),
            (
                revolved(center, axis, [-0.04, 0.1, 0.5]),
                revolved(there, moved, [-0.040001, 0.1, 0.500002]),
            ),
            (revolved(center, axis, [-0.03, 0.2]), revolved(there, moved, [-0.03, 0.200002])),
        ]
    }

    fn revolved<const N: usize>(point: Point, axis: Unit, profile: [f64; N]) -> Surface {
        let made = Revolved { point, axis, profile: profile.to_vec(), factor: 1.5 };
        Surface::Quadric(made.quadric())
    }

    /// Points of a surface, spread over it.
    fn points(surface: &Surface) -> Vec<Point> {
        let near = |i: u32| {
            let [a, b, c] = [7, 11, 13].map(|k| f64::from(i * k % 29) / 29.0);
            Point::new(a, b, 0.7 + c / 2.0)
        };
        (0..200).filter_map(|i| surface.project(near(i))).collect()
    }

    #[test]
    fn the_form_is_the_sum_of_squared_distances_of_a_surface_nearby() {
        for (free, other) in shapes() {
            let points = points(&free);
            let condensed = Condensed::new(&free, &points, SIGMA).unwrap();
            let step = condensed.coordinates(&other).unwrap();
            let form = step.dot(&(&condensed.information * &step));
            let squares: f64 = points.iter().map(|p| other.distance(*p).unwrap().powi(2)).sum();
            assert!(
                (form * SIGMA * SIGMA / squares - 1.0).abs() < 1e-3,
                "{free:?}: {form} {squares}"
            );
        }
    }

    #[test]
    fn a_surface_has_the_coordinates_zero_of_itself() {
        for (free, _) in shapes() {
            let condensed = Condensed::new(&free, &points(&free), SIGMA).unwrap();
            assert!(condensed.coordinates(&free).unwrap().amax() < 1e-12);
        }
    }

    #[test]
    fn points_on_a_line_determine_no_plane() {
        let line: Vec<_> = (0..9).map(|i| Point::new(f64::from(i), 0.0, 0.0)).collect();
        let plane = Surface::Plane(Plane::through(Point::origin(), Vector::z_axis()));
        assert!(Condensed::new(&plane, &line, 1.0).is_none());
    }
}
