//! A mesh goes in, regions with surfaces come out: what holds for every mesh, whatever it shows.

use nalgebra::{Translation3, UnitQuaternion};
use quadrics::math::{Point, Similarity};
use quadrics::mesh::{Adjacency, Mesh};
use quadrics::options::Preset;
use quadrics::result::{Region, Segmentation, Side};
use quadrics::surface::Surface;
use quadrics::synth::{self, Part};
use quadrics::{Context, Error, Options};

fn run(mesh: &Mesh, options: &Options) -> Segmentation {
    quadrics::segment(&mut Context::new(options.seed), mesh, options, None).unwrap()
}

fn part(name: &str) -> Part {
    synth::part(name, 6_000).unwrap()
}

fn cube() -> Mesh {
    let corner = |i: u32| Point::from([i & 1, i >> 1 & 1, i >> 2 & 1].map(f64::from));
    let squares =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let halves = |[a, b, c, d]: [u32; 4]| [[a, b, c], [a, c, d]];
    Mesh {
        positions: (0..8).map(corner).collect(),
        faces: squares.into_iter().flat_map(halves).collect(),
    }
}

/// Labels are those of the regions, and every region is connected.
fn check_partition(mesh: &Mesh, result: &Segmentation) {
    let mut faces = vec![0; result.regions.len()];
    assert_eq!(result.labels.len(), mesh.faces.len());
    result.labels.iter().for_each(|&label| faces[label as usize] += 1);
    for (id, region) in result.regions.iter().enumerate() {
        assert_eq!((region.id as usize, region.faces), (id, faces[id]));
        assert!(region.faces > 0 && region.area > 0.0 && region.area.is_finite());
        assert!((0.0..=1.0).contains(&region.confidence), "{}", region.confidence);
        assert!(region.neighbours.is_sorted() && !region.neighbours.contains(&region.id));
        assert!(region.uncertainty.iter().all(|(_, sigma)| *sigma >= 0.0));
    }
    let adjacency = Adjacency::new(&mesh.faces, mesh.positions.len());
    let (_, pieces) = quadrics::partition::components(&result.labels, &adjacency);
    assert_eq!(pieces.len(), result.regions.len());
}

fn types(result: &Segmentation) -> Vec<&'static str> {
    let mut types: Vec<_> = result.regions.iter().map(|r| r.surface.type_name()).collect();
    types.sort_unstable();
    types
}

/// Hamming distance of eq. 6: area that no best match covers, in both directions, over twice the area.
fn hamming(mesh: &Mesh, one: &[u32], other: &[u32]) -> f64 {
    let areas = quadrics::mesh::Geometry::new(mesh).areas;
    let missed = |from: &[u32], to: &[u32]| {
        let mut overlap = std::collections::BTreeMap::new();
        for (face, area) in areas.iter().enumerate() {
            *overlap.entry((from[face], to[face])).or_insert(0.0) += area;
        }
        let mut best = std::collections::BTreeMap::new();
        for ((from, _), area) in overlap {
            let best = best.entry(from).or_insert(0.0f64);
            *best = best.max(area);
        }
        areas.iter().sum::<f64>() - best.values().sum::<f64>()
    };
    (missed(one, other) + missed(other, one)) / (2.0 * areas.iter().sum::<f64>())
}

fn moved(mesh: &Mesh, by: &Similarity) -> Mesh {
    let positions = mesh.positions.iter().map(|point| by * point).collect();
    Mesh { positions, faces: mesh.faces.clone() }
}

#[test]
fn labels_are_a_partition_into_connected_regions() {
    for name in ["demo", "shaft", "open"] {
        let part = part(name);
        for preset in [Preset::Default, Preset::Paper] {
            let options = Options { preset, max_edge: f64::INFINITY, ..Options::default() };
            check_partition(&part.mesh, &run(&part.mesh, &options));
        }
    }
}

/// Whether parameters agree to a millionth; `None` where the types differ.
fn agrees(found: &Surface, truth: &Surface) -> Option<bool> {
    let near = |one: f64, other: f64| (one / other - 1.0).abs() < 1e-6;
    match (found, truth) {
        (Surface::Plane(one), Surface::Plane(other)) => {
            Some(1.0 - one.normal.dot(&other.normal) < 1e-12)
        }
        (Surface::Cylinder(one), Surface::Cylinder(other)) => {
            Some(near(one.radius, other.radius) && 1.0 - one.axis.dot(&other.axis).abs() < 1e-12)
        }
        (Surface::Torus(one), Surface::Torus(other)) => Some(
            near(one.minor_radius, other.minor_radius)
                && near(one.major_radius, other.major_radius),
        ),
        (Surface::Cone(one), Surface::Cone(other)) => Some(near(one.half_angle, other.half_angle)),
        (Surface::Sphere(one), Surface::Sphere(other)) => Some(near(one.radius, other.radius)),
        _ => None,
    }
}

