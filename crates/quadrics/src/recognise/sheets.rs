//! Planes among points that no mesh connects: the middles of walls.

use rand::RngExt;
use rayon::prelude::*;

use super::cells::Cells;
use super::levels::{Levels, levels};
use crate::context::Context;
use crate::error::Result;
use crate::math::Point;
use crate::surface::start::{self, Samples};
use crate::surface::{Plane, Shape, Surface};

/// A plane and the points about it.
#[derive(Debug)]
pub struct Sheet {
    pub plane: Plane,
    pub points: Vec<u32>,
}

impl Sheet {
    /// The levels that its points lie at.
    pub fn levels(&self, points: &[Point]) -> Levels {
        levels(self.points.iter().map(|&p| self.plane.distance(points[p as usize])).collect())
    }
}

/// Neighbourhoods that are tried for one sheet; what saves most is kept: of the largest many are bent.
const TRIES: usize = 40;
/// Points that a neighbourhood must have.
const FEWEST_AROUND: usize = 20;
/// Points of a sheet.
const FEWEST: usize = 60;
/// A neighbourhood reaches so many edges around its point.
const AROUND: f64 = 13.0;
/// Edges that half of a sheet's points keep within of its plane: only walls thinner than an edge come out
/// in shreds.
const THIN: f64 = 0.5;
/// What no sheet explains may lie so many edges off it.
const STRAY: f64 = 2.0;
/// Points within so many medians of the distances are of the sheet: those of two sides are one of them
/// away, and what three standard deviations of a sixth of an edge leave.
const WITHIN: f64 = 2.2;
/// Rounds of growing and fitting.
const ROUNDS: usize = 6;
/// Two sheets are one where either lies so flat on the plane of both, as the less flat one on its own.
const AS_FLAT: f64 = 1.3;
/// They may be so many times further apart than the shreds of one.
const GAP: f64 = 3.0;

/// The sheets of `points`, largest first, until no more are found.
///
/// # Errors
/// Cancellation.
pub fn find(
    context: &mut Context,
    points: &[Point],
    cells: &Cells,
    edge: f64,
) -> Result<Vec<Sheet>> {
    let mut free = vec![true; points.len()];
    let mut left = points.len();
    let mut sheets = Vec::new();
    // What comes after draws as if this had not been tried.
    let mut rng = context.rng.clone();
    loop {
        context.step("sheets", 1.0 - left as f64 / points.len() as f64)?;
        let open: Vec<u32> = (0..points.len() as u32).filter(|&p| free[p as usize]).collect();
        if open.len() < FEWEST {
            break;
        }
        let seeds: Vec<u32> = (0..TRIES).map(|_| open[rng.random_range(0..open.len())]).collect();
        let grown = seeds.par_iter().filter_map(|&seed| grow(points, cells, &free, seed, edge));
        // What a description of the points by their sheet saves, in nats.
        let saved =
            |grown: &Grown| grown.sheet.points.len() as f64 * (STRAY * edge / grown.thickness).ln();
        let better = |one: &Grown, other: &Grown| saved(one).total_cmp(&saved(other));
        let large = grown.filter(|grown| grown.sheet.points.len() >= FEWEST);
        let Some(Grown { sheet: best, .. }) = large.max_by(better) else { break };
        best.points.iter().for_each(|&p| free[p as usize] = false);
        left -= best.points.len();
        sheets.push(best);
    }
    unite(points, &Cells::new(points, GAP * edge), &mut sheets);
    Ok(sheets)
}

struct Grown {
    sheet: Sheet,
    thickness: f64,
}

/// What grows from the neighbourhood of a point.
fn grow(points: &[Point], cells: &Cells, free: &[bool], seed: u32, edge: f64) -> Option<Grown> {
    let center = points[seed as usize];
    let radius = AROUND * edge;
    let near = |p: u32| free[p as usize] && (points[p as usize] - center).norm() < radius;
    let mut own = cells.reach(seed, near);
    if own.len() < FEWEST_AROUND {
        return None;
    }
    let (mut plane, mut thickness) = fit(points, &own)?;
    // A wall is as thick everywhere: what grows thicker bends.
    let thickest = thickness;
    for _ in 0..ROUNDS {
        let within = WITHIN * thickness.min(thickest);
        let belongs =
            |p: u32| free[p as usize] && plane.distance(points[p as usize]).abs() < within;
        let from = own.iter().copied().find(|&p| belongs(p))?;
        own = cells.reach(from, belongs);
        if own.len() < FEWEST_AROUND {
            return None;
        }
        (plane, thickness) = fit(points, &own)?;
    }
    own.sort_unstable();
    let thin = thickness < THIN * edge;
    thin.then_some(Grown { sheet: Sheet { plane, points: own }, thickness })
}

