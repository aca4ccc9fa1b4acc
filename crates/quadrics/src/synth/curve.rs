//! Plane curves that sweep out analytic surfaces: the profiles and contours of parts.

use std::f64::consts::TAU;

/// A point of the drawing plane: (radius, height) of a profile, (x, y) of a contour.
pub(super) type Point2 = [f64; 2];

/// Chords by which the length of a curve without closed form is measured. Points are found by
/// interpolating its parameter, so they lie on the curve whatever this number is.
const CHORDS: usize = 2048;

/// One smooth piece of a drawing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Curve {
    /// A straight piece.
    Line {
        /// Where it begins.
        from: Point2,
        /// Where it ends.
        to: Point2,
    },
    /// A piece of a circle.
    Arc {
        /// Centre of the circle.
        center: Point2,
        /// Its radius.
        radius: f64,
        /// Angle at which it begins, in radians.
        start: f64,
        /// Angle that it covers; positive counter-clockwise.
        sweep: f64,
    },
    /// `x = √(a + b y + c y²)`: turned about the y axis it is a quadric, extruded a cylinder.
    Root {
        /// `a`, `b`, `c`.
        square: [f64; 3],
        /// First and last `y`.
        range: Point2,
    },
    /// `x = a - k y²`, for extrusion.
    Parabola {
        /// `a`, where it crosses the x axis.
        vertex: f64,
        /// `k`.
        bend: f64,
        /// First and last `y`.
        range: Point2,
    },
}

impl Curve {
    /// The arc about `center` from one point to another, which is at the same distance.
    pub(super) fn arc(center: Point2, from: Point2, to: Point2, left: bool) -> Self {
        let angle = |p: Point2| (p[1] - center[1]).atan2(p[0] - center[0]);
        let start = angle(from);
        let turn = (angle(to) - start).rem_euclid(TAU);
        let sweep = if left { turn } else { turn - TAU };
        Self::Arc { center, radius: (from[0] - center[0]).hypot(from[1] - center[1]), start, sweep }
    }

    /// `count + 1` points at equal distances along the curve, both ends among them.
    pub(super) fn points(&self, count: usize) -> Vec<Point2> {
        let parameters = self.even_parameters(count);
        parameters.into_iter().map(|t| self.at(t)).collect()
    }

    /// Parameters of `count + 1` points at equal distances.
    pub(super) fn even_parameters(&self, count: usize) -> Vec<f64> {
        let even = (0..=count).map(|i| i as f64 / count as f64);
        if matches!(self, Self::Line { .. } | Self::Arc { .. }) {
            return even.collect();
        }
        let lengths = self.lengths();
        let total = lengths[CHORDS];
        even.map(|fraction| {
            let target = fraction * total;
            let chord = lengths.partition_point(|&l| l < target).clamp(1, CHORDS) - 1;
            let part = (target - lengths[chord]) / (lengths[chord + 1] - lengths[chord]);
            (chord as f64 + part.clamp(0.0, 1.0)) / CHORDS as f64
        })
        .collect()
    }

    /// Its length.
    pub(super) fn length(&self) -> f64 {
        match *self {
            Self::Line { from, to } => (to[0] - from[0]).hypot(to[1] - from[1]),
            Self::Arc { radius, sweep, .. } => radius * sweep.abs(),
            _ => self.lengths()[CHORDS],
        }
    }

    /// Where it begins.
    pub(super) fn start(&self) -> Point2 {
        self.at(0.0)
    }

    /// Where it ends.
    pub(super) fn end(&self) -> Point2 {
        self.at(1.0)
    }

    /// The point at parameter `t` in [0, 1].
    pub(super) fn at(&self, t: f64) -> Point2 {
        match *self {
            // So written, both ends are met to the last bit.
            Self::Line { from, to } => [0, 1].map(|i| from[i] * (1.0 - t) + to[i] * t),
            Self::Arc { center, radius, start, sweep } => {
                let (sine, cosine) = (start + t * sweep).sin_cos();
                [center[0] + radius * cosine, center[1] + radius * sine]
            }
            Self::Root { square: [a, b, c], range } => {
                let y = between(range, crowded(t));
                [(a + y * (b + y * c)).max(0.0).sqrt(), y]
            }
            Self::Parabola { vertex, bend, range } => {
                let y = between(range, t);
                [vertex - bend * y * y, y]
            }
        }
    }

