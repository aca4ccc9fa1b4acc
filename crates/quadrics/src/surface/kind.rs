//! Which kind of quadric ten coefficients are, by the eigen-structure of their matrix.

use nalgebra::Matrix3;

use super::Quadric;
use crate::math::{Point, Unit, Vector};

/// Eigenvalues that differ by less than this fraction of the largest count as equal, lesser ones
/// as zero; what is left of constant and slope is judged on the same scale at the part's size.
const TOLERANCE: f64 = 1e-3;

/// The kinds of real quadrics, by the names of the result files.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Class {
    /// One plane, or two: no curvature.
    Plane,
    /// All curvatures equal.
    Sphere,
    /// Circular.
    Cylinder,
    /// Circular, both nappes.
    Cone,
    /// Closed.
    Ellipsoid,
    /// Straight along one axis, an ellipse across.
    EllipticCylinder,
    /// Straight lines through one point.
    EllipticCone,
    /// A bowl.
    EllipticParaboloid,
    /// A saddle.
    HyperbolicParaboloid,
    /// In one piece.
    HyperboloidOneSheet,
    /// In two pieces.
    HyperboloidTwoSheets,
    /// Straight along one axis, a parabola across.
    ParabolicCylinder,
    /// Straight along one axis, a hyperbola across.
    HyperbolicCylinder,
    /// No real surface, or no surface at all.
    Other,
}

impl Class {
    /// Its name in the result files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Plane => "plane",
            Self::Sphere => "sphere",
            Self::Cylinder => "cylinder",
            Self::Cone => "cone",
            Self::Ellipsoid => "ellipsoid",
            Self::EllipticCylinder => "elliptic_cylinder",
            Self::EllipticCone => "elliptic_cone",
            Self::EllipticParaboloid => "elliptic_paraboloid",
            Self::HyperbolicParaboloid => "hyperbolic_paraboloid",
            Self::HyperboloidOneSheet => "hyperboloid_one_sheet",
            Self::HyperboloidTwoSheets => "hyperboloid_two_sheets",
            Self::ParabolicCylinder => "parabolic_cylinder",
            Self::HyperbolicCylinder => "hyperbolic_cylinder",
            Self::Other => "other",
        }
    }
}

/// A quadric's class with what it has of centre, axes and semi-axes.
#[derive(Debug, Clone, PartialEq)]
pub struct Kind {
    /// The class.
    pub class: Class,
    /// Centre, apex or vertex; on a cylinder the point of its axis nearest to the origin.
    pub center: Option<Point>,
    /// Principal directions, the most curved first; the third of a paraboloid points into it.
    pub axes: [Unit; 3],
    /// One for every curved axis, in the order of the axes: of a paraboloid `a, b` in
    /// `z = x²/a² + y²/b²`. Empty for cones, planes and parabolic cylinders.
    pub semi_axes: Vec<f64>,
}

/// The kind of a quadric in a part whose longest side is `size`.
pub fn kind(quadric: &Quadric, size: f64) -> Kind {
    let (constant, linear, form) = quadric.parts();
    // In units of the part, then divided by the largest curvature: tolerances are fractions.
    let (linear, form) = (linear * size, form * (size * size));
    let scale = form.amax().max(TOLERANCE * linear.amax());
    if !(constant + linear.sum() + form.sum()).is_finite() || scale == 0.0 {
        let axes = [Vector::x_axis(), Vector::y_axis(), Vector::z_axis()];
        return Kind { class: Class::Other, center: None, axes, semi_axes: Vec::new() };
    }
    Reduced::new(constant / scale, linear / scale, form / scale).kind(size)
}

/// A quadric in its own frame: `constant + Σ slopes·u + values·u²`.
struct Reduced {
    values: [f64; 3],
    axes: [Vector; 3],
    /// How many of the values count as curved; the others are last.
    rank: usize,
    center: Vector,
    /// `f` at the centre.
    level: f64,
    /// Slopes along the axes that are not curved.
    slopes: [f64; 3],
}

