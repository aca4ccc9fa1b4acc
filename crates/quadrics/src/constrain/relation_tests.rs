//! Relations that equations say: contact, distances, patterns, symmetry.

use super::tests::{cylinder, plane, sphere};
use super::{Constrained, Demands, Link, Value, constrain};
use crate::math::{Point, Unit, Vector};
use crate::surface::{Condensed, Revolved, Surface};

/// What the data support when all border on each other.
fn touching(items: &[Condensed]) -> Constrained {
    let count = items.len();
    let others = |i: usize| (0..count).filter(|j| *j != i).collect();
    let neighbours: Vec<Vec<usize>> = (0..count).map(others).collect();
    constrain(items, &neighbours, &Demands::default()).unwrap()
}

fn standing<'a>(found: &'a Constrained, kind: &str) -> Vec<&'a Link> {
    let holds = |link: &&Link| link.kind == kind && link.status != "refused";
    found.links.iter().filter(holds).collect()
}

#[test]
fn a_fillet_touches_both_of_its_walls() {
    let found = touching(&[
        plane([0.0, 0.5, 0.5], Vector::x()),
        plane([0.5, 0.0, 0.5], Vector::y()),
        cylinder([0.10005, 0.0999, 0.5], Vector::z(), 0.1001),
    ]);
    let tangent = standing(&found, "tangent");
    assert_eq!(tangent.len(), 2, "{:?}", found.links);
    assert!(tangent.iter().all(|link| link.before > 2e-5 && link.after < 1e-12));
    let Surface::Cylinder(fillet) = &found.surfaces[2] else { panic!() };
    let away = found.surfaces[0].distance(fillet.point).unwrap();
    assert!((away.abs() - fillet.radius).abs() < 1e-9);
}

#[test]
fn a_paraboloid_shares_the_axis_of_its_bore() {
    let axis = Unit::new_normalize(Vector::new(1e-4, -2e-4, 1.0));
    let point = Point::new(0.50005, 0.4999, 0.5);
    let bowl = Revolved { point, axis, profile: vec![0.0, -0.1], factor: 1.0 }.quadric();
    let bowl = Surface::Quadric(bowl);
    let near = |k: i32| {
        let (turn, out) = (f64::from(k) * 2.4, f64::from(k) / 1000.0);
        Point::new(0.5 + out * turn.cos(), 0.5 + out * turn.sin(), 0.5)
    };
    let points: Vec<_> = (20..220).filter_map(|k| bowl.project(near(k))).collect();
    let found = touching(&[
        cylinder([0.5, 0.5, 0.3], Vector::z(), 0.1),
        Condensed::new(&bowl, &points, 1e-3).unwrap(),
        plane([0.5, 0.2, 0.5], Vector::y()),
    ]);
    let kinds = ["parallel", "coaxial", "orthogonal"];
    assert!(kinds.iter().all(|kind| !standing(&found, kind).is_empty()), "{:?}", found.links);
    let (Surface::Cylinder(bore), Surface::Quadric(bowl)) =
        (&found.surfaces[0], &found.surfaces[1])
    else {
        panic!()
    };
    let bowl = Revolved::of(bowl).unwrap();
    assert!(bowl.axis.cross(&bore.axis).norm() < 1e-12);
    assert!((bowl.point - bore.point).cross(&bore.axis).norm() < 1e-12);
    assert!((bowl.profile[1].abs() - 0.1).abs() < 1e-3);
}

#[test]
fn a_bore_that_cuts_a_wall_does_not_touch_it() {
    let found = touching(&[
        plane([0.0, 0.5, 0.5], Vector::x()),
        cylinder([0.07, 0.5, 0.5], Vector::z(), 0.1),
    ]);
    assert!(standing(&found, "tangent").is_empty());
}