    /// Direction at parameter `t`, of length one.
    pub(super) fn tangent(&self, t: f64) -> Point2 {
        let [dx, dy] = match *self {
            Self::Line { from, to } => [to[0] - from[0], to[1] - from[1]],
            Self::Arc { start, sweep, .. } => {
                let (sine, cosine) = (start + t * sweep).sin_cos();
                [-sine * sweep, cosine * sweep]
            }
            Self::Root { square: [_, b, c], range } => {
                let [x, y] = self.at(t);
                let sign = (range[1] - range[0]).signum();
                [sign * (b + 2.0 * c * y) / 2.0, sign * x]
            }
            Self::Parabola { bend, range, .. } => {
                let sign = (range[1] - range[0]).signum();
                [-2.0 * sign * bend * between(range, t), sign]
            }
        };
        let length = dx.hypot(dy);
        [dx / length, dy / length]
    }

    fn lengths(&self) -> Vec<f64> {
        let mut total = 0.0;
        let mut last = self.start();
        (0..=CHORDS)
            .map(|i| {
                let next = self.at(i as f64 / CHORDS as f64);
                total += (next[0] - last[0]).hypot(next[1] - last[1]);
                last = next;
                total
            })
            .collect()
    }
}

fn between(range: Point2, t: f64) -> f64 {
    range[0] * (1.0 - t) + range[1] * t
}

/// A root meets the axis at a right angle: there equal steps in `y` would be huge steps in `x`.
fn crowded(t: f64) -> f64 {
    (1.0 - (t * TAU / 2.0).cos()) / 2.0
}

/// A drawing of several curves, pen on the paper.
#[derive(Debug, Clone)]
pub(super) struct Pen {
    curves: Vec<Curve>,
    at: Point2,
}

impl Pen {
    /// Puts the pen down.
    pub(super) fn at(x: f64, y: f64) -> Self {
        Self { curves: Vec::new(), at: [x, y] }
    }

    /// A straight line to a point.
    pub(super) fn line(self, x: f64, y: f64) -> Self {
        let from = self.at;
        self.draw(Curve::Line { from, to: [x, y] })
    }

    /// An arc to a point, turning left about a centre.
    pub(super) fn left(self, center: Point2, x: f64, y: f64) -> Self {
        let from = self.at;
        self.draw(Curve::arc(center, from, [x, y], true))
    }

    /// An arc to a point, turning right about a centre.
    pub(super) fn right(self, center: Point2, x: f64, y: f64) -> Self {
        let from = self.at;
        self.draw(Curve::arc(center, from, [x, y], false))
    }

    /// `x² = a + b y + c y²` up to `y`.
    pub(super) fn root(self, square: [f64; 3], y: f64) -> Self {
        let range = [self.at[1], y];
        self.draw(Curve::Root { square, range })
    }

    /// The curves drawn.
    pub(super) fn up(self) -> Vec<Curve> {
        self.curves
    }

    fn draw(mut self, curve: Curve) -> Self {
        self.at = curve.end();
        self.curves.push(curve);
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_at_equal_distances_and_end_at_the_ends() {
        let curves = [
            Curve::Line { from: [1.0, 2.0], to: [4.0, 6.0] },
            Curve::arc([0.0, 0.0], [2.0, 0.0], [0.0, 2.0], true),
            Curve::Root { square: [0.0, 4.0, 0.0], range: [3.0, 0.0] },
            Curve::Parabola { vertex: 3.0, bend: 0.5, range: [-2.0, 2.0] },
        ];
        for curve in curves {
            let points = curve.points(50);
            let step = |w: &[Point2]| (w[1][0] - w[0][0]).hypot(w[1][1] - w[0][1]);
            let even = curve.length() / 50.0;
            // Chords are shorter than arcs, by h²/24r² of themselves.
            assert!(points.windows(2).all(|w| (step(w) / even - 1.0).abs() < 2e-2), "{curve:?}");
            assert_eq!((points[0], points[50]), (curve.start(), curve.end()));
        }
    }

    #[test]
    fn tangents_agree_with_differences() {
        for curve in [
            Curve::arc([0.0, 0.0], [2.0, 0.0], [0.0, 2.0], false),
            Curve::Root { square: [1.0, 0.5, 2.0], range: [2.0, -1.0] },
            Curve::Parabola { vertex: 3.0, bend: 0.5, range: [-2.0, 2.0] },
        ] {
            let (near, far) = (curve.at(0.3 - 1e-6), curve.at(0.3 + 1e-6));
            let length = (far[0] - near[0]).hypot(far[1] - near[1]);
            let tangent = curve.tangent(0.3);
            assert!((tangent[0] - (far[0] - near[0]) / length).abs() < 1e-6, "{curve:?}");
            assert!((tangent[1] - (far[1] - near[1]) / length).abs() < 1e-6, "{curve:?}");
        }
    }
}
