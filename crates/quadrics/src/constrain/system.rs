//! Surfaces by shared unknowns: what is one thing in the part is one unknown here.
//!
//! A direction is shared by a parallel class, a line by a coaxial one, a centre, an offset, a radius,
//! an angle by theirs: equality needs no equation and holds to the last bit.

use crate::math::{Point, Unit, Vector, frame};
use crate::surface::{Condensed, Cone, Cylinder, Plane, Sphere, Surface, Torus, direction};

/// Which thing of its kind every surface has; surfaces of one number share it.
#[derive(Debug, Clone)]
pub struct Classes {
    /// Directions: normals and axes.
    pub direction: Vec<usize>,
    /// Axis lines.
    pub line: Vec<usize>,
    /// Centres of spheres and tori.
    pub center: Vec<usize>,
    /// Offsets of planes.
    pub offset: Vec<usize>,
    /// Radii of cylinders and spheres, minor radii of tori.
    pub radius: Vec<usize>,
    /// Half angles of cones.
    pub angle: Vec<usize>,
}

impl Classes {
    /// Every surface on its own.
    pub fn apart(count: usize) -> Self {
        let own: Vec<usize> = (0..count).collect();
        Self {
            direction: own.clone(),
            line: own.clone(),
            center: own.clone(),
            offset: own.clone(),
            radius: own.clone(),
            angle: own,
        }
    }
}

/// An axis: it passes `base + a u + b v` along a direction.
#[derive(Debug, Clone)]
pub struct Line {
    /// The direction's number.
    pub direction: usize,
    base: Point,
    across: (Vector, Vector),
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
}

/// Values of all unknowns.
#[derive(Debug, Clone)]
pub struct State {
    /// Unit vectors; two unknowns each, its tilts.
    pub directions: Vec<Unit>,
    /// Everything else, lengths and radians.
    pub scalars: Vec<f64>,
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
    /// Builds the unknowns; `directions` has the start of every direction class.
    pub fn new(items: &[Condensed], classes: &Classes, directions: &[Unit]) -> Self {
        let mut builder = Builder {
            items,
            classes,
            state: State { directions: directions.to_vec(), scalars: Vec::new() },
            lines: vec![None; items.len()],
            centers: vec![None; items.len()],
            heights: vec![None; items.len()],
            scalars: Default::default(),
        };
        // Tori first: spheres that share their centres lie on their axes.
        let mut forms: Vec<Option<Form>> = vec![None; items.len()];
        let is_sphere = |i: &usize| matches!(items[*i].surface, Surface::Sphere(_));
        let order =
            (0..items.len()).filter(|i| !is_sphere(i)).chain((0..items.len()).filter(is_sphere));
        for i in order {
            forms[i] = builder.form(i);
        }
        Self { forms: forms.into_iter().flatten().collect(), state: builder.state }
    }

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
        }
    }
}

impl Line {
    /// The directions that `a` and `b` lead to.
    pub fn across(&self) -> [Vector; 2] {
        [self.across.0, self.across.1]
    }

    /// The point so far along the line.
    pub fn at(&self, state: &State, height: f64) -> Point {
        let (a, b) = (state.scalars[self.at[0]], state.scalars[self.at[1]]);
        let along = state.directions[self.direction].into_inner() * height;
        self.base + self.across.0 * a + self.across.1 * b + along
    }
}

struct Builder<'a> {
    items: &'a [Condensed],
    classes: &'a Classes,
    state: State,
    lines: Vec<Option<Line>>,
    centers: Vec<Option<Center>>,
    heights: Vec<Option<usize>>,
    scalars: std::collections::BTreeMap<(&'static str, usize), usize>,
}

impl Builder<'_> {
    /// A scalar of one surface alone.
    fn own(&mut self, value: f64) -> usize {
        self.state.scalars.push(value);
        self.state.scalars.len() - 1
    }

    /// A scalar that a class shares; it starts where its first surface has it.
    fn shared(&mut self, kind: &'static str, class: usize, value: f64) -> usize {
        if let Some(&known) = self.scalars.get(&(kind, class)) {
            return known;
        }
        let new = self.own(value);
        self.scalars.insert((kind, class), new);
        new
    }

    /// The axis of a surface's class, and whether the surface runs along it.
    fn line(&mut self, i: usize, foot: Point) -> Line {
        let class = self.classes.line[i];
        if let Some(known) = &self.lines[class] {
            return known.clone();
        }
        let direction = self.classes.direction[i];
        let (u, v) = frame(&self.state.directions[direction]);
        let at = [self.own(0.0), self.own(0.0)];
        let line = Line { direction, base: foot, across: (u.into_inner(), v.into_inner()), at };
        self.lines[class] = Some(line.clone());
        line
    }

    fn form(&mut self, i: usize) -> Option<Form> {
        let item = &self.items[i];
        let class = self.classes.direction[i];
        let sign = direction(&item.surface)
            .map_or(1.0, |own| own.dot(&self.state.directions[class]).signum());
        let radius = self.classes.radius[i];
        Some(match &item.surface {
            Surface::Plane(_) => {
                let first =
                    self.classes.offset.iter().position(|c| *c == self.classes.offset[i])?;
                let base = self.items[first].foot;
                let offset = self.shared("offset", self.classes.offset[i], 0.0);
                Form::Plane { direction: class, sign, base, offset }
            }
            Surface::Cylinder(s) => {
                let line = self.line(i, item.foot);
                Form::Cylinder { line, sign, radius: self.shared("radius", radius, s.radius) }
            }
            Surface::Cone(s) => {
                let line = self.line(i, item.foot);
                let at = s.axis.dot(&(line.base - s.apex)) * s.half_angle.tan();
                let radius = self.own(at);
                let angle = self.shared("angle", self.classes.angle[i], s.half_angle);
                Form::Cone { line, sign, radius, angle }
            }
            Surface::Torus(s) => {
                let line = self.line(i, item.foot);
                let height = self.height(i, &line, s.center);
                let major = self.own(s.major_radius);
                let minor = self.shared("radius", radius, s.minor_radius);
                Form::Torus { line, sign, height, major, minor }
            }
            Surface::Sphere(s) => {
                let center = self.center(i, s.center);
                Form::Sphere { center, radius: self.shared("radius", radius, s.radius) }
            }
            Surface::Quadric(_) | Surface::FreeForm => return None,
        })
    }

    /// How far up a line the centre of a class lies.
    fn height(&mut self, i: usize, line: &Line, center: Point) -> usize {
        let class = self.classes.center[i];
        if let Some(known) = self.heights[class] {
            return known;
        }
        let along = self.state.directions[line.direction].dot(&(center - line.base));
        let height = self.own(along);
        self.heights[class] = Some(height);
        self.centers[class] = Some(Center::OnLine(line.clone(), height));
        height
    }

    fn center(&mut self, i: usize, center: Point) -> Center {
        let class = self.classes.center[i];
        if let Some(known) = &self.centers[class] {
            return known.clone();
        }
        let at = [center.x, center.y, center.z].map(|value| self.own(value));
        let new = Center::Free(at);
        self.centers[class] = Some(new.clone());
        new
    }
}
