//! Sets of right angles that follow from each other, or contradict.

use super::admit::{Candidate, Verdict, admit};
use super::classes::Classes;
use super::equation::Equation;
use super::gate::Gate;
use super::solve::solve;
use super::system::System;
use crate::math::{Point, Unit, Vector, frame};
use crate::surface::{Condensed, Plane, Surface};

fn plane(normal: Vector) -> Condensed {
    let normal = Unit::new_normalize(normal);
    let (u, v) = frame(&normal);
    let at = |i: i32, j: i32| {
        Point::from((u.into_inner() * f64::from(i) + v.into_inner() * f64::from(j)) * 0.02)
    };
    let points: Vec<_> = (-5..6).flat_map(|i| (-5..6).map(move |j| at(i, j))).collect();
    let surface = Surface::Plane(Plane::through(Point::origin(), normal));
    Condensed::new(&surface, &points, 1e-2).unwrap()
}

/// Verdicts on all right angles between planes of these normals, and the largest cosine left.
fn judged(normals: &[Vector]) -> (Vec<Verdict>, f64) {
    let items: Vec<_> = normals.iter().map(|n| plane(*n)).collect();
    let directions: Vec<_> = normals.iter().map(|n| Unit::new_normalize(*n)).collect();
    let system = System::new(&items, &Classes::apart(items.len()), &directions);
    let solution = solve(&items, &system, &system.state, &[]).unwrap();
    let count = normals.len();
    let candidates: Vec<_> = (0..count)
        .flat_map(|a| (a + 1..count).map(move |b| Equation::Orthogonal(a, b)))
        .map(|equation| Candidate { equation, range: 2.0, before: 0.0, forced: false })
        .collect();
    let (verdicts, state) =
        admit(&system, &solution.state, &solution.spread, &candidates, Gate::default());
    let held = candidates.iter().zip(&verdicts).filter(|(_, v)| !matches!(v, Verdict::Refused(_)));
    let left = held.map(|(c, _)| c.equation.value(&system, &state).abs()).fold(0.0, f64::max);
    (verdicts, left)
}

#[test]
fn three_right_angles_hold_exactly() {
    let (verdicts, left) =
        judged(&[Vector::x(), Vector::new(0.01, 1.0, 0.0), Vector::new(0.0, 0.01, 1.0)]);
    assert!(verdicts.iter().all(|v| matches!(v, Verdict::Accepted(_))), "{verdicts:?}");
    assert!(left < 1e-12);
}

#[test]
fn four_directions_are_never_all_at_right_angles() {
    let between = Vector::new(1.0, 1.0, 1.0);
    let (verdicts, left) = judged(&[Vector::x(), Vector::y(), Vector::z(), between]);
    let refused = verdicts.iter().filter(|v| matches!(v, Verdict::Refused(_))).count();
    assert_eq!((refused, verdicts.len()), (3, 6));
    assert!(left < 1e-12);
}

#[test]
fn what_follows_from_the_others_is_implied_or_holds() {
    // The fourth is at right angles to the first two, so it is the third.
    let (verdicts, left) = judged(&[
        Vector::x(),
        Vector::y(),
        Vector::new(0.0, 0.001, 1.0),
        Vector::new(0.001, 0.0, 1.0),
    ]);
    let refused = verdicts.iter().filter(|v| matches!(v, Verdict::Refused(_))).count();
    assert_eq!(refused, 1, "{verdicts:?}");
    assert!(left < 1e-12);
}