/// Few faces a surface: what none explains goes to a neighbour, and no fit may turn for its sake.
#[test]
fn a_coarse_clean_part_keeps_its_large_surfaces() {
    let part = synth::part("demo", 10_000).unwrap();
    let result = run(&part.mesh, &Options::default());
    let missed = hamming(&part.mesh, &result.labels, &part.labels);
    assert!(missed < 0.05, "{missed} of the area, {} regions", result.regions.len());
}

#[test]
fn a_clean_part_gives_its_surfaces_exactly() {
    let part = part("shaft");
    let result = run(&part.mesh, &Options::default());
    assert!(hamming(&part.mesh, &result.labels, &part.labels) < 0.02);
    let mut exact = 0;
    for region in &result.regions {
        let faces: Vec<usize> =
            (0..part.labels.len()).filter(|&f| result.labels[f] == region.id).collect();
        let truth = part.labels[faces[0]];
        let pure = faces.iter().all(|&face| part.labels[face] == truth);
        let agrees = agrees(&region.surface, &part.surfaces[truth as usize]);
        if let (true, Some(agrees)) = (pure, agrees) {
            assert!(
                agrees,
                "{:?} {:?} {:?} {}",
                region.rms,
                region.surface,
                part.surfaces[truth as usize],
                faces.len()
            );
            exact += 1;
        }
    }
    assert!(exact * 10 >= part.surfaces.len() * 8, "{exact} of {}", part.surfaces.len());
}

#[test]
fn the_frame_and_the_scale_do_not_matter() {
    let part = part("demo");
    let here = run(&part.mesh, &Options::default());
    let shift = Translation3::new(5e4, -3e4, 2e4);
    let turn = UnitQuaternion::from_euler_angles(0.4, -0.9, 2.1);
    let none = UnitQuaternion::identity();
    let frames = [
        ("moved", Similarity::from_parts(shift, none, 1.0)),
        ("scaled", Similarity::from_parts(shift, none, 1000.0)),
        ("turned", Similarity::from_parts(Translation3::identity(), turn, 1.0)),
        ("all", Similarity::from_parts(shift, turn, 1000.0)),
    ];
    for (name, by) in frames {
        let there = run(&moved(&part.mesh, &by), &Options::default());
        assert_eq!(types(&here), types(&there), "{name}");
        assert!(hamming(&part.mesh, &here.labels, &there.labels) < 0.002, "{name}");
    }
}

#[test]
fn the_order_of_faces_does_not_matter() {
    let part = part("demo");
    let count = part.mesh.faces.len();
    // 7919 is prime, so every face comes once.
    let order: Vec<usize> = (0..count).map(|i| i * 7919 % count).collect();
    let shuffled = Mesh {
        positions: part.mesh.positions.clone(),
        faces: order.iter().map(|&face| part.mesh.faces[face]).collect(),
    };
    let here = run(&part.mesh, &Options::default());
    let there = run(&shuffled, &Options::default());
    let mut back = vec![0; count];
    order.iter().zip(&there.labels).for_each(|(&face, &label)| back[face] = label);
    assert_eq!(types(&here), types(&there));
    assert!(hamming(&part.mesh, &here.labels, &back) < 0.002);
}

#[test]
fn any_number_of_threads_gives_the_same_bytes() {
    let part = part("demo");
    for preset in [Preset::Default, Preset::Paper] {
        let with = |threads| {
            let options = Options { preset, threads, ..Options::default() };
            Segmentation { timing: Vec::new(), ..run(&part.mesh, &options) }
        };
        assert_eq!(format!("{:?}", with(1)), format!("{:?}", with(2)));
    }
}

