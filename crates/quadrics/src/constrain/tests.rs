//! Systems whose solutions are known.

use super::{Constrained, Demands, Link};
use crate::math::{Point, Unit, Vector, frame};
use crate::surface::{Condensed, Cylinder, Plane, Sphere, Surface, direction};

/// Everything that the data support, nobody asking.
fn constrain(items: &[Condensed]) -> Constrained {
    let mut found = super::constrain(items, &vec![Vec::new(); items.len()], &Demands::default());
    let standing = |link: &Link| link.status != "refused" && !link.reason.starts_with("follows");
    if let Ok(found) = &mut found {
        found.links.retain(standing);
    }
    found.unwrap()
}

/// Standard deviation of a point, in sizes.
const SIGMA: f64 = 1e-3;

/// A patch of a plane, a tenth of the part wide, known by 400 points.
pub fn plane(center: [f64; 3], normal: Vector) -> Condensed {
    let normal = Unit::new_normalize(normal);
    let (u, v) = frame(&normal);
    let center = Point::from(center);
    let at = |i: i32, j: i32| {
        let way = u.into_inner() * f64::from(i) + v.into_inner() * f64::from(j);
        center + way * 0.01
    };
    let points: Vec<_> = (-10..10).flat_map(|i| (-10..10).map(move |j| at(i, j))).collect();
    Condensed::new(&Surface::Plane(Plane::through(center, normal)), &points, SIGMA).unwrap()
}

pub fn cylinder(point: [f64; 3], axis: Vector, radius: f64) -> Condensed {
    let axis = Unit::new_normalize(axis);
    let (u, v) = frame(&axis);
    let point = Point::from(point);
    let at = |turn: i32, step: i32| {
        let angle = f64::from(turn) * 0.2;
        let across = u.into_inner() * angle.cos() + v.into_inner() * angle.sin();
        point + across * radius + axis.into_inner() * (f64::from(step) * 0.01)
    };
    let points: Vec<_> = (0..31).flat_map(|t| (-10..10).map(move |s| at(t, s))).collect();
    Condensed::new(&Surface::Cylinder(Cylinder { point, axis, radius }), &points, SIGMA).unwrap()
}

pub fn sphere(center: [f64; 3], radius: f64) -> Condensed {
    let center = Point::from(center);
    let at = |i: i32| {
        let (turn, height) = (f64::from(i) * 2.4, f64::from(i) / 100.0 - 1.0);
        let across = (1.0 - height * height).sqrt();
        center + Vector::new(across * turn.cos(), across * turn.sin(), height) * radius
    };
    let points: Vec<_> = (1..200).map(at).collect();
    Condensed::new(&Surface::Sphere(Sphere { center, radius }), &points, SIGMA).unwrap()
}

fn kinds(found: &Constrained) -> Vec<(&'static str, Vec<usize>)> {
    found.links.iter().map(|link| (link.kind, link.surfaces.clone())).collect()
}

fn cosine(found: &Constrained, i: usize, j: usize) -> f64 {
    let along = |k: usize| direction(&found.surfaces[k]).unwrap();
    along(i).dot(&along(j))
}

#[test]
fn nothing_and_one_surface_have_no_relation() {
    assert!(constrain(&[]).links.is_empty());
    let alone = plane([0.5; 3], Vector::z());
    let found = constrain(std::slice::from_ref(&alone));
    assert!(found.links.is_empty());
    let moved = alone.coordinates(&found.surfaces[0]).unwrap();
    assert!(moved.amax() < 1e-9);
}

#[test]
fn two_equal_planes_meet_in_the_middle() {
    let (tilt, height) = (2e-4, 1e-4);
    let found = constrain(&[
        plane([0.3, 0.5, 0.5], Vector::new(tilt, 0.0, 1.0)),
        plane([0.3, 0.5, 0.9 + height], Vector::new(-tilt, 0.0, 1.0)),
    ]);
    assert_eq!(kinds(&found), [("parallel", vec![0, 1])]);
    let one = direction(&found.surfaces[0]).unwrap();
    assert!(one.x.abs() < 1e-9 && (cosine(&found, 0, 1) - 1.0).abs() < 1e-15);
}

