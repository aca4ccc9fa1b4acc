//! Placement and equality: which lines, centres, planes, radii and angles are one.

use nalgebra::{DMatrix, DVector};

use super::classes::Classes;
use super::cluster::{Rules, agglomerate};
use super::demands::Demands;
use super::position::Position;
use super::solve::{STEP, Solution};
use super::system::{Center, Form, Line, System};
use crate::math::{Point, Unit, frame};
use crate::surface::Scatter;

/// A solved system to look at.
pub struct View<'a> {
    /// Surfaces by their unknowns.
    pub system: &'a System,
    /// Their values and covariances.
    pub solution: &'a Solution,
    /// What the user says.
    pub demands: &'a Demands,
}

/// Area across a direction, length along it, and volume that places of a part in the unit cube
/// spread over.
pub const AREA: f64 = 0.3;
pub const LENGTH: f64 = 0.6;
const VOLUME: f64 = 0.2;
/// Radii spread over a few octaves: the density at one of them is that of its logarithm.
const OCTAVES: f64 = 3.0;
/// Half angles spread over a right angle.
pub const RIGHT_ANGLE: f64 = std::f64::consts::FRAC_PI_2;

impl View<'_> {
    fn scalar(&self, scalar: usize) -> (usize, f64) {
        (2 * self.system.state.directions.len() + scalar, self.solution.state.scalars[scalar])
    }

    /// Variance of a direction's tilt, the larger of the two.
    fn turn(&self, direction: usize) -> f64 {
        let rows = [vec![(2 * direction, 1.0)], vec![(2 * direction + 1, 1.0)]];
        self.solution.spread.of(&rows).diagonal().max()
    }

    /// Covariance of some scalars.
    pub fn covariance(&self, scalars: &[usize]) -> DMatrix<f64> {
        let rows: Vec<_> = scalars.iter().map(|&s| vec![(self.scalar(s).0, 1.0)]).collect();
        self.solution.spread.of(&rows)
    }

    /// The axis of a surface that has one.
    pub fn line_of(&self, i: usize) -> Option<&Line> {
        match &self.system.forms[i] {
            Form::Cylinder { line, .. }
            | Form::Cone { line, .. }
            | Form::Torus { line, .. }
            | Form::Revolved { line, .. } => Some(line),
            Form::Plane { .. } | Form::Sphere { .. } => None,
        }
    }

    pub fn axis(&self, i: usize) -> Option<Position> {
        let line = self.line_of(i)?;
        let state = &self.solution.state;
        let (u, v) = frame(&state.directions[line.direction]);
        let measured = line.at(state, 0.0);
        let value = [u, v].map(|axis| axis.dot(&measured.coords));
        // The line's own frame is that of the start: turned a little at most.
        Some(Position {
            group: line.direction,
            kin: None,
            count: 1,
            social: true,
            value: DVector::from_row_slice(&value),
            covariance: self.turned(line, &[u, v]),
            measured,
            turn: self.turn(line.direction),
            volume: AREA,
            tolerance: self.demands.gate.length,
        })
    }

    /// Covariance of a line's place in another frame across it.
    fn turned(&self, line: &Line, axes: &[Unit; 2]) -> DMatrix<f64> {
        let across = line.across;
        let turn = DMatrix::from_fn(2, 2, |i, j| axes[i].dot(&across[j]));
        &turn * self.covariance(&line.at) * turn.transpose()
    }

    pub fn plane(&self, i: usize) -> Option<Position> {
        let Form::Plane { direction, base, offset, .. } = &self.system.forms[i] else {
            return None;
        };
        let state = &self.solution.state;
        let along = state.directions[*direction].dot(&base.coords) + state.scalars[*offset];
        Some(Position {
            group: *direction,
            kin: None,
            count: 1,
            social: true,
            value: DVector::from_element(1, along),
            covariance: self.covariance(&[*offset]),
            measured: *base,
            turn: self.turn(*direction),
            volume: LENGTH,
            tolerance: self.demands.gate.length,
        })
    }

    pub fn center(&self, i: usize) -> Option<Position> {
        let state = &self.solution.state;
        let of_line = |line: &Line, height: usize| {
            let center = line.at(state, state.scalars[height]);
            let across = line.across;
            let d = state.directions[line.direction].into_inner();
            let axes = nalgebra::Matrix3::from_columns(&[across[0], across[1], d]);
            let axes = DMatrix::from_column_slice(3, 3, axes.as_slice());
            let spread = self.covariance(&[line.at[0], line.at[1], height]);
            (center, &axes * spread * axes.transpose())
        };
        let (center, covariance) = match &self.system.forms[i] {
            Form::Torus { line, height, .. } => of_line(line, *height),
            Form::Sphere { center: Center::OnLine(line, height), .. } => of_line(line, *height),
            Form::Sphere { center: Center::Free(at), .. } => (
                Point::from(nalgebra::Vector3::from(at.map(|s| state.scalars[s]))),
                self.covariance(at),
            ),
            _ => return None,
        };
        let value = DVector::from_column_slice(center.coords.as_slice());
        Some(Position {
            group: 0,
            kin: None,
            count: 1,
            social: false,
            value,
            covariance,
            measured: center,
            turn: 0.0,
            volume: VOLUME,
            tolerance: self.demands.gate.length,
        })
    }

    fn size(&self, scalar: usize, volume: f64, tolerance: Option<f64>) -> Position {
        let (_, value) = self.scalar(scalar);
        Position {
            group: 0,
            kin: None,
            count: 1,
            social: false,
            value: DVector::from_element(1, value),
            covariance: self.covariance(&[scalar]),
            measured: Point::origin(),
            turn: 0.0,
            volume,
            tolerance,
        }
    }

    pub fn radius(&self, i: usize) -> Option<Position> {
        let (Form::Cylinder { radius: scalar, .. }
        | Form::Sphere { radius: scalar, .. }
        | Form::Torus { minor: scalar, .. }) = &self.system.forms[i]
        else {
            return None;
        };
        let octaves = OCTAVES * self.scalar(*scalar).1.abs();
        let size = self.size(*scalar, octaves, self.demands.gate.length);
        let kin = match &self.system.forms[i] {
            Form::Cylinder { line, .. } => Some((0, line.direction)),
            Form::Torus { line, .. } => Some((1, line.direction)),
            _ => None,
        };
        Some(Position { kin, ..size })
    }

    pub fn angle(&self, i: usize) -> Option<Position> {
        let Form::Cone { angle, .. } = &self.system.forms[i] else { return None };
        Some(self.size(*angle, RIGHT_ANGLE, self.demands.gate.angle))
    }

    /// What each surface may still do.
    pub fn scatters(&self) -> Vec<Scatter> {
        let mut state = self.solution.state.clone();
        let of = |i: usize| {
            let unknowns = self.system.unknowns(i);
            let units: Vec<_> = unknowns.iter().map(|&u| vec![(u, 1.0)]).collect();
            let mut moved = |unknown: usize, step: f64| {
                let kept = state.value(unknown);
                state.nudge(unknown, step);
                let surface = self.system.surface(i, &state);
                state.restore(unknown, kept);
                surface
            };
            Scatter {
                covariance: self.solution.spread.of(&units),
                moved: unknowns.iter().map(|&u| [moved(u, STEP), moved(u, -STEP)]).collect(),
                step: STEP,
            }
        };
        (0..self.system.forms.len()).map(of).collect()
    }

    /// Classes of the positions; surfaces that have none keep theirs.
    fn classes(
        &self,
        old: &mut [usize],
        rules: &Rules,
        of: impl Fn(&Self, usize) -> Option<Position>,
    ) {
        let known = (0..old.len()).filter_map(|i| Some((i, of(self, i)?)));
        let (at, positions): (Vec<usize>, Vec<Position>) = known.unzip();
        let (classes, _) = agglomerate(positions, &rules.at(&at));
        for (&i, class) in at.iter().zip(&classes) {
            // A class is called after its first surface.
            let first = classes.iter().position(|c| c == class).map_or(i, |first| at[first]);
            old[i] = first;
        }
    }

    /// Coaxial and coplanar surfaces.
    pub fn align(&self, classes: &mut Classes) {
        self.classes(&mut classes.line, &self.demands.rules("coaxial"), Self::axis);
        self.classes(&mut classes.offset, &self.demands.rules("coplanar"), Self::plane);
    }

    /// Surfaces with one centre.
    pub fn center_all(&self, classes: &mut Classes) {
        let mut center = classes.center.clone();
        self.classes(&mut center, &self.demands.rules("concentric"), Self::center);
        // Tori on different lines cannot share a centre here.
        let line = |i: usize| self.line_of(i).map(|_| classes.line[i]);
        for i in 0..center.len() {
            let first = (0..i).find(|&j| center[j] == center[i] && line(j).is_some());
            if let (Some(first), Some(own)) = (first, line(i))
                && line(first) != Some(own)
            {
                center[i] = i;
            }
        }
        classes.center = center;
    }

    /// Equal radii and angles.
    pub fn equalise(&self, classes: &mut Classes) {
        self.classes(&mut classes.radius, &self.demands.rules("equal_radius"), Self::radius);
        self.classes(&mut classes.angle, &self.demands.rules("equal_angle"), Self::angle);
    }
}
