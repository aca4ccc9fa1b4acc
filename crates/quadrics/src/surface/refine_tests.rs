//! A surface is recovered from points drawn from it.

use std::f64::consts::TAU;

use rand::RngExt;

use super::start::{self, Samples};
use super::*;
use crate::context::Context;
use crate::math::Vector;
use crate::math::lanes::Packet;

/// Points of a patch of each surface, exactly on it, with normals.
fn patch(surface: &Surface) -> (Vec<Point>, Vec<Vector>) {
    let mut rng = Context::new(7).rng;
    let mut points = Vec::new();
    let mut normals = Vec::new();
    while points.len() < 120 {
        let mut draw = || rng.random_range(-0.25..0.25);
        let near = Point::new(1.0 + draw(), 0.5 + draw(), 0.3 + draw());
        if let (Some(foot), Some(normal)) = (surface.project(near), surface.normal(near))
            && (foot - near).norm() < 0.3
        {
            points.push(foot);
            normals.push(normal.into_inner());
        }
    }
    (points, normals)
}

fn tilted() -> Unit {
    Unit::new_normalize(Vector::new(0.3, -0.4, 1.0))
}

#[test]
fn exact_points_give_the_exact_surface() {
    let axis = tilted();
    let truth = [
        Surface::Plane(Plane::through(Point::new(1.0, 0.5, 0.3), axis)),
        Surface::Sphere(Sphere { center: Point::new(0.5, 0.5, 0.3), radius: 0.5 }),
        Surface::Cylinder(Cylinder { point: Point::new(0.5, 0.5, 0.3), axis, radius: 0.5 }),
        Surface::Cone(Cone { apex: Point::new(0.8, 0.4, -0.6), axis, half_angle: 0.4 }),
        Surface::Torus(Torus {
            center: Point::new(0.5, 0.2, 0.2),
            axis,
            major_radius: 0.5,
            minor_radius: 0.15,
        }),
        // Both sheets of tori that cut themselves.
        Surface::Torus(Torus {
            center: Point::new(0.5, 0.2, 0.2),
            axis,
            major_radius: 0.2,
            minor_radius: 0.5,
        }),
        Surface::Torus(Torus {
            center: Point::new(0.5, 0.2, 0.2),
            axis,
            major_radius: -0.3,
            minor_radius: 0.9,
        }),
    ];
    for truth in truth {
        let (points, normals) = patch(&truth);
        let samples = Samples { points: &points, barycentres: &points, normals: &normals };
        let starts: Vec<Surface> = match &truth {
            Surface::Plane(_) => start::plane(samples).into_iter().collect(),
            Surface::Sphere(_) => start::sphere(samples).into_iter().collect(),
            Surface::Cylinder(_) => {
                start::axes(samples).iter().filter_map(|a| start::cylinder(samples, a)).collect()
            }
            Surface::Cone(_) => {
                start::axes(samples).iter().filter_map(|a| start::cone(samples, a)).collect()
            }
            _ => {
                let tori = start::axes(samples);
                let tori = tori.iter().filter_map(|a| start::torus(samples, a));
                tori.map(Surface::Torus).collect()
            }
        };
        let best = starts
            .iter()
            .filter_map(|s| refine(s, &points, &[]))
            .min_by(|a, b| a.cost.total_cmp(&b.cost))
            .unwrap_or_else(|| panic!("no fit of {truth:?} from {starts:?}"));
        assert!(best.cost < 1e-18, "{truth:?}: {best:?}");
        for point in &points {
            let foot = *point + normals[0] * 0.01;
            let (one, other) = (best.surface.distance(foot), truth.distance(foot));
            assert!((one.unwrap().abs() - other.unwrap().abs()).abs() < 1e-7, "{truth:?}");
        }
    }
}

/// The middle of a full turn lies on the axis, where no normal leads to the surface.
#[test]
fn a_full_turn_is_fitted_to_the_last_digits() {
    let axis = tilted();
    let cone = Cone { apex: Point::new(0.8, 0.4, -0.6), axis, half_angle: 0.1 };
    let (u, v) = crate::math::frame(&axis);
    let at = |i: u32| {
        let (height, turn) = (1.0 + 0.1 * f64::from(i / 16), f64::from(i % 16) * TAU / 16.0);
        let radial = u.into_inner() * turn.cos() + v.into_inner() * turn.sin();
        cone.apex + (axis.into_inner() + radial * cone.half_angle.tan()) * height
    };
    let points: Vec<Point> = (0..80).map(at).collect();
    let start = Cone { half_angle: 0.101, ..cone.clone() };
    let fit = refine(&Surface::Cone(start), &points, &[]).unwrap();
    let Surface::Cone(found) = fit.surface else { panic!("{fit:?}") };
    assert!((found.half_angle - cone.half_angle).abs() < 1e-12, "{found:?}");
    assert!((found.apex - cone.apex).norm() < 1e-11, "{found:?}");
}

