//! The axes of a part itself, so that it does not matter how it lies in its file.

use nalgebra::{Matrix3, Rotation3, UnitQuaternion};

use super::to_unit_cube;
use crate::error::Result;
use crate::math::{Point, Similarity, Vector};
use crate::mesh::{Geometry, Mesh};

/// The similarity that takes a mesh, turned into its own axes, into the unit cube.
///
/// # Errors
/// Those of [`to_unit_cube`].
pub fn to_own_cube(mesh: &Mesh) -> Result<Similarity> {
    // In two steps: the third powers of large coordinates might overflow.
    let first = to_unit_cube(mesh)?;
    let moved = |mesh: &Mesh, by: &Similarity| Mesh {
        positions: mesh.positions.iter().map(|point| by * point).collect(),
        faces: mesh.faces.clone(),
    };
    let upright = moved(mesh, &first);
    let turn = nalgebra::convert(own_axes(&upright));
    Ok(to_unit_cube(&moved(&upright, &turn))? * turn * first)
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
