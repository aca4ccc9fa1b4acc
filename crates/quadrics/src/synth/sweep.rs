//! A profile swept along a closed contour: blocks, plates and pockets with drafted or rounded sides.

use super::build::{Builder, Frame, Loop};
use super::curve::{Curve, Point2};
use super::revolve::in_frame;
use crate::math::{Point, Vector};
use crate::surface::{Cone, Cylinder, Plane, Sphere, Surface, Torus};

/// Divisions of an arc of the contour or the profile, however coarse the mesh.
const LEAST_ON_ARC: usize = 3;

/// Parameters tabulated for points inside a side; those lie on its surface whatever this is.
const PARAMETERS: usize = 256;

/// Sweeps profiles along a contour in the xy plane of a frame.
pub(super) struct Sweep<'a> {
    /// Where contour and profile are drawn.
    pub(super) frame: Frame,
    /// Counter-clockwise, closed; smooth where the profile is not upright.
    pub(super) contour: &'a [Curve],
    /// Drawn as (inset, height), upwards: how far the side lies inside the contour.
    pub(super) profile: &'a [Curve],
    /// The material is inside the contour; if not, it is a pocket.
    pub(super) solid: bool,
}

/// What a sweep leaves open: its edges below and above, for planes to close.
pub(super) struct Rims {
    pub(super) below: Loop,
    pub(super) above: Loop,
}

/// The vertices of one level of a sweep: those of every piece of the contour, ends included.
type Level = Vec<Vec<u32>>;

