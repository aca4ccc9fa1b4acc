//! What cannot be substituted stays an equation, `g(u) = 0`.

use super::system::{State, System};
use crate::math::{Point, Unit, Vector, frame};
use crate::surface::{Revolved, Surface, direction};

/// A relation between unknowns. Numbers are those of surfaces unless it says otherwise; what is said
/// of directions and places holds as long as the classes that it was made for do.
#[derive(Debug, Clone, PartialEq)]
pub enum Equation {
    /// Two direction classes at right angles: the cosine between them.
    Orthogonal(usize, usize),
    /// The angle between two directions, in radians.
    Angle([usize; 2], f64),
    /// As large an angle between the first two directions as between the others.
    EqualAngle([usize; 4]),
    /// The spine of the first (an axis, a circle, a centre) lies its radius away from the second, on
    /// that side.
    Touch { spine: usize, other: usize, side: f64 },
    /// Factors times heights along a direction add up to a length.
    Heights { along: usize, terms: Vec<(usize, f64)>, sum: f64 },
    /// An axis lies beside another in that direction, not higher, seen along both.
    Level { along: usize, axes: [usize; 2] },
    /// Distance of two parallel planes.
    Distance([usize; 2], f64),
    /// As far from the first to the second parallel plane as between the others.
    EqualDistance([usize; 4]),
    /// The way between two parallel axes is that between two others, turned about their direction:
    /// its part along the first or second direction across that of `about`.
    Turned { about: usize, from: [usize; 2], to: [usize; 2], turn: f64, part: usize },
    /// A centre or an axis passes a point: offset along the first, second or third direction.
    Through { surface: usize, point: Point, part: usize },
    /// A centre lies on an axis: offset along the first or second direction across.
    OnAxis { center: usize, axis: usize, part: usize },
    /// A length or an angle of a surface.
    Size { surface: usize, size: Size, value: f64 },
    /// A direction is given: tilt along the first or second direction across it.
    Towards { surface: usize, direction: Unit, part: usize },
}

/// A size of a surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Size {
    /// Radius of a cylinder or sphere.
    Radius,
    /// Of a torus.
    MajorRadius,
    /// Of a torus.
    MinorRadius,
    /// Half angle of a cone, in radians.
    HalfAngle,
    /// Offset of a plane.
    Offset,
}

impl Size {
    /// Its value; `None` where a surface has no such size.
    pub fn of(self, surface: &Surface) -> Option<f64> {
        match (self, surface) {
            (Self::Radius, Surface::Cylinder(s)) => Some(s.radius),
            (Self::Radius, Surface::Sphere(s)) => Some(s.radius),
            (Self::MajorRadius, Surface::Torus(s)) => {
                (s.major_radius > 0.0).then_some(s.major_radius)
            }
            (Self::MinorRadius, Surface::Torus(s)) => Some(s.minor_radius),
            (Self::HalfAngle, Surface::Cone(s)) => Some(s.half_angle),
            (Self::Offset, Surface::Plane(s)) => Some(s.offset),
            _ => None,
        }
    }
}

/// Step of the differences.
const STEP: f64 = 1e-6;

impl Equation {
    /// How far the equation is from holding: a cosine, radians or a length.
    pub fn value(&self, system: &System, state: &State) -> f64 {
        let surface = |i: &usize| system.surface(*i, state);
        let along = |i: &usize| way(&surface(i));
        match self {
            Self::Orthogonal(a, b) => state.directions[*a].dot(&state.directions[*b]),
            Self::Angle([i, j], angle) => between(&along(i), &along(j)) - angle,
            Self::EqualAngle([i, j, k, l]) => {
                between(&along(i), &along(j)) - between(&along(k), &along(l))
            }
            Self::Touch { spine, other, side } => touching(&surface(spine), &surface(other), *side),
            Self::Heights { along: of, terms, sum } => {
                let d = along(of);
                terms
                    .iter()
                    .map(|(i, factor)| factor * d.dot(&place(&surface(i)).coords))
                    .sum::<f64>()
                    - sum
            }
            Self::Level { along: of, axes: [i, j] } => {
                let across = along(of).cross(&along(i));
                across.dot(&(place(&surface(j)) - place(&surface(i))))
            }
            Self::Distance([i, j], length) => apart(&surface(i), &surface(j)) - length,
            Self::EqualDistance([i, j, k, l]) => {
                apart(&surface(i), &surface(j)) - apart(&surface(k), &surface(l))
            }
            Self::Turned { about, from, to, turn, part } => {
                let [a, b, c, d] = [from[0], from[1], to[0], to[1]].map(|i| place(&surface(&i)));
                let axis = Unit::new_unchecked(along(about));
                let (u, v) = frame(&axis);
                let flat = |way: Vector| [u.dot(&way), v.dot(&way)];
                let ([x, y], there) = (flat(b - a), flat(d - c));
                let (sine, cosine) = turn.sin_cos();
                there[*part] - [cosine * x - sine * y, sine * x + cosine * y][*part]
            }
            Self::Through { surface: i, point, part } => {
                let surface = surface(i);
                let offset = place(&surface) - point;
                match surface {
                    Surface::Sphere(_) | Surface::Torus(_) => offset[*part],
                    _ => across(&along(i))[*part].dot(&offset),
                }
            }
            Self::OnAxis { center, axis, part } => {
                across(&along(axis))[*part].dot(&(place(&surface(center)) - place(&surface(axis))))
            }
            Self::Size { surface: i, size, value } => {
                size.of(&surface(i)).map_or(0.0, |own| own - value)
            }
            Self::Towards { surface: i, direction, part } => {
                across(direction)[*part].dot(&along(i))
            }
        }
    }

