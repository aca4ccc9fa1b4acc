//! Whether noisy points show a blend of two walls, or a chamfer.
//!
//! By least distances a blend beats the chamfer that is there: it hugs the corners that the chamfer makes
//! with both walls, where points stray to either side. So a point may come from any place of the section,
//! one wall, the band and the other wall, and its likelihood is the mean over all of them.

use super::blend::Ball;
use super::curve::{Curve, Flat};

/// Points count that are no farther from the corner than so many times what the blend spans, and sigmas.
const FAR: (f64, f64) = (2.2, 2.0);
/// The walls end so many sigmas behind them.
const BEYOND: f64 = 3.0;
/// Radii that are tried, each larger by the factor, from so many steps below the blend's to so many above.
const LARGER: f64 = 1.5;
const STEPS: std::ops::RangeInclusive<i32> = -3..=2;
/// Parabolas that refine the best, and the step, as a logarithm, below which it is known.
const PARABOLAS: usize = 4;
const KNOWN: f64 = 3e-3;
/// Pieces of an arc.
const PIECES: usize = 6;
/// What points of other surfaces count at least: as those beyond four sigmas.
const STRAY: f64 = 1e-3;
/// Exponents above this are nothing beside that.
const NOTHING: f64 = 15.0;

/// A radius and the log-likelihood of what has it.
#[derive(Clone, Copy)]
struct Tried {
    radius: f64,
    likelihood: f64,
}

/// From the best of three to the vertex of the parabola through all, as a logarithm of radii.
fn to_vertex(below: Tried, best: Tried, above: Tried) -> f64 {
    let way = |to: Tried| (to.radius / best.radius).ln();
    let slope = |to: Tried| (best.likelihood - to.likelihood) / way(to);
    let bend = (slope(above) - slope(below)) / (way(above) - way(below));
    let start = slope(below) - bend * way(below);
    if bend > 0.0 { -start / (2.0 * bend) } else { 0.0 }
}

/// Points about the corner of two walls, in the plane across it.
pub struct Section<'a, B> {
    /// The ball of a radius that touches both walls.
    ball: &'a B,
    /// Radius of the blend.
    radius: f64,
    /// Where the walls end.
    ends: [Flat; 2],
    points: Vec<Flat>,
    sigma: f64,
}

impl<'a, B: Fn(f64) -> Option<Ball>> Section<'a, B> {
    /// Of some points those around a corner, as far as a blend of this radius asks.
    pub fn new(
        ball: &'a B,
        radius: f64,
        corner: Flat,
        mut points: Vec<Flat>,
        sigma: f64,
    ) -> Option<Self> {
        let feet = ball(radius)?.feet();
        let spans = feet.map(|foot| (foot - corner).norm()).into_iter().fold(0.0, f64::max);
        let far = FAR.0 * spans + FAR.1 * sigma;
        points.retain(|p| (p - corner).norm() < far);
        let end = far + BEYOND * sigma;
        // Walls bend little on so short a way; where no ball is so large, they go on straight.
        let ends = ball(radius * end / spans).map_or(feet, |ball| ball.feet());
        let ends = ends.map(|foot| corner + (foot - corner).normalize() * end);
        Some(Self { ball, radius, ends, points, sigma })
    }

    /// The chord of the likeliest chamfer, and the logarithm of how much likelier it is than any blend.
    pub fn cut(&self) -> Option<(Curve, f64)> {
        let (cut, round) = (self.likeliest(false)?, self.likeliest(true)?);
        let [one, other] = (self.ball)(cut.radius)?.feet();
        let way = (other - one).normalize();
        let normal = Flat::new(-way.y, way.x);
        let chord = Curve::Line { normal, offset: normal.dot(&one) };
        Some((chord, cut.likelihood - round.likelihood))
    }

    /// The likeliest blend, or the chamfer between the feet of a ball: by successive parabolas.
    fn likeliest(&self, round: bool) -> Option<Tried> {
        let try_out = |radius: f64| {
            Some(Tried { radius, likelihood: self.likelihood(&self.path(radius, round)?) })
        };
        let radii = STEPS.map(|step| self.radius * LARGER.powi(step));
        let tried: Vec<Tried> = radii.filter_map(try_out).collect();
        let better = |&i: &usize, &j: &usize| tried[i].likelihood.total_cmp(&tried[j].likelihood);
        let at = (0..tried.len()).max_by(better)?;
        if at == 0 || at + 1 == tried.len() {
            return Some(tried[at]);
        }
        let [mut below, mut best, mut above] = [tried[at - 1], tried[at], tried[at + 1]];
        for _ in 0..PARABOLAS {
            let step = to_vertex(below, best, above);
            if step.abs() < KNOWN {
                break;
            }
            let new = try_out(best.radius * step.exp())?;
            let (one, other) = if step < 0.0 { (new, best) } else { (best, new) };
            (below, best, above) = if one.likelihood > other.likelihood {
                (below, one, other)
            } else {
                (one, other, above)
            };
        }
        Some(best)
    }

