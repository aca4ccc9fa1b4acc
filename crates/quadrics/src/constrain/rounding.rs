//! The dimensions of a drawing, and their rounding to a grid.

use std::collections::BTreeMap;

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

/// What a dimension measures.
#[derive(Clone, Copy)]
enum Measured {
    /// A size that the class of this surface shares.
    Size(usize, Size),
    /// The distance of two planes.
    Distance([usize; 2]),
    /// The angle between two directions.
    Angle([usize; 2]),
}

impl Measured {
    /// The equation that gives it a value.
    fn fixed(self, value: f64) -> Equation {
        match self {
            Self::Size(surface, size) => Equation::Size { surface, size, value },
            Self::Distance(ends) => Equation::Distance(ends, value),
            Self::Angle(ends) => Equation::Angle(ends, value),
        }
    }

    /// Whether an equation gives it a value.
    fn is_fixed_by(self, equation: &Equation) -> bool {
        let (Equation::Size { value, .. }
        | Equation::Distance(_, value)
        | Equation::Angle(_, value)) = equation
        else {
            return false;
        };
        *equation == self.fixed(*value)
    }
}

/// All dimensions, and what they measure.
fn all(part: &Part) -> Vec<(Dimension, Measured)> {
    let told = |kind, surfaces: Vec<usize>, value: f64, measured: Measured| {
        let row = measured.fixed(value).row(part.view.system, &part.view.solution.state);
        let sigma = part.view.solution.spread.of(&[row])[(0, 0)].max(0.0).sqrt();
        (Dimension { kind, surfaces, value, sigma, rounded: false }, measured)
    };
    let own: Vec<usize> = (0..part.surfaces.len()).collect();
    let sizes = [
        ("radius", Size::Radius, &part.classes.radius),
        ("minor_radius", Size::MinorRadius, &part.classes.radius),
        ("major_radius", Size::MajorRadius, &own),
        ("half_angle", Size::HalfAngle, &part.classes.angle),
    ];
    let mut found = Vec::new();
    for (kind, size, class) in sizes {
        let mut classes: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        let has = |i: &usize| size.of(&part.surfaces[*i]).is_some();
        own.iter().copied().filter(has).for_each(|i| classes.entry(class[i]).or_default().push(i));
        for members in classes.into_values() {
            let surface = members[0];
            let Some(value) = size.of(&part.surfaces[surface]) else { continue };
            found.push(told(kind, members, value, Measured::Size(surface, size)));
        }
    }
    let between = |kind, of: fn([usize; 2]) -> Measured| {
        move |(value, ends): (f64, [usize; 2])| told(kind, ends.to_vec(), value, of(ends))
    };
    found.extend(gaps::distances(part).into_iter().map(between("distance", Measured::Distance)));
    found.extend(gaps::angles(part).into_iter().map(between("angle", Measured::Angle)));
    found
}

/// Dimensions as they are; those that a relation of `rounded` fixes are marked.
pub fn dimensions(part: &Part, rounded: &[Proposal]) -> Vec<Dimension> {
    let marked = |(dimension, measured): (Dimension, Measured)| {
        let fixed = |p: &Proposal| p.equations.iter().any(|e| measured.is_fixed_by(e));
        Dimension { rounded: rounded.iter().any(fixed), ..dimension }
    };
    all(part).into_iter().map(marked).collect()
}

/// Dimensions onto the user's grid, where the data tell the grid's lines apart and one is near.
pub fn proposals(part: &Part) -> Vec<Proposal> {
    let grid = part.view.demands.grid;
    let near = |(dimension, measured): (Dimension, Measured)| {
        let step = if dimension.angular() { grid.angle } else { grid.length }?;
        let target = (dimension.value / step).round() * step;
        let told = dimension.sigma * TOLD < step && target > 0.0;
        let beside = (dimension.value - target).abs() < BESIDE * dimension.sigma.max(1e-9);
        (told && beside).then(|| Proposal {
            forced: true,
            ..Proposal::new("rounded", dimension.surfaces, vec![measured.fixed(target)], step)
        })
    };
    all(part).into_iter().filter_map(near).collect()
}
