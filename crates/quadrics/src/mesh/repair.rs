//! From the mesh as it came to one that every later station can trust, with a list of what was done.
//!
//! Exactly coincident vertices are welded; faces without area and faces that repeat another are left
//! out, their neighbours split where that would leave a slit; the winding is made consistent. Nothing
//! moves, and no hole is filled.

use rayon::prelude::*;

use super::caps::split_at_caps;
use super::orient::{Census, orient};
use super::substitute::substitutes;
use super::validate::{is_usable, validate};
use super::weld::{Welder, are_distinct, normal};
use super::{Mesh, NONE};
use crate::error::Result;
use crate::math::Point;
use crate::result::Repair;

/// A clean mesh and how it hangs together with the one it was made of.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Repaired {
    /// No coincident or unused vertices, no flat or repeated faces; neighbours wind alike.
    pub mesh: Mesh,
    /// The input face of every face of `mesh`; one that was split has two.
    pub parent: Vec<u32>,
    /// For every input face the face of `mesh` whose label it takes: itself, where it was kept; for a
    /// repeated face its twin; for a flat one a neighbour.
    pub representative: Vec<u32>,
    /// What was mended, and what was found and left.
    pub repairs: Vec<Repair>,
    /// The edges of `mesh`, for [`super::inspect`].
    pub(crate) census: Census,
}

/// Makes `mesh` fit for work; linear in its faces.
///
/// # Errors
/// Those of [`validate`].
pub fn repair(mesh: &Mesh) -> Result<Repaired> {
    validate(mesh)?;
    let mut repairs = Vec::new();
    let mut welded = weld(mesh, &mut repairs);
    let mut flat = flat_faces(&welded);
    let zero_area = flat.iter().filter(|flat| **flat).count();
    let owner = split_at_caps(&mut welded, &mut flat);
    let split = zero_area - flat.iter().filter(|flat| **flat).count();
    let twin = twins(&welded, &flat);
    let kept = |face: &u32| !flat[*face as usize] && twin[*face as usize] == NONE;
    let kept: Vec<u32> = (0..mesh.faces.len() as u32).filter(kept).collect();
    note_dropped(zero_area, split, &twin, &mut repairs);
    let representative = substitutes(&welded, &kept, &twin);
    let parent = kept.iter().map(|&face| owner[face as usize]).collect();
    let mut mesh = part(welded, &kept);
    let census = orient(&mut mesh);
    note_census(&census, &mut repairs);
    Ok(Repaired { mesh, parent, representative, repairs, census })
}

/// Whether rounding alone explains the area of a triangle.
pub(crate) fn is_flat([a, b, c]: [Point; 3]) -> bool {
    let sides = [b - a, c - b, a - c];
    let longest = sides.iter().map(|side| side.amax()).fold(0.0, f64::max);
    let farthest = [a, b, c].iter().map(|p| p.coords.amax()).fold(0.0, f64::max);
    // A coordinate is good to EPSILON of itself: a lesser height is none.
    sides[0].cross(&sides[2]).norm() <= 4.0 * f64::EPSILON * longest * farthest
}

/// The faces over distinct positions; vertices that no face uses are gone.
fn weld(mesh: &Mesh, repairs: &mut Vec<Repair>) -> Mesh {
    let mut number = vec![NONE; mesh.positions.len()];
    mesh.faces.iter().flatten().for_each(|&v| number[v as usize] = 0);
    // Most files keep every vertex once.
    if number.iter().all(|&number| number != NONE) && are_distinct(&mesh.positions) {
        let positions = mesh.positions.par_iter().map(|position| normal(*position)).collect();
        return Mesh { positions, faces: mesh.faces.clone() };
    }
    let mut welder = Welder::new();
    let mut unused = 0;
    let mut unusable = 0;
    for (number, position) in number.iter_mut().zip(&mesh.positions) {
        if *number == NONE {
            unused += 1;
            unusable += usize::from(!is_usable(position));
        } else {
            *number = welder.add(*position);
        }
    }
    let coincident = mesh.positions.len() - unused - welder.len();
    note(
        repairs,
        "coincident_vertices",
        coincident,
        "vertices at the place of another, welded to it",
    );
    note(repairs, "unreferenced_vertices", unused, "vertices that no face uses, left out");
    note(repairs, "not_finite_vertices", unusable, "unused vertices that are NaN or infinite");
    let faces = mesh.faces.iter().map(|corners| corners.map(|v| number[v as usize])).collect();
    Mesh { positions: welder.into_positions(), faces }
}

