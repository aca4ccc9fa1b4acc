//! What holds for every partition that the loop makes.

use rand::RngExt;

use super::*;
use crate::math::{Point, Vector};
use crate::mesh::Mesh;
use crate::mesh::samples::{Sample, can, cube};
use crate::partition::region_count;

fn run(working: &Working, options: &Options, start: &[u32]) -> Outcome {
    paper(&mut Context::new(0), working, options, start).unwrap()
}

/// Every face is in one of the regions, and every region is connected.
fn assert_partition(working: &Working, outcome: &Outcome, count: usize) {
    let (component, sizes) = components(&outcome.labels, &working.adjacency);
    assert_eq!(component.len(), working.len());
    assert!(!outcome.labels.contains(&UNLABELLED));
    assert_eq!((sizes.len(), region_count(&outcome.labels)), (count, count));
    assert_eq!(outcome.proxies.len(), count);
}

fn same_partition(one: &[u32], other: &[u32]) -> bool {
    let pairs: HashSet<_> = one.iter().zip(other).collect();
    let (left, right): (HashSet<u32>, HashSet<u32>) = pairs.iter().copied().unzip();
    pairs.len() == left.len() && pairs.len() == right.len()
}

/// Vertices moved by up to `far`.
fn shaken(mut sample: Sample, far: f64) -> Sample {
    let mut rng = Context::new(8).rng;
    for p in &mut sample.mesh.positions {
        *p += Vector::from_fn(|_, _| rng.random_range(-far..far));
    }
    sample
}

/// Labels of patches around random faces: a bad start.
fn random_start(working: &Working, regions: usize, seed: u64) -> Labels {
    let mut rng = Context::new(seed).rng;
    let mut labels = vec![UNLABELLED; working.len()];
    for region in 0..regions as u32 {
        labels[rng.random_range(0..working.len())] = region;
    }
    labels
}

#[test]
fn the_truth_of_a_can_stays_and_its_surfaces_are_recognised() {
    let Sample { mesh, labels } = can(12);
    let working = Working::new(mesh);
    let outcome = run(&working, &Options::default(), &labels);
    assert!(same_partition(&outcome.labels, &labels));
    assert!(matches!(outcome.proxies[0], Proxy::Quadric(_)));
    assert!(matches!(outcome.proxies[1..], [Proxy::Plane(_), Proxy::Plane(_)]));
    for (proxy, face) in [(0, 0), (1, labels.iter().position(|&l| l == 1).unwrap())] {
        let surface = outcome.proxies[proxy].surface();
        let normal = surface.normal(working.geometry.barycentres[face]).unwrap();
        assert!(normal.dot(&working.geometry.normals[face]) > 0.99, "outward");
    }
}

#[test]
fn five_insertions_explain_nine_tenths_of_a_cube() {
    let working = Working::new(cube(8).mesh);
    let energy = |wanted| {
        let options = Options { regions: Some(wanted), ..Options::default() };
        run(&working, &options, &vec![0; working.len()]).energy[0]
    };
    assert!(energy(6) < energy(1) / 10.0, "{} {}", energy(1), energy(6));
}

#[test]
fn the_number_of_regions_is_the_one_wanted_from_any_start() {
    let working = Working::new(shaken(can(8), 0.01).mesh);
    for seed in 0..6 {
        for wanted in [1, 2, 3, 7, 20] {
            let options = Options { regions: Some(wanted), ..Options::default() };
            let start = random_start(&working, 8, seed);
            let outcome = run(&working, &options, &start);
            assert_partition(&working, &outcome, wanted);
        }
    }
}

#[test]
fn components_and_faces_bound_the_number_of_regions() {
    let working = Working::new(cube(1).beside(cube(1), 3.0).mesh);
    let run_to = |regions| {
        let options = Options { regions: Some(regions), ..Options::default() };
        run(&working, &options, &vec![0; working.len()])
    };
    assert_partition(&working, &run_to(1), 2);
    assert_partition(&working, &run_to(1000), working.len());
}

#[test]
fn without_a_number_the_start_decides_it() {
    let working = Working::new(shaken(cube(6), 0.02).mesh);
    let start = connected(&working, &random_start(&working, 9, 1)).unwrap();
    let outcome = run(&working, &Options::default(), &start);
    assert_partition(&working, &outcome, region_count(&start));
}