impl Reduced {
    fn new(constant: f64, linear: Vector, form: Matrix3<f64>) -> Self {
        let eigen = form.symmetric_eigen();
        let mut order = [0, 1, 2];
        order.sort_by(|&i, &j| {
            eigen.eigenvalues[j].abs().total_cmp(&eigen.eigenvalues[i].abs()).then(i.cmp(&j))
        });
        let values = order.map(|i| eigen.eigenvalues[i]);
        let axes = order.map(|i| eigen.eigenvectors.column(i).into_owned());
        let rank = values.iter().filter(|value| value.abs() > TOLERANCE).count();
        let mut slopes = [0, 1, 2].map(|i| axes[i].dot(&linear));
        let (mut center, mut level) = (Vector::zeros(), constant);
        for i in 0..rank {
            let at = -slopes[i] / (2.0 * values[i]);
            center += axes[i] * at;
            level += slopes[i] * at / 2.0;
            slopes[i] = 0.0;
        }
        Self { values, axes, rank, center, level, slopes }
    }

    fn kind(mut self, size: f64) -> Kind {
        let class = self.class();
        let mut semi_axes = Vec::new();
        let mut center = Some(self.center);
        match class {
            Class::ParabolicCylinder | Class::Plane | Class::Other => center = None,
            Class::Cone | Class::EllipticCone => {}
            Class::EllipticParaboloid | Class::HyperbolicParaboloid => {
                // The vertex: where the axis meets the surface.
                let along = -self.level / self.slopes[2];
                center = Some(self.center + self.axes[2] * along);
                let into = -(self.values[0] * self.slopes[2]).signum();
                self.axes[2] *= into;
                let semi = |v: f64| (self.slopes[2] / v).abs().sqrt() * size.sqrt();
                semi_axes = self.values[..2].iter().map(|&v| semi(v)).collect();
            }
            _ => {
                let semi = |v: f64| (self.level / v).abs().sqrt() * size;
                semi_axes = self.values[..self.rank].iter().map(|&v| semi(v)).collect();
            }
        }
        let center = center.map(|center| Point::from(center * size));
        Kind { class, center, axes: self.axes.map(Unit::new_normalize), semi_axes }
    }