    /// The unknowns that it depends on.
    pub fn unknowns(&self, system: &System) -> Vec<usize> {
        let surfaces = match self {
            Self::Orthogonal(a, b) => return vec![2 * a, 2 * a + 1, 2 * b, 2 * b + 1],
            _ => self.surfaces(),
        };
        let mut unknowns: Vec<usize> = surfaces.iter().flat_map(|&i| system.unknowns(i)).collect();
        unknowns.sort_unstable();
        unknowns.dedup();
        unknowns
    }

    /// The surfaces that it is about; none for direction classes.
    pub fn surfaces(&self) -> Vec<usize> {
        match self {
            Self::Orthogonal(..) => Vec::new(),
            Self::Angle(pair, _) | Self::Distance(pair, _) => pair.to_vec(),
            Self::EqualAngle(four) | Self::EqualDistance(four) => four.to_vec(),
            Self::Touch { spine, other, .. } => vec![*spine, *other],
            Self::Heights { along, terms, .. } => {
                terms.iter().map(|(i, _)| *i).chain([*along]).collect()
            }
            Self::Level { along, axes } => vec![*along, axes[0], axes[1]],
            Self::Turned { about, from, to, .. } => {
                from.iter().chain(to).chain([about]).copied().collect()
            }
            Self::OnAxis { center, axis, .. } => vec![*center, *axis],
            Self::Through { surface, .. }
            | Self::Size { surface, .. }
            | Self::Towards { surface, .. } => vec![*surface],
        }
    }

    /// Its derivatives: unknown and value.
    pub fn row(&self, system: &System, state: &State) -> Vec<(usize, f64)> {
        if let Self::Orthogonal(a, b) = *self {
            let (one, other) = (state.directions[a], state.directions[b]);
            let ([u, v], [s, t]) = (across(&one), across(&other));
            let slopes = [u.dot(&other), v.dot(&other), s.dot(&one), t.dot(&one)];
            return self.unknowns(system).into_iter().zip(slopes).collect();
        }
        let mut moved = state.clone();
        let slope = |unknown: usize| {
            let mut at = |step: f64| {
                let known = moved.value(unknown);
                moved.nudge(unknown, step);
                let value = self.value(system, &moved);
                moved.restore(unknown, known);
                value
            };
            (unknown, (at(STEP) - at(-STEP)) / (2.0 * STEP))
        };
        self.unknowns(system).into_iter().map(slope).filter(|(_, slope)| *slope != 0.0).collect()
    }
}

/// Direction of a surface; zero where it has none.
fn way(surface: &Surface) -> Vector {
    direction(surface).map_or(Vector::zeros(), Unit::into_inner)
}

fn across(direction: &Vector) -> [Unit; 2] {
    let (u, v) = frame(&Unit::new_unchecked(*direction));
    [u, v]
}

/// The angle between two lines, at most a right one.
fn between(a: &Vector, b: &Vector) -> f64 {
    a.cross(b).norm().atan2(a.dot(b).abs())
}

/// Where a surface is: a centre, a point of an axis, a point of a plane.
pub fn place(surface: &Surface) -> Point {
    match surface {
        Surface::Plane(s) => Point::from(s.normal.into_inner() * s.offset),
        Surface::Cylinder(s) => s.point,
        Surface::Cone(s) => s.apex,
        Surface::Torus(s) => s.center,
        Surface::Sphere(s) => s.center,
        Surface::Quadric(s) => Revolved::of(s).map_or(Point::origin(), |own| own.point),
        Surface::FreeForm => Point::origin(),
    }
}

/// Distance of parallel planes.
pub fn apart(one: &Surface, other: &Surface) -> f64 {
    way(one).dot(&(place(other) - place(one))).abs()
}

/// A point of what rolls along a surface of that type, and the radius of what rolls.
pub fn spine(surface: &Surface) -> Option<(Point, f64)> {
    match surface {
        Surface::Cylinder(s) => Some((s.point, s.radius)),
        Surface::Sphere(s) => Some((s.center, s.radius)),
        Surface::Torus(s) => {
            let out = frame(&s.axis).0.into_inner() * s.major_radius;
            Some((s.center + out, s.minor_radius))
        }
        _ => None,
    }
}

fn touching(one: &Surface, other: &Surface, side: f64) -> f64 {
    let distance =
        spine(one).and_then(|(point, radius)| Some(other.distance(point)? - side * radius));
    distance.unwrap_or(0.0)
}
