//! Geometric constraints between recognised surfaces (paper, 4.3(5)), after Li et al., "GlobFit"
//! (SIGGRAPH 2011), for all types and by the covariances of the fits.
//!
//! Surfaces and their condensed normal equations come in, never a face. Relations are added in
//! stages: orientation, placement, equality, then contact, distances, symmetry and patterns. What is
//! equal becomes one unknown ([`system`]); what cannot be substituted stays an equation
//! ([`equation`]), admitted one at a time ([`admit`], [`weigh`]).

mod admit;
mod alike;
mod asked;
mod bounds;
mod build;
mod classes;
mod cluster;
mod contact;
mod demands;
mod directions;
mod equation;
mod gaps;
mod gate;
mod measure;
mod mirror;
mod orient;
mod pattern;
mod places;
mod position;
mod proposal;
mod refusals;
mod relate;
mod report;
mod rounding;
mod solve;
mod spread;
mod stages;
mod system;
mod weigh;

use crate::surface::{Condensed, Scatter, Surface};
use stages::Work;

pub use demands::{Demand, Demands, Fixed, Grid, KINDS, of_pairs};
pub use gate::Gate;
pub use report::{Link, Value};
pub use rounding::Dimension;

/// Surfaces under their relations.
pub struct Constrained {
    /// One for every surface that came in.
    pub surfaces: Vec<Surface>,
    /// The relations, by positions of the surfaces.
    pub links: Vec<Link>,
    /// The dimensions of a drawing.
    pub dimensions: Vec<Dimension>,
    /// How far each surface may still move; empty where nothing was solved.
    pub scatters: Vec<Scatter>,
}

/// Finds the relations that the data support and the user wants, and moves the surfaces until they
/// hold. `neighbours` has the surfaces that share a border with each; `demands` are about positions
/// in `items`.
///
/// # Errors
/// A demand that surfaces of these types cannot fulfil, in words; positions stand in braces.
pub fn constrain(
    items: &[Condensed],
    neighbours: &[Vec<usize>],
    demands: &Demands,
) -> Result<Constrained, String> {
    asked::check(items, demands)?;
    let mut work = Work::new(items, neighbours, demands);
    work.equalise();
    work.relate();
    work.round();
    Ok(work.done())
}

/// The surfaces under what is equal and at right angles alone: who touches whom, and which steps
/// repeat, is not settled while regions still change.
pub fn equalise(items: &[Condensed]) -> Vec<Surface> {
    let demands = Demands::default();
    let mut work = Work::new(items, &[], &demands);
    work.equalise();
    work.surfaces()
}

/// The surfaces under their common directions and axes alone.
pub fn align(items: &[Condensed]) -> Vec<Surface> {
    let demands = Demands::default();
    let mut work = Work::new(items, &[], &demands);
    work.align();
    work.surfaces()
}

#[cfg(test)]
mod admit_tests;
#[cfg(test)]
mod demand_tests;
#[cfg(test)]
mod relation_tests;
#[cfg(test)]
mod tests;
