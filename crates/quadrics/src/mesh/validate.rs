//! Is a mesh usable? The first reason why not.

use rayon::prelude::*;

use super::Mesh;
use super::repair::is_flat;
use crate::error::{Error, Result};
use crate::math::Point;

/// Beyond it, squares and volumes overflow; no length unit leads there.
pub const LARGEST_COORDINATE: f64 = 1e100;

/// The first reason why nothing can be made of `mesh`, in the order of [`Error`]'s variants.
///
/// What no face uses does not count: a NaN in such a vertex is only reported as a repair.
///
/// # Errors
/// [`Error::Empty`], [`Error::PointsOnly`], [`Error::IndexOutOfRange`], [`Error::NotFinite`] (also
/// beyond [`LARGEST_COORDINATE`]) or [`Error::Degenerate`].
pub fn validate(mesh: &Mesh) -> Result<()> {
    let vertices = mesh.positions.len();
    match (mesh.faces.is_empty(), vertices) {
        (true, 0) => return Err(Error::Empty),
        (true, vertices) => return Err(Error::PointsOnly { vertices }),
        _ => check_indices(&mesh.faces, vertices)?,
    }
    let usable =
        |corners: &[u32; 3]| corners.iter().all(|&v| is_usable(&mesh.positions[v as usize]));
    if !mesh.faces.par_iter().all(usable) {
        return Err(Error::NotFinite { vertex: first_unusable(mesh) });
    }
    if (0..mesh.faces.len()).all(|face| is_flat(mesh.corners(face))) {
        return Err(Error::Degenerate { faces: mesh.faces.len() });
    }
    Ok(())
}

/// That every face refers to vertices that exist.
///
/// # Errors
/// [`Error::IndexOutOfRange`] with the first that does not.
pub fn check_indices(faces: &[[u32; 3]], vertices: usize) -> Result<()> {
    let bad = |corners: &[u32; 3]| corners.iter().find(|&&v| v as usize >= vertices).copied();
    match faces.iter().enumerate().find_map(|(face, corners)| Some((face, bad(corners)?))) {
        Some((face, vertex)) => {
            Err(Error::IndexOutOfRange { face, vertex: i64::from(vertex), vertices })
        }
        None => Ok(()),
    }
}

pub(crate) fn is_usable(position: &Point) -> bool {
    // A NaN compares false, too.
    position.iter().all(|x| x.abs() < LARGEST_COORDINATE)
}

/// By vertex, not by face: that is what the user looks for in the file.
fn first_unusable(mesh: &Mesh) -> usize {
    let used = mesh.faces.iter().flatten().map(|&v| v as usize);
    used.filter(|&v| !is_usable(&mesh.positions[v])).min().unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mesh(positions: &[[f64; 3]], faces: &[[u32; 3]]) -> Mesh {
        Mesh {
            positions: positions.iter().copied().map(Point::from).collect(),
            faces: faces.to_vec(),
        }
    }

    const CORNER: [[f64; 3]; 4] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [f64::NAN; 3]];

    #[test]
    fn the_first_reason_is_given_with_its_place() {
        assert_eq!(validate(&Mesh::default()), Err(Error::Empty));
        assert_eq!(validate(&mesh(&CORNER, &[])), Err(Error::PointsOnly { vertices: 4 }));
        let out = Error::IndexOutOfRange { face: 1, vertex: 9, vertices: 4 };
        assert_eq!(validate(&mesh(&CORNER, &[[0, 1, 2], [0, 9, 3]])), Err(out));
        assert_eq!(
            validate(&mesh(&CORNER, &[[0, 1, 2], [0, 1, 3]])),
            Err(Error::NotFinite { vertex: 3 })
        );
        let flat = mesh(&CORNER, &[[0, 0, 1], [1, 2, 1]]);
        assert_eq!(validate(&flat), Err(Error::Degenerate { faces: 2 }));
    }

    #[test]
    fn a_nan_that_no_face_uses_does_no_harm() {
        assert_eq!(validate(&mesh(&CORNER, &[[0, 1, 2]])), Ok(()));
    }

    #[test]
    fn a_mesh_is_usable_in_any_unit() {
        for unit in [1e-60, 1e-9, 1.0, 1e9, 1e60] {
            let scaled = CORNER.map(|p| p.map(|x| x * unit));
            assert_eq!(validate(&mesh(&scaled, &[[0, 1, 2]])), Ok(()), "{unit}");
        }
        let huge = CORNER.map(|p| p.map(|x| x * 1e200));
        assert_eq!(validate(&mesh(&huge, &[[0, 1, 2]])), Err(Error::NotFinite { vertex: 1 }));
    }
}
