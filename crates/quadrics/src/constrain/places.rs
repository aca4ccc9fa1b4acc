//! Placement and equality: which lines, centres, planes, radii and angles are one.

use nalgebra::{DMatrix, DVector};

use super::cluster::{Estimate, agglomerate};
use super::gate;
use super::solve::Solution;
use super::system::{Center, Classes, Form, Line, System};
use crate::math::{Point, Unit, frame};

/// Where something is, in one or more numbers, and their covariance.
struct Position {
    /// Only things of one group are compared.
    group: usize,
    count: usize,
    /// Whether large groups attract: axes gather, sizes do not.
    social: bool,
    value: DVector<f64>,
    covariance: DMatrix<f64>,
    /// Where it was measured, and the variance of the direction that leads elsewhere.
    measured: Point,
    turn: f64,
    /// Volume of the places that it might have been in.
    volume: f64,
}

impl Position {
    /// Variance that the direction adds over the way between two measurements.
    fn lever(&self, other: &Self) -> DMatrix<f64> {
        let way = (self.measured - other.measured).norm_squared();
        DMatrix::identity(self.value.len(), self.value.len()) * (way * self.turn.max(other.turn))
    }
}

impl Estimate for Position {
    fn log_odds(&self, other: &Self) -> Option<f64> {
        if self.group != other.group {
            return None;
        }
        let covariance = &self.covariance + &other.covariance + self.lever(other);
        let before = if self.social { gate::joining(self.count, other.count) } else { 0.0 };
        let volume = self.volume.max(other.volume);
        gate::log_odds(&(&self.value - &other.value), &covariance, volume, before)
    }

    fn fused(&self, other: &Self) -> Self {
        let total = (&self.covariance + &other.covariance).try_inverse();
        let gain = total.map_or_else(|| self.covariance.clone() * 0.0, |t| &self.covariance * t);
        let nearer = self.covariance.trace() <= other.covariance.trace();
        Self {
            group: self.group,
            count: self.count + other.count,
            social: self.social,
            value: &self.value + &gain * (&other.value - &self.value),
            covariance: &self.covariance - &gain * &self.covariance,
            measured: if nearer { self.measured } else { other.measured },
            turn: self.turn.max(other.turn),
            volume: self.volume,
        }
    }
}

/// A solved system to look at.
pub struct View<'a> {
    /// Surfaces by their unknowns.
    pub system: &'a System,
    /// Their values and covariances.
    pub solution: &'a Solution,
}

/// Area across a direction, length along it, and volume that places of a part in the unit cube
/// spread over.
const AREA: f64 = 0.3;
const LENGTH: f64 = 0.6;
const VOLUME: f64 = 0.2;
/// Radii spread over a few octaves: the density at one of them is that of its logarithm.
const OCTAVES: f64 = 3.0;
/// Half angles spread over a right angle.
const RIGHT_ANGLE: f64 = std::f64::consts::FRAC_PI_2;

