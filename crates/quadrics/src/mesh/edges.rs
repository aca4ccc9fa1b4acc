//! The half-edges of every edge, without hashing and, but for crowds, without sorting.
//!
//! A half-edge `3 f + i` runs from corner `i` of face `f` to corner `i + 1`. The others of its edge are
//! among the faces around either of its ends, about six: every face finds them by itself, so all
//! faces can do so at once. Where many faces meet at both ends the half-edges are sorted instead.

use std::ops::Range;

use rayon::prelude::*;

use super::NONE;

/// Where a half-edge starts and ends.
pub(crate) fn ends(faces: &[[u32; 3]], half_edge: u32) -> (u32, u32) {
    let corners = faces[half_edge as usize / 3];
    let i = half_edge as usize % 3;
    (corners[i], corners[(i + 1) % 3])
}

/// The faces around every vertex, flat: the transpose of a mesh's faces.
#[derive(Debug, Clone, Default)]
pub(crate) struct Stars {
    offsets: Vec<u32>,
    faces: Vec<u32>,
}

impl Stars {
    pub fn new(faces: &[[u32; 3]], vertices: usize) -> Self {
        let mut offsets = vec![0u32; vertices + 1];
        for &vertex in faces.iter().flatten() {
            offsets[vertex as usize + 1] += 1;
        }
        for v in 0..vertices {
            offsets[v + 1] += offsets[v];
        }
        let mut next = offsets.clone();
        let mut around = vec![0; 3 * faces.len()];
        for (face, corners) in faces.iter().enumerate() {
            for &vertex in corners {
                around[next[vertex as usize] as usize] = face as u32;
                next[vertex as usize] += 1;
            }
        }
        Self { offsets, faces: around }
    }

    /// The faces at a vertex, in ascending order; one that is there with two corners comes twice.
    pub fn of(&self, vertex: u32) -> &[u32] {
        let v = vertex as usize;
        &self.faces[self.offsets[v] as usize..self.offsets[v + 1] as usize]
    }
}

/// What else is on the edge of a half-edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Across {
    Nothing,
    One(u32),
    Many,
}

/// A vertex of more faces is not walked around for each of them.
const CROWD: usize = 64;

/// The edges of a mesh.
pub(crate) struct Edges<'a> {
    faces: &'a [[u32; 3]],
    stars: &'a Stars,
    /// Half-edges between two crowded vertices by lower vertex, higher vertex, number.
    crowded: Vec<(u32, u32, u32)>,
}

impl<'a> Edges<'a> {
    pub fn new(faces: &'a [[u32; 3]], stars: &'a Stars) -> Self {
        let is_crowded = |&v: &u32| stars.of(v).len() > CROWD;
        let between = |half_edge: u32| {
            let (a, b) = ends(faces, half_edge);
            (is_crowded(&a) && is_crowded(&b)).then_some((a.min(b), a.max(b), half_edge))
        };
        let all = (0..faces.len() as u32).into_par_iter().with_min_len(4096);
        let some = all.filter(|&face| faces[face as usize].iter().any(is_crowded));
        let mut crowded: Vec<_> =
            some.flat_map_iter(|face| (3 * face..3 * face + 3).filter_map(between)).collect();
        crowded.par_sort_unstable();
        Self { faces, stars, crowded }
    }

    /// What else is on the edge of a half-edge.
    pub fn across(&self, half_edge: u32) -> Across {
        self.mates(half_edge).across
    }

    /// Whether a half-edge is the first of its edge.
    pub fn is_first(&self, half_edge: u32) -> bool {
        self.mates(half_edge).is_first
    }

    fn mates(&self, half_edge: u32) -> Mates {
        let (a, b) = ends(self.faces, half_edge);
        let (star, other) = (self.stars.of(a), self.stars.of(b));
        let star = if star.len() <= other.len() { star } else { other };
        let mut mates = Mates { across: Across::Nothing, is_first: true };
        if star.len() > CROWD {
            self.crowd(a.min(b), a.max(b)).for_each(|i| mates.add(half_edge, self.crowded[i].2));
            return mates;
        }
        let mut last = NONE;
        for &face in star.iter() {
            if face == std::mem::replace(&mut last, face) {
                continue;
            }
            let [p, q, r] = self.faces[face as usize];
            for (i, (from, to)) in (0..).zip([(p, q), (q, r), (r, p)]) {
                if (from, to) == (b, a) || (from, to) == (a, b) {
                    mates.add(half_edge, 3 * face + i);
                }
            }
        }
        mates
    }

    /// Where the half-edges between two crowded vertices are.
    fn crowd(&self, low: u32, high: u32) -> Range<usize> {
        let start = self.crowded.partition_point(|&(a, b, _)| (a, b) < (low, high));
        start..start + self.crowded[start..].partition_point(|&(a, b, _)| (a, b) == (low, high))
    }
}

/// The other half-edges of an edge, as far as they are known.
struct Mates {
    across: Across,
    is_first: bool,
}

impl Mates {
    fn add(&mut self, own: u32, half_edge: u32) {
        if half_edge == own {
            return;
        }
        self.is_first &= own < half_edge;
        self.across = match self.across {
            Across::Nothing => Across::One(half_edge),
            _ => Across::Many,
        };
    }
}

#[cfg(test)]
mod tests {
    use rand::RngExt;

    use super::*;
    use crate::context::Context;

    /// All half-edges of the edge of one.
    fn plain(faces: &[[u32; 3]], half_edge: u32) -> Vec<u32> {
        let sorted = |half_edge: u32| {
            let (a, b) = ends(faces, half_edge);
            (a.min(b), a.max(b))
        };
        let all = 0..3 * faces.len() as u32;
        all.filter(|&other| sorted(other) == sorted(half_edge)).collect()
    }

    fn check(faces: &[[u32; 3]], vertices: usize) {
        let stars = Stars::new(faces, vertices);
        let edges = Edges::new(faces, &stars);
        for half_edge in 0..3 * faces.len() as u32 {
            let mates = plain(faces, half_edge);
            let others: Vec<u32> = mates.iter().copied().filter(|&h| h != half_edge).collect();
            let expected = match others[..] {
                [] => Across::Nothing,
                [other] => Across::One(other),
                _ => Across::Many,
            };
            assert_eq!(edges.across(half_edge), expected);
            assert_eq!(edges.is_first(half_edge), mates[0] == half_edge);
        }
    }

    #[test]
    fn half_edges_find_each_other_in_any_soup() {
        let mut rng = Context::new(3).rng;
        for vertices in [3, 4, 6, 20] {
            for _ in 0..50 {
                let corner = |_| rng.random_range(0..vertices);
                let faces: Vec<[u32; 3]> = {
                    let corners: Vec<u32> = (0..36).map(corner).collect();
                    corners.chunks(3).map(|c| [c[0], c[1], c[2]]).collect()
                };
                check(&faces, vertices as usize);
            }
        }
    }

    #[test]
    fn a_book_and_two_hubs_are_sorted() {
        // Pages on the edge from 0 to 1, and a spindle between 2 and 3.
        let pages = (4..154).map(|page| [0, 1, page]);
        let spindle = (154..304).flat_map(|v| {
            let next = if v == 303 { 154 } else { v + 1 };
            [[2, v, next], [3, next, v]]
        });
        check(&pages.chain(spindle).collect::<Vec<_>>(), 304);
    }
}