/// The plane of least squares, and the median distance from it.
fn fit(points: &[Point], own: &[u32]) -> Option<(Plane, f64)> {
    let own: Vec<Point> = own.iter().map(|&p| points[p as usize]).collect();
    let samples = Samples { points: &own, barycentres: &[], normals: &[] };
    let Surface::Plane(plane) = start::plane(samples)? else { return None };
    let mut far: Vec<f64> = own.iter().map(|&p| plane.distance(p).abs()).collect();
    let middle = far.len() / 2;
    let (_, &mut median, _) = far.select_nth_unstable_by(middle, f64::total_cmp);
    Some((plane, median))
}

/// Makes one of sheets that a hole or a gap has parted.
fn unite(points: &[Point], wide: &Cells, sheets: &mut Vec<Sheet>) {
    let mut i = 1;
    while i < sheets.len() {
        let joined = (0..i).find_map(|j| {
            let (one, other) = (&sheets[j], &sheets[i]);
            let near = wide.touch(&one.points, &other.points);
            Some((j, near.then(|| together(points, one, other))??))
        });
        match joined {
            Some((j, sheet)) => {
                sheets.remove(i);
                sheets[j] = sheet;
                i = 1;
            }
            None => i += 1,
        }
    }
}

fn together(points: &[Point], one: &Sheet, other: &Sheet) -> Option<Sheet> {
    let mut own = one.points.clone();
    own.extend(&other.points);
    own.sort_unstable();
    let (plane, _) = fit(points, &own)?;
    let rms = |plane: &Plane, sheet: &Sheet| {
        let squares = sheet.points.iter().map(|&p| plane.distance(points[p as usize]).powi(2));
        (squares.sum::<f64>() / sheet.points.len() as f64).sqrt()
    };
    let flattest = rms(&one.plane, one).max(rms(&other.plane, other));
    let flat = [one, other].iter().all(|sheet| rms(&plane, sheet) < AS_FLAT * flattest);
    flat.then_some(Sheet { plane, points: own })
}

#[cfg(test)]
mod tests {
    use rand::RngExt;

    use super::*;
    use crate::math::Vector;

    #[test]
    fn two_walls_at_an_angle_are_two_sheets_of_two_levels() {
        let edge = 0.01;
        let mut context = Context::new(7);
        let mut rng = Context::new(1).rng;
        let mut points = Vec::new();
        for i in 0..4000 {
            let side = if i % 2 == 0 { 0.3 } else { -0.3 };
            let off = edge * (side + 0.3 * (rng.random::<f64>() - 0.5));
            let (along, up) = (rng.random::<f64>(), rng.random::<f64>());
            // Strips with gaps of two edges.
            let along = ((along * 10.0).floor() + 0.8 * along.fract()) / 10.0;
            points.push(if i < 2400 {
                Point::new(along, up, off)
            } else {
                Point::new(off - 0.1, along, up + 0.1)
            });
        }
        let sheets = find(&mut context, &points, &Cells::new(&points, edge), edge).unwrap();
        let large: Vec<&Sheet> = sheets.iter().filter(|sheet| sheet.points.len() > 1000).collect();
        assert_eq!(large.len(), 2);
        for (sheet, normal) in large.iter().zip([Vector::z(), Vector::x()]) {
            assert!(sheet.plane.normal.dot(&normal).abs() > 0.9999);
            let sides: Vec<Plane> = sheet.levels(&points).sides(&sheet.plane).collect();
            assert_eq!(sides.len(), 2);
            assert!((sides[0].offset + sides[1].offset - 0.6 * edge).abs() < 0.1 * edge);
        }
    }
}
