//! The edges of a mesh with the faces at each, without hashing.
//!
//! A half-edge `3 f + i` runs from corner `i` of face `f` to corner `i + 1`. Half-edges are dealt into
//! one bucket for each lower vertex (a counting sort) and ordered there by the higher one: linear, since
//! a vertex has about six edges, and still `n log n` where one vertex has them all. Every thread takes a
//! range of lower vertices and passes over all faces: reading them in turn costs little beside dealing.

use std::ops::Range;

use rayon::prelude::*;

/// Lower vertices for which a thread of its own pays.
const RANGE: usize = 1 << 14;

/// Calls `visit` once an edge with its half-edges, ascending, on all threads; what the calls gather in
/// their `T` comes back in parts.
pub(crate) fn fold_edges<T: Default + Send>(
    faces: &[[u32; 3]],
    vertices: usize,
    visit: impl Fn(&mut T, &[u32]) + Sync,
) -> Vec<T> {
    let ranges = vertices.div_ceil(RANGE).clamp(1, rayon::current_num_threads());
    let bound = |i: usize| (vertices * i / ranges) as u32;
    (0..ranges)
        .into_par_iter()
        .map(|i| {
            let mut gathered = T::default();
            for_each_edge_from(faces, bound(i)..bound(i + 1), |edge| visit(&mut gathered, edge));
            gathered
        })
        .collect()
}

/// The edges whose lower vertex is in `range`, ordered by their vertices.
fn for_each_edge_from(faces: &[[u32; 3]], range: Range<u32>, mut visit: impl FnMut(&[u32])) {
    let mut offsets = vec![0u32; range.len() + 1];
    for_each_half_edge(faces, &range, |low, _, _| offsets[low as usize + 1] += 1);
    for v in 0..range.len() {
        offsets[v + 1] += offsets[v];
    }
    // Higher vertex above, half-edge below: one integer to compare.
    let mut entries = vec![0u64; offsets[range.len()] as usize];
    for_each_half_edge(faces, &range, |low, high, half_edge| {
        let next = &mut offsets[low as usize];
        entries[*next as usize] = u64::from(high) << 32 | u64::from(half_edge);
        *next += 1;
    });
    // Every offset now stands at the end of its bucket.
    let mut start = 0;
    let mut edge = Vec::new();
    for end in offsets.into_iter().take(range.len()) {
        let bucket = &mut entries[start as usize..end as usize];
        bucket.sort_unstable();
        for same in bucket.chunk_by(|one, other| one >> 32 == other >> 32) {
            edge.clear();
            edge.extend(same.iter().map(|&entry| entry as u32));
            visit(&edge);
        }
        start = end;
    }
}

/// Lower vertex (counted from the start of `range`), higher vertex and number of the half-edges whose
/// lower vertex is in `range`.
fn for_each_half_edge(
    faces: &[[u32; 3]],
    range: &Range<u32>,
    mut visit: impl FnMut(u32, u32, u32),
) {
    for (face, &[a, b, c]) in faces.iter().enumerate() {
        for (i, (from, to)) in [(a, b), (b, c), (c, a)].into_iter().enumerate() {
            let (low, high) = (from.min(to), from.max(to));
            if range.contains(&low) {
                visit(low - range.start, high, (3 * face + i) as u32);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn edges(faces: &[[u32; 3]], vertices: usize) -> Vec<Vec<u32>> {
        let gather = |edges: &mut Vec<Vec<u32>>, edge: &[u32]| edges.push(edge.to_vec());
        fold_edges(faces, vertices, gather).concat()
    }

    #[test]
    fn every_half_edge_comes_once_and_with_its_edge() {
        let faces = [[0, 1, 2], [0, 2, 3], [2, 0, 4], [5, 4, 3]];
        let edges = edges(&faces, 6);
        let sorted = |h: u32| {
            let (corners, i) = (faces[h as usize / 3], h as usize % 3);
            let (a, b): (u32, u32) = (corners[i], corners[(i + 1) % 3]);
            (a.min(b), a.max(b))
        };
        assert!(edges.iter().all(|edge| edge.iter().all(|&h| sorted(h) == sorted(edge[0]))));
        let mut seen = edges.concat();
        let diagonal = seen.iter().filter(|&&h| sorted(h) == (0, 2));
        assert_eq!(diagonal.count(), 3);
        seen.sort_unstable();
        assert_eq!(seen, (0..12).collect::<Vec<_>>());
    }

    #[test]
    fn on_several_threads_the_edges_are_the_same() {
        let vertices = 3 * RANGE as u32;
        let faces: Vec<[u32; 3]> = (0..vertices - 2).map(|i| [i, i + 1, i + 2]).collect();
        let pool = |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let by = |threads| pool(threads).install(|| edges(&faces, vertices as usize));
        assert_eq!(by(1), by(3));
    }
}
