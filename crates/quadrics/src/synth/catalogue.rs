//! The parts: what is turned, what is swept, and which edges it shares. Lengths in millimetres.
//!
//! Features come before the faces that they open into, because they make the common edge.

use super::build::{Builder, Frame, Loop};
use super::curve::{Curve, Pen, Point2};
use super::revolve::{Lathe, in_frame};
use super::sweep::{Rims, Sweep};
use crate::math::Vector;
use crate::surface::Surface;

/// Pieces of the contour of a [`rectangle`] that are its sides; those between are its corners.
const FRONT: usize = 0;
const RIGHT: usize = 2;
const BACK: usize = 4;
const LEFT: usize = 6;

/// A housing on a bolted base: bores, a boss that ends in a ball, fillets, chamfers, a pocket.
pub(super) fn demo(part: &mut Builder) {
    let ground = Frame::upright(0.0, 0.0, 0.0);
    let bearing = Pen::at(20.0, 64.0).line(18.0, 62.0).line(18.0, 34.0).line(12.0, 34.0);
    let bearing = bearing.line(12.0, 2.0).line(14.0, 0.0).up();
    let bearing = Lathe::new(ground).turn(part, &bearing, &[]);
    let sides = housing_sides(part);
    let housing = Sweep {
        frame: ground,
        contour: &rectangle([36.0, 28.0], 8.0),
        profile: &Pen::at(0.0, 14.0).line(0.0, 61.0).line(3.0, 64.0).up(),
        solid: true,
    };
    let housing = housing.make(part, &sides, None);
    let mut top = vec![housing.above, bearing[0].clone()];
    for (x, y) in corners(26.0, 18.0) {
        let drill = Pen::at(2.5, 64.0).line(2.5, 50.0).line(0.0, 48.5).up();
        top.push(opening(part, Frame::upright(x, y, 0.0), &drill));
    }
    part.plane(&ground.moved([0.0, 0.0, 64.0]), &top);
    base(part, housing.below, bearing[5].clone());
}

/// The base of the demo, from the edge of the housing on it and of the bore through it.
fn base(part: &mut Builder, housing: Loop, bore: Loop) {
    let ground = Frame::upright(0.0, 0.0, 0.0);
    let fillet = Pen::at(0.0, 0.0).line(0.0, 11.0).right([3.0, 11.0], 3.0, 14.0).up();
    let contour = rectangle([70.0, 50.0], 12.0);
    let base = Sweep { frame: ground, contour: &contour, profile: &fillet, solid: true };
    let Rims { below, above } = base.make(part, &[], None);
    let (mut bottom, mut top) = (vec![below, bore], vec![above, housing]);
    for (x, y) in corners(56.0, 36.0) {
        let bolt = Pen::at(8.0, 14.0).line(8.0, 9.0).line(4.5, 9.0).line(4.5, 0.0).up();
        let edges = Lathe::new(Frame::upright(x, y, 0.0)).turn(part, &bolt, &[]);
        top.push(edges[0].clone());
        bottom.push(edges[3].clone());
    }
    part.plane(&ground.moved([0.0, 0.0, 14.0]), &top);
    part.plane(&ground.reversed(), &bottom);
}

/// What opens into the four sides of the demo's housing.
fn housing_sides(part: &mut Builder) -> Vec<(usize, Loop)> {
    let up = Vector::z();
    let ball = Pen::at(13.0, 0.0).right([13.0, 3.0], 10.0, 3.0).line(10.0, 12.0);
    let ball = ball.left([0.0, 12.0], 0.0, 22.0).up();
    let front = opening(part, Frame::new([0.0, -28.0, 40.0], up, -Vector::y()), &ball);
    let port = Pen::at(11.0, 0.0).line(8.5, 8.0).line(4.0, 8.0).line(4.0, -6.0);
    let port = port.right([0.0, -6.0], 0.0, -10.0).up();
    let right = opening(part, Frame::new([36.0, 0.0, 38.0], up, Vector::x()), &port);
    let mut sides = vec![(FRONT, front), (RIGHT, right)];
    for x in [-14.0, 14.0] {
        let dowel = Pen::at(4.0, 0.0).line(3.0, -1.0).line(3.0, -8.0).line(0.0, -8.0).up();
        let frame = Frame::new([x, 28.0, 42.0], up, Vector::y());
        sides.push((BACK, opening(part, frame, &dowel)));
    }
    let slot = Sweep {
        frame: Frame::new([-31.0, 0.0, 38.0], Vector::y(), -Vector::x()),
        contour: &rectangle([13.0, 6.0], 6.0 - 1.0),
        profile: &Pen::at(0.0, 0.0).line(0.0, 5.0).up(),
        solid: false,
    };
    let edges = slot.make(part, &[], None);
    part.plane(&slot.frame, &[edges.below]);
    sides.push((LEFT, edges.above));
    sides
}

