//! Whose label a face takes that was left out of the working mesh.

use std::collections::VecDeque;

use super::{Adjacency, Mesh, NONE};

/// For every face of `mesh` a position in `kept`: its own; its twin's; that of the kept face across its
/// longest edge; of one that shares an edge, a vertex, or a chain of left-out faces; and for a speck
/// that touches nothing, that of the last kept face before it in the file.
pub(crate) fn substitutes(mesh: &Mesh, kept: &[u32], twin: &[u32]) -> Vec<u32> {
    let mut substitute = vec![NONE; mesh.faces.len()];
    for (position, &face) in kept.iter().enumerate() {
        substitute[face as usize] = position as u32;
    }
    if kept.len() == mesh.faces.len() {
        return substitute;
    }
    let adjacency = Adjacency::new(&mesh.faces, mesh.positions.len());
    let left_out: Vec<usize> = (0..mesh.faces.len()).filter(|&f| substitute[f] == NONE).collect();
    let own = substitute.clone();
    let mut queue = VecDeque::new();
    for &face in &left_out {
        substitute[face] = match twin[face] {
            NONE => neighbour(mesh, &adjacency, face, &own),
            twin => own[twin as usize],
        };
        queue.extend((substitute[face] != NONE).then_some(face));
    }
    spread(mesh, &adjacency, queue, &mut substitute);
    for face in left_out {
        if substitute[face] == NONE {
            substitute[face] = if face == 0 { 0 } else { substitute[face - 1] };
        }
    }
    substitute
}

/// The kept face that shares most with this one.
fn neighbour(mesh: &Mesh, adjacency: &Adjacency, face: usize, own: &[u32]) -> u32 {
    let corners = mesh.faces[face];
    let mut sides = [0, 1, 2].map(|i| {
        let (a, b) = (corners[i], corners[(i + 1) % 3]);
        (a, b, (mesh.positions[a as usize] - mesh.positions[b as usize]).norm())
    });
    sides.sort_by(|one, other| other.2.total_cmp(&one.2));
    let kept_at = |v: u32| adjacency.around(v).iter().filter(|&&f| own[f as usize] != NONE);
    let across = sides
        .iter()
        .filter(|(a, b, _)| a != b)
        .find_map(|&(a, b, _)| kept_at(a).find(|&&f| mesh.faces[f as usize].contains(&b)).copied());
    let found = across.or_else(|| corners.iter().find_map(|&v| kept_at(v).next().copied()));
    found.map_or(NONE, |f| own[f as usize])
}

/// Faces that have a label to take hand it on over their vertices; every vertex is asked once.
fn spread(mesh: &Mesh, adjacency: &Adjacency, mut queue: VecDeque<usize>, substitute: &mut [u32]) {
    let mut asked = vec![false; mesh.positions.len()];
    while let Some(face) = queue.pop_front() {
        for v in mesh.faces[face] {
            if std::mem::replace(&mut asked[v as usize], true) {
                continue;
            }
            for &other in adjacency.around(v) {
                if substitute[other as usize] == NONE {
                    substitute[other as usize] = substitute[face];
                    queue.push_back(other as usize);
                }
            }
        }
    }
}
