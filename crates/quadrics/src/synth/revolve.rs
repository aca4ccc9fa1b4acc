//! Surfaces of revolution, and their images stretched across the axis: elliptic quadrics.

use std::f64::consts::TAU;

use nalgebra::Matrix3;

use super::build::{Builder, Frame, Loop};
use super::curve::{Curve, Point2};
use crate::math::Vector;
use crate::surface::{Cone, Cylinder, Quadric, Sphere, Surface, Torus};

/// Rows of equilateral triangles are this much closer than their vertices.
const ROW: f64 = 0.866_025_403_784_438_6;

/// Vertices around a small bore, however coarse the mesh: fewer look like a polygon.
const LEAST_AROUND: usize = 12;

/// Vertices around a pole.
const LEAST_AT_POLE: usize = 6;

/// Radii below this fraction of the stretch are a pole: the rounding of a square, under the root.
const AT_AXIS: f64 = 1e-6;

/// Points by which an ellipse is divided into equal arcs; the points lie on it whatever this is.
const ELLIPSE_CHORDS: usize = 4096;

/// A row of vertices around the axis, at equal distances.
#[derive(Debug, Clone)]
struct Row {
    vertices: Vec<u32>,
    /// Where its first vertex is, as a fraction of a step.
    phase: f64,
}

impl Row {
    /// Fraction of the turn at which a vertex is; vertices are counted on beyond a turn.
    fn turn(&self, i: usize) -> f64 {
        (i as f64 + self.phase) / self.vertices.len() as f64
    }

    fn vertex(&self, i: usize) -> u32 {
        self.vertices[i % self.vertices.len()]
    }
}

/// Turns profiles about the z axis of a frame.
pub(super) struct Lathe {
    frame: Frame,
    stretch: Point2,
    /// Angles of equal arcs of the stretched circle.
    angles: Vec<f64>,
    /// Circumference of the stretched unit circle.
    around: f64,
}

impl Lathe {
    /// For circles.
    pub(super) fn new(frame: Frame) -> Self {
        Self::stretched(frame, [1.0, 1.0])
    }

    /// For ellipses: radii are multiplied by `stretch` along x and y.
    pub(super) fn stretched(frame: Frame, stretch: Point2) -> Self {
        let at = |i: usize| {
            let (sine, cosine) = (i as f64 / ELLIPSE_CHORDS as f64 * TAU).sin_cos();
            [stretch[0] * cosine, stretch[1] * sine]
        };
        let mut around = 0.0;
        let mut angles = vec![0.0];
        for i in 0..ELLIPSE_CHORDS {
            let (a, b) = (at(i), at(i + 1));
            around += (b[0] - a[0]).hypot(b[1] - a[1]);
            angles.push(around);
        }
        Self { frame, stretch, angles, around }
    }

    /// Turns a profile, drawn as (radius, height) with the material on its left. Level pieces
    /// become planes, in which `holes` (number of the piece, loop) are left open. The loops at
    /// the joints of the pieces come back, empty at a pole; a profile that ends where it begins
    /// is closed.
    pub(super) fn turn(
        &self,
        part: &mut Builder,
        profile: &[Curve],
        holes: &[(usize, Loop)],
    ) -> Vec<Loop> {
        let mut joints: Vec<Row> = profile.iter().map(|c| self.joint(part, c.start())).collect();
        let (first, last) = (profile[0].start(), profile[profile.len() - 1].end());
        let closed = (first[0] - last[0]).hypot(first[1] - last[1]) < 1e-9 * self.around;
        joints.push(if closed { joints[0].clone() } else { self.joint(part, last) });
        for (i, curve) in profile.iter().enumerate() {
            match curve {
                Curve::Line { from, to } if from[1] == to[1] => {
                    let through = holes.iter().filter(|(piece, _)| *piece == i);
                    let through = through.map(|(_, hole)| hole.clone()).collect();
                    self.level(part, curve, [&joints[i], &joints[i + 1]], through);
                }
                _ => self.side(part, curve, &joints[i], &joints[i + 1]),
            }
        }
        joints.into_iter().map(|row| row.vertices).collect()
    }

    fn joint(&self, part: &mut Builder, [radius, height]: Point2) -> Row {
        if radius < AT_AXIS * self.around {
            return Row { vertices: Vec::new(), phase: 0.0 };
        }
        let count = part.divisions(self.around * radius, LEAST_AROUND);
        self.row(part, [radius, height], count, 0.0)
    }

    fn row(&self, part: &mut Builder, [radius, height]: Point2, count: usize, phase: f64) -> Row {
        let place = |i: usize| {
            let (sine, cosine) = self.angle((i as f64 + phase) / count as f64).sin_cos();
            let (x, y) = (self.stretch[0] * radius * cosine, self.stretch[1] * radius * sine);
            self.frame.at([x, y, height])
        };
        Row { vertices: (0..count).map(|i| part.vertex(place(i))).collect(), phase }
    }

    /// The angle at a fraction of the circumference.
    fn angle(&self, turn: f64) -> f64 {
        if self.stretch[0] == self.stretch[1] {
            return turn * TAU;
        }
        let target = turn.rem_euclid(1.0) * self.around;
        let i = self.angles.partition_point(|&a| a < target).clamp(1, ELLIPSE_CHORDS) - 1;
        let part = (target - self.angles[i]) / (self.angles[i + 1] - self.angles[i]);
        (i as f64 + part) / ELLIPSE_CHORDS as f64 * TAU
    }

