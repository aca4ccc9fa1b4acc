//! The algebraic fit of a quadric (Taubin 1991) and the plane of least squares, from moments.
//!
//! Taubin minimises `∫ f² / ∫ |∇f|²`, which is eq. 3 with the gradient taken out of the integral:
//! a generalised eigenproblem of size nine once the constant is eliminated.

use nalgebra::{Matrix3, SMatrix, SVector};

use super::moments::{Moments, Normalised};
use super::{Plane, Quadric};
use crate::math::{Unit, Vector};

/// Squared gradients below this fraction of the largest cannot be told from rounding: a quadric
/// that is flat all over the region (a double plane on a plane) is none that fits it.
const FLAT: f64 = 1e-10;
/// Mean squared distances (in squared extents of the region) that rounding alone produces.
const ROUNDING: f64 = 1e-13;

/// The plane of least squared distance, on the side of the normals; `None` without area.
pub fn plane(moments: &Moments) -> Option<Plane> {
    let covariance = moments.covariance();
    if !covariance.iter().all(|value| value.is_finite()) {
        return None;
    }
    let eigen = covariance.symmetric_eigen();
    let thin = eigen.eigenvectors.column(eigen.eigenvalues.imin()).into_owned();
    let outward = if thin.dot(&moments.oriented_area()) < 0.0 { -thin } else { thin };
    let normal = Unit::try_new(outward, f64::MIN_POSITIVE)?;
    Some(Plane::through(moments.centroid(), normal))
}

/// The stationary quadrics of Taubin's fit, their gradients on the side of the normals, the best
/// first; none without area.
///
/// Nearly always the first is the one that is wanted. But `∫ |∇f|²` can come from few points: a
/// plane with a rim is fitted by a double plane, which has a gradient on the rim alone. Which one
/// is best under eq. 3 only a look at the faces can tell.
pub fn quadrics(moments: &Moments) -> Vec<Quadric> {
    moments.normalised().and_then(|region| stationary(&region)).unwrap_or_default()
}

/// The first of [`quadrics`].
pub fn quadric(moments: &Moments) -> Option<Quadric> {
    quadrics(moments).into_iter().next()
}

fn stationary(region: &Normalised) -> Option<Vec<Quadric>> {
    // The constant has no gradient: its best value given the others is minus their mean.
    let means = region.values.fixed_view::<9, 1>(1, 0).into_owned();
    let values = region.values.fixed_view::<9, 9>(1, 1) - means * means.transpose();
    let gradients = region.gradients.fixed_view::<9, 9>(1, 1).into_owned();
    let along = region.along_normals.fixed_view::<9, 1>(1, 0).into_owned();
    let in_world = |best: SVector<f64, 9>| {
        let coefficients = SVector::<f64, 10>::from_fn(|i, _| match i {
            0 => -means.dot(&best),
            _ => best[i - 1],
        });
        in_world(coefficients * best.dot(&along).signum(), region)
    };
    let minima = oriented_minima(values, whitening(gradients)?, along);
    Some(minima.into_iter().map(in_world).collect())
}

type Nine = SMatrix<f64, 9, 9>;

/// `W` with `Wᵀ N W = 1` on the quadrics that have a gradient, and 0 on those that have none.
fn whitening(gradients: Nine) -> Option<Nine> {
    let eigen = gradients.symmetric_eigen();
    let least = FLAT * eigen.eigenvalues.max();
    let stretch = eigen.eigenvalues.map(|v| if v > least { v.sqrt().recip() } else { 0.0 });
    stretch
        .iter()
        .all(|s| s.is_finite())
        .then(|| eigen.eigenvectors * Nine::from_diagonal(&stretch))
}

/// The nine stationary quadrics of `∫ f² / ∫ |∇f|²` in the order of `∫ f² / (∫ ∇f · n)²`.
///
/// Through a noisy plane the first of the former is a pair of planes, one on each side of the
/// cloud: its gradient runs with the normals half of the time and against them the other half, so
/// that its mean along them vanishes.
fn oriented_minima(values: Nine, whiten: Nine, along: SVector<f64, 9>) -> Vec<SVector<f64, 9>> {
    let eigen = (whiten.transpose() * values * whiten).symmetric_eigen();
    let mut minima: Vec<_> = (0..9)
        .map(|i| (whiten * eigen.eigenvectors.column(i), eigen.eigenvalues[i].max(0.0) + ROUNDING))
        .map(|(vector, error)| (vector, error / vector.dot(&along).powi(2)))
        .filter(|(_, cost)| cost.is_finite())
        .collect();
    minima.sort_by(|one, other| one.1.total_cmp(&other.1));
    minima.into_iter().map(|(vector, _)| vector).collect()
}

