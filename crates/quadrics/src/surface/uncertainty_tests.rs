//! Deviations that are promised are those that are found.

use rand::RngExt;

use super::*;
use crate::context::Context;
use crate::math::Vector;

const SIGMA: f64 = 1e-3;
const TRIALS: usize = 200;

/// Points of a patch of a surface.
fn patch(surface: &Surface, rng: &mut impl RngExt) -> Vec<Point> {
    let mut points = Vec::new();
    while points.len() < 150 {
        let mut draw = || rng.random_range(-0.25..0.25);
        let near = Point::new(1.0 + draw(), 0.5 + draw(), 0.3 + draw());
        points.extend(surface.project(near).filter(|foot| (foot - near).norm() < 0.3));
    }
    points
}

/// A sum of twelve uniform draws is near enough to Gauss.
fn noisy(surface: &Surface, points: &[Point], rng: &mut impl RngExt) -> Vec<Point> {
    let shift = |p: &Point| {
        let draw: f64 = (0..12).map(|_| rng.random_range(-0.5..0.5)).sum();
        p + surface.normal(*p).unwrap().into_inner() * (draw * SIGMA)
    };
    points.iter().map(shift).collect()
}

#[test]
fn fits_scatter_as_their_uncertainty_says() {
    let axis = Unit::new_normalize(Vector::new(0.3, -0.4, 1.0));
    let point = Point::new(0.5, 0.5, 0.3);
    let out: Similarity = Similarity::from_scaling(80.0);
    let truths = [
        Surface::Plane(Plane::through(Point::new(1.0, 0.5, 0.3), axis)),
        Surface::Sphere(Sphere { center: point, radius: 0.5 }),
        Surface::Cylinder(Cylinder { point, axis, radius: 0.5 }),
        Surface::Cone(Cone { apex: Point::new(0.8, 0.4, -0.6), axis, half_angle: 0.4 }),
    ];
    let mut rng = Context::new(3).rng;
    for truth in truths {
        let points = patch(&truth, &mut rng);
        let promised = uncertainty(&truth, &points, SIGMA, &out);
        let mut squares = vec![0.0; promised.len()];
        for _ in 0..TRIALS {
            let fit = refine(&truth, &noisy(&truth, &points, &mut rng), &[]).unwrap();
            let found = errors(&truth, &fit.surface, &out);
            squares.iter_mut().zip(found).for_each(|(sum, error)| *sum += error * error);
        }
        for ((name, sigma), sum) in promised.into_iter().zip(squares) {
            let ratio = (sum / TRIALS as f64).sqrt() / sigma;
            assert!((0.8..1.25).contains(&ratio), "{truth:?} {name}: {ratio}");
        }
    }
}

/// Errors of the parameters in the order of their names, in degrees and in the frame of `out`.
fn errors(truth: &Surface, found: &Surface, out: &Similarity) -> Vec<f64> {
    let angle = |a: &Unit, b: &Unit| a.cross(b).norm().asin().to_degrees();
    match (truth.transformed(out), found.transformed(out)) {
        (Surface::Plane(a), Surface::Plane(b)) => {
            vec![angle(&a.normal, &b.normal), a.offset - b.offset]
        }
        (Surface::Sphere(a), Surface::Sphere(b)) => {
            vec![(a.center - b.center).norm(), a.radius - b.radius]
        }
        (Surface::Cylinder(a), Surface::Cylinder(b)) => {
            // Where the axes pass the point that stands for the axis: beside the data.
            let near = Cylinder { point: out * Point::new(1.0, 0.5, 0.3), ..a.clone() };
            let height = |axis: &Cylinder| {
                let along = axis.axis.dot(&(near.point - axis.point)) / axis.axis.dot(&a.axis);
                axis.point + axis.axis.into_inner() * along
            };
            vec![(height(&a) - height(&b)).norm(), angle(&a.axis, &b.axis), a.radius - b.radius]
        }
        (Surface::Cone(a), Surface::Cone(b)) => {
            let opening = (a.half_angle - b.half_angle).to_degrees();
            vec![(a.apex - b.apex).norm(), angle(&a.axis, &b.axis), opening]
        }
        _ => unreachable!("refining keeps the type"),
    }
}

#[test]
fn a_quadric_has_centre_and_semi_axes_that_are_known() {
    let form = nalgebra::Matrix3::from_diagonal(&Vector::new(4.0, 9.0, 2.0));
    let truth = Surface::Quadric(Quadric::about(Point::new(0.6, 0.5, 0.3), -1.0, form));
    let points = patch(&truth, &mut Context::new(5).rng);
    let found = uncertainty(&truth, &points, SIGMA, &Similarity::identity());
    assert_eq!(found.iter().map(|(name, _)| *name).collect::<Vec<_>>(), ["center", "semi_axes"]);
    assert!(found.iter().all(|(_, sigma)| (1e-6..1.0).contains(sigma)), "{found:?}");
}

#[test]
fn too_few_points_promise_nothing() {
    let axis = Vector::z_axis();
    let plane = Surface::Plane(Plane::through(Point::origin(), axis));
    let line = [Point::origin(), Point::new(1.0, 0.0, 0.0), Point::new(2.0, 0.0, 0.0)];
    assert!(uncertainty(&plane, &line, SIGMA, &Similarity::identity()).is_empty());
    assert!(uncertainty(&plane, &[], SIGMA, &Similarity::identity()).is_empty());
}