#[test]
fn the_loop_starts_from_the_labels_that_are_given() {
    let part = part("shaft");
    for preset in [Preset::Default, Preset::Paper] {
        let options = Options { preset, ..Options::default() };
        let mut context = Context::new(0);
        // Any numbers will do, and a face may have none.
        let mut labels: Vec<u32> = part.labels.iter().map(|l| l * 1_000_000 + 7).collect();
        labels[0] = u32::MAX;
        let result = quadrics::segment(&mut context, &part.mesh, &options, Some(&labels)).unwrap();
        check_partition(&part.mesh, &result);
        assert!(hamming(&part.mesh, &result.labels, &part.labels) < 0.05);
        assert!(result.timing.iter().all(|(stage, _)| *stage != "detect"));
    }
    let wrong =
        quadrics::segment(&mut Context::new(0), &part.mesh, &Options::default(), Some(&[0, 1]));
    assert!(matches!(wrong, Err(Error::Option(_))));
}

#[test]
fn a_listener_that_says_stop_is_obeyed_at_every_stage() {
    let part = synth::part("shaft", 3_000).unwrap();
    for preset in [Preset::Default, Preset::Paper] {
        let options = Options { preset, ..Options::default() };
        let mut stages = Vec::new();
        let mut context = Context::with_progress(0, |stage, _| {
            if !stages.contains(&stage) {
                stages.push(stage);
            }
            true
        });
        quadrics::segment(&mut context, &part.mesh, &options, None).unwrap();
        drop(context);
        assert!(stages.len() >= 4, "{stages:?}");
        for stop in stages {
            let mut context = Context::with_progress(0, move |stage, _| stage != stop);
            let result = quadrics::segment(&mut context, &part.mesh, &options, None);
            assert_eq!(result, Err(Error::Cancelled), "{stop}");
        }
    }
}

#[test]
fn twelve_triangles_of_a_cube_are_six_planes() {
    for preset in [Preset::Default, Preset::Paper] {
        let options = Options { preset, tau: 50, ..Options::default() };
        let result = run(&cube(), &options);
        check_partition(&cube(), &result);
        assert_eq!(types(&result), ["plane"; 6]);
        let outward = |region: &Region| match &region.surface {
            Surface::Plane(plane) => plane.normal.sum() > 0.0 || plane.offset.abs() < 1e-9,
            _ => false,
        };
        assert!(result.regions.iter().all(|r| r.side == Side::Outside && outward(r)));
        assert!(result.regions.iter().all(|r| r.neighbours.len() == 4 && r.rms < Some(1e-9)));
    }
}

#[test]
fn meshes_that_are_hardly_any_get_a_sensible_answer() {
    let triangle = Mesh {
        positions: vec![Point::origin(), Point::new(2.0, 0.0, 0.0), Point::new(0.0, 1.0, 0.0)],
        faces: vec![[0, 1, 2]],
    };
    let mut open = cube();
    open.faces.truncate(10);
    let mut flat = cube();
    // A face without area, and one twice.
    flat.faces.extend([[0, 0, 1], [0, 2, 3]]);
    let mut two = cube();
    let far = nalgebra::Vector3::new(3.0, 0.5, 0.0);
    two.positions.extend(cube().positions.into_iter().map(|point| point + far));
    two.faces.extend(cube().faces.iter().map(|face| face.map(|v| v + 8)));
    for (mesh, regions) in [(triangle, 1), (open, 5), (flat, 6), (two, 12)] {
        for preset in [Preset::Default, Preset::Paper] {
            let result = run(&mesh, &Options { preset, tau: 50, ..Options::default() });
            assert_eq!(result.labels.len(), mesh.faces.len());
            assert!(types(&result).iter().all(|kind| *kind == "plane"), "{preset:?}");
            // The paper's draws may cut a face of a box in two.
            assert!(result.regions.len() >= regions);
            assert!(result.regions.len() == regions || preset == Preset::Paper);
        }
    }
    let nothing =
        quadrics::segment(&mut Context::new(0), &Mesh::default(), &Options::default(), None);
    assert_eq!(nothing, Err(Error::Empty));
}

#[test]
fn crumbs_that_touch_nothing_are_regions_of_their_own() {
    let mut mesh = part("plate").mesh;
    for i in 0..3 {
        let first = mesh.positions.len() as u32;
        let at = 2.0 + f64::from(i);
        mesh.positions.extend([
            Point::new(at, 0.0, 0.0),
            Point::new(at, 0.1, 0.0),
            Point::new(at, 0.0, 0.1),
        ]);
        mesh.faces.push([first, first + 1, first + 2]);
    }
    let result = run(&mesh, &Options::default());
    check_partition(&mesh, &result);
    let labels = &result.labels[mesh.faces.len() - 3..];
    assert!(labels[0] != labels[1] && labels[1] != labels[2] && labels[0] != labels[2]);
}