/// A stepped shaft with shoulders, chamfers, a groove, a fillet, a taper and a ball end.
pub(super) fn shaft(part: &mut Builder) {
    let profile = Pen::at(0.0, 0.0).line(9.0, 0.0).line(10.0, 1.0).line(10.0, 28.0);
    let profile = profile.right([10.0, 30.0], 10.0, 32.0).line(10.0, 36.0);
    let profile = profile.right([13.0, 36.0], 13.0, 39.0).line(18.0, 39.0).line(19.0, 40.0);
    let profile = profile.line(19.0, 62.0).line(18.0, 63.0).line(14.0, 63.0).line(10.0, 100.0);
    let profile = profile.line(8.0, 100.0).line(8.0, 112.0).left([0.0, 112.0], 0.0, 120.0);
    // Lying, as on a lathe.
    let frame = Frame::new([0.0; 3], Vector::y(), Vector::x());
    Lathe::new(frame).turn(part, &profile.up(), &[]);
}

/// A rectangular plate with bores in rows.
pub(super) fn plate(part: &mut Builder, bores: usize) {
    const PITCH: f64 = 20.0;
    const BORE_RADIUS: f64 = 6.0;
    const THICKNESS: f64 = 10.0;
    let columns = (bores as f64).sqrt().ceil().max(1.0) as usize;
    let rows = bores.div_ceil(columns).max(1);
    let [length, width] = [columns, rows].map(|n| n as f64 * PITCH);
    let ground = Frame::upright(0.0, 0.0, 0.0);
    let contour = Pen::at(0.0, 0.0).line(length, 0.0).line(length, width).line(0.0, width);
    let contour = contour.line(0.0, 0.0).up();
    let profile = Pen::at(0.0, 0.0).line(0.0, THICKNESS).up();
    let sides = Sweep { frame: ground, contour: &contour, profile: &profile, solid: true };
    let Rims { below, above } = sides.make(part, &[], None);
    let (mut bottom, mut top) = (vec![below], vec![above]);
    let bore = Pen::at(BORE_RADIUS, THICKNESS).line(BORE_RADIUS, 0.0).up();
    for i in 0..bores {
        let [x, y] = [i % columns, i / columns].map(|n| (n as f64 + 0.5) * PITCH);
        let edges = Lathe::new(Frame::upright(x, y, 0.0)).turn(part, &bore, &[]);
        top.push(edges[0].clone());
        bottom.push(edges[1].clone());
    }
    part.plane(&ground.moved([0.0, 0.0, THICKNESS]), &top);
    part.plane(&ground.reversed(), &bottom);
}

/// A cast block: drafted sides, rounded above, a drafted pocket and in it a pin.
pub(super) fn draft(part: &mut Builder) {
    const DRAFT: f64 = 0.1;
    const FILLET: f64 = 5.0;
    let ground = Frame::upright(0.0, 0.0, 0.0);
    let (sine, cosine) = DRAFT.sin_cos();
    // The fillet is tangent to the drafted side and ends level.
    let edge = [35.0 * sine, 35.0 * cosine];
    let center = [edge[0] + FILLET * cosine, edge[1] - FILLET * sine];
    let height = center[1] + FILLET;
    let profile = Pen::at(0.0, 0.0).line(edge[0], edge[1]).right(center, center[0], height).up();
    let contour = rectangle([55.0, 40.0], 14.0);
    let block = Sweep { frame: ground, contour: &contour, profile: &profile, solid: true };
    let block = block.make(part, &[], None);
    let pocket = Sweep {
        frame: ground,
        contour: &rectangle([32.0, 20.0], 8.0),
        profile: &Pen::at(3.0, 15.0).line(0.0, height).up(),
        solid: false,
    };
    let pocket = pocket.make(part, &[], None);
    let pin = Pen::at(9.0, 15.0).line(7.0, 32.0).line(0.0, 32.0).up();
    let pin = opening(part, ground, &pin);
    part.plane(&ground.moved([0.0, 0.0, 15.0]), &[pocket.below, pin]);
    part.plane(&ground.moved([0.0, 0.0, height]), &[block.above, pocket.above]);
    part.plane(&ground.reversed(), &[block.below]);
}

