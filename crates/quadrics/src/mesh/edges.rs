//! The edges of a mesh with the faces at each, without hashing.
//!
//! A half-edge `3 f + i` runs from corner `i` of face `f` to corner `i + 1`. Half-edges are dealt into
//! one bucket for each lower vertex (a counting sort) and ordered there by the higher one: linear, since
//! a vertex has about six edges, and still `n log n` where one vertex has them all.

/// Where a half-edge starts and ends.
pub(crate) fn ends(faces: &[[u32; 3]], half_edge: u32) -> (u32, u32) {
    let corners = faces[half_edge as usize / 3];
    let i = half_edge as usize % 3;
    (corners[i], corners[(i + 1) % 3])
}

/// Calls `visit` once an edge with its half-edges, ascending; edges come ordered by their vertices.
pub(crate) fn for_each_edge(faces: &[[u32; 3]], vertices: usize, mut visit: impl FnMut(&[u32])) {
    let mut offsets = vec![0u32; vertices + 1];
    for_each_half_edge(faces, |low, _, _| offsets[low as usize + 1] += 1);
    for v in 0..vertices {
        offsets[v + 1] += offsets[v];
    }
    // Higher vertex above, half-edge below: one integer to compare.
    let mut entries = vec![0u64; 3 * faces.len()];
    for_each_half_edge(faces, |low, high, half_edge| {
        let next = &mut offsets[low as usize];
        entries[*next as usize] = u64::from(high) << 32 | u64::from(half_edge);
        *next += 1;
    });
    // Every offset now stands at the end of its bucket.
    let mut start = 0;
    let mut edge = Vec::new();
    for end in offsets.into_iter().take(vertices) {
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

fn for_each_half_edge(faces: &[[u32; 3]], mut visit: impl FnMut(u32, u32, u32)) {
    for (face, &[a, b, c]) in faces.iter().enumerate() {
        for (i, (from, to)) in [(a, b), (b, c), (c, a)].into_iter().enumerate() {
            visit(from.min(to), from.max(to), (3 * face + i) as u32);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_half_edge_comes_once_and_with_its_edge() {
        let faces = [[0, 1, 2], [0, 2, 3], [2, 0, 4], [5, 4, 3]];
        let mut seen = Vec::new();
        for_each_edge(&faces, 6, |edge| {
            let sorted = |h: u32| {
                let (a, b) = ends(&faces, h);
                (a.min(b), a.max(b))
            };
            assert!(edge.iter().all(|&h| sorted(h) == sorted(edge[0])));
            seen.extend_from_slice(edge);
        });
        let edges_of_the_diagonal: Vec<_> =
            seen.iter().filter(|&&h| matches!(ends(&faces, h), (0, 2) | (2, 0))).collect();
        assert_eq!(edges_of_the_diagonal.len(), 3);
        seen.sort_unstable();
        assert_eq!(seen, (0..12).collect::<Vec<_>>());
    }
}
