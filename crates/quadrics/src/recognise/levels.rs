//! Distances from the middle of a wall gather around its two sides.

use crate::surface::Plane;

/// Rounds of expectation and maximisation; the levels move by less than the noise after twenty.
const ROUNDS: usize = 60;
/// Levels closer than so many standard deviations of theirs cannot be told apart.
const APART: f64 = 2.0;
/// Two levels must explain the distances better than one by so many nats: their parameters cost three.
const BETTER: f64 = 5.0;

/// One level or two, and the standard deviation about them.
#[derive(Debug)]
pub struct Levels {
    at: [f64; 2],
    two: bool,
    /// Standard deviation about the nearer level.
    pub sigma: f64,
}

impl Levels {
    /// The planes at these levels of one, each looking away from the other.
    pub fn sides(&self, plane: &Plane) -> impl Iterator<Item = Plane> {
        let [low, high] = self.at;
        let below = Plane { normal: -plane.normal, offset: -(plane.offset + low) };
        let above = Plane { offset: plane.offset + high, ..plane.clone() };
        let sides = if self.two { vec![below, above] } else { vec![plane.clone()] };
        sides.into_iter()
    }
}

/// Levels of signed distances whose mean is 0: a mixture of two normal distributions of one width
/// (Dempster, Laird and Rubin, JRSS B 1977), where it pays.
pub fn levels(distances: Vec<f64>) -> Levels {
    let count = distances.len() as f64;
    let single = (distances.iter().map(|d| d * d).sum::<f64>() / count).sqrt();
    let (mut at, mut sigma, mut share) = ([-single, single], single / 2.0, 0.5);
    let density = |d: f64, at: f64, sigma: f64| (-0.5 * ((d - at) / sigma).powi(2)).exp() / sigma;
    let parts = |d: f64, at: [f64; 2], sigma: f64, share: f64| {
        [share * density(d, at[0], sigma), (1.0 - share) * density(d, at[1], sigma)]
    };
    for _ in 0..ROUNDS {
        let (mut weight, mut sum, mut squares) = ([0.0; 2], [0.0; 2], 0.0);
        for &d in &distances {
            let parts = parts(d, at, sigma, share);
            let total = (parts[0] + parts[1]).max(f64::MIN_POSITIVE);
            for i in 0..2 {
                weight[i] += parts[i] / total;
                sum[i] += parts[i] / total * d;
                squares += parts[i] / total * (d - at[i]).powi(2);
            }
        }
        at = [0, 1].map(|i| sum[i] / weight[i].max(f64::MIN_POSITIVE));
        sigma = (squares / count).sqrt().max(single * f64::EPSILON);
        share = weight[0] / count;
    }
    let log = |d: f64| {
        let [one, other] = parts(d, at, sigma, share);
        (one + other).max(f64::MIN_POSITIVE).ln()
            - density(d, 0.0, single).max(f64::MIN_POSITIVE).ln()
    };
    let gain: f64 = distances.iter().map(|&d| log(d)).sum();
    let two = gain > BETTER && at[1] - at[0] > APART * sigma;
    Levels { at, two, sigma: if two { sigma } else { single } }
}

#[cfg(test)]
mod tests {
    use rand::RngExt;

    use super::*;
    use crate::context::Context;
    use crate::math::{Unit, Vector};

    #[test]
    fn two_sides_of_a_wall_are_two_levels_and_one_is_one() {
        let mut rng = Context::new(3).rng;
        // A sum of twelve is as good as normal.
        let mut normal = || (0..12).map(|_| rng.random::<f64>() - 0.5).sum::<f64>();
        let mut around = |level: f64| level + 0.4 * normal();
        let wall: Vec<f64> =
            (0..2000).map(|i| around(if i % 2 == 0 { 0.8 } else { -0.8 })).collect();
        let plane = Plane { normal: Unit::new_unchecked(Vector::z()), offset: 10.0 };
        let sides: Vec<Plane> = levels(wall).sides(&plane).collect();
        assert!((sides[0].offset + 9.2).abs() < 0.1 && (sides[1].offset - 10.8).abs() < 0.1);
        assert_eq!(sides[0].normal, -sides[1].normal);
        let face: Vec<f64> = (0..2000).map(|_| around(0.0)).collect();
        assert_eq!(levels(face).sides(&plane).collect::<Vec<_>>(), [plane]);
    }
}
