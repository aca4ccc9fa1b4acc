use super::*;
use crate::context::Context;
use crate::evaluate::deviation;
use crate::synth::{self, Noise};

/// Standard deviation of eq. 5 over all vertices.
fn spread(noise: &Noise, size: f64) -> f64 {
    noise.sigma * size * (noise.ratio / 3.0).sqrt()
}

#[test]
fn true_surfaces_take_most_of_the_noise_away_and_move_nothing_too_far() {
    for (name, sigma) in [("shaft", 0.003), ("plate:4", 0.005), ("quadrics", 0.003)] {
        let part = synth::part(name, 12_000).unwrap();
        let noise = Noise::uniform(sigma, 0.9);
        let noisy = synth::add_noise(&mut Context::new(1), &part.mesh, &noise).unwrap();
        let sigma = spread(&noise, part.mesh.size());
        let positions = denoise(&noisy, &part.labels, &part.surfaces, sigma).unwrap();
        for (old, new) in noisy.positions.iter().zip(&positions) {
            assert!((new - old).norm() <= offset::REACH * sigma * (1.0 + 1e-9));
        }
        let clean = Mesh { positions, faces: noisy.faces.clone() };
        let before = deviation(&noisy, &part.mesh).unwrap();
        let after = deviation(&clean, &part.mesh).unwrap();
        assert!(after.mean < 0.1 * before.mean, "{name} {} {}", after.mean, before.mean);
        assert!(after.hausdorff < before.hausdorff, "{name}");
    }
}

#[test]
fn a_wrong_surface_does_not_carry_vertices_away() {
    let part = synth::part("plate:1", 6_000).unwrap();
    let noise = Noise::uniform(0.002, 1.0);
    let noisy = synth::add_noise(&mut Context::new(1), &part.mesh, &noise).unwrap();
    let sigma = spread(&noise, part.mesh.size());
    let mut wrong = part.surfaces.clone();
    for surface in &mut wrong {
        if let Surface::Plane(plane) = surface {
            plane.offset += 2.0 * sigma;
        }
    }
    let positions = denoise(&noisy, &part.labels, &wrong, sigma).unwrap();
    let clean = Mesh { positions, faces: noisy.faces.clone() };
    let before = deviation(&noisy, &part.mesh).unwrap();
    let after = deviation(&clean, &part.mesh).unwrap();
    assert!(after.mean < 0.5 * before.mean, "{} {}", after.mean, before.mean);
}

#[test]
fn a_clean_mesh_stays_and_no_face_turns_over() {
    let part = synth::part("draft", 8_000).unwrap();
    let still = denoise(&part.mesh, &part.labels, &part.surfaces, 0.0).unwrap();
    let most = part.mesh.positions.iter().zip(&still).map(|(a, b)| (a - b).norm());
    assert!(most.fold(0.0, f64::max) < 1e-6 * part.mesh.size());
    let noise = Noise::uniform(0.004, 0.9);
    let noisy = synth::add_noise(&mut Context::new(2), &part.mesh, &noise).unwrap();
    let sigma = spread(&noise, part.mesh.size());
    let positions = denoise(&noisy, &part.labels, &part.surfaces, sigma).unwrap();
    let (truth, now) = (
        Working::new(part.mesh.clone()),
        Working::new(Mesh { positions, faces: noisy.faces.clone() }),
    );
    let old = Working::new(noisy);
    for face in 0..truth.len() {
        let normal = truth.geometry.normals[face];
        let folded = |working: &Working| working.geometry.normals[face].dot(&normal) < 0.0;
        assert!(!folded(&now) || folded(&old), "{face}");
    }
}

#[test]
fn free_form_regions_become_smooth_and_bare_faces_stay() {
    let part = synth::part("quadrics", 12_000).unwrap();
    let noise = Noise::uniform(0.003, 0.9);
    let noisy = synth::add_noise(&mut Context::new(1), &part.mesh, &noise).unwrap();
    let sigma = spread(&noise, part.mesh.size());
    let free = vec![Surface::FreeForm; part.surfaces.len()];
    let positions = denoise(&noisy, &part.labels, &free, sigma).unwrap();
    let clean = Mesh { positions, faces: noisy.faces.clone() };
    let before = deviation(&noisy, &part.mesh).unwrap();
    let after = deviation(&clean, &part.mesh).unwrap();
    assert!(after.mean < 0.6 * before.mean, "{} {}", after.mean, before.mean);
    let bare = vec![UNLABELLED; part.labels.len()];
    assert_eq!(denoise(&noisy, &bare, &[], 1.0).unwrap(), noisy.positions);
    assert!(denoise(&noisy, &part.labels, &[], 1.0).is_err());
    assert!(denoise(&noisy, &part.labels[1..], &free, 1.0).is_err());
    assert!(denoise(&noisy, &part.labels, &free, f64::NAN).is_err());
}