impl View<'_> {
    fn scalar(&self, scalar: usize) -> (usize, f64) {
        (2 * self.system.state.directions.len() + scalar, self.solution.state.scalars[scalar])
    }

    /// Variance of a direction's tilt, the larger of the two.
    fn turn(&self, direction: usize) -> f64 {
        let rows = [vec![(2 * direction, 1.0)], vec![(2 * direction + 1, 1.0)]];
        self.solution.spread.of(&rows).diagonal().max()
    }

    fn covariance(&self, scalars: &[usize]) -> DMatrix<f64> {
        let rows: Vec<_> = scalars.iter().map(|&s| vec![(self.scalar(s).0, 1.0)]).collect();
        self.solution.spread.of(&rows)
    }

    fn line_of(&self, i: usize) -> Option<&Line> {
        match &self.system.forms[i] {
            Form::Cylinder { line, .. } | Form::Cone { line, .. } | Form::Torus { line, .. } => {
                Some(line)
            }
            _ => None,
        }
    }

    fn axis(&self, i: usize) -> Option<Position> {
        let line = self.line_of(i)?;
        let state = &self.solution.state;
        let (u, v) = frame(&state.directions[line.direction]);
        let measured = line.at(state, 0.0);
        let value = [u, v].map(|axis| axis.dot(&measured.coords));
        // The line's own frame is that of the start: turned a little at most.
        Some(Position {
            group: line.direction,
            count: 1,
            social: true,
            value: DVector::from_row_slice(&value),
            covariance: self.turned(line, &[u, v]),
            measured,
            turn: self.turn(line.direction),
            volume: AREA,
        })
    }

    /// Covariance of a line's place in another frame across it.
    fn turned(&self, line: &Line, axes: &[Unit; 2]) -> DMatrix<f64> {
        let across = line.across();
        let turn = DMatrix::from_fn(2, 2, |i, j| axes[i].dot(&across[j]));
        &turn * self.covariance(&line.at) * turn.transpose()
    }

    fn plane(&self, i: usize) -> Option<Position> {
        let Form::Plane { direction, base, offset, .. } = &self.system.forms[i] else {
            return None;
        };
        let state = &self.solution.state;
        let along = state.directions[*direction].dot(&base.coords) + state.scalars[*offset];
        Some(Position {
            group: *direction,
            count: 1,
            social: true,
            value: DVector::from_element(1, along),
            covariance: self.covariance(&[*offset]),
            measured: *base,
            turn: self.turn(*direction),
            volume: LENGTH,
        })
    }

    fn center(&self, i: usize) -> Option<Position> {
        let state = &self.solution.state;
        let of_line = |line: &Line, height: usize| {
            let center = line.at(state, state.scalars[height]);
            let across = line.across();
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
            count: 1,
            social: false,
            value,
            covariance,
            measured: center,
            turn: 0.0,
            volume: VOLUME,
        })
    }

    fn size(&self, scalar: usize, volume: f64) -> Position {
        let (_, value) = self.scalar(scalar);
        Position {
            group: 0,
            count: 1,
            social: false,
            value: DVector::from_element(1, value),
            covariance: self.covariance(&[scalar]),
            measured: Point::origin(),
            turn: 0.0,
            volume,
        }
    }

    fn radius(&self, i: usize) -> Option<Position> {
        let (Form::Cylinder { radius: scalar, .. }
        | Form::Sphere { radius: scalar, .. }
        | Form::Torus { minor: scalar, .. }) = &self.system.forms[i]
        else {
            return None;
        };
        Some(self.size(*scalar, OCTAVES * self.scalar(*scalar).1.abs()))
    }

    fn angle(&self, i: usize) -> Option<Position> {
        let Form::Cone { angle, .. } = &self.system.forms[i] else { return None };
        Some(self.size(*angle, RIGHT_ANGLE))
    }

    /// Classes of the positions; surfaces that have none keep theirs.
    fn classes(&self, old: &mut [usize], of: impl Fn(&Self, usize) -> Option<Position>) {
        let known = (0..old.len()).filter_map(|i| Some((i, of(self, i)?)));
        let (at, positions): (Vec<usize>, Vec<Position>) = known.unzip();
        let (classes, _) = agglomerate(positions);
        for (&i, class) in at.iter().zip(&classes) {
            // A class is called after its first surface.
            let first = classes.iter().position(|c| c == class).map_or(i, |first| at[first]);
            old[i] = first;
        }
    }

    /// Coaxial and coplanar surfaces.
    pub fn align(&self, classes: &mut Classes) {
        self.classes(&mut classes.line, Self::axis);
        self.classes(&mut classes.offset, Self::plane);
    }

    /// Surfaces with one centre.
    pub fn center_all(&self, classes: &mut Classes) {
        let mut center = classes.center.clone();
        self.classes(&mut center, Self::center);
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
        self.classes(&mut classes.radius, Self::radius);
        self.classes(&mut classes.angle, Self::angle);
    }
}
