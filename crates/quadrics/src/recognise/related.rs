//! What surfaces cost that stand in directions and about axes that others show: a narrow fillet that noise let
//! pass for a plane, or a bore that passed for a cone, is told by that.

use super::scene::{Gathered, Scene};
use crate::surface::Surface;
use crate::surface::select::{Choice, Evidence, agreement, judge, plausible};

/// Mean cosine to the face normals that a related surface may lose: a tube through two rows of
/// vertices fits them, but lies across their faces.
pub(super) const TURNED: f64 = 0.05;

/// The criterion of a surface, less what the scene shows of it.
pub fn priced(scene: &Scene, surface: Surface, gathered: &Gathered, evidence: Evidence) -> Choice {
    let (held, among) = scene.shown.held(&surface);
    let mut choice = judge(surface, gathered.samples(), gathered.total, evidence);
    // Whoever picks one of several pays for the choice.
    let price = held * evidence.samples(gathered.total).ln() - (among as f64).ln();
    choice.criterion -= 2.0 * price;
    choice
}

/// The best of some related surfaces, if it is better than `bound` and the faces' normals agree with it nearly
/// as well as with `than`.
pub fn best(
    scene: &Scene,
    gathered: &Gathered,
    evidence: Evidence,
    than: &Surface,
    mut bound: f64,
    related: impl Iterator<Item = Surface>,
) -> Option<Choice> {
    let samples = gathered.samples();
    let least = agreement(than, samples) - TURNED;
    let mut best = None;
    for surface in related {
        let choice = priced(scene, surface, gathered, evidence);
        if choice.criterion < bound
            && plausible(&choice.surface, samples, evidence)
            && agreement(&choice.surface, samples) > least
        {
            bound = choice.criterion;
            best = Some(choice);
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::super::scene::Marks;
    use super::*;
    use crate::math::{Point, Vector};
    use crate::mesh::{Mesh, Working};
    use crate::surface::related::Shown;
    use crate::surface::{Plane, select};

    const SIGMA: f64 = 0.004;
    const ALONG: u32 = 16;
    const ACROSS: u32 = 5;

    /// A quarter of a bore along z, whose vertices stray by sigma.
    fn fillet() -> Mesh {
        let at = |i: u32, j: u32| {
            let turn = f64::from(j) * std::f64::consts::FRAC_PI_2 / f64::from(ACROSS - 1);
            // Of no order that a surface could follow.
            let stray = f64::from((i * 7 + j * 11 + i * j * 5) % 17) / 8.0 - 1.0;
            let radius = 0.05 + 1.7 * SIGMA * stray;
            Point::new(radius * turn.cos(), radius * turn.sin(), f64::from(i) * 0.02)
        };
        let corner = |i: u32, j: u32| i * ACROSS + j;
        let quads = (0..ALONG - 1).flat_map(|i| (0..ACROSS - 1).map(move |j| (i, j)));
        let faces = quads.flat_map(|(i, j)| {
            let [a, b] = [corner(i, j), corner(i, j + 1)];
            let [c, d] = [corner(i + 1, j), corner(i + 1, j + 1)];
            [[a, b, c], [b, d, c]]
        });
        let positions = (0..ALONG).flat_map(|i| (0..ACROSS).map(move |j| at(i, j))).collect();
        Mesh { positions, faces: faces.collect() }
    }

    #[test]
    fn a_fillet_that_passes_for_a_plane_is_told_by_the_direction_of_its_walls() {
        let working = Working::new(fillet());
        let mut scene = Scene::raw(&working);
        scene.evidence =
            // So noisy that the arc hides in it.
            Evidence { sigma: 2.2 * SIGMA, independent: 1.0, normal_sigma: 0.3, general: false };
        let faces: Vec<u32> = (0..working.len() as u32).collect();
        let gathered = scene.samples(&faces, 200, &mut Marks::default());
        let free = select::choose(gathered.samples(), gathered.total, scene.evidence).remove(0);
        assert!(matches!(free.surface, Surface::Plane(_)), "{free:?}");
        let told = |scene: &Scene| {
            let (than, bound) = (&free.surface, free.criterion);
            let related = scene.shown.nearest(&gathered.points);
            best(scene, &gathered, scene.evidence, than, bound, related).map(|c| c.surface)
        };
        assert_eq!(told(&scene), None);
        let top = Plane::through(Point::new(0.0, 0.0, 0.3), Vector::z_axis());
        scene.shown = Shown::by(&vec![Surface::Plane(top); 3]);
        let Some(Surface::Cylinder(found)) = told(&scene) else { panic!("{:?}", told(&scene)) };
        assert!((found.radius - 0.05).abs() < 0.01, "{found:?}");
    }
}
