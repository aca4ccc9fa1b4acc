//! The rasteriser, for `quadrics.picture`.

use numpy::ndarray::Array3;
use numpy::{IntoPyArray, PyArray3, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use quadrics::math::Vector;
use quadrics::render::View;

use crate::mesh::{colours_from, mesh_from};

/// Draws a mesh, one colour, normal and label a face: pixels (height, width, 3).
#[pyfunction]
#[allow(clippy::too_many_arguments)] // Keyword arguments in Python.
pub fn render<'py>(
    py: Python<'py>,
    positions: PyReadonlyArray2<'py, f64>,
    faces: PyReadonlyArray2<'py, u32>,
    colours: PyReadonlyArray2<'py, u8>,
    normals: PyReadonlyArray2<'py, f64>,
    labels: PyReadonlyArray1<'py, i32>,
    toward_eye: [f64; 3],
    width: usize,
    height: usize,
) -> PyResult<Bound<'py, PyArray3<u8>>> {
    let mesh = mesh_from(py, &positions, &faces)?;
    let colours = colours_from(&colours)?;
    let normals: Vec<Vector> =
        normals.as_array().rows().into_iter().map(|n| Vector::new(n[0], n[1], n[2])).collect();
    let labels = labels.as_array().to_vec();
    let count = mesh.faces.len();
    if colours.len() != count || normals.len() != count || labels.len() != count {
        return Err(PyValueError::new_err("one colour, normal and label a face are needed"));
    }
    let view = View { toward_eye: Vector::from(toward_eye), width, height };
    let pixels = py.detach(|| quadrics::render::render(&mesh, &colours, &normals, &labels, &view));
    let shape = (height, width, 3);
    let pixels = Array3::from_shape_vec(shape, pixels.into_flattened()).expect("as many as asked");
    Ok(pixels.into_pyarray(py))
}
