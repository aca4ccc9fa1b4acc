//! The generator: parts, noise, scans.

use numpy::{IntoPyArray, PyArray2, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use quadrics::Context;
use quadrics::mesh::validate;
use quadrics::synth::{self, Noise, Part};

use crate::error::to_python;
use crate::mesh::{mesh_from, rows_of_three};
use crate::surface;

/// Names of the parts.
#[pyfunction]
pub fn part_names() -> Vec<&'static str> {
    synth::names().to_vec()
}

/// The part of that name with about `faces` faces.
#[pyfunction]
pub fn part<'py>(py: Python<'py>, name: &str, faces: usize) -> PyResult<Bound<'py, PyDict>> {
    let part = py.detach(|| synth::part(name, faces)).map_err(|error| to_python(py, &error))?;
    describe(py, part)
}

/// New positions of the vertices of a mesh, with the noise of eq. 5.
#[pyfunction]
pub fn noise<'py>(
    py: Python<'py>,
    positions: PyReadonlyArray2<'py, f64>,
    faces: PyReadonlyArray2<'py, u32>,
    sigma: f64,
    ratio: f64,
    seed: u64,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let mesh = mesh_from(&positions, &faces)?;
    let noisy = py.detach(|| {
        // An index without a vertex would be our fault further down.
        validate(&mesh)?;
        synth::add_noise(&mut Context::new(seed), &mesh, &Noise::uniform(sigma, ratio))
    });
    let noisy = noisy.map_err(|error| to_python(py, &error))?;
    let positions = noisy.positions.iter().flat_map(|p| [p.x, p.y, p.z]).collect();
    Ok(rows_of_three(positions).into_pyarray(py))
}

fn describe(py: Python<'_>, part: Part) -> PyResult<Bound<'_, PyDict>> {
    let dict = PyDict::new(py);
    let surfaces: PyResult<Vec<_>> =
        part.surfaces.iter().map(|s| surface::describe(py, s)).collect();
    let positions = part.mesh.positions.iter().flat_map(|p| [p.x, p.y, p.z]).collect();
    dict.set_item("positions", rows_of_three(positions).into_pyarray(py))?;
    dict.set_item("faces", rows_of_three(part.mesh.faces.into_flattened()).into_pyarray(py))?;
    dict.set_item("labels", part.labels.into_pyarray(py))?;
    dict.set_item("surfaces", PyList::new(py, surfaces?)?)?;
    Ok(dict)
}
