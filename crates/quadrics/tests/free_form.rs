//! Free-form patches on clean meshes: whole, and parted where curvature jumps.

use quadrics::math::Point;
use quadrics::mesh::Mesh;
use quadrics::{Context, Options};

/// Squares along each side.
const SIDE: usize = 70;

/// Where the points of a square of side 1 lie.
fn sheet(place: impl Fn(f64, f64) -> Point) -> Mesh {
    let at = |i: usize| i as f64 / SIDE as f64;
    let vertex = |i: usize, j: usize| (i * (SIDE + 1) + j) as u32;
    let squares = (0..SIDE).flat_map(|i| (0..SIDE).map(move |j| (i, j)));
    Mesh {
        positions: (0..=SIDE)
            .flat_map(|i| (0..=SIDE).map(move |j| (i, j)))
            .map(|(i, j)| place(at(i), at(j)))
            .collect(),
        faces: squares
            .flat_map(|(i, j)| {
                let [a, b, c, d] =
                    [vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)];
                [[a, b, c], [a, c, d]]
            })
            .collect(),
    }
}

/// Regions of more than a tenth of the faces by type, and the share that they cover, largest first.
fn regions(mesh: &Mesh) -> Vec<(&'static str, f64)> {
    let found = quadrics::segment(&mut Context::new(0), mesh, &Options::default(), None).unwrap();
    let share = |faces: usize| faces as f64 / mesh.faces.len() as f64;
    let all = found.regions.iter().map(|r| (r.surface.type_name(), share(r.faces)));
    let mut large: Vec<_> = all.filter(|region| region.1 > 0.1).collect();
    large.sort_by(|a, b| b.1.total_cmp(&a.1));
    large
}

/// Waves that no quadric is.
fn waves(x: f64, y: f64) -> f64 {
    0.05 * (5.0 * x).sin() * (4.0 * y).cos() + 0.03 * (7.0 * x * y).sin()
}

#[test]
fn a_smooth_sheet_is_one_patch() {
    let found = regions(&sheet(|x, y| Point::new(x, y, waves(x, y))));
    assert_eq!(found[0].0, "freeform");
    assert!(found[0].1 > 0.95, "{found:?}");
}

#[test]
fn two_sheets_that_are_tangent_are_two_patches() {
    let step = |x: f64| 8.0 * (x - 0.5).max(0.0).powi(2);
    let found = regions(&sheet(|x, y| Point::new(x, y, waves(x, y) + step(x))));
    assert!(found.iter().all(|region| region.0 == "freeform" && region.1 > 0.45), "{found:?}");
    assert_eq!(found.len(), 2);
}

/// A third of a bend turns, with as much straight pipe before and behind it.
#[test]
fn a_bend_so_wide_that_it_hardly_turns_is_a_torus_between_two_cylinders() {
    const RING: f64 = 1.2;
    const TUBE: f64 = 0.1;
    let found = regions(&sheet(|x, y| {
        let (turn, straight) = (x.clamp(1.0 / 3.0, 2.0 / 3.0), x - x.clamp(1.0 / 3.0, 2.0 / 3.0));
        let (sin, cos) = (turn / RING).sin_cos();
        let (out, up) = ((3.0 * y).cos() * TUBE + RING, (3.0 * y).sin() * TUBE);
        Point::new(out * cos - straight * sin, out * sin + straight * cos, up)
    }));
    let mut types: Vec<&str> = found.iter().map(|region| region.0).collect();
    types.sort_unstable();
    assert_eq!(types, ["cylinder", "cylinder", "torus"], "{found:?}");
}
