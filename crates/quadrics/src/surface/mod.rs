//! Analytic surfaces: distances, normals, projections. Geometry without meshes.
//!
//! Distances are signed: positive on the side that [`Shape::normal`] points to, which is away from
//! the centre, the axis or the spine. Lengths are in the unit of the points, angles in radians.

mod arc;
mod axis;
pub mod blend;
mod chamfer;
mod condensed;
mod cone;
mod curve;
mod cylinder;
pub mod family;
pub mod general;
pub mod height_field;
pub mod kind;
mod local;
pub mod moments;
pub mod planarity;
mod plane;
pub mod polynomial;
pub mod profile;
pub mod quadrature;
mod quadric;
mod refine;
pub mod related;
mod revolved;
pub mod round;
pub mod select;
mod sphere;
mod squares;
pub mod start;
pub mod sweep;
pub mod taubin;
mod torus;
mod tube;
mod uncertainty;
mod waves;

pub use axis::{axis, direction};
pub use condensed::Condensed;
pub use cone::Cone;
pub use cylinder::Cylinder;
pub use plane::Plane;
pub use quadric::Quadric;
pub use refine::{Fit, centroid, refine, refine_within};
pub use revolved::Revolved;
pub use sphere::Sphere;
pub use start::Samples;
pub use torus::Torus;
pub use uncertainty::{Scatter, uncertainty};
pub use waves::Waves;

use crate::math::{Point, Similarity, Unit};
use kind::Class;

/// What every analytic surface can be asked.
pub trait Shape {
    /// Degrees of freedom.
    const PARAMETERS: usize;

    /// Signed orthogonal distance of a point.
    fn distance(&self, point: Point) -> f64;

    /// Unit normal at the foot of `point`; `None` where geometry has no answer (a centre, an axis).
    fn normal(&self, point: Point) -> Option<Unit>;

    /// The nearest point of the surface; `None` where it is not unique.
    fn project(&self, point: Point) -> Option<Point> {
        Some(point - self.normal(point)?.into_inner() * self.distance(point))
    }
}

/// A recognised surface.
#[derive(Debug, Clone, PartialEq)]
pub enum Surface {
    /// A plane.
    Plane(Plane),
    /// A sphere.
    Sphere(Sphere),
    /// A circular cylinder.
    Cylinder(Cylinder),
    /// One nappe of a circular cone.
    Cone(Cone),
    /// A torus.
    Torus(Torus),
    /// A general quadric.
    Quadric(Quadric),
    /// No quadric and no torus fits.
    FreeForm,
}

impl Surface {
    /// Whether it is asked only where simpler types do not explain a noisy region: a general quadric, or a
    /// torus that cuts itself.
    pub fn is_general(&self) -> bool {
        match self {
            Self::Quadric(_) => true,
            Self::Torus(s) => s.cuts_itself(),
            _ => false,
        }
    }

    /// Whether it is of another's type.
    pub fn is_like(&self, other: &Self) -> bool {
        std::mem::discriminant(self) == std::mem::discriminant(other)
    }

    /// The name of its type; [`Self::class_name`] tells quadrics apart.
    pub fn type_name(&self) -> &'static str {
        match self {
            Self::Plane(_) => "plane",
            Self::Sphere(_) => "sphere",
            Self::Cylinder(_) => "cylinder",
            Self::Cone(_) => "cone",
            Self::Torus(_) => "torus",
            Self::Quadric(_) => "quadric",
            Self::FreeForm => "freeform",
        }
    }

    /// The name of its type, as in the result files: of a general quadric in a part whose longest
    /// side is `size` its class, where that has a name of its own.
    pub fn class_name(&self, size: f64) -> &'static str {
        let Self::Quadric(s) = self else { return self.type_name() };
        match kind::kind(s, size).class {
            Class::Plane | Class::Sphere | Class::Cylinder | Class::Cone | Class::Other => {
                "quadric"
            }
            class => class.name(),
        }
    }

    /// Signed orthogonal distance; `None` for a free-form surface.
    pub fn distance(&self, point: Point) -> Option<f64> {
        match self {
            Self::Plane(s) => Some(s.distance(point)),
            Self::Sphere(s) => Some(s.distance(point)),
            Self::Cylinder(s) => Some(s.distance(point)),
            Self::Cone(s) => Some(s.distance(point)),
            Self::Torus(s) => Some(s.distance(point)),
            Self::Quadric(s) => Some(s.distance(point)),
            Self::FreeForm => None,
        }
    }

    /// Unit normal at the foot of `point`.
    pub fn normal(&self, point: Point) -> Option<Unit> {
        match self {
            Self::Plane(s) => s.normal(point),
            Self::Sphere(s) => s.normal(point),
            Self::Cylinder(s) => s.normal(point),
            Self::Cone(s) => s.normal(point),
            Self::Torus(s) => s.normal(point),
            Self::Quadric(s) => s.normal(point),
            Self::FreeForm => None,
        }
    }

    /// The nearest point of the surface.
    pub fn project(&self, point: Point) -> Option<Point> {
        match self {
            Self::Plane(s) => s.project(point),
            Self::Sphere(s) => s.project(point),
            Self::Cylinder(s) => s.project(point),
            Self::Cone(s) => s.project(point),
            Self::Torus(s) => s.project(point),
            Self::Quadric(s) => s.project(point),
            Self::FreeForm => None,
        }
    }

    /// The ten coefficients of eq. 1, where the surface is a quadric.
    pub fn quadric(&self) -> Option<Quadric> {
        match self {
            Self::Plane(s) => Some(s.quadric()),
            Self::Sphere(s) => Some(s.quadric()),
            Self::Cylinder(s) => Some(s.quadric()),
            Self::Cone(s) => Some(s.quadric()),
            Self::Quadric(s) => Some(s.clone()),
            Self::Torus(_) | Self::FreeForm => None,
        }
    }

    /// The same surface in another frame.
    pub fn transformed(&self, by: &Similarity) -> Self {
        match self {
            Self::Plane(s) => Self::Plane(s.transformed(by)),
            Self::Sphere(s) => Self::Sphere(s.transformed(by)),
            Self::Cylinder(s) => Self::Cylinder(s.transformed(by)),
            Self::Cone(s) => Self::Cone(s.transformed(by)),
            Self::Torus(s) => Self::Torus(s.transformed(by)),
            Self::Quadric(s) => Self::Quadric(s.transformed(by)),
            Self::FreeForm => Self::FreeForm,
        }
    }
}

#[cfg(test)]
mod family_tests;
#[cfg(test)]
mod refine_tests;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod uncertainty_tests;
