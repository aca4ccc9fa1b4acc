//! What nearly holds, and why it was not imposed.

use nalgebra::DVector;

use super::gate;
use super::measure::{off_angle, off_axis, off_center, off_plane, off_radius, radius, tilt};
use super::position::Position;
use super::proposal::Part;
use super::report::Link;
use crate::surface::Surface;

/// What deviates less than this, in radians and sizes, is worth a word when it is refused.
pub const NEAR: f64 = 0.02;

/// One line for every class and the nearest other class of its kind that it nearly equals.
pub fn near_misses(part: &Part) -> Vec<Link> {
    let view = &part.view;
    let mut links = Vec::new();
    let classes = part.classes;
    let speakers = part.speakers(&classes.direction, |_| true);
    nearest(part, "parallel", &speakers, tilt, |i, j| tilted(part, i, j), &mut links);
    let places = |of: &dyn Fn(usize) -> Option<Position>, i: usize, j: usize| {
        let (one, other) = (of(i)?, of(j)?);
        (one.group == other.group).then(|| one.chi_squared(&other))
    };
    let lines = |i, j| places(&|k| view.axis(k), i, j);
    nearest(part, "coaxial", &part.lines(), off_axis, lines, &mut links);
    let planes = |i, j| places(&|k| view.plane(k), i, j);
    nearest(part, "coplanar", &part.planes(), off_plane, planes, &mut links);
    let first = |class: &[usize], member: &dyn Fn(&Surface) -> bool| {
        let has = |i: &usize| member(&part.surfaces[*i]) && (0..*i).all(|j| class[j] != class[*i]);
        (0..part.surfaces.len()).filter(has).collect::<Vec<_>>()
    };
    let balls = first(&classes.center, &|s| matches!(s, Surface::Sphere(_) | Surface::Torus(_)));
    let centers = |i, j| places(&|k| view.center(k), i, j);
    nearest(part, "concentric", &balls, off_center, centers, &mut links);
    let round = first(&classes.radius, &|s| radius(s).is_some());
    let radii = |i, j| places(&|k| view.radius(k), i, j);
    nearest(part, "equal_radius", &round, off_radius, radii, &mut links);
    let cones = first(&classes.angle, &|s| matches!(s, Surface::Cone(_)));
    let angles = |i, j| places(&|k| view.angle(k), i, j);
    nearest(part, "equal_angle", &cones, off_angle, angles, &mut links);
    links
}

/// Chi-squared and number of equations of two directions being one.
fn tilted(part: &Part, i: usize, j: usize) -> Option<(f64, usize)> {
    let (one, spread) = part.items[i].direction()?;
    let (other, more) = part.items[j].direction()?;
    let (u, v) = crate::math::frame(&one);
    let sign = one.dot(&other).signum();
    let g = DVector::from_vec(vec![u.dot(&other) * sign, v.dot(&other) * sign]);
    let total = spread + more;
    let seen =
        nalgebra::DMatrix::from_fn(2, 2, |a, b| [u, v][a].dot(&(total * [u, v][b].into_inner())));
    Some((g.dot(&seen.cholesky()?.solve(&g)), 2))
}

fn nearest(
    part: &Part,
    kind: &'static str,
    speakers: &[usize],
    measure: fn(&Surface, &Surface) -> f64,
    chi_squared: impl Fn(usize, usize) -> Option<(f64, usize)>,
    links: &mut Vec<Link>,
) {
    let angular = ["parallel", "equal_angle"].contains(&kind);
    let limit = if angular { NEAR.to_degrees() } else { NEAR };
    let free = |i: usize| &part.items[i].surface;
    for (at, &i) in speakers.iter().enumerate() {
        let near = speakers[at + 1..].iter().filter_map(|&j| {
            let apart = measure(&part.surfaces[i], &part.surfaces[j]);
            (apart < limit).then_some(())?;
            Some((apart, j, chi_squared(i, j)?))
        });
        let Some((after, j, (chi, count))) = near.min_by(|a, b| a.0.total_cmp(&b.0)) else {
            continue;
        };
        let most = gate::limit(count);
        let reason = if part.view.demands.forbids(kind, &[i, j]) {
            "the user forbids it".to_owned()
        } else if chi > most {
            format!("chi-squared would rise by {chi:.1}, at most {most:.1}")
        } else {
            format!("chi-squared {chi:.2} allows it, but chance explains it as well")
        };
        links.push(Link {
            kind,
            surfaces: vec![i, j],
            status: "refused",
            value: None,
            parameters: Vec::new(),
            before: measure(free(i), free(j)),
            after,
            angular,
            reason,
        });
    }
}
