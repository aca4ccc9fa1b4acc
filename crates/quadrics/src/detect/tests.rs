//! What holds for every start that the detection gives.

use super::*;
use crate::mesh::samples::{Sample, can, cube};
use crate::partition::{components, region_count};

fn assert_partition(working: &Working, labels: &[u32]) {
    let (_, sizes) = components(labels, &working.adjacency);
    assert!(!labels.contains(&UNLABELLED));
    assert_eq!(sizes.len(), region_count(labels));
}

/// The share of faces in which two partitions of equal numbers agree at best.
fn agreement(one: &[u32], other: &[u32]) -> f64 {
    let mut most = vec![std::collections::BTreeMap::<u32, usize>::new(); region_count(one)];
    one.iter().zip(other).for_each(|(&a, &b)| *most[a as usize].entry(b).or_default() += 1);
    let hits: usize = most.iter().filter_map(|counts| counts.values().max()).sum();
    hits as f64 / one.len() as f64
}

#[test]
fn a_cube_and_a_can_fall_into_their_surfaces() {
    for (Sample { mesh, labels }, count) in [(cube(16), 6), (can(16), 3)] {
        let working = Working::new(mesh);
        for seed in 0..3 {
            let found = detect(&mut Context::new(seed), &working, &Options::default()).unwrap();
            assert_partition(&working, &found);
            assert_eq!(region_count(&found), count);
            assert!(agreement(&labels, &found) > 0.99);
        }
    }
}

#[test]
fn components_without_a_shape_become_regions() {
    let working = Working::new(cube(2).beside(can(2), 2.0).mesh);
    // Fewer than tau faces each.
    let found = detect(&mut Context::new(0), &working, &Options::default()).unwrap();
    assert_partition(&working, &found);
    assert_eq!(region_count(&found), 2);
}

#[test]
fn the_same_seed_gives_the_same_labels_with_any_number_of_threads() {
    let working = Working::new(can(16).mesh);
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let run = || detect(&mut Context::new(7), &working, &Options::default());
        pool.install(run).unwrap()
    };
    assert_eq!(with(1), with(3));
}

#[test]
fn nothing_and_next_to_nothing_are_no_trouble() {
    let mut context = Context::new(0);
    let nothing = Working::new(crate::Mesh::default());
    assert_eq!(detect(&mut context, &nothing, &Options::default()), Err(Error::Empty));
    let mut mesh = cube(1).mesh;
    mesh.faces.truncate(1);
    let options = Options { tau: 1, ..Options::default() };
    assert_eq!(detect(&mut context, &Working::new(mesh), &options), Ok(vec![0]));
}
