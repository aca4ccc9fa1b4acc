//! The similarity to the unit cube and back (paper, section 4.1).

use nalgebra::{Translation3, UnitQuaternion};

use crate::error::{Error, Result};
use crate::math::Similarity;
use crate::mesh::Mesh;

/// The similarity that takes the bounding box of `mesh` into `[0, 1]³`: its least corner to the
/// origin, its longest side to 1. Without rotation; the way back is its inverse.
///
/// # Errors
/// [`Error::Empty`] without faces, [`Error::Degenerate`] if all vertices coincide.
pub fn to_unit_cube(mesh: &Mesh) -> Result<Similarity> {
    let (low, high) = mesh.bounds().ok_or(Error::Empty)?;
    let scale = 1.0 / (high - low).max();
    if !scale.is_finite() {
        return Err(Error::Degenerate { faces: mesh.faces.len() });
    }
    let shift = Translation3::from(-low.coords * scale);
    Ok(Similarity::from_parts(shift, UnitQuaternion::identity(), scale))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Point;

    #[test]
    fn the_longest_side_becomes_one_and_the_way_back_is_exact() {
        let positions = vec![
            Point::new(1e3, -5.0, 2.0),
            Point::new(1e3 + 40.0, -5.0, 2.0),
            Point::new(1e3, 5.0, 7.0),
            // A vertex that no face uses does not count.
            Point::new(9e9, 0.0, 0.0),
        ];
        let mesh = Mesh { positions, faces: vec![[0, 1, 2]] };
        let to = to_unit_cube(&mesh).unwrap();
        let moved: Vec<_> = mesh.positions[..3].iter().map(|p| to * p).collect();
        assert!((moved[0] - Point::origin()).norm() < 1e-12);
        assert!((moved[1] - Point::new(1.0, 0.0, 0.0)).norm() < 1e-12);
        for (there, here) in moved.iter().zip(&mesh.positions) {
            assert!((to.inverse() * there - here).norm() < 1e-12 * 1e3);
        }
    }

    #[test]
    fn a_mesh_without_extent_is_refused() {
        let mesh = Mesh { positions: vec![Point::origin(); 3], faces: vec![[0, 1, 2]] };
        assert_eq!(to_unit_cube(&mesh), Err(Error::Degenerate { faces: 1 }));
        assert_eq!(to_unit_cube(&Mesh::default()), Err(Error::Empty));
    }
}