#[test]
fn the_result_is_the_best_partition_that_was_seen() {
    let working = Working::new(shaken(can(8), 0.02).mesh);
    let options = Options::default();
    let outcome = run(&working, &options, &random_start(&working, 6, 3));
    let task = Task { working: &working, options: &options, metric: Metric::Surfaces };
    let energy: f64 = fit_all(&task, faces_of(&outcome.labels), &[]).iter().map(|r| r.error).sum();
    let least = outcome.energy.iter().copied().fold(f64::INFINITY, f64::min);
    assert!((energy - least).abs() <= 1e-12 * least);
    assert!(least < outcome.energy[0]);
}

#[test]
fn halves_of_planes_merge_before_anything_else() {
    let Sample { mesh, labels } = cube(6);
    let working = Working::new(mesh);
    let half = |face: usize| u32::from(working.geometry.barycentres[face].coords.sum() > 1.5);
    let start: Vec<u32> = (0..labels.len()).map(|face| 2 * labels[face] + half(face)).collect();
    let options = Options { regions: Some(6), ..Options::default() };
    assert!(same_partition(&run(&working, &options, &start).labels, &labels));
}

#[test]
fn above_the_threshold_regions_are_split_until_none_is() {
    let Sample { mesh, labels } = cube(5);
    let working = Working::new(mesh);
    let options = Options { insertion_threshold: Some(1e-9), ..Options::default() };
    let outcome = run(&working, &options, &vec![0; working.len()]);
    assert!(outcome.energy[0] < 1e-9 * 6.0);
    assert!(region_count(&outcome.labels) >= 6, "{}", region_count(&labels));
}

#[test]
fn any_number_of_threads_gives_the_same_labels() {
    let working = Working::new(shaken(can(10), 0.02).mesh);
    let options = Options { regions: Some(5), ..Options::default() };
    let start = random_start(&working, 9, 2);
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| run(&working, &options, &start))
    };
    assert_eq!(with(1), with(3));
}

#[test]
fn the_order_of_the_faces_does_not_matter() {
    // So few that no region is sampled: of larger ones every n-th face is.
    let mesh = shaken(can(3), 0.01).mesh;
    let straight = Working::new(mesh.clone());
    let reversed: Vec<_> = mesh.faces.iter().rev().copied().collect();
    let reversed = Working::new(Mesh { faces: reversed, ..mesh });
    for seed in 0..5 {
        let options = Options { regions: Some(4), ..Options::default() };
        let start = connected(&straight, &random_start(&straight, 6, seed)).unwrap();
        let backwards: Labels = start.iter().rev().copied().collect();
        let one = run(&straight, &options, &start).labels;
        let other = run(&reversed, &options, &backwards).labels;
        assert!(same_partition(&one, &other.into_iter().rev().collect::<Labels>()));
    }
}

#[test]
fn faces_without_area_do_no_harm() {
    let mut mesh = cube(2).mesh;
    let [a, b, _] = mesh.faces[0];
    mesh.positions.push(nalgebra::center(&mesh.positions[a as usize], &mesh.positions[b as usize]));
    mesh.faces.push([a, b, mesh.positions.len() as u32 - 1]);
    mesh.positions.extend([Point::new(0.5, 0.5, 0.5); 3]);
    let last = mesh.positions.len() as u32;
    mesh.faces.push([last - 3, last - 2, last - 1]);
    let working = Working::new(mesh);
    let options = Options { regions: Some(7), ..Options::default() };
    let outcome = run(&working, &options, &vec![0; working.len()]);
    assert_partition(&working, &outcome, 7);
    assert!(outcome.energy.iter().all(|energy| energy.is_finite()));
}

#[test]
fn a_start_must_have_a_label_a_face_and_a_mesh_a_face() {
    let working = Working::new(cube(1).mesh);
    let mut context = Context::new(0);
    let options = Options::default();
    assert!(matches!(paper(&mut context, &working, &options, &[0]), Err(Error::Option(_))));
    let nothing = Working::new(Mesh::default());
    assert_eq!(paper(&mut context, &nothing, &options, &[]), Err(Error::Empty));
}

