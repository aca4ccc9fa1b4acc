//! Planes among points that no mesh connects: the middles of walls.

use rand::RngExt;
use rayon::prelude::*;

use super::cells::Cells;
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

/// Neighbourhoods that are tried for one sheet; the one that grows largest is kept.
const TRIES: usize = 40;
/// Points that a neighbourhood must have.
const FEWEST_AROUND: usize = 20;
/// Points of a sheet.
const FEWEST: usize = 60;
/// A neighbourhood reaches so many edges around its point, and lies in a plane where its points are
/// within a sixth of that, root mean square.
const AROUND: f64 = 13.0;
const FLAT: f64 = 1.0 / 6.0;
/// Points within so many root mean squares are of the sheet. Those of two sides are one of them away,
/// and three quarters of what the sides err by remain.
const WITHIN: f64 = 2.0;
/// Rounds of growing and fitting.
const ROUNDS: usize = 6;
/// Two sheets are one where together they lie no further from their plane than either from its own, and
/// each lies on it.
const AS_FLAT: f64 = 1.15;
const BESIDE: f64 = 0.5;
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
    loop {
        context.step("sheets", 1.0 - left as f64 / points.len() as f64)?;
        let open: Vec<u32> = (0..points.len() as u32).filter(|&p| free[p as usize]).collect();
        if open.len() < FEWEST {
            break;
        }
        let seeds: Vec<u32> =
            (0..TRIES).map(|_| open[context.rng.random_range(0..open.len())]).collect();
        let grown = seeds.par_iter().filter_map(|&seed| grow(points, cells, &free, seed, edge));
        let size = |sheet: &Sheet| (sheet.points.len(), std::cmp::Reverse(sheet.points[0]));
        let Some(best) = grown.max_by_key(size).filter(|best| best.points.len() >= FEWEST) else {
            break;
        };
        best.points.iter().for_each(|&p| free[p as usize] = false);
        left -= best.points.len();
        sheets.push(best);
    }
    unite(points, &Cells::new(points, GAP * edge), &mut sheets);
    Ok(sheets)
}

/// What grows from the neighbourhood of a point.
fn grow(points: &[Point], cells: &Cells, free: &[bool], seed: u32, edge: f64) -> Option<Sheet> {
    let center = points[seed as usize];
    let radius = AROUND * edge;
    let near = |p: u32| free[p as usize] && (points[p as usize] - center).norm() < radius;
    let mut own = cells.reach(seed, near);
    if own.len() < FEWEST_AROUND {
        return None;
    }
    let (mut plane, mut rms) = fit(points, &own)?;
    if rms > FLAT * radius {
        return None;
    }
    for _ in 0..ROUNDS {
        let within = WITHIN * rms;
        let belongs =
            |p: u32| free[p as usize] && plane.distance(points[p as usize]).abs() < within;
        let from = own.iter().copied().find(|&p| belongs(p))?;
        own = cells.reach(from, belongs);
        if own.len() < FEWEST_AROUND {
            return None;
        }
        (plane, rms) = fit(points, &own)?;
    }
    own.sort_unstable();
    Some(Sheet { plane, points: own })
}

/// The plane of least squares, and the root mean square distance from it.
fn fit(points: &[Point], own: &[u32]) -> Option<(Plane, f64)> {
    let own: Vec<Point> = own.iter().map(|&p| points[p as usize]).collect();
    let samples = Samples { points: &own, barycentres: &[], normals: &[] };
    let Surface::Plane(plane) = start::plane(samples)? else { return None };
    let rms = rms(&plane, own.iter().copied());
    Some((plane, rms))
}

fn rms(plane: &Plane, points: impl ExactSizeIterator<Item = Point>) -> f64 {
    let count = points.len() as f64;
    (points.map(|p| plane.distance(p).powi(2)).sum::<f64>() / count).sqrt()
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
    let (plane, whole) = fit(points, &own)?;
    let at = |sheet: &Sheet| sheet.points.iter().map(|&p| points[p as usize]).collect::<Vec<_>>();
    let parts = [one, other].map(|sheet| (sheet, at(sheet)));
    let flat = parts.iter().map(|(sheet, at)| rms(&sheet.plane, at.iter().copied()));
    let flattest = flat.fold(0.0, f64::max);
    let mean = |at: &[Point]| at.iter().map(|&p| plane.distance(p)).sum::<f64>() / at.len() as f64;
    let on_it = parts.iter().all(|(_, at)| mean(at).abs() < BESIDE * flattest);
    (on_it && whole < AS_FLAT * flattest).then_some(Sheet { plane, points: own })
}
