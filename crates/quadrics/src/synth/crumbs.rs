//! Connected regions out of labels that holes and coarse triangles have torn.

use super::part::Part;
use crate::mesh::Adjacency;
use crate::partition::components;

/// Pieces of fewer faces are below what a scan resolves.
pub(super) const RESOLVED: usize = 12;

/// Rounds in which crumbs join their neighbours: a crumb among crumbs takes several.
const ROUNDS: usize = 10;

/// Makes every connected piece a region with a copy of its surface, after crumbs have joined the
/// neighbour with which they share most edges.
pub(super) fn regions(part: &mut Part) {
    let adjacency = Adjacency::new(&part.mesh.faces, part.mesh.positions.len());
    for _ in 0..ROUNDS {
        if !absorb(&mut part.labels, &adjacency) {
            break;
        }
    }
    let (component, sizes) = components(&part.labels, &adjacency);
    let mut source = vec![0; sizes.len()];
    for (&piece, &label) in component.iter().zip(&part.labels) {
        source[piece as usize] = label as usize;
    }
    part.surfaces = source.iter().map(|&label| part.surfaces[label].clone()).collect();
    part.labels = component;
}

/// One round; whether a crumb has joined.
fn absorb(labels: &mut [u32], adjacency: &Adjacency) -> bool {
    let (component, sizes) = components(labels, adjacency);
    let crumb = |face: usize| (sizes[component[face] as usize] as usize) < RESOLVED;
    // (crumb, label beyond its border), once for every edge between them.
    let mut borders = Vec::new();
    for face in (0..labels.len()).filter(|&face| crumb(face)) {
        for next in adjacency.across(face).filter(|&next| !crumb(next)) {
            borders.push((component[face], labels[next]));
        }
    }
    borders.sort_unstable();
    let mut joins = vec![None; sizes.len()];
    for same in borders.chunk_by(|one, other| one == other) {
        let (piece, label) = same[0];
        let best = &mut joins[piece as usize];
        if best.is_none_or(|(count, _)| count < same.len()) {
            *best = Some((same.len(), label));
        }
    }
    for (label, &piece) in labels.iter_mut().zip(&component) {
        if let Some((_, joined)) = joins[piece as usize] {
            *label = joined;
        }
    }
    !borders.is_empty()
}
