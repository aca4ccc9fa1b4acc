//! Tori that start from the principal curvatures of a small patch.
//!
//! A few faces of a fillet show its tube but not the axis that it turns about, so that a start from an
//! axis ends beside it. On a torus of radii `R` and `r`, where the normal leaves the plane of the ring by
//! `θ`, the curvatures are `1 / r` along the tube's circle and `cos θ / (R + r cos θ)` across it: for
//! every `θ` that gives one torus.

use super::refine::centroid;
use super::select::LARGEST_RADIUS;
use super::start::{Samples, curvatures};
use super::{Surface, Torus};
use crate::math::{Unit, Vector};

/// Where on the tube a patch may lie, in radians (five turns are not enough).
const TURNS: [f64; 7] = [0.0, 0.5, -0.5, 1.0, -1.0, 1.35, -1.35];

/// The tori that touch the samples and bend as they do, their tubes the way they bend most.
pub fn tori(samples: Samples) -> impl Iterator<Item = Surface> {
    let touch = touch(samples);
    TURNS.into_iter().filter_map(move |turn| touch.as_ref()?.torus(turn))
}

/// Where the samples are and how they bend.
struct Touch {
    at: Vector,
    normal: Vector,
    /// The way that they bend most.
    along: Vector,
    /// Curvature that way, and across it.
    tube: f64,
    ring: f64,
}

fn touch(samples: Samples) -> Option<Touch> {
    let ([ring, tube], [_, along]) = curvatures(samples)?;
    let normal = Unit::try_new(samples.normals.iter().sum::<Vector>(), 1e-9)?;
    let along = Unit::try_new(along - normal.into_inner() * normal.dot(&along), 1e-9)?;
    let at = centroid(samples.points)?.coords;
    Some(Touch { at, normal: *normal, along: *along, tube, ring })
}

impl Touch {
    /// None where it would have no ring, or a larger one than any surface of a part.
    fn torus(&self, turn: f64) -> Option<Surface> {
        let outward = self.normal * turn.cos() + self.along * turn.sin();
        // Signed, like the curvatures.
        let minor = 1.0 / self.tube;
        let major = turn.cos() * (1.0 / self.ring - minor);
        let torus = Torus {
            center: (self.at - self.normal * minor - outward * major).into(),
            axis: Unit::new_normalize(self.along * turn.cos() - self.normal * turn.sin()),
            major_radius: major.abs(),
            minor_radius: minor.abs(),
        };
        (torus.minor_radius..LARGEST_RADIUS)
            .contains(&torus.major_radius)
            .then_some(Surface::Torus(torus))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Point;
    use crate::surface::{Shape, refine_within};

    /// A patch of a fillet: tube of 0.02 turning about the z axis at 0.18, seen from within or without.
    fn patch(turn: f64, side: f64) -> (Vec<Point>, Vec<Vector>) {
        let at = |i: usize, j: usize| {
            let (around, on) = (i as f64 * 0.1, turn + j as f64 * 0.25);
            let ring = Vector::new(around.cos(), around.sin(), 0.0);
            let normal = ring * on.cos() + Vector::z() * on.sin();
            (Point::from(ring * 0.18 + normal * 0.02), normal * side)
        };
        (0..4).flat_map(|i| (0..4).map(move |j| at(i, j))).unzip()
    }

    #[test]
    fn a_few_faces_of_a_fillet_show_its_torus() {
        for (turn, side) in [(-0.2, 1.0), (0.7, 1.0), (2.0, 1.0), (-1.1, -1.0), (2.6, -1.0)] {
            let (points, normals) = patch(turn, side);
            let samples = Samples { points: &points, barycentres: &points, normals: &normals };
            let fits = tori(samples).filter_map(|torus| refine_within(&torus, &points, &[], 200));
            let best = fits.min_by(|a, b| a.cost.total_cmp(&b.cost)).unwrap();
            let Surface::Torus(torus) = best.surface else { panic!("no torus") };
            assert!((torus.minor_radius - 0.02).abs() < 2e-4, "{turn}: {torus:?}");
            assert!((torus.major_radius - 0.18).abs() < 4e-3, "{turn}: {torus:?}");
            assert!(points.iter().all(|p| torus.distance(*p).abs() < 1e-5), "{turn}: {torus:?}");
        }
    }
}
