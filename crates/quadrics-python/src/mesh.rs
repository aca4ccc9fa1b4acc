//! Meshes: NumPy arrays to the core's and back.

use numpy::PyReadonlyArray2;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use quadrics::Mesh;
use quadrics::math::Point;

/// A mesh of the core, copied: the run goes on while Python may change its arrays.
pub fn mesh_from(
    positions: &PyReadonlyArray2<f64>,
    faces: &PyReadonlyArray2<u32>,
) -> PyResult<Mesh> {
    let (positions, faces) = (positions.as_array(), faces.as_array());
    if positions.ncols() != 3 || faces.ncols() != 3 {
        return Err(PyValueError::new_err("vertices must be (n, 3) and faces (m, 3)"));
    }
    Ok(Mesh {
        positions: positions.rows().into_iter().map(|p| Point::new(p[0], p[1], p[2])).collect(),
        faces: faces.rows().into_iter().map(|f| [f[0], f[1], f[2]]).collect(),
    })
}
