//! The noise of a scan: waves that neighbours share, and what every vertex errs on its own.
//!
//! Vertices a distance `d` apart err together by `wave² exp(-d² / 2 length²)`. A surface fitted to
//! them hides a part of that: its residuals are `R e` for the errors `e`, where `R` projects onto
//! what no change of its parameters explains. So products of residuals, by distance, are compared
//! with what waves of each length would leave of them (a variogram, as in kriging, seen through `R`).

use nalgebra::{DMatrix, Matrix2, Vector2};

use super::Surface;
use super::condensed::rows;
use crate::math::Point;

/// How the vertices of a scan err.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Waves {
    /// Standard deviation of the waves.
    pub wave: f64,
    /// Their length, in the unit of the points.
    pub length: f64,
    /// Standard deviation of what a vertex errs on its own.
    pub own: f64,
}

/// Regions that are heard, the largest, and points of each.
const REGIONS: usize = 12;
const POINTS: usize = 100;
/// Upper ends of the classes of distances, in sizes; the first has the points themselves.
const CLASSES: [f64; 11] = [1e-9, 0.015, 0.03, 0.045, 0.06, 0.08, 0.1, 0.13, 0.17, 0.22, 0.3];
/// Lengths that are tried, in sizes.
const LENGTHS: [f64; 8] = [0.01, 0.015, 0.02, 0.03, 0.04, 0.06, 0.08, 0.12];
/// By so many times what a vertex errs on its own it errs where edges are rounded, as those that
/// triangles cross are; small regions have little else. Measured on the scans of 23 shapes: so the
/// tilts of planes and cylinders of all sizes err by 0.8 to 1.3 of their sigmas in the root mean
/// square, without it those of fewer than 120 faces by 2.1 to 2.4.
const ROUNDED: f64 = 3.0;

/// Sums of products over one class of distances.
#[derive(Clone, Copy, Default)]
struct Class {
    pairs: f64,
    seen: f64,
    /// What independent errors, and waves of every length, leave, each of variance one.
    own: f64,
    waves: [f64; LENGTHS.len()],
}

impl Waves {
    /// From the residuals of surfaces and the points that they were fitted to, in sizes; `None` where
    /// no region has enough of them.
    pub fn measure(fits: &[(&Surface, &[Point])]) -> Option<Self> {
        let mut large: Vec<_> = fits.iter().filter(|(_, points)| points.len() >= POINTS).collect();
        large.sort_by_key(|(_, points)| std::cmp::Reverse(points.len()));
        let mut classes = [Class::default(); CLASSES.len()];
        large
            .iter()
            .take(REGIONS)
            .for_each(|(surface, points)| hear(surface, points, &mut classes));
        let best = (0..LENGTHS.len()).filter_map(|at| explained(&classes, at));
        best.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, waves)| waves)
    }

    /// Covariance of the errors of some of so many points.
    pub fn covariance(&self, heard: &[Point], points: usize) -> DMatrix<f64> {
        let share = heard.len() as f64 / points.max(1) as f64;
        let own = (ROUNDED * self.own).powi(2) * share;
        let mut spread = together(heard, self.length) * self.wave.powi(2);
        (0..heard.len()).for_each(|i| spread[(i, i)] += own);
        spread
    }

    /// Mean squared residual of a surface over what these errors leave.
    pub fn misfit(&self, surface: &Surface, points: &[Point]) -> f64 {
        let squares: f64 = points.iter().filter_map(|p| surface.distance(*p)).map(|d| d * d).sum();
        let expected = self.wave.powi(2) + self.own.powi(2);
        squares / points.len().max(1) as f64 / expected.max(f64::MIN_POSITIVE)
    }
}

/// Correlation of waves of a length at some points.
fn together(points: &[Point], length: f64) -> DMatrix<f64> {
    let fall = |a: Point, b: Point| (-(a - b).norm_squared() / (2.0 * length * length)).exp();
    DMatrix::from_fn(points.len(), points.len(), |i, j| fall(points[i], points[j]))
}

/// Adds the products of one region's residuals.
fn hear(surface: &Surface, points: &[Point], classes: &mut [Class]) {
    let Some((rows, heard)) = rows(surface, points, POINTS) else { return };
    let Some(factor) = (rows.transpose() * &rows).cholesky() else { return };
    let count = heard.len();
    let rest = DMatrix::identity(count, count) - &rows * factor.solve(&rows.transpose());
    let left = LENGTHS.map(|length| &rest * together(&heard, length) * &rest);
    let away: Vec<f64> = heard.iter().map(|p| surface.distance(*p).unwrap_or(0.0)).collect();
    for (i, j) in (0..count).flat_map(|i| (0..count).map(move |j| (i, j))) {
        let distance = (heard[i] - heard[j]).norm();
        let Some(at) = CLASSES.iter().position(|end| distance < *end) else { continue };
        let class = &mut classes[at];
        class.pairs += 1.0;
        class.seen += away[i] * away[j];
        class.own += rest[(i, j)];
        class.waves.iter_mut().zip(&left).for_each(|(sum, left)| *sum += left[(i, j)]);
    }
}

