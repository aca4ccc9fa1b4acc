//! The dimensions of a drawing, and their rounding to a grid.

use super::equation::{Equation, Size};
use super::gaps;
use super::proposal::{Part, Proposal};

/// A dimension: a radius, an angle, a distance.
#[derive(Debug, Clone, PartialEq)]
pub struct Dimension {
    /// `radius`, `major_radius`, `minor_radius`, `half_angle`, `angle` or `distance`.
    pub kind: &'static str,
    /// The surfaces that have it, or that it lies between.
    pub surfaces: Vec<usize>,
    /// Radians or a length.
    pub value: f64,
    /// Standard deviation, under the relations.
    pub sigma: f64,
    /// Whether it was rounded.
    pub rounded: bool,
}

impl Dimension {
    /// Whether it is an angle.
    pub fn angular(&self) -> bool {
        ["half_angle", "angle"].contains(&self.kind)
    }
}

/// A grid coarser than this many standard deviations can be told from the data.
const TOLD: f64 = 2.0;
/// A dimension may lie this many standard deviations beside the grid.
const BESIDE: f64 = 3.0;

/// All dimensions, with the equation that fixes each to a value.
fn all(part: &Part) -> Vec<(Dimension, Box<dyn Fn(f64) -> Equation>)> {
    let mut found: Vec<(Dimension, Box<dyn Fn(f64) -> Equation>)> = Vec::new();
    let mut add = |kind, surfaces: Vec<usize>, value, equation: Box<dyn Fn(f64) -> Equation>| {
        let row = equation(value).row(part.view.system, &part.view.solution.state);
        let sigma = part.view.solution.spread.of(&[row])[(0, 0)].max(0.0).sqrt();
        found.push((Dimension { kind, surfaces, value, sigma, rounded: false }, equation));
    };
    let radii = [("radius", Size::Radius), ("minor_radius", Size::MinorRadius)];
    let sizes = radii.map(|(kind, size)| (kind, size, &part.classes.radius));
    let own: Vec<usize> = (0..part.surfaces.len()).collect();
    let others = [
        ("major_radius", Size::MajorRadius, &own),
        ("half_angle", Size::HalfAngle, &part.classes.angle),
    ];
    for (kind, size, class) in sizes.into_iter().chain(others) {
        let mut classes: std::collections::BTreeMap<usize, Vec<usize>> = Default::default();
        let has = |i: &usize| size.of(&part.surfaces[*i]).is_some();
        own.iter().copied().filter(has).for_each(|i| classes.entry(class[i]).or_default().push(i));
        for members in classes.into_values() {
            let surface = members[0];
            let Some(value) = size.of(&part.surfaces[surface]) else { continue };
            add(
                kind,
                members,
                value,
                Box::new(move |value| Equation::Size { surface, size, value }),
            );
        }
    }
    for (value, ends) in gaps::distances(part) {
        add("distance", ends.to_vec(), value, Box::new(move |v| Equation::Distance(ends, v)));
    }
    for (value, ends) in gaps::angles(part) {
        add("angle", ends.to_vec(), value, Box::new(move |v| Equation::Angle(ends, v)));
    }
    found
}

/// Dimensions as they are; those between the same surfaces as a rounded one are marked.
pub fn dimensions(part: &Part, rounded: &[Proposal]) -> Vec<Dimension> {
    let marked = |mut dimension: Dimension| {
        let same = |p: &Proposal| p.surfaces == dimension.surfaces;
        dimension.rounded = rounded.iter().any(same);
        dimension
    };
    all(part).into_iter().map(|(dimension, _)| marked(dimension)).collect()
}

/// Dimensions onto the user's grid, where the data tell the grid's lines apart and one is near.
pub fn proposals(part: &Part) -> Vec<Proposal> {
    let grid = part.view.demands.grid;
    let near = |(dimension, equation): (Dimension, Box<dyn Fn(f64) -> Equation>)| {
        let step = if dimension.angular() { grid.angle } else { grid.length }?;
        let target = (dimension.value / step).round() * step;
        let told = dimension.sigma * TOLD < step && target > 0.0;
        let beside = (dimension.value - target).abs() < BESIDE * dimension.sigma.max(1e-9);
        (told && beside).then(|| Proposal {
            forced: true,
            ..Proposal::new("rounded", dimension.surfaces, vec![equation(target)], step)
        })
    };
    all(part).into_iter().filter_map(near).collect()
}
