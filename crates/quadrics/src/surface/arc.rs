//! Lines and circles through points of a plane, fitted from sums, as fast for many points as for few.

use nalgebra::{Matrix4, Vector4};

use super::curve::{Curve, Flat};

/// Sums of `w wᵀ` over points, `w = (1, x, y, x² + y²)`.
#[derive(Debug, Clone, Copy, Default)]
pub struct Sums(Matrix4<f64>);

/// A curve through some points.
#[derive(Debug, Clone, Copy)]
pub struct Arc {
    /// The curve.
    pub curve: Curve,
    /// Sum of squared distances, for circles to first order.
    pub cost: f64,
    /// Where the points are, and the direction that they extend in.
    pub middle: Flat,
    /// Of unit length.
    pub along: Flat,
}

/// Variance of the points across over that along, from which they are a cloud and no arc (0.19 for half a circle).
const SLENDER: f64 = 0.3;
const NEWTON: usize = 12;
const SETTLED: f64 = 1e-12;

/// Moments about the mean, `z = x² + y²`.
struct Moments {
    xx: f64,
    yy: f64,
    xy: f64,
    xz: f64,
    yz: f64,
    zz: f64,
}

impl Sums {
    /// Takes in a point.
    pub fn add(&mut self, p: Flat) {
        let w = Vector4::new(1.0, p.x, p.y, p.norm_squared());
        self.0 += w * w.transpose();
    }

    /// The sums over the points that are not among the first ones.
    pub fn less(&self, first: &Self) -> Self {
        Self(self.0 - first.0)
    }

    /// The line, or the circle of at least a `least` radius where that saves more than its `price`.
    pub fn fit(&self, price: f64, least: f64) -> Arc {
        let count = self.0[(0, 0)];
        let middle = Flat::new(self.0[(0, 1)], self.0[(0, 2)]) / count;
        let m = self.about(middle);
        let half = (m.xx + m.yy) / 2.0;
        let root = ((m.xx - m.yy) / 2.0).hypot(m.xy);
        let turn = 0.5 * (2.0 * m.xy).atan2(m.xx - m.yy);
        let along = Flat::new(turn.cos(), turn.sin());
        let normal = Flat::new(-along.y, along.x);
        let line = Curve::Line { normal, offset: normal.dot(&middle) };
        let cost = count * (half - root).max(0.0);
        let arc = Arc { curve: line, cost, middle, along };
        if half - root > SLENDER * (half + root) {
            return arc;
        }
        match m.circle() {
            Some((center, radius, square)) if radius > least && count * square + price < cost => {
                let curve = Curve::Circle { center: center + middle, radius, outward: 1.0 };
                Arc { curve, cost: count * square, ..arc }
            }
            _ => arc,
        }
    }

    fn about(&self, mean: Flat) -> Moments {
        #[rustfmt::skip]
        let shift = Matrix4::new(
            1.0, 0.0, 0.0, 0.0,
            -mean.x, 1.0, 0.0, 0.0,
            -mean.y, 0.0, 1.0, 0.0,
            mean.norm_squared(), -2.0 * mean.x, -2.0 * mean.y, 1.0,
        );
        let m = shift * self.0 * shift.transpose() / self.0[(0, 0)];
        let (xx, yy, xy) = (m[(1, 1)], m[(2, 2)], m[(1, 2)]);
        Moments { xx, yy, xy, xz: m[(1, 3)], yz: m[(2, 3)], zz: m[(3, 3)] }
    }
}

impl Moments {
    /// Centre from the mean, radius and mean squared distance of Taubin's circle (Taubin 1991, by Newton's method
    /// as in Chernov 2010, "Circular and linear regression").
    fn circle(&self) -> Option<(Flat, f64, f64)> {
        let Self { xx, yy, xy, xz, yz, zz } = *self;
        let z = xx + yy;
        let (cov, var) = (xx * yy - xy * xy, zz - z * z);
        let a3 = 4.0 * z;
        let a2 = -3.0 * z * z - zz;
        let a1 = var * z + 4.0 * cov * z - xz * xz - yz * yz;
        let a0 = xz * (xz * yy - yz * xy) + yz * (yz * xx - xz * xy) - var * cov;
        let mut root = 0.0;
        for _ in 0..NEWTON {
            let value = a0 + root * (a1 + root * (a2 + root * a3));
            let slope = a1 + root * (2.0 * a2 + root * 3.0 * a3);
            let next = root - value / slope;
            if !next.is_finite() || (next - root).abs() < SETTLED * z {
                break;
            }
            root = next;
        }
        let det = root * root - root * z + cov;
        let x = (xz * (yy - root) - yz * xy) / (2.0 * det);
        let y = (yz * (xx - root) - xz * xy) / (2.0 * det);
        let square = x * x + y * y + z;
        // Of the algebraic distance, whose gradient on the circle is twice the radius.
        let across = x * x * xx + y * y * yy + 2.0 * x * y * xy - x * xz - y * yz;
        let algebraic = (var + 4.0 * across).max(0.0);
        square.is_finite().then(|| (Flat::new(x, y), square.sqrt(), algebraic / (4.0 * square)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RADIUS: f64 = 0.3;
    const CENTER: Flat = Flat::new(0.4, -0.2);

    fn sums(points: impl Iterator<Item = Flat>) -> Sums {
        let mut sums = Sums::default();
        points.for_each(|p| sums.add(p));
        sums
    }

    /// A sixth of a circle, whose points stray.
    fn circle(stray: f64) -> Sums {
        let at = |i: i32| {
            let (angle, off) = (f64::from(i) * 0.01, stray * f64::from(i * 7 % 5 - 2));
            CENTER + Flat::new(angle.cos(), angle.sin()) * (RADIUS + off)
        };
        sums((0..100).map(at))
    }

    #[test]
    fn an_arc_is_found_exactly_and_measured_well() {
        let Arc { curve, cost, .. } = circle(0.0).fit(0.0, 0.1);
        let Curve::Circle { center, radius, .. } = curve else { panic!("{curve:?}") };
        assert!((center - CENTER).norm() < 1e-6 && (radius - RADIUS).abs() < 1e-6 && cost < 1e-12);
        let stray = circle(1e-3).fit(0.0, 0.1);
        // The mean square of -2, -1, 0, 1, 2.
        assert!((stray.cost / (100.0 * 2e-6) - 1.0).abs() < 0.1, "{stray:?}");
    }

    #[test]
    fn a_line_is_one_whatever_a_circle_costs() {
        let line = sums((0..50).map(|i| Flat::new(0.01, 0.02) * f64::from(i) + CENTER));
        let Arc { curve, cost, along, .. } = line.fit(1e-9, 0.1);
        assert!(matches!(curve, Curve::Line { .. }) && cost < 1e-12);
        assert!(along.perp(&Flat::new(1.0, 2.0)).abs() < 1e-9);
        assert!(matches!(circle(0.0).fit(1e3, 0.1).curve, Curve::Line { .. }));
    }
}
