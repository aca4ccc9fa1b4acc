//! Smooth random fields: how the errors of a scanner are alike at neighbouring points.

use std::f64::consts::TAU;

use rand::RngExt;

use super::noise::gaussian;
use crate::context::Context;
use crate::math::{Point, Vector};

/// Waves that are added up: enough to look normally distributed.
const WAVES: usize = 96;

/// A random function of space, of mean 0, variance 1 and one correlation length.
pub(super) struct Field {
    waves: Vec<(Vector, f64)>,
}

impl Field {
    /// Its values are alike within `length`: their correlation is `exp(-d² / 2 length²)`.
    pub(super) fn new(context: &mut Context, length: f64) -> Self {
        let mut wave = || {
            let direction = Vector::from_fn(|_, _| gaussian(context));
            (direction / length, context.rng.random_range(0.0..TAU))
        };
        Self { waves: (0..WAVES).map(|_| wave()).collect() }
    }

    /// The value at a point.
    pub(super) fn at(&self, point: Point) -> f64 {
        let sum: f64 =
            self.waves.iter().map(|(k, phase)| (k.dot(&point.coords) + phase).cos()).sum();
        sum * (2.0 / WAVES as f64).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_field_has_variance_one_and_its_correlation_length() {
        let mut context = Context::new(1);
        let (mut square, mut product, mut count) = (0.0, 0.0, 0.0);
        for _ in 0..200 {
            let field = Field::new(&mut context, 2.0);
            for i in 0..10 {
                let point = Point::new(50.0 * f64::from(i), 0.0, 0.0);
                let (here, there) = (field.at(point), field.at(point + Vector::y() * 2.0));
                square += here * here;
                product += here * there;
                count += 1.0;
            }
        }
        // 2000 nearly independent values: a standard error of 0.03.
        assert!((square / count - 1.0).abs() < 0.1, "{}", square / count);
        assert!((product / count - (-0.5f64).exp()).abs() < 0.1, "{}", product / count);
    }
}