/// The variances under which waves of one length leave what was seen, by least squares over the
/// classes, each as good as the root of its pairs; and the squares that remain.
fn explained(classes: &[Class], length: usize) -> Option<(f64, Waves)> {
    let (mut normal, mut right) = (Matrix2::zeros(), Vector2::zeros());
    let heard = || classes.iter().filter(|class| class.pairs > 0.0);
    for class in heard() {
        let row = Vector2::new(class.own, class.waves[length]);
        normal += row * row.transpose() / class.pairs;
        right += row * class.seen / class.pairs;
    }
    let variances = normal.try_inverse()? * right;
    let variances = variances.map(|value| value.max(0.0));
    let off = |class: &Class| {
        let model = class.own * variances.x + class.waves[length] * variances.y;
        (model - class.seen).powi(2) / class.pairs
    };
    let (wave, own) = (variances.y.sqrt(), variances.x.sqrt());
    let found = Waves { wave, length: LENGTHS[length], own };
    (wave > 0.0 || own > 0.0).then(|| (heard().map(off).sum(), found))
}

#[cfg(test)]
mod tests {
    use rand::RngExt;

    use super::*;
    use crate::context::Context;
    use crate::math::Vector;
    use crate::surface::{Condensed, Plane, refine};

    const WAVES: Waves = Waves { wave: 1e-3, length: 0.06, own: 5e-4 };

    fn normal(context: &mut Context) -> f64 {
        (0..12).map(|_| context.rng.random_range(-0.5..0.5)).sum()
    }

    /// A plane with errors: a sum of waves of random directions and phases, and a rest.
    fn scanned(context: &mut Context, size: f64, count: usize) -> (Surface, Vec<Point>) {
        let waves: Vec<(Vector, f64)> = (0..128)
            .map(|_| {
                let way = Vector::from_fn(|_, _| normal(context)) / WAVES.length;
                (way, context.rng.random_range(0.0..std::f64::consts::TAU))
            })
            .collect();
        let points: Vec<Point> = (0..count)
            .map(|_| {
                let [x, y] = [(); 2].map(|()| context.rng.random_range(-size / 2.0..size / 2.0));
                let at = Vector::new(x, y, 0.0);
                let sum: f64 = waves.iter().map(|(way, phase)| (way.dot(&at) + phase).cos()).sum();
                let height =
                    WAVES.wave * sum * (2.0f64 / 128.0).sqrt() + WAVES.own * normal(context);
                Point::new(x, y, height)
            })
            .collect();
        let plane = Surface::Plane(Plane::through(Point::origin(), Vector::z_axis()));
        (refine(&plane, &points, &[]).expect("a plane").surface, points)
    }

    #[test]
    fn waves_are_found_from_what_fits_leave() {
        let context = &mut Context::new(3);
        let scans: Vec<_> = (0..12).map(|_| scanned(context, 0.4, 2000)).collect();
        let fits: Vec<_> = scans.iter().map(|(s, points)| (s, points.as_slice())).collect();
        let found = Waves::measure(&fits).expect("waves");
        assert!((0.04..=0.08).contains(&found.length), "{found:?}");
        assert!((found.wave / WAVES.wave - 1.0).abs() < 0.25, "{found:?}");
        assert!((found.own / WAVES.own - 1.0).abs() < 0.25, "{found:?}");
    }

    #[test]
    fn planes_under_waves_err_as_their_covariance_says() {
        let context = &mut Context::new(5);
        let waves = Waves { own: WAVES.own / ROUNDED, ..WAVES };
        let runs = 200;
        let square = |context: &mut Context| {
            let (plane, points) = scanned(context, 0.15, 200);
            let known = Condensed::under(&plane, &points, &waves).expect("a plane");
            let truth = Surface::Plane(Plane::through(Point::origin(), Vector::z_axis()));
            let off = known.coordinates(&truth).expect("a plane");
            off.dot(&(&known.information * &off)) / 3.0
        };
        let mean = (0..runs).map(|_| square(context)).sum::<f64>() / f64::from(runs);
        assert!((0.75..1.35).contains(&mean), "{mean}");
    }
}
