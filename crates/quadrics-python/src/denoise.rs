//! `denoise` and `deviation`: meshes in, positions and distances out.

use numpy::{IntoPyArray, PyArray2, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use quadrics::Surface;
use quadrics::{denoise as core, evaluate};

use crate::error::to_python;
use crate::mesh::{mesh_from, rows_of_three};
use crate::surface::{Flat, build};

/// Positions without the noise; `labels` are places in `surfaces`, `None` is free-form.
#[pyfunction]
pub fn denoise<'py>(
    py: Python<'py>,
    positions: PyReadonlyArray2<'py, f64>,
    faces: PyReadonlyArray2<'py, u32>,
    labels: PyReadonlyArray1<'py, i32>,
    surfaces: Vec<Option<Flat>>,
    sigma: f64,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let mesh = mesh_from(py, &positions, &faces)?;
    let labels: Vec<u32> = labels.as_array().iter().map(|&label| label as u32).collect();
    let surface = |flat: Option<Flat>| match flat {
        Some((kind, numbers)) => build(&kind, &numbers),
        None => Ok(Surface::FreeForm),
    };
    let surfaces = surfaces.into_iter().map(surface).collect::<PyResult<Vec<_>>>()?;
    let moved = py
        .detach(|| core::denoise(&mesh, &labels, &surfaces, sigma))
        .map_err(|error| to_python(py, &error))?;
    Ok(rows_of_three(moved.iter().flat_map(|p| [p.x, p.y, p.z]).collect()).into_pyarray(py))
}

/// Distances between two meshes, both ways.
#[pyfunction]
pub fn deviation<'py>(
    py: Python<'py>,
    positions: PyReadonlyArray2<'py, f64>,
    faces: PyReadonlyArray2<'py, u32>,
    reference_positions: PyReadonlyArray2<'py, f64>,
    reference_faces: PyReadonlyArray2<'py, u32>,
) -> PyResult<Bound<'py, PyDict>> {
    let mesh = mesh_from(py, &positions, &faces)?;
    let reference = mesh_from(py, &reference_positions, &reference_faces)?;
    let found = py
        .detach(|| evaluate::deviation(&mesh, &reference))
        .map_err(|error| to_python(py, &error))?;
    let dict = PyDict::new(py);
    dict.set_item("hausdorff", found.hausdorff)?;
    dict.set_item("mean", found.mean)?;
    dict.set_item("of_vertex", found.of_vertex.into_pyarray(py))?;
    Ok(dict)
}
