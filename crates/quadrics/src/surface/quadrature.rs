//! Integrals over a triangle by a fixed rule.

use crate::math::Point;
use crate::math::lanes::Packet;

/// Points of the rule.
pub const POINTS: usize = 6;

/// Weights (of the area) and barycentric coordinates of a rule exact to degree four (Dunavant
/// 1985): six points, all inside, all weights positive, so that no sum of squares turns negative.
const RULE: [(f64, [f64; 3]); POINTS] = {
    const W: [f64; 2] = [0.223_381_589_678_011_47, 0.109_951_743_655_321_87];
    const A: [f64; 2] = [0.445_948_490_915_964_9, 0.091_576_213_509_770_74];
    const B: [f64; 2] = [1.0 - 2.0 * A[0], 1.0 - 2.0 * A[1]];
    [
        (W[0], [B[0], A[0], A[0]]),
        (W[0], [A[0], B[0], A[0]]),
        (W[0], [A[0], A[0], B[0]]),
        (W[1], [B[1], A[1], A[1]]),
        (W[1], [A[1], B[1], A[1]]),
        (W[1], [A[1], A[1], B[1]]),
    ]
};

/// The weights of the points; they add up to one.
pub const WEIGHTS: [f64; POINTS] = {
    let mut weights = [0.0; POINTS];
    let mut i = 0;
    while i < POINTS {
        weights[i] = RULE[i].0;
        i += 1;
    }
    weights
};

/// The points in a triangle.
#[inline]
pub fn points([a, b, c]: [Point; 3]) -> [Point; POINTS] {
    RULE.map(|(_, [u, v, w])| Point::from(a.coords * u + b.coords * v + c.coords * w))
}

/// The mean of a function over a triangle.
#[inline]
pub fn mean(corners: [Point; 3], mut function: impl FnMut(Point) -> f64) -> f64 {
    let mut sum = 0.0;
    each(corners, |weight, point| sum += weight * function(point));
    sum
}

/// Calls back with the points and their weights.
#[inline]
pub fn each(corners: [Point; 3], mut visit: impl FnMut(f64, Point)) {
    points(corners).into_iter().zip(WEIGHTS).for_each(|(point, weight)| visit(weight, point));
}

/// Calls back with the points in four triangles at a time and their weights.
#[inline(always)]
pub fn each_of_packet([a, b, c]: [Packet; 3], mut visit: impl FnMut(f64, Packet)) {
    for (weight, [u, v, w]) in RULE {
        let point = Packet {
            x: a.x * u + b.x * v + c.x * w,
            y: a.y * u + b.y * v + c.y * w,
            z: a.z * u + b.z * v + c.z * w,
        };
        visit(weight, point);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn monomials_to_degree_four_are_exact() {
        // Over the unit right triangle the mean of x^i y^j is 2 i! j! / (i + j + 2)!.
        let corners = [Point::origin(), Point::new(1.0, 0.0, 0.0), Point::new(0.0, 1.0, 0.0)];
        let factorial = |n: i32| (1..=n).map(f64::from).product::<f64>();
        for i in 0..=4 {
            for j in 0..=4 - i {
                let mean = mean(corners, |p| p.x.powi(i) * p.y.powi(j));
                let exact = 2.0 * factorial(i) * factorial(j) / factorial(i + j + 2);
                assert!((mean - exact).abs() < 1e-14, "x^{i} y^{j}: {mean} {exact}");
            }
        }
    }
}
