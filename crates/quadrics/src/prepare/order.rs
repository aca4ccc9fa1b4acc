//! Vertices and faces in an order that follows from where they are.
//!
//! Whatever draws faces at random or visits them in turn then does the same whichever order the file
//! has them in; and neighbours in space become neighbours in memory.

use rayon::prelude::*;

use crate::math::Point;
use crate::mesh::Mesh;

/// A mesh in that order.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Ordered {
    /// The same triangles.
    pub mesh: Mesh,
    /// The former number of every face.
    pub former: Vec<u32>,
}

/// Bits of a coordinate in the order's key.
const BITS: u32 = 21;
/// Cells begin at no round number: coordinates of a drawing, good to rounding, never lie on a border.
const OFFSET: f64 = 0.381_966;

/// Brings vertices and faces of a mesh in the unit cube, without unused vertices, into that order.
pub fn ordered(mesh: &Mesh) -> Ordered {
    let mut vertices: Vec<(u64, u32)> =
        mesh.positions.par_iter().enumerate().map(|(i, p)| (key(*p), i as u32)).collect();
    let place = |i: u32| mesh.positions[i as usize].coords;
    vertices.par_sort_unstable_by(|a, b| {
        // Positions, somewhere in memory, are looked up only where they decide.
        let exact = || {
            let (p, q) = (place(a.1), place(b.1));
            p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y)).then(p.z.total_cmp(&q.z))
        };
        a.0.cmp(&b.0).then_with(exact).then(a.1.cmp(&b.1))
    });
    let mut number = vec![0; mesh.positions.len()];
    for (new, &(_, old)) in vertices.iter().enumerate() {
        number[old as usize] = new as u32;
    }
    let renumbered = |corners: &[u32; 3]| {
        let mut corners = corners.map(|v| number[v as usize]);
        let least = (0..3).min_by_key(|&i| corners[i]).unwrap_or(0);
        corners.rotate_left(least);
        corners
    };
    let mut faces: Vec<([u32; 3], u32)> = mesh
        .faces
        .par_iter()
        .enumerate()
        .map(|(i, corners)| (renumbered(corners), i as u32))
        .collect();
    faces.par_sort_unstable();
    let (faces, former) = faces.into_par_iter().unzip();
    let positions = vertices.par_iter().map(|&(_, old)| mesh.positions[old as usize]).collect();
    Ordered { mesh: Mesh { positions, faces }, former }
}

/// Place along a curve that fills the unit cube (Morton's).
fn key(point: Point) -> u64 {
    let cells = point.coords.map(|c| (c * f64::from((1u32 << BITS) - 2) + OFFSET) as u64);
    spread(cells.x) | spread(cells.y) << 1 | spread(cells.z) << 2
}

/// Two zero bits after every bit of the lowest 21.
fn spread(value: u64) -> u64 {
    let mut v = value & 0x1f_ffff;
    for (shift, mask) in [
        (32, 0x001f_0000_0000_ffff),
        (16, 0x001f_0000_ff00_00ff),
        (8, 0x100f_00f0_0f00_f00f),
        (4, 0x10c3_0c30_c30c_30c3),
        (2, 0x1249_2492_4924_9249),
    ] {
        v = (v | v << shift) & mask;
    }
    v
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::prepare::to_unit_cube;
    use crate::synth;

    #[test]
    fn shuffled_it_is_the_same_mesh_in_the_same_order() {
        let mut mesh = synth::part("demo", 6_000).unwrap().mesh;
        let into = to_unit_cube(&mesh).unwrap();
        mesh.positions.iter_mut().for_each(|point| *point = into * *point);
        let here = ordered(&mesh);
        let count = mesh.faces.len();
        // 7919 is prime, so every face comes once.
        let order: Vec<usize> = (0..count).map(|i| i * 7919 % count).collect();
        let last = mesh.positions.len() as u32 - 1;
        let shuffled = Mesh {
            positions: mesh.positions.iter().rev().copied().collect(),
            faces: order.iter().map(|&f| mesh.faces[f].map(|v| last - v)).collect(),
        };
        let there = ordered(&shuffled);
        assert_eq!(there.mesh, here.mesh);
        let mut pairs = there.former.iter().zip(&here.former);
        assert!(pairs.all(|(&there, &here)| order[there as usize] == here as usize));
    }

    #[test]
    fn bits_are_spread_by_three() {
        assert_eq!(spread(0b1011), 0b1_000_001_001);
        assert_eq!(spread(0x1f_ffff).count_ones(), 21);
    }
}
