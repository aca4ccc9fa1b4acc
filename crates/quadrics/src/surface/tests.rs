//! What holds for every surface.

use nalgebra::{Matrix3, Rotation3, Translation3, UnitQuaternion};
use rand::RngExt;

use super::*;
use crate::context::Context;
use crate::math::Vector;

fn shapes() -> Vec<Surface> {
    let axis = Unit::new_normalize(Vector::new(0.3, -0.5, 0.8));
    let center = Point::new(0.2, 0.1, -0.3);
    let turn = Rotation3::from_axis_angle(&axis, 0.7);
    let form = |a: f64, b: f64, c: f64| {
        turn.matrix() * Matrix3::from_diagonal(&Vector::new(a, b, c)) * turn.matrix().transpose()
    };
    vec![
        Surface::Plane(Plane::through(center, axis)),
        Surface::Sphere(Sphere { center, radius: 0.4 }),
        Surface::Cylinder(Cylinder { point: center, axis, radius: 0.4 }),
        // Its apex lies outside the points: there a cone has no normal.
        Surface::Cone(Cone { apex: center - axis.into_inner() * 2.0, axis, half_angle: 0.5 }),
        Surface::Torus(Torus { center, axis, major_radius: 0.6, minor_radius: 0.2 }),
        // Its tips lie outside the points.
        Surface::Torus(Torus { center, axis, major_radius: -3.0, minor_radius: 4.0 }),
        Surface::Quadric(Quadric::about(center, -1.0, form(4.0, 9.0, 2.0))),
        Surface::Quadric(Quadric::about(center, -1.0, form(4.0, 9.0, -2.0))),
        Surface::Quadric(Quadric::from_parts(0.1, axis.into_inner(), form(2.0, 0.5, 0.0))),
    ]
}

fn random_points() -> Vec<Point> {
    let mut rng = Context::new(3).rng;
    let mut draw = || rng.random_range(-1.0..1.0);
    (0..200).map(|_| Point::new(draw(), draw(), draw())).collect()
}

#[test]
fn a_projected_point_has_distance_zero_and_projects_onto_itself() {
    for surface in shapes() {
        for point in random_points() {
            let foot = surface.project(point).unwrap();
            assert!(surface.distance(foot).unwrap().abs() < 1e-9, "{surface:?} {point}");
            assert!((surface.project(foot).unwrap() - foot).norm() < 1e-9, "{surface:?} {point}");
            let far = (point - foot).norm();
            assert!((far - surface.distance(point).unwrap().abs()).abs() < 1e-9, "{surface:?}");
        }
    }
}

#[test]
fn the_normal_is_the_gradient_of_the_distance() {
    let step = 1e-6;
    for surface in shapes() {
        for point in random_points() {
            let foot = surface.project(point).unwrap();
            let normal = surface.normal(foot).unwrap();
            let rate = (surface.distance(foot + normal.into_inner() * step).unwrap()
                - surface.distance(foot - normal.into_inner() * step).unwrap())
                / (2.0 * step);
            assert!((rate - 1.0).abs() < 1e-5, "{surface:?} at {point}: {rate}");
        }
    }
}

#[test]
fn a_similarity_moves_surfaces_as_it_moves_points() {
    let by = Similarity::from_parts(
        Translation3::new(3.0, -2.0, 1.0),
        UnitQuaternion::from_euler_angles(0.3, 1.1, -0.4),
        2.5,
    );
    for surface in shapes() {
        let moved = surface.transformed(&by);
        for point in random_points() {
            let here = surface.distance(point).unwrap() * by.scaling();
            let there = moved.distance(by * point).unwrap();
            assert!((here - there).abs() < 1e-8, "{surface:?}: {here} {there}");
        }
    }
}

#[test]
fn a_typed_surface_and_its_ten_coefficients_are_the_same_points() {
    for surface in shapes() {
        let Some(quadric) = surface.quadric() else { continue };
        for point in random_points() {
            let foot = surface.project(point).unwrap();
            assert!(quadric.value(foot).abs() < 1e-9, "{surface:?}");
        }
    }
}