#[test]
fn a_sum_over_packets_is_the_sum_over_points() {
    use super::local::LocalCone;
    use super::squares::{Local, normal_equations, sum_of_squares};
    let cone = Cone { apex: Point::new(0.8, 0.4, -0.6), axis: tilted(), half_angle: 0.4 };
    let model = LocalCone::new(&cone, Point::new(1.0, 0.5, 0.3)).unwrap();
    let points: Vec<Point> = (0..7).map(|i| Point::new(0.9, 0.1 * f64::from(i), 0.3)).collect();
    let weights = [1.0, 2.0, 0.5, 0.0, 1.0, 3.0, 0.25];
    for weights in [&weights[..], &[]] {
        let (matrix, slopes) = normal_equations(&model, &points, weights);
        let (mut squares, mut gradient, mut corner) = (0.0, 0.0, 0.0);
        for (i, &point) in points.iter().enumerate() {
            let weight = weights.get(i).copied().unwrap_or(1.0);
            let (residual, row) = model.residual(Packet::new(&[point]));
            squares += weight * residual.0[0].powi(2);
            gradient += weight * residual.0[0] * row[4].0[0];
            corner += weight * row[4].0[0] * row[1].0[0];
        }
        let same = |a: f64, b: f64| assert!((a - b).abs() < 1e-12 * a.abs(), "{a} {b}");
        same(squares, sum_of_squares(&model, &points, weights));
        same(gradient, slopes[4]);
        same(corner, matrix[(4, 1)]);
        same(corner, matrix[(1, 4)]);
    }
}

#[test]
fn the_derivatives_agree_with_differences() {
    use super::local::*;
    use super::squares::Local;
    fn check<const N: usize, M: Local<N>>(model: &M, points: &[Point]) {
        for &point in points {
            let at = Packet::new(&[point]);
            let (_, row) = model.residual(at);
            for i in 0..N {
                let mut step = nalgebra::SVector::<f64, N>::zeros();
                step[i] = 1e-6;
                let ahead = model.moved(&step).unwrap().residual(at).0;
                let behind = model.moved(&-step).unwrap().residual(at).0;
                let rate = (ahead.0[0] - behind.0[0]) / 2e-6;
                let row = row[i].0[0];
                assert!((rate - row).abs() < 1e-4 * (1.0 + rate.abs()), "{i}: {rate} {row}");
            }
        }
    }
    let axis = tilted();
    let near = Point::new(1.0, 0.5, 0.3);
    let cylinder = Cylinder { point: Point::new(0.5, 0.5, 0.3), axis, radius: 0.5 };
    let cone = Cone { apex: Point::new(0.8, 0.4, -0.6), axis, half_angle: 0.4 };
    let sphere = Sphere { center: Point::new(0.5, 0.5, 0.3), radius: 0.5 };
    let center = Point::new(0.5, 0.2, 0.2);
    let torus = Torus { center, axis, major_radius: 0.5, minor_radius: 0.15 };
    let plane = Plane::through(near, axis);
    let points = |s: &Surface| patch(s).0;
    check(&LocalPlane::new(&plane, near), &points(&Surface::Plane(plane)));
    check(&LocalCylinder::new(&cylinder, near).unwrap(), &points(&Surface::Cylinder(cylinder)));
    check(&LocalCone::new(&cone, near).unwrap(), &points(&Surface::Cone(cone)));
    check(&LocalSphere::new(&sphere, near).unwrap(), &points(&Surface::Sphere(sphere)));
    check(&LocalTorus::new(&torus), &points(&Surface::Torus(torus)));
}

#[test]
fn an_ellipsoid_is_recovered_as_a_quadric() {
    let form = nalgebra::Matrix3::from_diagonal(&Vector::new(4.0, 9.0, 2.0));
    let truth = Surface::Quadric(Quadric::about(Point::new(0.6, 0.5, 0.3), -1.0, form));
    let (points, normals) = patch(&truth);
    let samples = Samples { points: &points, barycentres: &points, normals: &normals };
    let fit = refine(&start::quadric(samples).unwrap(), &points, &[]).unwrap();
    assert!(fit.cost < 1e-16, "{fit:?}");
}
