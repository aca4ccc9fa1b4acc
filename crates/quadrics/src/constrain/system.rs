//! Surfaces by shared unknowns: what is one thing in the part is one unknown here.
//!
//! A direction is shared by a parallel class, a line by a coaxial one, a centre, an offset, a radius,
//! an angle by theirs: equality needs no equation and holds to the last bit.

use crate::math::{Point, Unit, Vector, frame};
use crate::surface::{Cone, Cylinder, Plane, Revolved, Sphere, Surface, Torus};

/// An axis: it passes `base + a u + b v` along a direction.
#[derive(Debug, Clone)]
pub struct Line {
    /// The direction's number.
    pub direction: usize,
    /// Where it passes before it moves.
    pub base: Point,
    /// Two directions across it.
    pub across: [Vector; 2],
    /// The scalars `a` and `b`.
    pub at: [usize; 2],
}

/// Where a sphere's centre may be.
#[derive(Debug, Clone)]
pub enum Center {
    /// Anywhere: three coordinates.
    Free([usize; 3]),
    /// On a line, so far from its base.
    OnLine(Line, usize),
}

/// A surface by its unknowns; `usize` is the number of a scalar. `sign` leads from the shared
/// direction to the surface's own.
#[derive(Debug, Clone)]
pub enum Form {
    /// `n · (x - base) = offset`, for the shared direction `n`.
    Plane {
        direction: usize,
        sign: f64,
        base: Point,
        offset: usize,
    },
    Cylinder {
        line: Line,
        sign: f64,
        radius: usize,
    },
    /// `radius` is that at the base of the line.
    Cone {
        line: Line,
        sign: f64,
        radius: usize,
        angle: usize,
    },
    Torus {
        line: Line,
        sign: f64,
        height: usize,
        major: usize,
        minor: usize,
    },
    Sphere {
        center: Center,
        radius: usize,
    },
    /// A quadric of revolution; `height` is that of its point over the base of the line.
    Revolved {
        line: Line,
        sign: f64,
        height: f64,
        profile: Vec<usize>,
        factor: f64,
    },
}

/// Values of all unknowns.
#[derive(Debug, Clone)]
pub struct State {
    /// Unit vectors; two unknowns each, its tilts.
    pub directions: Vec<Unit>,
    /// Everything else, lengths and radians.
    pub scalars: Vec<f64>,
}

/// What one unknown belongs to, as it was.
pub enum Kept {
    /// A tilted direction.
    Direction(Unit),
    /// A scalar.
    Scalar(f64),
}

impl State {
    /// Number of unknowns: tilts first.
    pub fn len(&self) -> usize {
        2 * self.directions.len() + self.scalars.len()
    }

    /// The state after one unknown changed.
    pub fn nudge(&mut self, unknown: usize, step: f64) {
        let tilts = 2 * self.directions.len();
        if unknown >= tilts {
            self.scalars[unknown - tilts] += step;
            return;
        }
        let direction = &mut self.directions[unknown / 2];
        let (u, v) = frame(direction);
        let along = if unknown.is_multiple_of(2) { u } else { v };
        *direction = Unit::new_normalize(direction.into_inner() + along.into_inner() * step);
    }

    /// What [`State::nudge`] changes: a direction, or a scalar.
    pub fn value(&self, unknown: usize) -> Kept {
        let tilts = 2 * self.directions.len();
        if unknown < tilts {
            Kept::Direction(self.directions[unknown / 2])
        } else {
            Kept::Scalar(self.scalars[unknown - tilts])
        }
    }

    /// Sets it back.
    pub fn restore(&mut self, unknown: usize, known: Kept) {
        let tilts = 2 * self.directions.len();
        match known {
            Kept::Direction(direction) => self.directions[unknown / 2] = direction,
            Kept::Scalar(scalar) => self.scalars[unknown - tilts] = scalar,
        }
    }

    /// The state after all unknowns changed.
    pub fn moved(&self, step: &[f64]) -> Self {
        let tilts = 2 * self.directions.len();
        let tilted = |(direction, tilt): (&Unit, &[f64])| {
            let (u, v) = frame(direction);
            let turn = u.into_inner() * tilt[0] + v.into_inner() * tilt[1];
            Unit::new_normalize(direction.into_inner() + turn)
        };
        let directions = self.directions.iter().zip(step[..tilts].chunks(2)).map(tilted).collect();
        let scalars = self.scalars.iter().zip(&step[tilts..]).map(|(s, d)| s + d).collect();
        Self { directions, scalars }
    }
}

