//! Classes of general quadrics, told under noise.

use nalgebra::{Matrix3, Translation3, UnitQuaternion};
use rand::RngExt;

use super::family::{Family, HELD};
use super::kind::{Class, kind};
use super::select::Evidence;
use super::{Quadric, Samples, Surface, general, refine};
use crate::context::Context;
use crate::math::{Point, Similarity, Vector};

/// Noise of the points, in sizes: between noise5 and noise10 of the paper.
const SIGMA: f64 = 0.004;

/// Points of a patch and its normals.
struct Patch {
    points: Vec<Point>,
    feet: Vec<Point>,
    normals: Vec<Vector>,
}

impl Patch {
    /// Points near `middle` on a quadric, moved by `sigma` along their normals.
    fn of(quadric: &Quadric, middle: Point, reach: Vector, sigma: f64) -> Self {
        let surface = Surface::Quadric(quadric.clone());
        let mut rng = Context::new(3).rng;
        let mut patch = Self { points: Vec::new(), feet: Vec::new(), normals: Vec::new() };
        for _ in 0..600 {
            let near = reach.map(|far| rng.random_range(-far..far));
            let foot = surface.project(middle + near).unwrap();
            let normal = surface.normal(foot).unwrap().into_inner();
            // The sum of twelve uniform numbers is as good as Gaussian.
            let gauss: f64 = (0..12).map(|_| rng.random_range(-0.5..0.5)).sum();
            patch.points.push(foot + normal * (sigma * gauss));
            patch.feet.push(foot);
            patch.normals.push(normal);
        }
        patch
    }

    fn samples(&self) -> Samples<'_> {
        Samples { points: &self.points, barycentres: &self.feet, normals: &self.normals }
    }
}

/// `values·x² + slope z + level` in a frame that is turned, with its origin inside of the unit cube.
fn placed(values: [f64; 3], slope: f64, level: f64) -> (Quadric, Similarity) {
    let form = Matrix3::from_diagonal(&Vector::from(values));
    let turn = UnitQuaternion::from_euler_angles(0.3, 1.1, -0.4);
    let frame = Similarity::from_parts(Translation3::new(0.4, 0.5, 0.6), turn, 1.0);
    let quadric = Quadric::from_parts(level, Vector::new(0.0, 0.0, slope), form);
    (quadric.transformed(&frame), frame)
}

/// A patch of every class: the quadric in its frame, and where the patch lies.
fn classes() -> Vec<(Class, Family, Quadric, Point, Vector)> {
    use Class::*;
    let half = Vector::new(0.3, 0.3, 0.15);
    let all = Vector::new(0.3, 0.3, 0.3);
    let table = [
        (Ellipsoid, Family::General, [25.0, 16.0, 9.0], 0.0, -1.0, [0.0, 0.0, 0.2], half),
        (HyperboloidOneSheet, Family::General, [25.0, 12.0, -16.0], 0.0, -0.5, [0.0; 3], all),
        (HyperboloidTwoSheets, Family::General, [16.0, 9.0, -9.0], 0.0, 0.3, [0.0, 0.0, 0.3], half),
        (EllipticCone, Family::Cone, [4.0, 2.0, -1.0], 0.0, 0.0, [0.0, 0.0, 0.35], half),
        (EllipticParaboloid, Family::Paraboloid, [4.0, 2.0, 0.0], -1.0, 0.0, [0.0, 0.0, 0.2], all),
        (HyperbolicParaboloid, Family::Paraboloid, [2.0, -1.5, 0.0], 1.0, 0.0, [0.0; 3], all),
        (EllipticCylinder, Family::Cylinder, [16.0, 6.0, 0.0], 0.0, -1.0, [0.0; 3], all),
        (HyperbolicCylinder, Family::Cylinder, [9.0, -9.0, 0.0], 0.0, -0.5, [0.3, 0.0, 0.0], half),
        (Ellipsoid, Family::Revolved, [16.0, 16.0, 6.0], 0.0, -1.0, [0.0, 0.0, 0.2], half),
        (HyperboloidOneSheet, Family::Revolved, [25.0, -9.0, 25.0], 0.0, -0.5, [0.0; 3], all),
        (
            EllipticParaboloid,
            Family::RevolvedParaboloid,
            [3.0, 3.0, 0.0],
            -1.0,
            0.0,
            [0.0, 0.0, 0.2],
            all,
        ),
        (ParabolicCylinder, Family::ParabolicCylinder, [3.0, 0.0, 0.0], 1.0, 0.0, [0.0; 3], all),
    ];
    let row =
        |(class, family, values, slope, level, middle, reach): (_, _, _, _, _, [f64; 3], _)| {
            let (quadric, frame) = placed(values, slope, level);
            (class, family, quadric, frame * Point::from(middle), reach)
        };
    table.into_iter().map(row).collect()
}

fn evidence(sigma: f64) -> Evidence {
    Evidence { sigma, independent: 1.0, normal_sigma: 0.1, general: false }
}

#[test]
fn every_class_is_told_from_noisy_points() {
    for (class, family, quadric, middle, reach) in classes() {
        let patch = Patch::of(&quadric, middle, reach, SIGMA);
        let choices = general::choose(patch.samples(), patch.points.len(), evidence(SIGMA));
        let Surface::Quadric(best) = &choices[0].surface else { panic!("{class:?}") };
        assert_eq!((kind(best, 1.0).class, Family::of(best)), (class, family));
        // Nine parameters take 1.5 % of the scatter.
        assert!((0.8..1.2).contains(&choices[0].misfit), "{class:?}: {}", choices[0].misfit);
        let surface = &choices[0].surface;
        let away: f64 = patch.feet.iter().map(|p| surface.distance(*p).unwrap().powi(2)).sum();
        let away = (away / patch.feet.len() as f64).sqrt();
        assert!(away < SIGMA / 4.0, "{class:?}: {away}");
    }
}

#[test]
fn without_noise_each_family_finds_its_own_member() {
    for (class, family, quadric, middle, reach) in classes() {
        assert_eq!(family, Family::of(&quadric), "{class:?}");
        if family == Family::General {
            continue;
        }
        let patch = Patch::of(&quadric, middle, reach, 0.0);
        let free = general::free(patch.samples()).unwrap().quadric().unwrap();
        let found = family.fit(&free, patch.samples()).unwrap();
        let surface = Surface::Quadric(found);
        let most =
            patch.feet.iter().map(|p| surface.distance(*p).unwrap().abs()).fold(0.0, f64::max);
        assert!(most < 1e-7, "{class:?}: {most}");
    }
}

#[test]
fn a_refined_member_stays_in_its_family() {
    for (class, family, quadric, middle, reach) in classes() {
        let patch = Patch::of(&quadric, middle, reach, SIGMA);
        let fit = refine(&Surface::Quadric(quadric), &patch.points, &[]).unwrap();
        let Surface::Quadric(refined) = &fit.surface else { panic!("{class:?}") };
        assert_eq!((kind(refined, 1.0).class, Family::of(refined)), (class, family));
        let turn = UnitQuaternion::from_euler_angles(1.0, -0.2, 0.7);
        let there = Similarity::from_parts(Translation3::new(-0.2, 0.1, 0.3), turn, 1.0);
        assert_eq!(Family::of(&refined.transformed(&there)), family, "{class:?}");
    }
}

#[test]
fn families_have_the_freedom_of_their_equations() {
    assert_eq!(HELD.map(Family::freedom), [8, 8, 7, 6, 7, 6]);
    assert_eq!(Family::General.freedom(), 9);
}
