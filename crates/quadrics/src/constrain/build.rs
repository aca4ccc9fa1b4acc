//! From classes to unknowns: every class gets its own once, its members refer to them.

use super::classes::Classes;
use super::system::{Center, Form, Line, State, System};
use crate::math::{Point, Unit, frame};
use crate::surface::{Condensed, Revolved, Surface, direction};

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
        let line = Line { direction, base: foot, across: [u, v].map(Unit::into_inner), at };
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
            Surface::Quadric(s) => {
                let own = Revolved::of(s)?.from(item.foot);
                let line = self.line(i, item.foot);
                let height = self.state.directions[class].dot(&(item.foot - line.base));
                let profile = own.profile.iter().map(|value| self.own(*value)).collect();
                Form::Revolved { line, sign, height, profile, factor: own.factor }
            }
            Surface::FreeForm => return None,
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