fn flat_faces(mesh: &Mesh) -> Vec<bool> {
    let faces = (0..mesh.faces.len()).into_par_iter().with_min_len(4096);
    faces.map(|face| is_flat(mesh.corners(face))).collect()
}

/// For every face that repeats the vertices of an earlier one, in whichever order, that earlier face.
fn twins(mesh: &Mesh, flat: &[bool]) -> Vec<u32> {
    // Dealt by least vertex, then ordered by the other two: equal faces come together.
    let mut offsets = vec![0u32; mesh.positions.len() + 1];
    for corners in &mesh.faces {
        offsets[corners[0].min(corners[1]).min(corners[2]) as usize + 1] += 1;
    }
    for v in 1..offsets.len() {
        offsets[v] += offsets[v - 1];
    }
    let mut entries = vec![(0u64, 0u32); mesh.faces.len()];
    for (face, corners) in mesh.faces.iter().enumerate() {
        let mut sorted = *corners;
        sorted.sort_unstable();
        let next = &mut offsets[sorted[0] as usize];
        entries[*next as usize] = (u64::from(sorted[1]) << 32 | u64::from(sorted[2]), face as u32);
        *next += 1;
    }
    let mut twin = vec![NONE; mesh.faces.len()];
    let mut start = 0;
    for &end in &offsets[..mesh.positions.len()] {
        let bucket = &mut entries[start as usize..end as usize];
        bucket.sort_unstable();
        for same in bucket.chunk_by(|one, other| one.0 == other.0) {
            for &(_, face) in same[1..].iter().filter(|(_, face)| !flat[*face as usize]) {
                twin[face as usize] = same[0].1;
            }
        }
        start = end;
    }
    twin
}

/// The named faces and the vertices that they use, in their order.
fn part(mesh: Mesh, faces: &[u32]) -> Mesh {
    if faces.len() == mesh.faces.len() {
        return mesh;
    }
    let mut number = vec![NONE; mesh.positions.len()];
    faces.iter().flat_map(|&f| mesh.faces[f as usize]).for_each(|v| number[v as usize] = 0);
    let mut positions = Vec::with_capacity(mesh.positions.len());
    for (number, position) in number.iter_mut().zip(&mesh.positions).filter(|(n, _)| **n != NONE) {
        *number = positions.len() as u32;
        positions.push(*position);
    }
    let faces = faces.iter().map(|&f| mesh.faces[f as usize].map(|v| number[v as usize])).collect();
    Mesh { positions, faces }
}

fn note_dropped(zero_area: usize, split: usize, twin: &[u32], repairs: &mut Vec<Repair>) {
    let repeated = twin.iter().filter(|&&twin| twin != NONE).count();
    note(
        repairs,
        "zero_area_faces",
        zero_area,
        "faces without area, which take a neighbour's label",
    );
    note(repairs, "split_faces", split, "faces split at the middle corner of one without area");
    note(
        repairs,
        "duplicate_faces",
        repeated,
        "faces on the vertices of an earlier one, which take its label",
    );
}

fn note_census(census: &Census, repairs: &mut Vec<Repair>) {
    note(repairs, "flipped_faces", census.flipped, "faces turned to agree with the others");
    note(
        repairs,
        "unorientable_edges",
        census.unorientable,
        "edges whose two faces cannot be wound alike",
    );
    note(
        repairs,
        "non_manifold_edges",
        census.non_manifold,
        "edges of more than two faces, which no region crosses",
    );
    note(repairs, "border_edges", census.border, "edges of one face only: the mesh is open");
    if census.components > 1 {
        note(repairs, "components", census.components, "separate components");
    }
}

fn note(repairs: &mut Vec<Repair>, kind: &'static str, count: usize, what: &str) {
    if count > 0 {
        repairs.push(Repair { kind, count, detail: format!("{what}: {count}") });
    }
}

#[cfg(test)]
mod tests;
