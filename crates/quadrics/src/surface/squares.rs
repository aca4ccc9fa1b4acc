//! Sums of squared residuals over points, and their normal equations: what a fit spends its time on.
//!
//! Four points are taken at a time, in the vector instructions of the machine that runs it.

use std::array::from_fn;

use nalgebra::{SMatrix, SVector};
use pulp::{Arch, NullaryFnOnce};

use crate::math::Point;
use crate::math::lanes::{LANES, Lanes, Packet};

/// Surfaces as the solver sees them: residuals, derivatives by `N` local unknowns, and steps.
pub(super) trait Local<const N: usize>: Clone {
    /// Signed distances of points, and their derivatives.
    fn residual(&self, points: Packet) -> (Lanes, [Lanes; N]);
    /// The surface after a step; `None` where it would stop being one.
    fn moved(&self, step: &SVector<f64, N>) -> Option<Self>;
    /// A direction in which a step changes nothing, if there is one.
    fn gauge(&self) -> Option<SVector<f64, N>> {
        None
    }
}

/// Residuals that are worked out for one point after the other.
pub(super) fn one_by_one<const N: usize>(
    points: Packet,
    residual: impl Fn(Point) -> (f64, SVector<f64, N>),
) -> (Lanes, [Lanes; N]) {
    let each: [_; LANES] = from_fn(|i| residual(points.point(i)));
    let row = |unknown: usize| Lanes(from_fn(|i| each[i].1[unknown]));
    (Lanes(from_fn(|i| each[i].0)), from_fn(row))
}

/// The normal equations of a model at some points: `JᵀJ` and `Jᵀr`. Weights default to 1.
pub(super) fn normal_equations<const N: usize, M: Local<N>>(
    model: &M,
    points: &[Point],
    weights: &[f64],
) -> (SMatrix<f64, N, N>, SVector<f64, N>) {
    let (sums, slopes) = Arch::new().dispatch(Products { model, points, weights });
    let matrix = SMatrix::from_fn(|a, b| sums[a.min(b)][a.max(b)].sum());
    (matrix, SVector::from_fn(|a, _| slopes[a].sum()))
}

/// The weighted sum of squared residuals of a model at some points.
pub(super) fn sum_of_squares<const N: usize, M: Local<N>>(
    model: &M,
    points: &[Point],
    weights: &[f64],
) -> f64 {
    Arch::new().dispatch(Squares { model, points, weights })
}

/// Packets of points and their weights, which are 0 beyond the last point.
#[inline(always)]
fn packets<'a>(
    points: &'a [Point],
    weights: &'a [f64],
) -> impl Iterator<Item = (Packet, Lanes)> + 'a {
    points.chunks(LANES).enumerate().map(move |(packet, chunk)| {
        let of = |i: usize| weights.get(packet * LANES + i).copied().unwrap_or(1.0);
        let weights = if weights.is_empty() && chunk.len() == LANES {
            Lanes::splat(1.0)
        } else {
            Lanes(from_fn(|i| if i < chunk.len() { of(i) } else { 0.0 }))
        };
        (Packet::new(chunk), weights)
    })
}

/// The upper triangle of `JᵀJ`, and `Jᵀr`, by lane.
struct Products<'a, const N: usize, M: Local<N>> {
    model: &'a M,
    points: &'a [Point],
    weights: &'a [f64],
}

impl<const N: usize, M: Local<N>> NullaryFnOnce for Products<'_, N, M> {
    type Output = ([[Lanes; N]; N], [Lanes; N]);

    #[inline(always)]
    fn call(self) -> Self::Output {
        let mut sums = [[Lanes::splat(0.0); N]; N];
        let mut slopes = [Lanes::splat(0.0); N];
        for (packet, weight) in packets(self.points, self.weights) {
            let (residual, row) = self.model.residual(packet);
            for a in 0..N {
                let scaled = weight * row[a];
                slopes[a] += scaled * residual;
                for b in a..N {
                    sums[a][b] += scaled * row[b];
                }
            }
        }
        (sums, slopes)
    }
}

struct Squares<'a, const N: usize, M: Local<N>> {
    model: &'a M,
    points: &'a [Point],
    weights: &'a [f64],
}

impl<const N: usize, M: Local<N>> NullaryFnOnce for Squares<'_, N, M> {
    type Output = f64;

    #[inline(always)]
    fn call(self) -> f64 {
        let mut sum = Lanes::splat(0.0);
        for (packet, weight) in packets(self.points, self.weights) {
            let (residual, _) = self.model.residual(packet);
            sum += weight * residual * residual;
        }
        sum.sum()
    }
}
