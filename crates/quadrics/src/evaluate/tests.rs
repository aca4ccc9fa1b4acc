use super::*;
use crate::context::Context;
use crate::math::{Unit, Vector};
use crate::mesh::samples::{Sample, can};
use crate::surface::{Cylinder, Plane};
use crate::synth::{self, Part};

fn answer(part: &Part) -> Answer {
    let named = |surface: &Surface| Named {
        kind: surface.type_name().into(),
        surface: Some(surface.clone()),
        near: None,
    };
    Answer { labels: part.labels.clone(), regions: part.surfaces.iter().map(named).collect() }
}

fn nothing(labels: Vec<u32>, count: usize) -> Answer {
    let none = Named { kind: "none".into(), surface: None, near: None };
    Answer { labels, regions: vec![none; count] }
}

#[test]
fn the_truth_is_perfect_in_any_numbering() {
    for name in synth::names() {
        let part = synth::part(name, 12_000).unwrap();
        let truth = answer(&part);
        let count = truth.regions.len() as u32;
        let mut turned = truth.clone();
        turned.labels.iter_mut().for_each(|label| *label = (*label + 1) % count);
        turned.regions.rotate_right(1);
        let report = evaluate(&part.mesh, &turned, &truth, TOLERANCE).unwrap();
        assert!(report.hamming < 1e-12 && report.consistency < 1e-12, "{name}");
        assert_eq!((report.rand.index, report.rand.adjusted), (1.0, 1.0));
        assert_eq!(report.hits(true), truth.regions.len(), "{name}");
        for verdict in &report.verdicts {
            assert!(verdict.rms.unwrap() < 1e-7);
            assert!(verdict.errors.iter().all(|(_, error)| *error < 1e-9), "{verdict:?}");
        }
    }
}

#[test]
fn one_region_for_all_is_a_refinement_and_nothing_else() {
    let Sample { mesh, labels } = can(6);
    let truth = nothing(labels, 3);
    let one = nothing(vec![0; mesh.faces.len()], 1);
    let report = evaluate(&mesh, &one, &truth, TOLERANCE).unwrap();
    assert!(report.consistency < 1e-12);
    // The side of the can is its largest region.
    let (side, caps) = (std::f64::consts::TAU * 0.4, std::f64::consts::TAU * 0.16);
    assert!((report.hamming - caps / (side + caps)).abs() < 0.02, "{}", report.hamming);
    assert!(report.rand.adjusted.abs() < 1e-12);
    assert_eq!(report.hits(false), 0);
}

#[test]
fn faces_without_a_label_count_as_lost() {
    let Sample { mesh, labels } = can(4);
    let truth = nothing(labels.clone(), 3);
    let part: Vec<u32> = labels.iter().map(|&l| if l == 2 { UNLABELLED } else { l }).collect();
    let report = evaluate(&mesh, &nothing(part, 3), &truth, TOLERANCE).unwrap();
    assert!((report.hamming - report.unlabelled_area).abs() < 1e-12 && report.hamming > 0.1);
    assert_eq!(report.verdicts.len(), 2);
}

#[test]
fn a_region_is_judged_by_extent_type_and_surface() {
    let Sample { mesh, labels } = can(10);
    let axis = Vector::z_axis();
    let side = |radius| Surface::Cylinder(Cylinder { point: [0.5, 0.5, 0.0].into(), axis, radius });
    let flat = |height: f64, up: f64| {
        Surface::Plane(Plane { normal: Unit::new_normalize(Vector::z() * up), offset: height * up })
    };
    let named = |kind: &str, surface| Named { kind: kind.into(), surface, near: None };
    let regions = |radius, kind: &str| {
        vec![
            named(kind, Some(side(radius))),
            named("plane", Some(flat(1.0, 1.0))),
            named("plane", Some(flat(0.0, -1.0))),
        ]
    };
    let truth = Answer { labels: labels.clone(), regions: regions(0.4, "cylinder") };
    let judge = |radius, kind: &str| {
        let found = Answer { labels: labels.clone(), regions: regions(radius, kind) };
        let report = evaluate(&mesh, &found, &truth, TOLERANCE).unwrap();
        let verdict = report.verdicts[0].clone();
        (verdict.rms.unwrap(), verdict.is_hit(), verdict.is_geometry(), verdict.errors)
    };
    let (rms, hit, geometry, errors) = judge(0.408, "cylinder");
    assert!((rms - 0.008).abs() < 1e-9 && hit && geometry);
    assert!(errors.iter().any(|(name, e)| *name == "radius" && (e - 0.02).abs() < 1e-12));
    let (_, hit, geometry, _) = judge(0.411, "cylinder");
    assert!(!hit && !geometry);
    let (_, hit, geometry, _) = judge(0.4, "cone");
    assert!(!hit && geometry);
}

#[test]
fn energy_is_zero_on_planes_and_grows_with_noise() {
    let part = synth::part("plate:1", 3_000).unwrap();
    let surfaces: Vec<_> = part.surfaces.iter().map(Some).collect();
    let on = |mesh: &Mesh| energy(mesh, &part.labels, &surfaces, 1e-3).unwrap();
    let noise = |sigma| synth::Noise::uniform(sigma, 0.9);
    let noisy = |s| synth::add_noise(&mut Context::new(1), &part.mesh, &noise(s)).unwrap();
    let [clean, some, more] = [on(&part.mesh), on(&noisy(0.002)), on(&noisy(0.004))];
    assert!(clean.total < some.total && some.total < more.total);
    assert_eq!(clean.without_surface, 0.0);
    let none = energy(&part.mesh, &part.labels, &vec![None; surfaces.len()], 1e-3).unwrap();
    assert!(none.total == 0.0 && (none.without_surface - 1.0).abs() < 1e-12);
}

#[test]
fn labels_of_another_mesh_are_refused() {
    let Sample { mesh, labels } = can(4);
    let truth = nothing(labels.clone(), 3);
    assert!(evaluate(&mesh, &nothing(labels[1..].to_vec(), 3), &truth, TOLERANCE).is_err());
    assert!(evaluate(&mesh, &nothing(labels, 2), &truth, TOLERANCE).is_err());
    let nobody = Answer::default();
    assert_eq!(evaluate(&Mesh::default(), &nobody, &nobody, TOLERANCE), Err(Error::Empty));
}