    fn class(&mut self) -> Class {
        let curved = &self.values[..self.rank];
        let sign: f64 = curved.iter().map(|value| value.signum()).sum();
        let one_sign = sign.abs() as usize == self.rank;
        // Same sign and nearly same size, among the values of the majority's sign.
        let major = curved.iter().filter(|value| value.signum() == sign.signum());
        let (low, high) =
            major.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &v| (l.min(v), h.max(v)));
        let round = high - low < TOLERANCE;
        let real = !one_sign || self.level.signum() != sign.signum();
        match self.rank {
            3 if one_sign && !real => Class::Other,
            3 if one_sign && round => Class::Sphere,
            3 if one_sign => Class::Ellipsoid,
            3 if self.level.abs() < TOLERANCE && round => Class::Cone,
            3 if self.level.abs() < TOLERANCE => Class::EllipticCone,
            3 if real && self.level.signum() != sign.signum() => Class::HyperboloidOneSheet,
            3 => Class::HyperboloidTwoSheets,
            2 if self.sloped() && one_sign => Class::EllipticParaboloid,
            2 if self.sloped() => Class::HyperbolicParaboloid,
            2 if one_sign && !real => Class::Other,
            2 if one_sign && round => Class::Cylinder,
            2 if one_sign => Class::EllipticCylinder,
            2 => Class::HyperbolicCylinder,
            1 if self.sloped() => Class::ParabolicCylinder,
            _ => Class::Plane,
        }
    }

    fn sloped(&self) -> bool {
        self.slopes[1].hypot(self.slopes[2]) > TOLERANCE
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{Translation3, UnitQuaternion};

    use super::*;
    use crate::math::Similarity;
    use crate::surface::{Cone, Cylinder, Plane, Sphere};

    /// `values·x² + slope z + level`, about a centre in a part of size 80.
    fn diagonal(values: [f64; 3], slope: f64, level: f64) -> Quadric {
        let form = Matrix3::from_diagonal(&Vector::from(values));
        Quadric::from_parts(level, Vector::new(0.0, 0.0, slope), form)
    }

    fn moved(quadric: &Quadric) -> (Quadric, Similarity) {
        let turn = UnitQuaternion::from_euler_angles(0.3, 1.1, -0.4);
        let by = Similarity::from_parts(Translation3::new(30.0, -20.0, 10.0), turn, 40.0);
        (quadric.transformed(&by), by)
    }

    #[test]
    fn every_kind_is_told_wherever_it_lies_and_whatever_its_sign() {
        use Class::*;
        let table = [
            (diagonal([1.0, 1.0, 1.0], 0.0, -1.0), Sphere),
            (diagonal([1.0, 2.0, 3.0], 0.0, -1.0), Ellipsoid),
            (diagonal([1.0, 1.0, 0.0], 0.0, -1.0), Cylinder),
            (diagonal([1.0, 2.0, 0.0], 0.0, -1.0), EllipticCylinder),
            (diagonal([1.0, -2.0, 0.0], 0.0, -1.0), HyperbolicCylinder),
            (diagonal([1.0, 0.0, 0.0], 1.0, 0.3), ParabolicCylinder),
            (diagonal([1.0, 1.0, -0.5], 0.0, 0.0), Cone),
            (diagonal([1.0, 2.0, -0.5], 0.0, 0.0), EllipticCone),
            (diagonal([1.0, 2.0, -0.5], 0.0, -1.0), HyperboloidOneSheet),
            (diagonal([1.0, 2.0, -0.5], 0.0, 1.0), HyperboloidTwoSheets),
            (diagonal([1.0, 2.0, 0.0], -1.0, 0.2), EllipticParaboloid),
            (diagonal([1.0, -2.0, 0.0], 1.0, 0.2), HyperbolicParaboloid),
            (diagonal([0.0, 0.0, 0.0], 1.0, 0.2), Plane),
            (diagonal([1.0, 2.0, 3.0], 0.0, 1.0), Other),
            (diagonal([0.0, 0.0, 0.0], 0.0, 0.0), Other),
        ];
        for (quadric, class) in table {
            let (there, _) = moved(&quadric);
            assert_eq!(kind(&there, 80.0).class, class);
            assert_eq!(kind(&there.flipped(), 80.0).class, class);
        }
    }

    #[test]
    fn typed_surfaces_are_of_their_own_class() {
        let axis = Unit::new_normalize(Vector::new(0.3, -0.5, 0.8));
        let point = Point::new(3.0, 1.0, -7.0);
        let plane = Plane::through(point, axis).quadric();
        assert_eq!(kind(&plane, 10.0).class, Class::Plane);
        let sphere = Sphere { center: point, radius: 2.0 }.quadric();
        let found = kind(&sphere, 10.0);
        assert_eq!(found.class, Class::Sphere);
        assert!((found.center.unwrap() - point).norm() < 1e-12);
        assert!(found.semi_axes.iter().all(|a| (a - 2.0).abs() < 1e-12));
        let cylinder = Cylinder { point, axis, radius: 2.0 }.quadric();
        assert_eq!(kind(&cylinder, 10.0).class, Class::Cylinder);
        assert!(kind(&cylinder, 10.0).axes[2].dot(&axis).abs() > 1.0 - 1e-12);
        let cone = Cone { apex: point, axis, half_angle: 0.4 }.quadric();
        assert_eq!(kind(&cone, 10.0).class, Class::Cone);
        assert!((kind(&cone, 10.0).center.unwrap() - point).norm() < 1e-9);
    }

    #[test]
    fn centre_axes_and_semi_axes_are_those_it_was_made_from() {
        let (there, by) = moved(&diagonal([4.0, 1.0, 0.25], 0.0, -1.0));
        let found = kind(&there, 80.0);
        assert!((found.center.unwrap() - by * Point::origin()).norm() < 1e-9);
        for (found, made) in found.semi_axes.iter().zip([20.0, 40.0, 80.0]) {
            assert!((found - made).abs() < 1e-9);
        }
        // z = x²/a² + y²/b² from its vertex into the bowl.
        let (there, by) = moved(&diagonal([4.0, 1.0, 0.0], -1.0, 0.5));
        let found = kind(&there, 80.0);
        assert!((found.center.unwrap() - by * Point::new(0.0, 0.0, 0.5)).norm() < 1e-9);
        assert!((found.axes[2].dot(&(by.isometry.rotation * Vector::z())) - 1.0).abs() < 1e-9);
        let scale = 40f64.sqrt();
        assert!((found.semi_axes[0] - 0.5 * scale).abs() < 1e-9);
        assert!((found.semi_axes[1] - scale).abs() < 1e-9);
    }
}