/// From the region's own coordinates to those of the mesh.
fn in_world(c: SVector<f64, 10>, region: &Normalised) -> Quadric {
    let (constant, linear, form): (f64, Vector, Matrix3<f64>) =
        Quadric { coefficients: c.into() }.parts();
    let (linear, form) = (linear / region.extent, form / region.extent.powi(2));
    let centre = region.centre.coords;
    let pull = form * centre;
    Quadric::from_parts(constant - centre.dot(&(linear - pull)), linear - pull * 2.0, form)
}

#[cfg(test)]
mod tests {
    use rand::RngExt;

    use super::*;
    use crate::context::Context;
    use crate::math::Point;
    use crate::math::triangle::Triangle;
    use crate::surface::{Cone, Cylinder, Shape, Sphere, Surface};

    /// Small triangles whose corners lie on a surface; `noise` is their size.
    fn on(surface: &Surface, middle: Point, reach: f64, noise: f64) -> Moments {
        let mut rng = Context::new(2).rng;
        let mut draw = |far: f64| Vector::from_fn(|_, _| rng.random_range(-far..far));
        let mut moments = Moments::about(middle);
        for _ in 0..500 {
            let near = middle + draw(reach);
            let mut corner = || {
                let foot = surface.project(near + draw(1e-5)).unwrap();
                let normal = surface.normal(foot).unwrap().into_inner();
                foot + normal * draw(1.0).x * noise
            };
            let corners = [corner(), corner(), corner()];
            let normal = surface.normal(corners[0]).unwrap().into_inner();
            moments.add(&[Triangle { corners, normal, area: 1.0 }]);
        }
        moments
    }

    fn shapes() -> Vec<Surface> {
        let axis = Unit::new_normalize(Vector::new(0.3, -0.5, 0.8));
        let center = Point::new(0.6, 0.3, 0.4);
        vec![
            Surface::Sphere(Sphere { center, radius: 0.2 }),
            Surface::Cylinder(Cylinder { point: center, axis, radius: 0.1 }),
            Surface::Cone(Cone { apex: center - axis.into_inner() * 0.5, axis, half_angle: 0.4 }),
            Surface::Quadric(Quadric::about(
                center,
                -0.02,
                Matrix3::new(1., 0., 0., 0., 2., 0., 0., 0., 0.5),
            )),
        ]
    }

    #[test]
    fn a_quadric_is_recovered_from_its_own_patches() {
        for surface in shapes() {
            let middle = Point::new(0.6, 0.4, 0.4);
            let found = quadric(&on(&surface, middle, 0.15, 0.0)).unwrap();
            let mut rng = Context::new(9).rng;
            for _ in 0..50 {
                let near = middle + Vector::from_fn(|_, _| rng.random_range(-0.15..0.15));
                let foot = surface.project(near).unwrap();
                // Triangles of 1e-5 cut a corner of 1e-9.
                assert!(found.distance(foot).abs() < 1e-7, "{surface:?}: {}", found.distance(foot));
                let along = found.gradient(foot).dot(&surface.normal(foot).unwrap());
                assert!(along > 0.0, "{surface:?}");
            }
        }
    }

    #[test]
    fn a_noisy_plane_does_not_become_a_pair_of_planes() {
        let normal = Unit::new_normalize(Vector::new(1.0, 2.0, 2.0));
        let middle = Point::new(0.2, 0.9, 0.4);
        let surface = Surface::Plane(Plane::through(middle, normal));
        let moments = on(&surface, middle, 0.3, 0.005);
        let found = quadric(&moments).unwrap();
        let gradient = found.gradient(middle).normalize();
        assert!(gradient.dot(&normal) > 0.99, "{gradient}");
        assert!(plane(&moments).unwrap().normal.dot(&normal) > 0.9999);
    }

    #[test]
    fn without_area_there_is_no_surface() {
        let moments = Moments::about(Point::origin());
        assert_eq!((plane(&moments), quadric(&moments)), (None, None));
    }
}
