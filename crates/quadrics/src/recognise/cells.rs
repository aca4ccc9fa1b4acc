//! Points in cells of space: what is near across the gaps of a mesh.

use std::collections::HashMap;

use crate::math::Point;

/// Edges of a mesh that a cell is wide. Points of cells that touch are near each other: the shreds of a
/// scanned wall lie up to six edges apart.
const WIDTH: f64 = 3.5;

/// Cells that hold points.
pub struct Cells {
    of_point: Vec<u32>,
    points: Vec<Vec<u32>>,
    beside: Vec<Vec<u32>>,
}

impl Cells {
    /// Deals points into cells for a mesh of this mean edge.
    pub fn new(points: &[Point], edge: f64) -> Self {
        let key = |p: &Point| p.coords.map(|c| (c / (WIDTH * edge)).floor() as i64);
        let mut number = HashMap::new();
        let mut members: Vec<Vec<u32>> = Vec::new();
        let mut keys = Vec::new();
        let mut of_point = Vec::with_capacity(points.len());
        for (point, i) in points.iter().zip(0..) {
            let key = key(point);
            let cell = *number.entry(key).or_insert_with(|| {
                members.push(Vec::new());
                keys.push(key);
                members.len() as u32 - 1
            });
            members[cell as usize].push(i);
            of_point.push(cell);
        }
        let around = |key: &nalgebra::Vector3<i64>| {
            let steps =
                (0..27).map(|i| nalgebra::Vector3::new(i / 9 - 1, i / 3 % 3 - 1, i % 3 - 1));
            steps.filter_map(|step| number.get(&(key + step)).copied()).collect()
        };
        let beside = keys.iter().map(around).collect();
        Self { of_point, points: members, beside }
    }

    /// The cell of a point.
    pub fn of(&self, point: u32) -> u32 {
        self.of_point[point as usize]
    }

    /// The points that hang together with `seed` over cells that touch, among those that `belongs` names.
    pub fn reach(&self, seed: u32, belongs: impl Fn(u32) -> bool) -> Vec<u32> {
        let mut seen = vec![false; self.points.len()];
        let mut wave = vec![self.of(seed)];
        seen[wave[0] as usize] = true;
        let mut reached = Vec::new();
        while let Some(cell) = wave.pop() {
            let before = reached.len();
            reached.extend(self.points[cell as usize].iter().copied().filter(|&p| belongs(p)));
            if reached.len() > before || cell == self.of(seed) {
                for &other in &self.beside[cell as usize] {
                    if !std::mem::replace(&mut seen[other as usize], true) {
                        wave.push(other);
                    }
                }
            }
        }
        reached
    }

    /// Whether a point of one set lies in a cell of the other's or beside it.
    pub fn touch(&self, one: &[u32], other: &[u32]) -> bool {
        let marked = self.marked([one].into_iter());
        other.iter().any(|&point| !marked[self.of(point) as usize].is_empty())
    }

    /// For every cell which of several sets have points in it or beside it.
    pub fn marked<'a>(&self, sets: impl Iterator<Item = &'a [u32]>) -> Vec<Vec<usize>> {
        let mut marked: Vec<Vec<usize>> = vec![Vec::new(); self.points.len()];
        for (i, set) in sets.enumerate() {
            for &point in set {
                let cell = self.of(point) as usize;
                for &other in &self.beside[cell] {
                    let marks = &mut marked[other as usize];
                    if marks.last() != Some(&i) {
                        marks.push(i);
                    }
                }
            }
        }
        marked
    }
}
