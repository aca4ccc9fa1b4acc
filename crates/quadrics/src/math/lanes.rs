//! Four points at a time: arithmetic that the compiler turns into vector instructions.

use std::array::from_fn;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

use super::{Point, Vector};

/// Numbers in a packet. The same on every machine, whatever its vectors hold, so that sums are, too.
pub const LANES: usize = 4;

/// One number of each of [`LANES`] points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lanes(pub [f64; LANES]);

impl Lanes {
    /// The same number in each.
    #[inline(always)]
    pub fn splat(value: f64) -> Self {
        Self([value; LANES])
    }

    /// A function of each.
    #[inline(always)]
    pub fn map(self, f: impl Fn(f64) -> f64) -> Self {
        Self(from_fn(|i| f(self.0[i])))
    }

    /// The square root of each.
    #[inline(always)]
    pub fn sqrt(self) -> Self {
        self.map(f64::sqrt)
    }

    /// Each, or `least` where it is less.
    #[inline(always)]
    pub fn at_least(self, least: f64) -> Self {
        self.map(|value| if value > least { value } else { least })
    }

    /// Their sum.
    #[inline(always)]
    pub fn sum(self) -> f64 {
        let [a, b, c, d] = self.0;
        (a + b) + (c + d)
    }
}

/// An operator between two packets, and between a packet and a number on either side.
macro_rules! operator {
    ($operator:ident, $name:ident) => {
        impl $operator for Lanes {
            type Output = Self;
            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                Self(from_fn(|i| self.0[i].$name(other.0[i])))
            }
        }

        impl $operator<f64> for Lanes {
            type Output = Self;
            #[inline(always)]
            fn $name(self, other: f64) -> Self {
                self.$name(Self::splat(other))
            }
        }

        impl $operator<Lanes> for f64 {
            type Output = Lanes;
            #[inline(always)]
            fn $name(self, other: Lanes) -> Lanes {
                Lanes::splat(self).$name(other)
            }
        }
    };
}

operator!(Add, add);
operator!(Sub, sub);
operator!(Mul, mul);
operator!(Div, div);

impl Neg for Lanes {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.map(f64::neg)
    }
}

impl AddAssign for Lanes {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

/// [`LANES`] points or displacements.
#[derive(Debug, Clone, Copy)]
pub struct Packet {
    /// First coordinates.
    pub x: Lanes,
    /// Second coordinates.
    pub y: Lanes,
    /// Third coordinates.
    pub z: Lanes,
}

impl Packet {
    /// One to [`LANES`] points; the last one again where they are fewer.
    #[inline(always)]
    pub fn new(points: &[Point]) -> Self {
        let some = || from_fn(|i| points[i.min(points.len() - 1)]);
        let all: [Point; LANES] = points.try_into().unwrap_or_else(|_| some());
        let along = |axis: usize| Lanes(from_fn(|i| all[i][axis]));
        Self { x: along(0), y: along(1), z: along(2) }
    }

    /// One of the points.
    pub fn point(&self, i: usize) -> Point {
        Point::new(self.x.0[i], self.y.0[i], self.z.0[i])
    }

    /// The displacements from a point.
    #[inline(always)]
    pub fn from(self, origin: &Point) -> Self {
        Self { x: self.x - origin.x, y: self.y - origin.y, z: self.z - origin.z }
    }

    /// Scalar products with a vector.
    #[inline(always)]
    pub fn dot(self, other: &Vector) -> Lanes {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    /// Scalar products, one by one.
    #[inline(always)]
    pub fn times(self, other: Self) -> Lanes {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    /// Vector products.
    #[inline(always)]
    pub fn cross(self, other: Self) -> Self {
        Self {
            x: self.y * other.z - self.z * other.y,
            y: self.z * other.x - self.x * other.z,
            z: self.x * other.y - self.y * other.x,
        }
    }
}
