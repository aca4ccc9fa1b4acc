//! Faces without area whose middle corner lies on the edge of a neighbour.
//!
//! CAD programs put such *caps* where a face's border has more points than its triangles need. Left out,
//! they would leave a slit: two edges on one side, one on the other. So the neighbour across the longest
//! edge is split at the middle corner, and the cap holds the second half.

use super::repair::is_flat;
use super::{Adjacency, Mesh, NONE};
use crate::math::Point;

/// Caps lean on caps: each round settles those that lean on a face. Rows of more are left out.
const ROUNDS: usize = 8;

/// Splits the neighbours of the caps of `mesh`, and clears their mark in `flat`.
///
/// Gives back for every face the one of which it is now a part: itself but for the caps.
pub(crate) fn split_at_caps(mesh: &mut Mesh, flat: &mut [bool]) -> Vec<u32> {
    let mut owner: Vec<u32> = (0..mesh.faces.len() as u32).collect();
    let mut caps: Vec<usize> =
        (0..flat.len()).filter(|&face| flat[face] && is_cap(mesh, face)).collect();
    for _ in 0..ROUNDS {
        if caps.is_empty() {
            break;
        }
        let adjacency = Adjacency::new(&mesh.faces, mesh.positions.len());
        let mut changed = vec![false; mesh.faces.len()];
        let before = caps.len();
        caps.retain(|&cap| {
            let longest = longest_edge(mesh.corners(cap));
            let neighbour = adjacency.neighbours[cap][longest];
            if neighbour == NONE || flat[neighbour as usize] || changed[neighbour as usize] {
                return true;
            }
            let Some([first, second]) = halves(mesh, cap, longest, neighbour as usize) else {
                return true;
            };
            (mesh.faces[neighbour as usize], mesh.faces[cap]) = (first, second);
            // What the adjacency says of both is out of date until the next round.
            (changed[neighbour as usize], changed[cap]) = (true, true);
            flat[cap] = false;
            owner[cap] = owner[neighbour as usize];
            false
        });
        if caps.len() == before {
            break;
        }
    }
    owner
}

/// Whether a face without area has three corners in different places.
fn is_cap(mesh: &Mesh, face: usize) -> bool {
    let [a, b, c] = mesh.faces[face];
    a != b && b != c && c != a
}

fn longest_edge(corners: [Point; 3]) -> usize {
    let length = |i: usize| (corners[(i + 1) % 3] - corners[i]).norm();
    (1..3).fold(0, |longest, i| if length(i) > length(longest) { i } else { longest })
}

/// The two parts of `neighbour`, wound as it is, cut from its far corner to the middle of the cap.
fn halves(mesh: &Mesh, cap: usize, longest: usize, neighbour: usize) -> Option<[[u32; 3]; 2]> {
    let ends = [mesh.faces[cap][longest], mesh.faces[cap][(longest + 1) % 3]];
    let middle = mesh.faces[cap][(longest + 2) % 3];
    let corners = mesh.faces[neighbour];
    let far = (0..3).find(|&i| !ends.contains(&corners[i]))?;
    let [from, to] = [corners[(far + 1) % 3], corners[(far + 2) % 3]];
    let halves = [[from, middle, corners[far]], [middle, to, corners[far]]];
    let place = |half: [u32; 3]| half.map(|v| mesh.positions[v as usize]);
    halves.iter().all(|half| !is_flat(place(*half))).then_some(halves)
}
