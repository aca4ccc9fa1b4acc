//! Splits: a surface that bridges several (a torus over ring bands, a flat cylinder over a plane and
//! its fillets) leaves residuals that are no noise; simpler surfaces found inside explain it better.

use super::assign::{self, Model, face_cost};
use super::detect;
use super::moves::{self, LABEL};
use super::scene::Scene;
use crate::context::Context;
use crate::error::Result;
use crate::partition::{Regions, UNLABELLED};
use crate::surface::select;

/// Fewest faces of a region that is worth splitting.
const FEWEST: usize = 40;

/// Splits every region that two or more surfaces explain better; how many regions were added.
///
/// # Errors
/// Cancellation.
pub fn split(
    context: &mut Context,
    scene: &Scene,
    models: &mut Vec<Model>,
    labels: &mut [u32],
) -> Result<usize> {
    let regions = Regions::new(labels);
    let before = models.len();
    // Everything outside the region in hand is taken.
    let mut inside = vec![detect::TAKEN; labels.len()];
    let mut dead = vec![false; labels.len()];
    for id in 0..regions.len() {
        let faces = regions.faces(id);
        if faces.len() < FEWEST {
            continue;
        }
        let whole = energy(scene, std::slice::from_ref(&models[id]), faces, |_| 0);
        faces.iter().for_each(|&f| inside[f as usize] = UNLABELLED);
        let found = detect::detect_within(context, scene, &mut inside, faces, &mut dead)?;
        if found.len() > 1 || found.iter().any(|c| c.faces.len() * 10 < faces.len() * 9) {
            let mut parts: Vec<Model> = found
                .into_iter()
                .map(|c| Model { surface: c.choice.surface, side: c.side })
                .collect();
            if parts.len() == 1 {
                parts.push(models[id].clone());
            }
            settle(scene, &mut parts, faces, &mut inside);
            let split = energy(scene, &parts, faces, |f| inside[f as usize]);
            if parts.len() > 1 && split < whole {
                let first = models.len() as u32;
                for &face in faces {
                    let part = inside[face as usize];
                    labels[face as usize] = if part == 0 { id as u32 } else { first + part - 1 };
                }
                models[id] = parts[0].clone();
                models.extend_from_slice(&parts[1..]);
            }
        }
        faces.iter().for_each(|&f| inside[f as usize] = detect::TAKEN);
    }
    Ok(models.len() - before)
}

/// Gives every face of the region to the part that explains it best, and fits the parts again.
fn settle(scene: &Scene, parts: &mut Vec<Model>, faces: &[u32], inside: &mut [u32]) {
    for _ in 0..2 {
        for &face in faces {
            let best = (0..parts.len())
                .map(|part| (face_cost(scene, &parts[part], face as usize), part))
                .min_by(|a, b| a.0.total_cmp(&b.0));
            inside[face as usize] = best.map_or(0, |(_, part)| part as u32);
        }
        let mut local: Vec<u32> = faces.iter().map(|&f| inside[f as usize]).collect();
        moves::tidy(parts, &mut local);
        let members = Regions::new(&local);
        for (part, model) in parts.iter_mut().enumerate() {
            let own: Vec<u32> = members.faces(part).iter().map(|&i| faces[i as usize]).collect();
            moves::fit_one(scene, model, &own);
        }
        faces.iter().zip(&local).for_each(|(&f, &part)| inside[f as usize] = part);
    }
}

/// Minus the log-likelihood of the faces and what the surfaces cost, in nats.
///
/// Two faces share a vertex's noise, hence the half; on scans few samples are independent.
fn energy(scene: &Scene, parts: &[Model], faces: &[u32], part_of: impl Fn(u32) -> u32) -> f64 {
    let weight = 0.5 * scene.evidence.independent.sqrt();
    let mut counts = vec![0usize; parts.len()];
    let mut sum = 0.0;
    for &face in faces {
        let part = part_of(face) as usize;
        counts[part] += 1;
        sum += face_cost(scene, &parts[part], face as usize).min(assign::WORST);
    }
    let price = |(model, &count): (&Model, &usize)| {
        let vertices = (count as f64 / 2.0).max(2.0);
        LABEL + select::cost(&model.surface) * vertices.ln()
    };
    weight * sum + parts.iter().zip(&counts).map(price).sum::<f64>()
}