/// All nine general quadrics: a block with a saddle on top, on a foot of elliptic sections.
pub(super) fn quadrics(part: &mut Builder) {
    let ground = Frame::upright(0.0, 0.0, 0.0);
    let foot = quadric_foot(part);
    let mut contour = Pen::at(-40.0, -30.0).line(40.0, -30.0).up();
    contour.push(Curve::Root { square: [900.0, 0.0, 700.0 / 900.0], range: [-30.0, 30.0] });
    contour.extend(Pen::at(40.0, 30.0).line(-40.0, 30.0).up());
    contour.push(Curve::Parabola { vertex: -52.0, bend: -12.0 / 900.0, range: [30.0, -30.0] });
    // One sheet of a hyperboloid of two: r² = c ((z - 18)² - 6²), from r = 14 at the side.
    let c = 14.0 * 14.0 / (18.0 * 18.0 - 6.0 * 6.0);
    let two = Pen::at(14.0, 0.0).root([c * 288.0, -36.0 * c, c], 12.0).up();
    let frame = Frame::new([-8.0, -30.0, 24.0], Vector::x(), -Vector::y());
    let two = Lathe::stretched(frame, [1.0, 0.75]).turn(part, &two, &[]).swap_remove(0);
    // A hollow paraboloid: r² = k (z + 12).
    let k = 14.0 * 14.0 / 12.0;
    let bowl = Pen::at(14.0, 0.0).root([12.0 * k, k, 0.0], -12.0).up();
    let frame = Frame::new([6.0, 30.0, 24.0], Vector::x(), Vector::y());
    let bowl = Lathe::stretched(frame, [1.0, 0.7]).turn(part, &bowl, &[]).swap_remove(0);
    let (rise, fall, middle) = (1.0 / 160.0, 1.0 / 120.0, 50.0);
    let saddle = move |[x, y]: Point2| middle + x * x * rise - y * y * fall;
    let profile = Pen::at(0.0, 0.0).line(0.0, middle).up();
    let block = Sweep { frame: ground, contour: &contour, profile: &profile, solid: true };
    let Rims { below, above } = block.make(part, &[(0, two), (2, bowl)], Some(&saddle));
    let form = Vector::new(-rise, fall, 0.0);
    let surface = Surface::Quadric(in_frame(&ground, -middle, Vector::z(), form));
    let region = part.region(surface);
    part.lifted(region, &ground, &[above], |[x, y]| ground.at([x, y, saddle([x, y])]));
    part.plane(&ground.reversed(), &[below, foot]);
}

/// Elliptic cylinder, cone, hyperboloid and ellipsoid, one below the other.
fn quadric_foot(part: &mut Builder) -> Loop {
    let down = Frame::upright(0.0, 0.0, 0.0).reversed();
    let foot = Pen::at(26.0, 0.0).line(26.0, 14.0).line(22.0, 14.0).line(14.0, 30.0);
    // r² = 100 + 0.96 (z - 40)²: again 14 at z = 30.
    let foot = foot.root([100.0 + 0.96 * 1600.0, -0.96 * 80.0, 0.96], 52.0).line(24.0, 52.0);
    // r² = 24² (1 - (z - 52)² / 18²).
    let k = 576.0 / 324.0;
    let foot = foot.root([576.0 - k * 2704.0, k * 104.0, -k], 70.0).up();
    Lathe::stretched(down, [1.0, 0.65]).turn(part, &foot, &[]).swap_remove(0)
}

/// A pressed cup: one skin, open below, above and in its six bolt holes.
pub(super) fn open(part: &mut Builder) {
    let ground = Frame::upright(0.0, 0.0, 0.0);
    let holes: Vec<_> = (0..6)
        .map(|i| {
            let (sine, cosine) = (f64::from(i) / 6.0 * std::f64::consts::TAU).sin_cos();
            let skirt = Pen::at(4.0, 0.0).line(4.0, -6.0).up();
            (0, opening(part, Frame::upright(50.0 * cosine, 50.0 * sine, 0.0), &skirt))
        })
        .collect();
    let profile = Pen::at(60.0, 0.0).line(40.0, 0.0).right([40.0, 6.0], 34.0, 6.0);
    let profile = profile.line(34.0, 30.0).line(26.0, 50.0);
    let angle = 60f64.to_radians();
    let rim = [26.0 * angle.cos(), 50.0 + 26.0 * angle.sin()];
    let profile = profile.left([0.0, 50.0], rim[0], rim[1]).up();
    Lathe::new(ground).turn(part, &profile, &holes);
}

/// Turns a profile and returns the edge at which it begins.
fn opening(part: &mut Builder, frame: Frame, profile: &[Curve]) -> Loop {
    Lathe::new(frame).turn(part, profile, &[]).swap_remove(0)
}

/// A rectangle with rounded corners about the origin, counter-clockwise from its front side.
fn rectangle([x, y]: Point2, radius: f64) -> Vec<Curve> {
    let (u, v) = (x - radius, y - radius);
    let pen = Pen::at(-u, -y).line(u, -y).left([u, -v], x, -v).line(x, v).left([u, v], u, y);
    pen.line(-u, y).left([-u, v], -x, v).line(-x, -v).left([-u, -v], -u, -y).up()
}

fn corners(x: f64, y: f64) -> [(f64, f64); 4] {
    [(-x, -y), (x, -y), (x, y), (-x, y)]
}
