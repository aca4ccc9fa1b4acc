//! Noise on the vertices of a clean mesh, as the paper adds it (eq. 5 and section 5.5).

use std::f64::consts::TAU;

use rand::RngExt;
use rand::seq::SliceRandom;

use crate::context::Context;
use crate::error::{Error, Result};
use crate::math::Vector;
use crate::mesh::Mesh;

/// How far a vertex moves, as a multiple of sigma.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Distribution {
    /// Evenly between -1 and 1 (eq. 5): no vertex moves further than sigma.
    #[default]
    Uniform,
    /// With standard deviation 1 (section 5.5).
    Gaussian,
}

/// Noise along the normals of the vertices.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Noise {
    /// The paper's σ, as a fraction of the longest side of the mesh.
    pub sigma: f64,
    /// Fraction of the vertices that move, in [0, 1].
    pub ratio: f64,
    /// How far they move.
    pub distribution: Distribution,
}

impl Noise {
    /// Eq. 5: `v + σ ω n`, with ω uniform in [-1, 1], on a random `ratio` of the vertices.
    pub fn uniform(sigma: f64, ratio: f64) -> Self {
        Self { sigma, ratio, distribution: Distribution::Uniform }
    }

    /// Section 5.5: Gaussian, on half of the vertices.
    pub fn gaussian(sigma: f64) -> Self {
        Self { sigma, ratio: 0.5, distribution: Distribution::Gaussian }
    }

    fn check(&self) -> Result<()> {
        if !(self.sigma >= 0.0 && self.sigma.is_finite()) {
            let sigma = self.sigma;
            return Err(Error::Option(format!("sigma is {sigma}: give a fraction such as 0.01")));
        }
        if !(0.0..=1.0).contains(&self.ratio) {
            let ratio = self.ratio;
            return Err(Error::Option(format!("ratio is {ratio}: give a number from 0 to 1")));
        }
        Ok(())
    }
}

/// The mesh with noise; faces are as before.
///
/// Normals are those of the mesh as given, weighted by area. A vertex without a face stays.
///
/// # Errors
/// [`Error::Option`] if sigma is negative or not finite, or the ratio not in [0, 1].
pub fn add_noise(context: &mut Context, mesh: &Mesh, noise: &Noise) -> Result<Mesh> {
    noise.check()?;
    let normals = vertex_normals(mesh);
    let mut movable: Vec<u32> =
        (0..).zip(&normals).filter(|(_, n)| **n != Vector::zeros()).map(|(v, _)| v).collect();
    let count = (noise.ratio * movable.len() as f64).round() as usize;
    let (chosen, _) = movable.partial_shuffle(&mut context.rng, count);
    // In ascending order: which vertex gets which number must not depend on the shuffle's ways.
    chosen.sort_unstable();
    let reach = noise.sigma * mesh.size();
    let mut noisy = mesh.clone();
    for &vertex in &*chosen {
        let omega = match noise.distribution {
            Distribution::Uniform => context.rng.random_range(-1.0..=1.0),
            Distribution::Gaussian => gaussian(context),
        };
        noisy.positions[vertex as usize] += normals[vertex as usize] * (reach * omega);
    }
    Ok(noisy)
}

/// A number from the standard normal distribution, by Box and Muller.
pub(super) fn gaussian(context: &mut Context) -> f64 {
    // 1 - u is in (0, 1]: its logarithm is finite.
    let radius = (-2.0 * (1.0 - context.rng.random::<f64>()).ln()).sqrt();
    radius * (context.rng.random::<f64>() * TAU).cos()
}

/// Unit normals of the vertices, faces weighted by area; zero where there is none.
pub(super) fn vertex_normals(mesh: &Mesh) -> Vec<Vector> {
    let mut normals = vec![Vector::zeros(); mesh.positions.len()];
    for (face, corners) in mesh.faces.iter().enumerate() {
        let [a, b, c] = mesh.corners(face);
        let cross = (b - a).cross(&(c - a));
        corners.iter().for_each(|&v| normals[v as usize] += cross);
    }
    for normal in &mut normals {
        let length = normal.norm();
        *normal = if length > 0.0 { *normal / length } else { Vector::zeros() };
    }
    normals
}

#[cfg(test)]
mod tests {
    use super::super::part;
    use super::*;

    fn moves(mesh: &Mesh, noise: &Noise, seed: u64) -> Vec<f64> {
        let noisy = add_noise(&mut Context::new(seed), mesh, noise).unwrap();
        let (pairs, size) = (noisy.positions.iter().zip(&mesh.positions), mesh.size());
        pairs.map(|(p, q)| (p - q).norm() / size).collect()
    }

    #[test]
    fn exactly_the_ratio_moves_and_none_further_than_sigma() {
        let mesh = part("shaft", 5_000).unwrap().mesh;
        let far = moves(&mesh, &Noise::uniform(0.01, 0.9), 1);
        let moved = far.iter().filter(|&&far| far > 0.0).count();
        assert_eq!(moved, (0.9 * mesh.positions.len() as f64).round() as usize);
        let most = far.iter().copied().fold(0.0, f64::max);
        assert!(most <= 0.01 * (1.0 + 1e-12) && most > 0.0099, "{most}");
        let mean = far.iter().sum::<f64>() / moved as f64;
        // |ω| has mean 1/2, and here a standard error of 0.006.
        assert!((mean / 0.01 - 0.5).abs() < 0.03, "{mean}");
    }

    #[test]
    fn gaussian_noise_has_the_standard_deviation_asked_for() {
        let mesh = part("shaft", 20_000).unwrap().mesh;
        let far = moves(&mesh, &Noise::gaussian(0.004), 2);
        let moved: Vec<_> = far.iter().filter(|&&far| far > 0.0).collect();
        let variance = moved.iter().map(|far| **far * **far).sum::<f64>() / moved.len() as f64;
        assert!((variance.sqrt() / 0.004 - 1.0).abs() < 0.05);
        assert_eq!(moved.len(), (mesh.positions.len() as f64 / 2.0).round() as usize);
    }

    #[test]
    fn the_same_seed_gives_the_same_noise() {
        let mesh = part("open", 3_000).unwrap().mesh;
        let noise = Noise::uniform(0.01, 0.5);
        assert_eq!(moves(&mesh, &noise, 3), moves(&mesh, &noise, 3));
        assert_ne!(moves(&mesh, &noise, 3), moves(&mesh, &noise, 4));
    }

    #[test]
    fn a_vertex_without_a_face_stays_and_an_empty_mesh_is_empty() {
        let mut mesh = part("open", 3_000).unwrap().mesh;
        mesh.positions.push([1e3, 0.0, 0.0].into());
        let noisy = add_noise(&mut Context::new(0), &mesh, &Noise::uniform(0.1, 1.0)).unwrap();
        assert_eq!(noisy.positions.last(), mesh.positions.last());
        let none = add_noise(&mut Context::new(0), &Mesh::default(), &Noise::gaussian(0.1));
        assert_eq!(none, Ok(Mesh::default()));
    }

    #[test]
    fn senseless_noise_is_refused() {
        let mesh = Mesh::default();
        for noise in [Noise::uniform(-1.0, 0.5), Noise::uniform(f64::NAN, 0.5)] {
            assert!(add_noise(&mut Context::new(0), &mesh, &noise).is_err());
        }
        for ratio in [-0.1, 1.1, f64::NAN] {
            assert!(add_noise(&mut Context::new(0), &mesh, &Noise::uniform(0.1, ratio)).is_err());
        }
    }
}