#[test]
fn a_bolt_circle_is_one_pattern_with_its_numbers() {
    let hole = |k: usize| {
        let turn = std::f64::consts::TAU * k as f64 / 6.0 + 0.3;
        let off = 5e-5 * (k as f64).sin();
        let at = [0.5 + 0.3 * turn.cos() + off, 0.5 + 0.3 * turn.sin() - off, 0.5];
        cylinder(at, Vector::z(), 0.03)
    };
    let items: Vec<_> =
        (0..6).map(hole).chain([cylinder([0.5, 0.5, 0.5], Vector::z(), 0.12)]).collect();
    let found = touching(&items);
    let patterns = standing(&found, "pattern");
    assert_eq!(patterns.len(), 1, "{:?}", found.links);
    let pattern = patterns[0];
    assert_eq!(pattern.surfaces.len(), 6);
    assert!(pattern.before > 1e-5 && pattern.after < 1e-12, "{pattern:?}");
    let of = |name: &str| pattern.parameters.iter().find(|(known, _)| *known == name).unwrap().1;
    assert_eq!(of("count"), Value::Count(6));
    let Value::Length(radius) = of("pitch_radius") else { panic!() };
    assert!((radius - 0.3).abs() < 1e-4);
}

#[test]
fn a_bolt_circle_may_lack_a_hole() {
    let hole = |k: usize| {
        let turn = std::f64::consts::TAU * k as f64 / 6.0 + 0.3;
        let off = 5e-5 * (k as f64).sin();
        let at = [0.5 + 0.3 * turn.cos() + off, 0.5 + 0.3 * turn.sin() - off, 0.5];
        cylinder(at, Vector::z(), 0.03)
    };
    let bore = || cylinder([0.5, 0.5, 0.5], Vector::z(), 0.12);
    let without = |gone: usize| (0..6).filter(move |k| *k != gone).map(hole);
    for items in [without(2).chain([bore()]).collect::<Vec<_>>(), without(5).collect()] {
        let found = touching(&items);
        let patterns = standing(&found, "pattern");
        assert_eq!(patterns.len(), 1, "{:?}", found.links);
        let pattern = patterns[0];
        assert!(pattern.after < 1e-12, "{pattern:?}");
        let of =
            |name: &str| pattern.parameters.iter().find(|(known, _)| *known == name).unwrap().1;
        assert_eq!([of("count"), of("places")], [Value::Count(5), Value::Count(6)]);
        let (Value::Length(radius), Value::Point(center)) = (of("pitch_radius"), of("point"))
        else {
            panic!()
        };
        assert!((radius - 0.3).abs() < 2e-4, "{radius}");
        assert!((center.xy() - nalgebra::Point2::new(0.5, 0.5)).norm() < 3e-4, "{center}");
    }
}

#[test]
fn a_row_has_a_pitch_and_odd_holes_no_pattern() {
    let row = |x: f64| cylinder([x, 0.3, 0.5], Vector::z(), 0.02);
    let found = touching(&[row(0.2), row(0.4001), row(0.6), row(0.8)]);
    let patterns = standing(&found, "pattern");
    assert_eq!(patterns.len(), 1);
    let pitch = patterns[0].parameters.iter().find(|(name, _)| *name == "pitch").unwrap().1;
    assert!(matches!(pitch, Value::Length(pitch) if (pitch - 0.2).abs() < 1e-4));
    let found = touching(&[row(0.2), row(0.37), row(0.6), row(0.71)]);
    assert!(standing(&found, "pattern").is_empty());
}

#[test]
fn a_ball_sits_on_the_axis_of_its_shaft() {
    let found = touching(&[
        cylinder([0.5, 0.5, 0.3], Vector::z(), 0.05),
        sphere([0.50004, 0.49997, 0.8], 0.1),
    ]);
    let on = standing(&found, "center_on_axis");
    assert_eq!(on.len(), 1);
    assert!(on[0].before > 4e-5 && on[0].after < 1e-12);
}

#[test]
fn equal_slots_are_equal_and_walls_mirror_each_other() {
    let wall = |x: f64, sign: f64| plane([x, 0.5, 0.5], Vector::x() * sign);
    let found = touching(&[
        wall(0.1, -1.0),
        wall(0.25001, 1.0),
        wall(0.4, -1.0),
        wall(0.6, 1.0),
        wall(0.75, -1.0),
        wall(0.9, 1.0),
    ]);
    assert_eq!(standing(&found, "symmetric").len(), 1, "{:?}", found.links);
    assert!(!standing(&found, "equal_distance").is_empty(), "{:?}", found.links);
    let exact = |link: &Link| link.status == "refused" || link.after < 1e-9;
    assert!(found.links.iter().all(exact));
}