/// Surfaces, how they hang together, and the state to start from.
#[derive(Debug, Clone)]
pub struct System {
    /// One for every surface.
    pub forms: Vec<Form>,
    /// The free fits, seen through the shared unknowns.
    pub state: State,
}

impl System {
    /// A surface from the unknowns.
    pub fn surface(&self, index: usize, state: &State) -> Surface {
        let value = |scalar: &usize| state.scalars[*scalar];
        let signed = |direction: usize, sign: f64| {
            let axis = state.directions[direction];
            if sign < 0.0 { -axis } else { axis }
        };
        match &self.forms[index] {
            Form::Plane { direction, sign, base, offset } => {
                let normal = signed(*direction, *sign);
                let along = state.directions[*direction].dot(&base.coords) + value(offset);
                Surface::Plane(Plane { normal, offset: sign * along })
            }
            Form::Cylinder { line, sign, radius } => Surface::Cylinder(Cylinder {
                point: line.at(state, 0.0),
                axis: signed(line.direction, *sign),
                radius: value(radius),
            }),
            Form::Cone { line, sign, radius, angle } => {
                let half_angle = value(angle);
                let back = -sign * value(radius) / half_angle.tan();
                let axis = signed(line.direction, *sign);
                Surface::Cone(Cone { apex: line.at(state, back), axis, half_angle })
            }
            Form::Torus { line, sign, height, major, minor } => Surface::Torus(Torus {
                center: line.at(state, value(height)),
                axis: signed(line.direction, *sign),
                major_radius: value(major),
                minor_radius: value(minor),
            }),
            Form::Sphere { center, radius } => {
                let center = match center {
                    Center::Free(at) => Point::from(Vector::from(at.map(|s| state.scalars[s]))),
                    Center::OnLine(line, height) => line.at(state, value(height)),
                };
                Surface::Sphere(Sphere { center, radius: value(radius) })
            }
            Form::Revolved { line, sign, height, profile, factor } => {
                let revolved = Revolved {
                    point: line.at(state, *height),
                    axis: signed(line.direction, *sign),
                    profile: profile.iter().map(value).collect(),
                    factor: *factor,
                };
                Surface::Quadric(revolved.quadric())
            }
        }
    }

    /// The unknowns that a surface depends on.
    pub fn unknowns(&self, index: usize) -> Vec<usize> {
        let tilts = 2 * self.state.directions.len();
        let turn = |direction: usize| [2 * direction, 2 * direction + 1];
        let scalar = |s: usize| tilts + s;
        let of_line = |line: &Line| turn(line.direction).into_iter().chain(line.at.map(scalar));
        match &self.forms[index] {
            Form::Plane { direction, offset, .. } => {
                turn(*direction).into_iter().chain([scalar(*offset)]).collect()
            }
            Form::Cylinder { line, radius, .. } => of_line(line).chain([scalar(*radius)]).collect(),
            Form::Cone { line, radius, angle, .. } => {
                of_line(line).chain([*radius, *angle].map(scalar)).collect()
            }
            Form::Torus { line, height, major, minor, .. } => {
                of_line(line).chain([*height, *major, *minor].map(scalar)).collect()
            }
            Form::Sphere { center: Center::Free(at), radius } => {
                at.map(scalar).into_iter().chain([scalar(*radius)]).collect()
            }
            Form::Sphere { center: Center::OnLine(line, height), radius } => {
                of_line(line).chain([*height, *radius].map(scalar)).collect()
            }
            Form::Revolved { line, profile, .. } => {
                of_line(line).chain(profile.iter().map(|s| scalar(*s))).collect()
            }
        }
    }
}

impl Line {
    /// The point so far along the line.
    pub fn at(&self, state: &State, height: f64) -> Point {
        let (a, b) = (state.scalars[self.at[0]], state.scalars[self.at[1]]);
        let along = state.directions[self.direction].into_inner() * height;
        self.base + self.across[0] * a + self.across[1] * b + along
    }
}