#[test]
fn a_box_has_three_right_angles_and_keeps_its_chirality() {
    let e = 2e-4;
    let found = constrain(&[
        plane([0.1, 0.5, 0.5], Vector::new(1.0, e, -e)),
        plane([0.9, 0.5, 0.5], Vector::new(-1.0, e, e)),
        plane([0.5, 0.1, 0.5], Vector::new(e, 1.0, e)),
        plane([0.5, 0.9, 0.5], Vector::new(e, -1.0, e)),
        plane([0.5, 0.5, 0.1], Vector::new(-e, e, 1.0)),
        plane([0.5, 0.5, 0.9], Vector::new(e, -e, -1.0)),
    ]);
    let right = found.links.iter().filter(|link| link.kind == "orthogonal").count();
    let parallel = found.links.iter().filter(|link| link.kind == "parallel").count();
    assert_eq!((right, parallel), (3, 3));
    for (i, j) in [(0, 2), (0, 4), (2, 4), (1, 3), (3, 5)] {
        assert!(cosine(&found, i, j).abs() < 1e-12);
    }
    assert!((cosine(&found, 0, 1) + 1.0).abs() < 1e-12);
    assert!(found.links.iter().all(|link| link.after < 1e-9 && link.after <= link.before));
}

#[test]
fn half_a_degree_of_draft_stays() {
    let draft = 0.5f64.to_radians();
    let drafted = plane([0.9, 0.5, 0.5], Vector::new(draft.cos(), 0.0, draft.sin()));
    let items = [plane([0.1, 0.5, 0.5], Vector::x()), drafted];
    let found = constrain(&items);
    assert!(found.links.is_empty(), "{:?}", found.links);
    assert!((cosine(&found, 0, 1).acos() - draft).abs() < 1e-6);
    let all = super::constrain(&items, &vec![Vec::new(); 2], &Demands::default()).unwrap();
    let refused = &all.links[0];
    assert_eq!((refused.kind, refused.status), ("parallel", "refused"));
    assert!(refused.reason.starts_with("chi-squared would rise by"), "{}", refused.reason);
    assert!((refused.after - 0.5).abs() < 1e-3);
}

#[test]
fn a_bore_and_its_counterbore_share_an_axis() {
    let found = constrain(&[
        cylinder([0.5, 0.5, 0.3], Vector::new(1e-4, 0.0, 1.0), 0.1),
        cylinder([0.5001, 0.5, 0.7], Vector::new(0.0, -1e-4, 1.0), 0.2),
    ]);
    assert_eq!(kinds(&found), [("parallel", vec![0, 1]), ("coaxial", vec![0, 1])]);
    assert!(found.links[1].before > 5e-5 && found.links[1].after < 1e-12);
}

#[test]
fn bolt_holes_share_direction_and_radius_but_no_axis() {
    let hole = |x, y, radius| cylinder([x, y, 0.5], Vector::z(), radius);
    let found = constrain(&[hole(0.2, 0.2, 0.05), hole(0.8, 0.2, 0.05001), hole(0.5, 0.8, 0.1)]);
    assert_eq!(kinds(&found), [("parallel", vec![0, 1, 2]), ("equal_radius", vec![0, 1])]);
    let radius = |i: usize| match &found.surfaces[i] {
        Surface::Cylinder(s) => s.radius,
        other => panic!("{other:?}"),
    };
    assert_eq!(radius(0), radius(1));
    assert!((radius(0) - 0.050005).abs() < 1e-7 && (radius(2) - 0.1).abs() < 1e-9);
}

#[test]
fn shells_are_concentric() {
    let found = constrain(&[sphere([0.5; 3], 0.2), sphere([0.50005, 0.5, 0.5], 0.3)]);
    assert_eq!(kinds(&found), [("concentric", vec![0, 1])]);
}

#[test]
fn three_hundred_surfaces_take_less_than_a_second() {
    let axes = [Vector::x(), Vector::y(), Vector::z()];
    let place = |i: usize| [7, 11, 13].map(|k| (i * k % 31) as f64 / 31.0);
    let items: Vec<_> = (0..300)
        .map(|i| {
            let lean = Vector::new(1.0, -1.0, 0.5) * (i as f64 * 0.7).sin() * 1e-4;
            let axis = axes[i % 3] + lean;
            let radius = 0.02 + 0.01 * (i % 7) as f64;
            if i % 2 == 0 { plane(place(i), axis) } else { cylinder(place(i), axis, radius) }
        })
        .collect();
    let start = std::time::Instant::now();
    let found = constrain(&items);
    // Tests are built with less optimisation and run beside each other.
    assert!(start.elapsed().as_secs_f64() < 5.0, "{:?}", start.elapsed());
    assert_eq!(found.links.iter().filter(|link| link.kind == "parallel").count(), 3);
    assert_eq!(found.links.iter().filter(|link| link.kind == "orthogonal").count(), 3);
}