    /// A plane across the axis.
    fn level(&self, part: &mut Builder, curve: &Curve, joints: [&Row; 2], holes: Vec<Loop>) {
        let ([from, height], [to, _]) = (curve.start(), curve.end());
        let here = self.frame.moved([0.0, 0.0, height]);
        // The material is on the left: below on the way inwards, above on the way outwards.
        let (frame, rings) =
            if to < from { (here, joints) } else { (here.reversed(), [joints[1], joints[0]]) };
        let loops: Vec<Loop> = rings.iter().map(|row| row.vertices.clone()).chain(holes).collect();
        let loops: Vec<Loop> = loops.into_iter().filter(|l| !l.is_empty()).collect();
        part.plane(&frame, &loops);
    }

    /// A curved side.
    fn side(&self, part: &mut Builder, curve: &Curve, start: &Row, end: &Row) {
        let region = part.region(self.surface(curve));
        let rows = ((curve.length() / (part.spacing * ROW)).round() as usize).max(1);
        let poles = [start, end].map(|row| row.vertices.is_empty());
        let least = if poles == [false; 2] { LEAST_AROUND } else { LEAST_AT_POLE };
        let points = curve.points(rows);
        let mut below = start.clone();
        for (i, &point) in points.iter().enumerate().skip(1) {
            let above = if i == rows {
                end.clone()
            } else {
                let count = part.divisions(self.around * point[0], least);
                // Half a step further every row: that makes the triangles equilateral.
                self.row(part, point, count, if i % 2 == 1 { 0.5 } else { 0.0 })
            };
            match (below.vertices.is_empty(), above.vertices.is_empty()) {
                (true, _) => self.fan(part, region, curve.start(), &above, false),
                (_, true) => self.fan(part, region, curve.end(), &below, true),
                _ => zip(part, region, &below, &above),
            }
            below = above;
        }
    }

    fn fan(&self, part: &mut Builder, region: u32, pole: Point2, row: &Row, above: bool) {
        let pole = part.vertex(self.frame.at([0.0, 0.0, pole[1]]));
        for i in 0..row.vertices.len() {
            let (a, b) = (row.vertex(i), row.vertex(i + 1));
            part.face(region, if above { [a, b, pole] } else { [b, a, pole] });
        }
    }

    /// The surface that a curve sweeps out.
    fn surface(&self, curve: &Curve) -> Surface {
        let round = self.stretch == [1.0, 1.0];
        let axis = self.frame.z;
        let on_axis = |height: f64| self.frame.at([0.0, 0.0, height]);
        match *curve {
            Curve::Line { from, to } if !round => self.stretched_root(line_root(from, to)),
            Curve::Line { from, to } if from[0] == to[0] => {
                Surface::Cylinder(Cylinder { point: on_axis(from[1]), axis, radius: from[0] })
            }
            Curve::Line { from, to } => {
                let slope = (to[0] - from[0]) / (to[1] - from[1]);
                let apex = on_axis(from[1] - from[0] / slope);
                let axis = if slope > 0.0 { axis } else { -axis };
                Surface::Cone(Cone { apex, axis, half_angle: slope.abs().atan() })
            }
            Curve::Arc { center: [major, height], radius, .. } => {
                let center = on_axis(height);
                if major == 0.0 {
                    return Surface::Sphere(Sphere { center, radius });
                }
                debug_assert!(round, "a stretched torus is of degree four");
                Surface::Torus(Torus { center, axis, major_radius: major, minor_radius: radius })
            }
            Curve::Root { square, .. } => self.stretched_root(square),
            Curve::Parabola { .. } => unreachable!("a turned parabola is of degree four"),
        }
    }

    /// `x²/s² + y²/t² = a + b z + c z²`, with the stretches s and t.
    fn stretched_root(&self, [a, b, c]: [f64; 3]) -> Surface {
        let [s, t] = self.stretch;
        let form = Vector::new(1.0 / (s * s), 1.0 / (t * t), -c);
        Surface::Quadric(in_frame(&self.frame, -a, Vector::new(0.0, 0.0, -b), form))
    }
}

/// `constant + linear · p + p · diagonal p = 0` in the coordinates of a frame.
pub(super) fn in_frame(frame: &Frame, constant: f64, linear: Vector, diagonal: Vector) -> Quadric {
    let turn = Matrix3::from_columns(&[*frame.x, *frame.y, *frame.z]);
    let form = turn * Matrix3::from_diagonal(&diagonal) * turn.transpose();
    let linear = turn * linear;
    let origin = frame.origin.coords;
    let constant = constant - linear.dot(&origin) + origin.dot(&(form * origin));
    Quadric::from_parts(constant, linear - form * origin * 2.0, form)
}

/// `r² = a + b z + c z²` of a straight profile.
fn line_root(from: Point2, to: Point2) -> [f64; 3] {
    let slope = (to[0] - from[0]) / (to[1] - from[1]);
    let level = from[0] - slope * from[1];
    [level * level, 2.0 * level * slope, slope * slope]
}

/// The strip of triangles between two rows.
fn zip(part: &mut Builder, region: u32, below: &Row, above: &Row) {
    let (count, other) = (below.vertices.len(), above.vertices.len());
    let (mut i, mut j) = (0, 0);
    while i < count || j < other {
        // The edge whose middle comes first makes the next triangle.
        let (here, there) = (below.turn(i) + below.turn(i + 1), above.turn(j) + above.turn(j + 1));
        let (a, b) = (below.vertex(i), above.vertex(j));
        if j == other || (i < count && here <= there) {
            part.face(region, [a, below.vertex(i + 1), b]);
            i += 1;
        } else {
            part.face(region, [a, above.vertex(j + 1), b]);
            j += 1;
        }
    }
}
