use super::super::part;
use super::*;
use crate::mesh::NONE;
use crate::surface::Surface;

fn small() -> Scanner {
    Scanner { faces: 12_000, ..Scanner::default() }
}

fn exact() -> Scanner {
    Scanner { waviness: 0.0, jitter: 0.0, holes: (0, 0), ..small() }
}

fn borders(mesh: &Mesh) -> usize {
    let adjacency = Adjacency::new(&mesh.faces, mesh.positions.len());
    adjacency.neighbours.iter().flatten().filter(|&&n| n == NONE).count()
}

#[test]
fn a_scan_has_holes_and_connected_regions_with_their_true_surfaces() {
    let part = part("demo", 20_000).unwrap();
    let scan = scan(&mut Context::new(1), &part, &small()).unwrap();
    assert!(borders(&scan.mesh) > 20);
    let adjacency = Adjacency::new(&scan.mesh.faces, scan.mesh.positions.len());
    let (_, sizes) = components(&scan.labels, &adjacency);
    assert_eq!(sizes.len(), scan.surfaces.len());
    assert!(scan.surfaces.iter().all(|s| part.surfaces.contains(s)));
    assert!(scan.surfaces.len() > part.surfaces.len() / 2, "{}", scan.surfaces.len());
}

#[test]
fn an_exact_scan_without_holes_is_closed_and_lies_on_the_part_but_at_its_edges() {
    let part = part("shaft", 8_000).unwrap();
    let scan = scan(&mut Context::new(2), &part, &exact()).unwrap();
    assert_eq!(borders(&scan.mesh), 0);
    let size = part.mesh.size();
    let far = |surface: &Surface, face: usize| {
        let corners = scan.mesh.corners(face).map(|p| surface.distance(p).unwrap().abs());
        corners.into_iter().fold(0.0, f64::max)
    };
    let faces = scan.labels.iter().enumerate();
    let off =
        faces.filter(|(face, label)| far(&scan.surfaces[**label as usize], *face) > 1e-9 * size);
    let share = off.count() as f64 / scan.labels.len() as f64;
    assert!(share > 0.02 && share < 0.4, "{share}");
}

#[test]
fn the_errors_have_the_standard_deviations_asked_for() {
    let part = part("shaft", 8_000).unwrap();
    let noisy = Scanner { jitter: 0.002, waviness: 0.0, ..exact() };
    let clean = scan(&mut Context::new(3), &part, &exact()).unwrap().mesh;
    let scan = scan(&mut Context::new(3), &part, &noisy).unwrap().mesh;
    let pairs = scan.positions.iter().zip(&clean.positions);
    let square = pairs.map(|(p, q)| (p - q).norm_squared()).sum::<f64>();
    let sigma = (square / clean.positions.len() as f64).sqrt() / part.mesh.size();
    assert!((sigma / 0.002 - 1.0).abs() < 0.05, "{sigma}");
}

#[test]
fn the_same_seed_gives_the_same_scan() {
    let part = part("open", 5_000).unwrap();
    let make = |seed| scan(&mut Context::new(seed), &part, &small()).unwrap();
    let one = make(4);
    assert_eq!(one, make(4));
    assert_ne!(one, make(5));
}

#[test]
fn a_cancelled_scan_stops_and_a_senseless_one_does_not_begin() {
    let part = part("open", 5_000).unwrap();
    let mut stop = Context::with_progress(0, |_, _| false);
    assert_eq!(scan(&mut stop, &part, &small()), Err(Error::Cancelled));
    let mut context = Context::new(0);
    assert_eq!(scan(&mut context, &Part::default(), &small()), Err(Error::Empty));
    let nan = Scanner { jitter: f64::NAN, ..small() };
    assert!(scan(&mut context, &part, &nan).unwrap_err().to_string().contains("jitter"));
    assert!(scan(&mut context, &part, &Scanner { faces: 0, ..small() }).is_err());
    let torn = Part { surfaces: Vec::new(), ..part.clone() };
    assert!(scan(&mut context, &torn, &small()).unwrap_err().to_string().contains("surface"));
    assert!(scan(&mut context, &part, &Scanner { holes: (3, 2), ..small() }).is_err());
}

#[test]
fn a_scanner_whose_lengths_are_zero_makes_finite_meshes() {
    let part = part("shaft", 2_000).unwrap();
    let zero = Scanner { wavelength: 0.0, hole_radius: (0.0, 0.0), faces: 2_000, ..small() };
    let scan = scan(&mut Context::new(6), &part, &zero).unwrap();
    assert!(scan.mesh.positions.iter().flat_map(|p| p.iter()).all(|c| c.is_finite()));
}