impl Sweep<'_> {
    /// Makes the sides. `holes` (piece of the contour, loop) are left open in upright flat sides;
    /// `lift` gives the height of the upper edge, where it is not level.
    pub(super) fn make(
        &self,
        part: &mut Builder,
        holes: &[(usize, Loop)],
        lift: Option<&dyn Fn(Point2) -> f64>,
    ) -> Rims {
        let last = self.profile.len() - 1;
        let counts: Vec<usize> = self.contour.iter().map(|c| divisions(part, c)).collect();
        let mut below = self.level(part, &counts, self.profile[0].start(), None);
        let first = below.clone();
        for (i, profile) in self.profile.iter().enumerate() {
            let lift = lift.filter(|_| i == last);
            let above = self.level(part, &counts, profile.end(), lift);
            self.band(part, profile, [&below, &above], if i == 0 { holes } else { &[] }, lift);
            below = above;
        }
        let rim = |level: Level| level.iter().flat_map(|p| p[..p.len() - 1].to_vec()).collect();
        Rims { below: rim(first), above: rim(below) }
    }

    fn level(
        &self,
        part: &mut Builder,
        counts: &[usize],
        at: Point2,
        lift: Option<&dyn Fn(Point2) -> f64>,
    ) -> Level {
        let mut level: Level = Vec::new();
        for (curve, &count) in self.contour.iter().zip(counts) {
            let parameters = curve.even_parameters(count);
            let place = |&t: &f64| {
                let [x, y] = inset(curve, t, at[0]);
                [x, y, lift.map_or(at[1], |lift| lift([x, y]))]
            };
            let points = parameters[..count].iter().map(place);
            level.push(points.map(|p| part.vertex(self.frame.at(p))).collect());
        }
        let starts: Vec<u32> = level.iter().map(|piece| piece[0]).collect();
        for (i, piece) in level.iter_mut().enumerate() {
            piece.push(starts[(i + 1) % starts.len()]);
        }
        level
    }

    /// The sides between two levels, one region for every piece of the contour.
    fn band(
        &self,
        part: &mut Builder,
        profile: &Curve,
        [below, above]: [&Level; 2],
        holes: &[(usize, Loop)],
        lift: Option<&dyn Fn(Point2) -> f64>,
    ) {
        let height = |part: &Builder, v: u32| match lift {
            None => profile.length(),
            Some(_) => {
                self.frame.z.dot(&(part.position(v) - self.frame.origin)) - profile.start()[1]
            }
        };
        // The edges between two sides, bottom to top; every side shares one with the next.
        let columns: Vec<Vec<u32>> = (0..self.contour.len())
            .map(|i| {
                let tall = height(part, above[i][0]);
                let curve = &self.contour[i];
                self.column(part, curve, profile, [below[i][0], above[i][0]], tall)
            })
            .collect();
        for (i, curve) in self.contour.iter().enumerate() {
            let next = &columns[(i + 1) % columns.len()];
            let sides: [&[u32]; 4] = [&below[i], next, &above[i], &columns[i]];
            let tops: Vec<f64> = above[i].iter().map(|&v| height(part, v)).collect();
            let through = holes.iter().filter(|(piece, _)| *piece == i).map(|(_, hole)| hole);
            self.side(part, curve, profile, sides, &tops, through);
        }
    }

    fn column(
        &self,
        part: &mut Builder,
        curve: &Curve,
        profile: &Curve,
        [foot, head]: [u32; 2],
        tall: f64,
    ) -> Vec<u32> {
        let least = if matches!(profile, Curve::Arc { .. }) { LEAST_ON_ARC } else { 1 };
        let count = part.divisions(tall, least);
        let mut column = vec![foot];
        for i in 1..count {
            let along = i as f64 / count as f64 * tall / profile.length();
            let place = self.place(curve, 0.0, profile.at(along));
            column.push(part.vertex(place));
        }
        column.push(head);
        column
    }

    /// One side: a patch over (length along the contour, length along the profile).
    fn side<'h>(
        &self,
        part: &mut Builder,
        curve: &Curve,
        profile: &Curve,
        sides: [&[u32]; 4],
        tops: &[f64],
        holes: impl Iterator<Item = &'h Loop>,
    ) {
        let region = part.region(self.surface(curve, profile));
        // Half way up, where the contour is neither longest nor shortest.
        let length = self.length_at(curve, profile.at(0.5)[0]);
        let (mut vertices, outline) = outline(sides, length, tops);
        let mut outlines = vec![outline];
        for hole in holes {
            vertices.extend(hole);
            outlines.push(
                hole.iter().map(|&v| self.unroll(curve, profile, part.position(v))).collect(),
            );
        }
        let (mirror, total) = (!self.solid, profile.length());
        let even = curve.even_parameters(PARAMETERS);
        if mirror {
            outlines.iter_mut().flatten().for_each(|p| p[0] = -p[0]);
        }
        part.patch(region, &vertices, &outlines, |[x, y]| {
            let x = if mirror { -x } else { x };
            self.place(curve, between(&even, x / length), profile.at(y / total))
        });
    }

    /// Parameters of a point of a flat upright side.
    fn unroll(&self, curve: &Curve, profile: &Curve, point: Point) -> Point2 {
        debug_assert!(matches!(curve, Curve::Line { .. }), "holes need a flat side");
        let ([x, y], start, along) = (self.frame.flat(point), curve.start(), curve.tangent(0.0));
        let height = self.frame.z.dot(&(point - self.frame.origin)) - profile.start()[1];
        [(x - start[0]) * along[0] + (y - start[1]) * along[1], height]
    }

    fn place(&self, curve: &Curve, t: f64, [inward, height]: Point2) -> Point {
        let [x, y] = inset(curve, t, inward);
        self.frame.at([x, y, height])
    }

    fn length_at(&self, curve: &Curve, inward: f64) -> f64 {
        match *curve {
            Curve::Arc { radius, sweep, .. } => (radius - inward * sweep.signum()) * sweep.abs(),
            _ => curve.length(),
        }
    }

    /// The surface that a piece of the profile sweeps out along a piece of the contour.
    fn surface(&self, curve: &Curve, profile: &Curve) -> Surface {
        let frame = &self.frame;
        let outward = if self.solid { 1.0 } else { -1.0 };
        match (*curve, *profile) {
            (Curve::Line { .. }, Curve::Line { .. }) => {
                let ([tx, ty], [inward, up]) = (curve.tangent(0.0), profile.tangent(0.0));
                let normal = [ty * up, -tx * up, inward].map(|c| c * outward);
                let normal = frame.direction(normal);
                Surface::Plane(Plane::through(self.place(curve, 0.0, profile.start()), normal))
            }
            (Curve::Line { .. }, Curve::Arc { center, radius, .. }) => {
                let [tx, ty] = curve.tangent(0.0);
                let point = self.place(curve, 0.0, center);
                Surface::Cylinder(Cylinder { point, axis: frame.direction([tx, ty, 0.0]), radius })
            }
            (Curve::Arc { center, radius, sweep, .. }, Curve::Line { from, to }) => {
                let around = |inward: f64| radius - sweep.signum() * inward;
                let (low, high) = (around(from[0]), around(to[0]));
                let axis = frame.z;
                let on_axis = |height: f64| frame.at([center[0], center[1], height]);
                if low == high {
                    return Surface::Cylinder(Cylinder { point: on_axis(0.0), axis, radius: low });
                }
                let slope = (high - low) / (to[1] - from[1]);
                let apex = on_axis(from[1] - low / slope);
                let axis = if slope > 0.0 { axis } else { -axis };
                Surface::Cone(Cone { apex, axis, half_angle: slope.abs().atan() })
            }
            (
                Curve::Arc { center, radius, sweep, .. },
                Curve::Arc { center: bend, radius: minor, .. },
            ) => {
                let major = radius - sweep.signum() * bend[0];
                let center = frame.at([center[0], center[1], bend[1]]);
                if major.abs() < 1e-9 * radius {
                    return Surface::Sphere(Sphere { center, radius: minor });
                }
                Surface::Torus(Torus {
                    center,
                    axis: frame.z,
                    major_radius: major,
                    minor_radius: minor,
                })
            }
            (Curve::Root { square: [a, b, c], .. }, _) => {
                let form = Vector::new(1.0, -c, 0.0);
                Surface::Quadric(in_frame(frame, -a, Vector::new(0.0, -b, 0.0), form))
            }
            (Curve::Parabola { vertex, bend, .. }, _) => {
                let form = Vector::new(0.0, bend, 0.0);
                Surface::Quadric(in_frame(frame, -vertex, Vector::new(1.0, 0.0, 0.0), form))
            }
            _ => unreachable!("profiles of sweeps are lines and arcs"),
        }
    }
}