#[test]
fn a_listener_can_stop_it() {
    let working = Working::new(cube(3).mesh);
    let mut context = Context::with_progress(0, |_, _| false);
    let stopped = paper(&mut context, &working, &Options::default(), &vec![0; working.len()]);
    assert_eq!(stopped, Err(Error::Cancelled));
}

/// The text of section 4.3(1) with a list for a queue.
fn flood_slowly(task: &Task, regions: &[Fitted], seeds: &[Vec<u32>]) -> Labels {
    let mut labels = vec![UNLABELLED; task.working.len()];
    let mut queue = Vec::new();
    let pair = |face: u32, region: usize, seed: bool| {
        (task.error(&regions[region].proxy, face) as f32, face, region, seed)
    };
    for (region, faces) in seeds.iter().enumerate() {
        for &face in faces {
            labels[face as usize] = region as u32;
            queue.push(pair(face, region, true));
        }
    }
    while !queue.is_empty() {
        let by_error =
            |one: &usize, other: &usize| queue[*one].partial_cmp(&queue[*other]).unwrap();
        let top = (0..queue.len()).min_by(by_error).unwrap();
        let (_, face, region, seed) = queue.swap_remove(top);
        if labels[face as usize] != UNLABELLED && !seed {
            continue;
        }
        labels[face as usize] = region as u32;
        for next in task.working.adjacency.across(face as usize) {
            if labels[next] == UNLABELLED {
                queue.push(pair(next as u32, region, false));
            }
        }
    }
    labels
}

#[test]
fn the_flood_is_the_papers_pop_by_pop() {
    let options = Options::default();
    for seed in 0..20 {
        let working = Working::new(shaken(can(4), 0.03).mesh);
        let task = Task { working: &working, options: &options, metric: Metric::Surfaces };
        let labels = connected(&working, &random_start(&working, 5, seed)).unwrap();
        let regions = fit_all(&task, faces_of(&labels), &[]);
        let seeds = seeds::seeds(&task, &labels, &regions);
        let mut flooded = vec![UNLABELLED; labels.len()];
        let numbered = seeds.iter().enumerate().map(|(region, faces)| (region as u32, &faces[..]));
        flood::flood(&task, |r| &regions[r as usize].proxy, numbered, &mut flooded);
        assert_eq!(flooded, flood_slowly(&task, &regions, &seeds));
    }
}

#[test]
fn seeds_are_connected_parts_of_their_regions_of_a_tenth() {
    let working = Working::new(shaken(can(8), 0.02).mesh);
    for kind in [crate::options::Seeds::Region, crate::options::Seeds::Triangle] {
        let options = Options { seeds: kind, ..Options::default() };
        let task = Task { working: &working, options: &options, metric: Metric::Surfaces };
        let labels = connected(&working, &random_start(&working, 5, 1)).unwrap();
        let regions = fit_all(&task, faces_of(&labels), &[]);
        for (region, seed) in seeds::seeds(&task, &labels, &regions).iter().enumerate() {
            let size = match kind {
                crate::options::Seeds::Triangle => 1,
                crate::options::Seeds::Region => (regions[region].faces.len() / 10).max(1),
            };
            assert_eq!(seed.len(), size);
            assert!(seed.iter().all(|&face| labels[face as usize] == region as u32));
            let inside: Vec<u32> =
                (0..labels.len() as u32).map(|f| seed.contains(&f).into()).collect();
            let (component, _) = components(&inside, &working.adjacency);
            assert!(seed.iter().all(|&f| component[f as usize] == component[seed[0] as usize]));
        }
    }
}

#[test]
fn a_region_too_many_goes_where_one_is_missing() {
    let Sample { mesh, labels } = cube(10);
    let working = Working::new(mesh);
    // Two sides that share an edge are one region, and another side is two.
    let start: Labels = labels
        .iter()
        .enumerate()
        .map(|(face, &label)| match label {
            2 => 0,
            5 if working.geometry.barycentres[face].x < 0.5 => 2,
            other => other,
        })
        .collect();
    let options = Options { regions: Some(6), merge_angle_deg: 0.0, ..Options::default() };
    let outcome = run(&working, &options, &start);
    assert!(same_partition(&outcome.labels, &labels), "{:?}", outcome.energy);
}
