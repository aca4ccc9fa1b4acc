//! What a user says about the relations: forced, forbidden, fixed, rounded.

use super::tests::{cylinder, plane, sphere};
use super::{Demand, Demands, Fixed, Gate, Grid, Link, constrain};
use crate::math::Vector;
use crate::surface::{Condensed, Surface, direction};

fn demand(kind: &str, regions: &[usize], forced: bool) -> Demands {
    let demand = Demand { kind: kind.to_owned(), regions: regions.to_vec(), forced };
    Demands { relations: vec![demand], ..Demands::default() }
}

fn fixed(region: usize, parameter: &str, value: &[f64]) -> Demands {
    let fixed = Fixed { region, parameter: parameter.to_owned(), value: value.to_vec() };
    Demands { fixed: vec![fixed], ..Demands::default() }
}

fn apart(items: &[Condensed]) -> Vec<Vec<usize>> {
    vec![Vec::new(); items.len()]
}

fn standing<'a>(links: &'a [Link], kind: &str) -> Vec<&'a Link> {
    links.iter().filter(|link| link.kind == kind && link.status != "refused").collect()
}

#[test]
fn a_forced_relation_that_the_data_refuse_holds_and_says_so() {
    let leaning = Vector::new(0.05, 0.0, 1.0);
    let items = [plane([0.3, 0.5, 0.5], Vector::z()), plane([0.7, 0.5, 0.5], leaning)];
    let found = constrain(&items, &apart(&items), &demand("parallel", &[0, 1], true)).unwrap();
    let parallel = standing(&found.links, "parallel")[0];
    assert!(parallel.after < 1e-9 && parallel.before > 2.0);
    assert!(parallel.reason.ends_with("the user wants it"), "{}", parallel.reason);

    let across = [plane([0.3, 0.5, 0.5], Vector::x()), plane([0.7, 0.5, 0.5], leaning)];
    let found = constrain(&across, &apart(&across), &demand("orthogonal", &[0, 1], true)).unwrap();
    let right = standing(&found.links, "orthogonal")[0];
    assert!(right.after < 1e-9 && right.before > 2.0);
    assert!(right.reason.contains("the data refuse it"), "{}", right.reason);
}

#[test]
fn what_is_forbidden_is_not_imposed() {
    let leaning = Vector::new(1e-5, 0.0, 1.0);
    let items = [plane([0.3, 0.5, 0.5], Vector::z()), plane([0.7, 0.5, 0.5], leaning)];
    let free = constrain(&items, &apart(&items), &Demands::default()).unwrap();
    assert_eq!(standing(&free.links, "coplanar").len(), 1);
    for kind in ["coplanar", "parallel"] {
        let found = constrain(&items, &apart(&items), &demand(kind, &[0, 1], false)).unwrap();
        assert!(standing(&found.links, kind).is_empty(), "{:?}", found.links);
        let told = |link: &Link| link.kind == kind && link.reason == "the user forbids it";
        assert!(found.links.iter().any(told), "{:?}", found.links);
    }
}

#[test]
fn known_values_hold_exactly() {
    let items = [cylinder([0.5; 3], Vector::new(0.01, 0.0, 1.0), 0.1)];
    let found = constrain(&items, &apart(&items), &fixed(0, "radius", &[0.101])).unwrap();
    let Surface::Cylinder(known) = &found.surfaces[0] else { panic!() };
    assert!((known.radius - 0.101).abs() < 1e-12);
    let found = constrain(&items, &apart(&items), &fixed(0, "axis", &[0.0, 0.0, 1.0])).unwrap();
    assert!(direction(&found.surfaces[0]).unwrap().cross(&Vector::z()).norm() < 1e-9);
    let found = constrain(&items, &apart(&items), &fixed(0, "point", &[0.5, 0.51, 0.5])).unwrap();
    let Surface::Cylinder(known) = &found.surfaces[0] else { panic!() };
    let offset = crate::math::Point::new(0.5, 0.51, 0.5) - known.point;
    assert!(offset.cross(&known.axis).norm() < 1e-9);
}

#[test]
fn contradictory_values_are_refused() {
    let items = [cylinder([0.5; 3], Vector::z(), 0.1)];
    let mut demands = fixed(0, "radius", &[0.101]);
    demands.fixed.extend(fixed(0, "radius", &[0.102]).fixed);
    let found = constrain(&items, &apart(&items), &demands).unwrap();
    let refused: Vec<_> = found.links.iter().filter(|link| link.status == "refused").collect();
    assert_eq!(refused.len(), 1);
    assert_eq!(refused[0].reason, "contradicts the other relations");
}

#[test]
fn a_gate_of_the_user_overrides_the_odds() {
    let leaning = Vector::new(0.5f64.to_radians(), 0.0, 1.0);
    let items = [plane([0.3, 0.5, 0.5], Vector::z()), plane([0.7, 0.5, 0.5], leaning)];
    let gate = Gate { angle: Some(1f64.to_radians()), length: None };
    let demands = Demands { gate, ..Demands::default() };
    let found = constrain(&items, &apart(&items), &demands).unwrap();
    assert_eq!(standing(&found.links, "parallel").len(), 1);
}

#[test]
fn dimensions_are_told_and_rounded_where_the_data_allow_it() {
    let items = [
        cylinder([0.5; 3], Vector::z(), 0.10001),
        cylinder([0.2; 3], Vector::x(), 0.1043),
        plane([0.5, 0.5, 0.1], Vector::z()),
        plane([0.5, 0.5, 0.89999], Vector::z()),
    ];
    let grid = Grid { length: Some(0.01), angle: None };
    let demands = Demands { grid, ..Demands::default() };
    let found = constrain(&items, &apart(&items), &demands).unwrap();
    let value = |kind: &str, surface: usize| {
        let of = |d: &&super::Dimension| d.kind == kind && d.surfaces.contains(&surface);
        let known = found.dimensions.iter().find(of).unwrap();
        assert!(known.sigma < 1e-3);
        (known.value, known.rounded)
    };
    assert!((value("radius", 0).0 - 0.1).abs() < 1e-12 && value("radius", 0).1);
    assert!(found.dimensions.iter().filter(|d| d.rounded).count() == 2);
    assert!((value("radius", 1).0 - 0.1043).abs() < 1e-4 && !value("radius", 1).1);
    assert!((value("distance", 2).0 - 0.8).abs() < 1e-12);
}

#[test]
fn demands_that_do_not_fit_the_surfaces_are_named() {
    let items = [plane([0.5; 3], Vector::z()), sphere([0.5; 3], 0.1)];
    for (demands, words) in [
        (
            demand("coaxial", &[0, 1], true),
            "coaxial takes surfaces with an axis, but region {0} is a plane",
        ),
        (demand("tangent", &[0], true), "tangent takes two regions, not 1 regions"),
        (fixed(0, "radius", &[1.0]), "region {0} is a plane: it has no radius"),
    ] {
        let error = constrain(&items, &apart(&items), &demands).err().unwrap();
        assert_eq!(error, words);
    }
}
