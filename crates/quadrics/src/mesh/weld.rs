//! Exactly coincident vertices become one.
//!
//! By their bits, with `-0.0` taken as `0.0`: no tolerance, so nothing that the file keeps apart is
//! joined. One open-addressing table over the positions already seen; it grows with the distinct
//! vertices, not with the corners, and so stays in the cache six times longer.

use std::hash::{BuildHasher, RandomState};

use rayon::prelude::*;

use crate::math::Point;

const EMPTY: u32 = u32::MAX;
/// Any odd number without pattern (of wyhash).
const SPREAD: u64 = 0x8ebc_6af0_9c88_c6e3;

/// Numbers positions in the order in which they first appear.
#[derive(Debug)]
pub(crate) struct Welder {
    positions: Vec<Point>,
    slots: Vec<u32>,
    keys: [u64; 3],
}

impl Welder {
    pub fn new() -> Self {
        // Drawn anew each time, or a file could be made whose positions all fall into one slot. The
        // numbers do not depend on them.
        let random = RandomState::new();
        let keys = [0, 1, 2].map(|i| random.hash_one(i));
        Self { positions: Vec::new(), slots: vec![EMPTY; 1 << 10], keys }
    }

    /// The number of this position; a new one if it was not seen before.
    pub fn add(&mut self, position: Point) -> u32 {
        let position = normal(position);
        if 2 * (self.positions.len() + 1) > self.slots.len() {
            self.grow();
        }
        let slot = self.find(&self.slots, &position);
        if self.slots[slot] == EMPTY {
            self.slots[slot] = self.positions.len() as u32;
            self.positions.push(position);
        }
        self.slots[slot]
    }

    /// The numbers of several positions.
    ///
    /// Looked up all at once before they are added one by one: the memory is then waited for once a
    /// batch instead of once a position, where neighbours in the file are none on the part.
    pub fn add_all<const N: usize>(&mut self, positions: [Point; N]) -> [u32; N] {
        let mask = self.slots.len() - 1;
        let slots = positions.map(|p| self.slots[hash(&normal(p), &self.keys) & mask]);
        let seen = slots.map(|slot| self.positions.get(slot as usize).map_or(0.0, |p| p.x));
        std::hint::black_box(seen);
        positions.map(|position| self.add(position))
    }

    /// The distinct positions, by number.
    pub fn into_positions(self) -> Vec<Point> {
        self.positions
    }

    pub fn len(&self) -> usize {
        self.positions.len()
    }

    fn grow(&mut self) {
        let mut slots = vec![EMPTY; 4 * self.slots.len()];
        for (number, position) in self.positions.iter().enumerate() {
            let slot = self.find(&slots, position);
            slots[slot] = number as u32;
        }
        self.slots = slots;
    }

    /// The slot that holds this position, or the empty one where it belongs.
    fn find(&self, slots: &[u32], position: &Point) -> usize {
        let mask = slots.len() - 1;
        let mut slot = hash(position, &self.keys) & mask;
        let wanted = bits(position);
        while slots[slot] != EMPTY && bits(&self.positions[slots[slot] as usize]) != wanted {
            slot = (slot + 1) & mask;
        }
        slot
    }
}

/// Whether no two positions are equal. Rarely, and then wrongly, it says that some are.
pub(crate) fn are_distinct(positions: &[Point]) -> bool {
    let keys = [0, 21, 42].map(|turn| SPREAD.rotate_left(turn));
    let mut hashes: Vec<usize> =
        positions.par_iter().map(|position| hash(&normal(*position), &keys)).collect();
    hashes.par_sort_unstable();
    hashes.par_windows(2).all(|pair| pair[0] != pair[1])
}

/// Adding zero turns -0.0 into 0.0 and leaves all else alone.
pub(crate) fn normal(position: Point) -> Point {
    Point::from(position.coords.add_scalar(0.0))
}

/// Not `==`: NaN must equal itself here, or it would fill the table.
fn bits(position: &Point) -> [u64; 3] {
    [position.x.to_bits(), position.y.to_bits(), position.z.to_bits()]
}

/// Folded products, as wyhash does: the low bits of an f64 that was an f32 are all zero, so every
/// bit of the input has to reach the low bits of the hash.
fn hash(position: &Point, keys: &[u64; 3]) -> usize {
    let [x, y, z] = bits(position);
    fold(fold(x ^ keys[0], y ^ keys[1]) ^ SPREAD, z ^ keys[2]) as usize
}

fn fold(a: u64, b: u64) -> u64 {
    let product = u128::from(a) * u128::from(b);
    (product >> 64) as u64 ^ product as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_are_numbered_by_their_first_appearance() {
        let mut welder = Welder::new();
        let grid = |i: usize| Point::new((i % 37) as f64 * 0.1, (i / 37 % 41) as f64, 1e6);
        let numbers: Vec<_> = (0..20_000).map(|i| welder.add(grid(i)) as usize).collect();
        assert!(numbers.iter().enumerate().all(|(i, &number)| number == i % (37 * 41)));
        assert_eq!(welder.len(), 37 * 41);
        let positions = welder.into_positions();
        assert!(numbers.iter().enumerate().all(|(i, &number)| positions[number] == grid(i)));
    }

    #[test]
    fn a_batch_gets_the_numbers_that_its_positions_get_one_by_one() {
        let (mut one, mut other) = (Welder::new(), Welder::new());
        for i in 0..4000 {
            let batch =
                std::array::from_fn(|j| Point::new(f64::from(i * j as u32 % 997), -0.0, 0.1));
            assert_eq!(one.add_all::<7>(batch), batch.map(|position| other.add(position)));
        }
        assert_eq!(one.into_positions(), other.into_positions());
    }

    #[test]
    fn one_position_that_comes_twice_is_found_among_many() {
        let mut positions: Vec<_> =
            (0..5000).map(|i| Point::new(f64::from(i % 70), f64::from(i / 70), 0.0)).collect();
        assert!(are_distinct(&positions));
        positions[4321] = Point::new(11.0, 2.0, -0.0);
        assert!(!are_distinct(&positions));
    }

    #[test]
    fn minus_zero_is_zero_and_the_next_number_is_another() {
        let mut welder = Welder::new();
        assert_eq!(welder.add(Point::new(-0.0, 1.0, f64::NAN)), 0);
        assert_eq!(welder.add(Point::new(0.0, 1.0, f64::NAN)), 0);
        assert_eq!(welder.add(Point::new(f64::MIN_POSITIVE, 1.0, f64::NAN)), 1);
    }
}
