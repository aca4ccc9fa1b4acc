//! Into the unit cube along a part's own axes, so that it does not matter how it lies in its file.

use nalgebra::{Matrix3, Rotation3, UnitQuaternion};
use rayon::prelude::*;

use super::order::{Ordered, ordered};
use super::to_unit_cube;
use crate::error::Result;
use crate::math::{Point, Similarity, Vector};
use crate::mesh::{Geometry, Mesh};

/// A mesh in the unit cube, the former number of every face, and how it came there.
pub type Placed = (Mesh, Vec<u32>, Similarity);

/// The mesh in the unit cube of the input's axes, in an order of its own.
///
/// # Errors
/// Those of [`to_unit_cube`].
pub fn in_unit_cube(mesh: Mesh) -> Result<Placed> {
    let into = to_unit_cube(&mesh)?;
    let Ordered { mesh, former } = ordered(&moved(mesh, &into));
    Ok((mesh, former, into))
}

/// The same in the unit cube of the part's own axes: up to symmetries of the part, it does not matter
/// how it lies in the file.
///
/// # Errors
/// Those of [`to_unit_cube`].
pub fn in_own_cube(mesh: Mesh) -> Result<Placed> {
    // In order before anything is summed, so that the file's order does not show in the last digit.
    let (mesh, first, upright) = in_unit_cube(mesh)?;
    let turn: Similarity = nalgebra::convert(own_axes(&mesh));
    let (mut mesh, second, into) = in_unit_cube(moved(mesh, &turn))?;
    mesh.positions.par_iter_mut().for_each(|point| {
        point.coords.apply(|c| *c = (*c / GRID).round() * GRID);
    });
    let former = second.into_par_iter().map(|face| first[face as usize]).collect();
    Ok((mesh, former, into * turn * upright))
}

/// Coordinates are rounded to this fraction of the size, far below any scanner's: what rounding a
/// rotation leaves behind must not decide a tie.
const GRID: f64 = 1.0 / (1u64 << 30) as f64;

fn moved(mut mesh: Mesh, by: &Similarity) -> Mesh {
    mesh.positions.par_iter_mut().for_each(|point| *point = by * *point);
    mesh
}

/// The rotation into the principal axes of the mesh's area, longest first, each towards its heavier
/// tail (the third makes the frame right-handed). Symmetric parts have several such frames.
fn own_axes(mesh: &Mesh) -> UnitQuaternion<f64> {
    let geometry = Geometry::new(mesh);
    let weighted = || geometry.barycentres.iter().zip(&geometry.areas);
    let total: f64 = geometry.areas.iter().sum();
    let sum: Vector = weighted().map(|(p, area)| p.coords * *area).sum();
    let center = Point::from(sum / total);
    let scatter = weighted().map(|(p, a)| (p - center) * (p - center).transpose() * *a).sum();
    let eigen = Matrix3::symmetric_eigen(scatter);
    let mut longest = [0, 1, 2];
    longest.sort_by(|&i, &j| eigen.eigenvalues[j].total_cmp(&eigen.eigenvalues[i]));
    let towards_tail = |axis: Vector| {
        let skew: f64 = weighted().map(|(p, area)| axis.dot(&(p - center)).powi(3) * area).sum();
        if skew < 0.0 { -axis } else { axis }
    };
    let axis = |i: usize| towards_tail(eigen.eigenvectors.column(longest[i]).into_owned());
    let (first, second) = (axis(0), axis(1));
    let frame = Matrix3::from_columns(&[first, second, first.cross(&second)]);
    let rotation = Rotation3::from_matrix_unchecked(frame.transpose());
    // A mesh whose axes are not numbers stays as it lies.
    if frame.iter().all(|value| value.is_finite()) {
        UnitQuaternion::from_rotation_matrix(&rotation)
    } else {
        UnitQuaternion::identity()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synth;

    #[test]
    fn turned_in_any_way_a_part_comes_back_to_its_axes() {
        let mesh = synth::part("demo", 6_000).unwrap().mesh;
        let here = own_axes(&mesh);
        let turn = UnitQuaternion::from_euler_angles(0.4, -0.9, 2.1);
        let positions = mesh.positions.iter().map(|point| turn * point).collect();
        let there = own_axes(&Mesh { positions, faces: mesh.faces.clone() });
        assert!((there * turn).angle_to(&here) < 1e-9);
    }
}
