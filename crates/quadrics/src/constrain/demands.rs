//! What a user says about the relations: forced, forbidden, fixed, and by which gate.

use super::cluster::Rules;
use super::equation::Size;
use super::gate::Gate;

/// Everything that a user may say; nothing by default. Regions are those of the result.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Demands {
    /// Relations that must, or must not, be there.
    pub relations: Vec<Demand>,
    /// Parameters that are known.
    pub fixed: Vec<Fixed>,
    /// Tolerances instead of odds; lengths in input units.
    pub gate: Gate,
    /// Dimensions are rounded to multiples of these where the data allow it.
    pub grid: Grid,
}

impl Demands {
    /// Whether a region is named by a relation or a parameter.
    pub fn mention(&self, region: usize) -> bool {
        self.relations.iter().any(|demand| demand.regions.contains(&region))
            || self.fixed.iter().any(|fixed| fixed.region == region)
    }
}

/// A relation that must, or must not, be there.
#[derive(Debug, Clone, PartialEq)]
pub struct Demand {
    /// One of [`KINDS`].
    pub kind: String,
    /// The regions; pairs of them one after the other for relations of pairs.
    pub regions: Vec<usize>,
    /// Whether it must hold; otherwise it must not be imposed.
    pub forced: bool,
}

/// A parameter that is known, by its name in the result files.
#[derive(Debug, Clone, PartialEq)]
pub struct Fixed {
    /// The region.
    pub region: usize,
    /// `radius`, `major_radius`, `minor_radius`, `half_angle_deg`, `offset`, `axis`, `normal`, `center`
    /// or `point`.
    pub parameter: String,
    /// One number, or three.
    pub value: Vec<f64>,
}

/// Multiples that dimensions are rounded to; none where not given.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Grid {
    /// Radii and distances.
    pub length: Option<f64>,
    /// Half angles and angles between directions, in radians.
    pub angle: Option<f64>,
}

/// The kinds of relations.
pub const KINDS: [&str; 14] = [
    "parallel",
    "orthogonal",
    "coaxial",
    "concentric",
    "coplanar",
    "equal_radius",
    "equal_angle",
    "center_on_axis",
    "axis_in_plane",
    "tangent",
    "equal_dihedral",
    "equal_distance",
    "symmetric",
    "pattern",
];

/// Relations that are classes of equal things.
const CLASSES: [&str; 6] =
    ["parallel", "coaxial", "concentric", "coplanar", "equal_radius", "equal_angle"];
/// Relations whose regions are pairs, one after the other.
const OF_PAIRS: [&str; 3] = ["equal_dihedral", "equal_distance", "symmetric"];

impl Demands {
    /// What they say about one class of equal things, by numbers of regions.
    pub fn rules(&self, kind: &str) -> Rules {
        let mut rules = Rules::default();
        for demand in &self.relations {
            // Coaxial and coplanar surfaces are parallel too.
            let follows = kind == "parallel" && ["coaxial", "coplanar"].contains(&&*demand.kind);
            if demand.kind == kind && !demand.forced {
                rules.apart.extend(pairs(&demand.regions));
            } else if demand.forced && (demand.kind == kind || follows) {
                rules.same.extend(pairs(&demand.regions));
            }
        }
        rules
    }

    /// Whether a relation between exactly these regions is forbidden.
    pub fn forbids(&self, kind: &str, regions: &[usize]) -> bool {
        let sorted = |regions: &[usize]| {
            let mut sorted = regions.to_vec();
            sorted.sort_unstable();
            sorted.dedup();
            sorted
        };
        let wanted = sorted(regions);
        let same = |demand: &&Demand| !demand.forced && demand.kind == kind;
        self.relations.iter().filter(same).any(|demand| sorted(&demand.regions) == wanted)
    }

    /// Relations that the user wants and that are no classes of equal things.
    pub fn forced(&self) -> impl Iterator<Item = &Demand> {
        self.relations.iter().filter(|demand| demand.forced && !CLASSES.contains(&&*demand.kind))
    }

    /// Whether two surfaces are made one in a class by the user.
    pub fn joins(&self, kind: &str, members: &[usize]) -> bool {
        let same = |(i, j): &(usize, usize)| members.contains(i) && members.contains(j);
        self.rules(kind).same.iter().any(same)
    }
}

/// Whether the regions of a relation are pairs.
pub fn of_pairs(kind: &str) -> bool {
    OF_PAIRS.contains(&kind)
}

fn pairs(regions: &[usize]) -> Vec<(usize, usize)> {
    let each = |(at, &i): (usize, &usize)| regions[at + 1..].iter().map(move |&j| (i, j)).collect();
    regions.iter().enumerate().flat_map::<Vec<_>, _>(each).collect()
}

impl Fixed {
    /// The size that the parameter is, where it is one.
    pub fn size(&self) -> Option<Size> {
        Some(match self.parameter.as_str() {
            "radius" => Size::Radius,
            "major_radius" => Size::MajorRadius,
            "minor_radius" => Size::MinorRadius,
            "half_angle_deg" => Size::HalfAngle,
            "offset" => Size::Offset,
            _ => return None,
        })
    }
}