/// The vertices around a side and their parameters, from the foot counter-clockwise.
fn outline(
    [below, right, above, left]: [&[u32]; 4],
    length: f64,
    tops: &[f64],
) -> (Vec<u32>, Vec<Point2>) {
    let step = |i: usize, chain: &[u32]| i as f64 / (chain.len() - 1) as f64;
    let (first, last) = (tops[0], tops[tops.len() - 1]);
    let foot = below.iter().enumerate().map(|(i, &v)| (v, [step(i, below) * length, 0.0]));
    let rise = right.iter().enumerate().map(|(i, &v)| (v, [length, step(i, right) * last]));
    let head = above.iter().enumerate().map(|(i, &v)| (v, [step(i, above) * length, tops[i]]));
    let fall = left.iter().enumerate().map(|(i, &v)| (v, [0.0, step(i, left) * first]));
    // Each ends with the vertex at which the next begins.
    let (foot, rise) = (foot.take(below.len() - 1), rise.take(right.len() - 1));
    let (head, fall) = (head.rev().take(above.len() - 1), fall.rev().take(left.len() - 1));
    foot.chain(rise).chain(head).chain(fall).unzip()
}

fn divisions(part: &Builder, curve: &Curve) -> usize {
    let least = if matches!(curve, Curve::Line { .. }) { 1 } else { LEAST_ON_ARC };
    part.divisions(curve.length(), least)
}

/// Interpolates a table of equal steps at a fraction of its length.
fn between(table: &[f64], fraction: f64) -> f64 {
    let at = (fraction * PARAMETERS as f64).clamp(0.0, PARAMETERS as f64);
    let i = (at as usize).min(PARAMETERS - 1);
    table[i] + (table[i + 1] - table[i]) * (at - i as f64)
}

/// The point of a contour at `t`, moved inwards.
fn inset(curve: &Curve, t: f64, inward: f64) -> Point2 {
    let ([x, y], [tx, ty]) = (curve.at(t), curve.tangent(t));
    [x - ty * inward, y + tx * inward]
}
