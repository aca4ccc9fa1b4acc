//! What holds for every part.

use super::*;
use crate::math::{Similarity, Vector};
use crate::mesh::{Adjacency, Geometry, NONE};
use crate::partition::{components, region_count};

/// Enough for every part.
const FACES: usize = 12_000;

/// Rounding of a square under a root, near a pole, relative to the size.
const ON_SURFACE: f64 = 1e-9;

fn parts() -> impl Iterator<Item = (&'static str, Part)> {
    names().iter().map(|name| (*name, part(name, FACES).unwrap()))
}

fn volume(part: &Part) -> f64 {
    let corners = (0..part.mesh.faces.len()).map(|face| part.mesh.corners(face).map(|p| p.coords));
    corners.map(|[a, b, c]| a.dot(&b.cross(&c)) / 6.0).sum()
}

#[test]
fn every_vertex_of_a_region_lies_on_its_surface_also_when_moved() {
    let by = Similarity::new(Vector::new(30.0, -9.0, 50.0), Vector::new(0.3, -1.0, 0.7), 0.1);
    for (name, part) in
        parts().flat_map(|(name, part)| [(name, part.transformed(&by)), (name, part)])
    {
        let size = part.mesh.size();
        for (face, &label) in part.labels.iter().enumerate() {
            for point in part.mesh.corners(face) {
                let far = part.surfaces[label as usize].distance(point).unwrap();
                assert!(far.abs() < ON_SURFACE * size, "{name}: region {label}, {far}");
            }
        }
    }
}

#[test]
fn normals_of_faces_agree_with_those_of_their_surface() {
    for (name, part) in parts() {
        let geometry = Geometry::new(&part.mesh);
        // Normals of a region are all on one side of its surface.
        let mut side = vec![0.0; part.surfaces.len()];
        let mut bad = 0;
        for (face, &label) in part.labels.iter().enumerate() {
            let normal = part.surfaces[label as usize].normal(geometry.barycentres[face]).unwrap();
            let agree = normal.dot(&geometry.normals[face]);
            let region = &mut side[label as usize];
            *region = if *region == 0.0 { agree.signum() } else { *region };
            assert!(agree * *region > 0.7, "{name}: face {face} of region {label}, {agree}");
            bad += usize::from(agree.abs() < 0.97);
        }
        assert!(bad * 50 < part.labels.len(), "{name}: {bad} faces off by 14 degrees");
    }
}

#[test]
fn labels_are_connected_and_every_surface_has_faces() {
    for (name, part) in parts() {
        let adjacency = Adjacency::new(&part.mesh.faces, part.mesh.positions.len());
        let (_, sizes) = components(&part.labels, &adjacency);
        assert_eq!(sizes.len(), part.surfaces.len(), "{name}");
        assert_eq!(region_count(&part.labels), part.surfaces.len(), "{name}");
    }
}

#[test]
fn closed_parts_are_closed_and_oriented_outward() {
    // Genus: bores through the part.
    for (name, genus) in [("demo", 5), ("shaft", 0), ("plate", 24), ("draft", 0), ("quadrics", 0)] {
        let part = part(name, FACES).unwrap();
        let adjacency = Adjacency::new(&part.mesh.faces, part.mesh.positions.len());
        assert!(adjacency.neighbours.iter().flatten().all(|&n| n != NONE), "{name} is open");
        let (faces, vertices) = (part.mesh.faces.len(), part.mesh.positions.len());
        assert_eq!(vertices + faces, 3 * faces / 2 + 2 - 2 * genus, "{name}");
        assert!(volume(&part) > 0.0, "{name}");
    }
}

#[test]
fn the_volume_of_a_plate_is_that_of_its_solids() {
    let part = part("plate:4", 40_000).unwrap();
    // The bores are polygons inside their circles, by less than a thousandth of their area.
    let exact = 10.0 * (40.0 * 40.0 - 4.0 * 36.0 * std::f64::consts::PI);
    assert!((volume(&part) / exact - 1.0).abs() < 1e-3);
}

#[test]
fn neighbouring_faces_agree_in_orientation() {
    for (name, part) in parts() {
        let mut edges: Vec<_> =
            part.mesh.faces.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).collect();
        edges.sort_unstable();
        assert!(edges.windows(2).all(|pair| pair[0] != pair[1]), "{name}");
    }
}

#[test]
fn the_number_of_faces_is_about_the_one_asked_for() {
    for name in names() {
        for faces in [3_000, 30_000] {
            let made = part(name, faces).unwrap().mesh.faces.len() as f64 / faces as f64;
            assert!((0.66..1.5).contains(&made), "{name} at {faces}: {made}");
        }
    }
}

#[test]
fn the_plate_has_the_promised_regions() {
    assert_eq!(part("plate:100", 50_000).unwrap().surfaces.len(), 106);
}

#[test]
fn every_type_of_surface_occurs() {
    let surfaces: Vec<_> = parts().flat_map(|(_, part)| part.surfaces).collect();
    for name in ["plane", "sphere", "cylinder", "cone", "torus", "quadric"] {
        assert!(surfaces.iter().any(|s| s.type_name() == name), "{name}");
    }
}

#[test]
fn triangles_are_those_of_a_decent_mesher() {
    for (name, part) in parts() {
        let quality = |face: usize| {
            let [a, b, c] = part.mesh.corners(face);
            let sides = (b - a).norm_squared() + (c - b).norm_squared() + (a - c).norm_squared();
            2.0 * 3f64.sqrt() * (b - a).cross(&(c - a)).norm() / sides
        };
        let mut all: Vec<_> = (0..part.labels.len()).map(quality).collect();
        all.sort_by(f64::total_cmp);
        let (twentieth, median) = (all[all.len() / 20], all[all.len() / 2]);
        assert!(twentieth > 0.6 && median > 0.9, "{name}: {twentieth}, {median}");
    }
}

#[test]
fn what_cannot_be_made_is_refused_with_the_way_out() {
    let text = part("flange", 1000).unwrap_err().to_string();
    assert!(text.contains("flange") && text.contains("demo"), "{text}");
    for (name, faces) in [("plate:100", 100), ("plate:999999999999", 10_000), ("demo", 0)] {
        let text = part(name, faces).unwrap_err().to_string();
        assert!(text.contains("too few"), "{text}");
    }
    assert!(part("shaft", usize::MAX).unwrap_err().to_string().contains("too many"));
    assert!(part("plate:-1", 10_000).is_err());
    assert_eq!(part("plate:0", 1_000).unwrap().surfaces.len(), 6);
}
