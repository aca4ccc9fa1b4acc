//! Relations between surfaces that equations say, each all of them or none.

use nalgebra::Vector2;

use super::classes::Classes;
use super::equation::Equation;
use super::measure::has_axis;
use super::places::View;
use crate::math::{Unit, frame};
use crate::surface::{Condensed, Surface, direction};

/// A relation that might hold.
#[derive(Debug, Clone)]
pub struct Proposal {
    /// Its name in the result files.
    pub kind: &'static str,
    /// The surfaces, pairs one after the other for relations of pairs.
    pub surfaces: Vec<usize>,
    /// What would hold.
    pub equations: Vec<Equation>,
    /// Range of the value of each equation if the relation does not hold.
    pub range: f64,
    /// Log odds before anything is measured, over those of any relation.
    pub before: f64,
    /// The user wants it.
    pub forced: bool,
}

impl Proposal {
    /// One that nobody asked for.
    pub fn new(
        kind: &'static str,
        surfaces: Vec<usize>,
        equations: Vec<Equation>,
        range: f64,
    ) -> Self {
        Self { kind, surfaces, equations, range, before: 0.0, forced: false }
    }

    /// Whether its residual is an angle.
    pub fn angular(&self) -> bool {
        let angle = |e: &Equation| {
            matches!(e, Equation::Angle(..) | Equation::EqualAngle(_) | Equation::Towards { .. })
        };
        self.equations.first().is_some_and(angle)
    }
}

/// The part as far as it is solved: what proposals are made from.
pub struct Part<'a> {
    /// The free fits.
    pub items: &'a [Condensed],
    /// What is one thing.
    pub classes: &'a Classes,
    /// Unknowns and their covariances.
    pub view: View<'a>,
    /// The surfaces as they are.
    pub surfaces: Vec<Surface>,
    /// The surfaces that share a border with each.
    pub neighbours: &'a [Vec<usize>],
}

/// Cosine, sine and length up to which something holds exactly.
const EXACT: f64 = 1e-9;

impl Part<'_> {
    /// Direction of a surface.
    pub fn way(&self, i: usize) -> Option<Unit> {
        direction(&self.surfaces[i])
    }

    /// Whether two directions are at right angles.
    pub fn right(&self, i: usize, j: usize) -> bool {
        let (Some(a), Some(b)) = (self.way(i), self.way(j)) else { return false };
        a.dot(&b).abs() < EXACT
    }

    /// Whether two directions are one.
    pub fn parallel(&self, i: usize, j: usize) -> bool {
        let (Some(a), Some(b)) = (self.way(i), self.way(j)) else { return false };
        a.cross(&b).norm() < EXACT
    }

    /// One surface of every class among those of which `member` holds: the one whose direction is
    /// known best.
    pub fn speakers(&self, class: &[usize], member: impl Fn(&Surface) -> bool) -> Vec<usize> {
        let mut best: std::collections::BTreeMap<usize, (f64, usize)> = Default::default();
        for (i, item) in self.items.iter().enumerate().filter(|(_, item)| member(&item.surface)) {
            let Some((_, covariance)) = item.direction() else { continue };
            let new = (covariance.trace(), i);
            best.entry(class[i])
                .and_modify(|old| {
                    if new.0 < old.0 {
                        *old = new
                    }
                })
                .or_insert(new);
        }
        best.into_values().map(|(_, i)| i).collect()
    }

    /// One surface of every axis line.
    pub fn lines(&self) -> Vec<usize> {
        self.speakers(&self.classes.line, has_axis)
    }

    /// One plane of every set of coplanar ones.
    pub fn planes(&self) -> Vec<usize> {
        self.speakers(&self.classes.offset, |s| matches!(s, Surface::Plane(_)))
    }

    /// Where an axis passes the plane through the origin across a direction.
    pub fn pierced(&self, i: usize, direction: &Unit) -> Vector2<f64> {
        let (u, v) = frame(direction);
        let at = super::equation::place(&self.surfaces[i]).coords;
        Vector2::new(u.dot(&at), v.dot(&at))
    }

    /// Standard deviation of the place of an axis, the larger of both ways across it.
    pub fn unsure(&self, i: usize) -> f64 {
        self.view
            .line_of(i)
            .map_or(0.0, |line| self.view.covariance(&line.at).diagonal().max().sqrt())
    }
}