    /// From the end of one wall to that of the other, along the arc of a ball or the chord of its feet.
    fn path(&self, radius: f64, round: bool) -> Option<Vec<Flat>> {
        let ball = (self.ball)(radius)?;
        let [from, to] = ball.touches;
        let turn = from.angle(&to);
        let on = |k: usize| {
            let share = k as f64 / PIECES as f64;
            let way = from * ((1.0 - share) * turn).sin() + to * (share * turn).sin();
            ball.center + way / turn.sin()
        };
        let pieces = if round { 1..PIECES } else { 0..0 };
        let ([start, end], [one, other]) = (self.ends, ball.feet());
        Some([start, one].into_iter().chain(pieces.map(on)).chain([other, end]).collect())
    }

    /// Log-likelihood, up to a constant, of points that stray from a path.
    fn likelihood(&self, path: &[Flat]) -> f64 {
        let narrow = 1.0 / (std::f64::consts::SQRT_2 * self.sigma);
        let ways = path.windows(2).map(|ends| (ends[0], ends[1] - ends[0]));
        let pieces: Vec<_> = ways.map(|(from, way)| (from, way.normalize(), way.norm())).collect();
        let length: f64 = pieces.iter().map(|piece| piece.2).sum();
        let density = |point: &Flat| {
            let near = |&(from, way, length): &(Flat, Flat, f64)| {
                let away = point - from;
                let (along, across) = (way.dot(&away), way.perp(&away) * narrow);
                if across * across > NOTHING {
                    return 0.0;
                }
                let share = libm::erf((length - along) * narrow) + libm::erf(along * narrow);
                (-across * across).exp() * share
            };
            (pieces.iter().map(near).sum::<f64>() + STRAY).ln()
        };
        self.points.iter().map(density).sum::<f64>() - self.points.len() as f64 * length.ln()
    }
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64Mcg;

    use super::super::blend::Walls;
    use super::super::{Plane, Surface};
    use crate::math::{Point, Vector};

    const SIGMA: f64 = 0.003;
    const LEG: f64 = 0.02;
    const RADIUS: f64 = 0.03;

    /// Points of the edge of x = 0 and y = 0, both outward, that a chamfer or a fillet takes away.
    fn edge(round: bool, seed: u64) -> Vec<Point> {
        let mut rng = Pcg64Mcg::seed_from_u64(seed);
        let on = |t: f64| {
            let far = t.abs();
            let (near, away) = match (round, far) {
                // Angle from the bisector, on an arc that touches both walls.
                (true, _) if far < RADIUS * std::f64::consts::FRAC_PI_4 => {
                    let turn = std::f64::consts::FRAC_PI_4 - far / RADIUS;
                    (RADIUS * (turn.cos() - 1.0), RADIUS * (turn.sin() - 1.0))
                }
                (true, _) => (0.0, -RADIUS - far + RADIUS * std::f64::consts::FRAC_PI_4),
                (false, _) if far < LEG / std::f64::consts::SQRT_2 => {
                    let way = far / std::f64::consts::SQRT_2;
                    (way - LEG / 2.0, -way - LEG / 2.0)
                }
                (false, _) => (0.0, -LEG - far + LEG / std::f64::consts::SQRT_2),
            };
            if t < 0.0 { (near, away) } else { (away, near) }
        };
        let mut stray = || SIGMA * ((0..12).map(|_| rng.random::<f64>()).sum::<f64>() - 6.0);
        let steps = (-40..=40).flat_map(|i| (0..8).map(move |j| (i, j)));
        let points = steps.map(|(i, j)| {
            let (x, y) = on(f64::from(i) * 0.002);
            Point::new(x + stray(), y + stray(), f64::from(j) * 0.01 + stray())
        });
        points.collect()
    }

    /// What a blend of the walls of an edge loses to a chamfer.
    fn gain(points: &[Point]) -> f64 {
        let wall = |normal| Surface::Plane(Plane::through(Point::origin(), normal));
        let (one, other) = (wall(Vector::x_axis()), wall(Vector::y_axis()));
        let walls = Walls::new([(&one, 1.0), (&other, 1.0)], Point::origin()).unwrap();
        let in_band = |p: &&Point| (p.x + p.y) < -0.01 && p.x.min(p.y) > -LEG;
        let band: Vec<Point> = points.iter().filter(in_band).copied().collect();
        let blend = walls.nearest(&band, 0.005).unwrap();
        let cut = walls.chamfer(&blend, points, SIGMA).unwrap();
        assert!(matches!(cut.surface, Surface::Plane(_)), "{:?}", cut.surface);
        cut.gain
    }

    #[test]
    fn noise_does_not_hide_whether_an_edge_is_rounded_or_cut() {
        for seed in 0..10 {
            let (cut, round) = (gain(&edge(false, seed)), gain(&edge(true, seed)));
            assert!(cut > 0.0 && round < 0.0, "{seed}: {cut} {round}");
        }
    }
}
