//! The generator: parts, noise, scans.

use numpy::IntoPyArray;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use quadrics::synth::{self, Part};

use crate::error::to_python;
use crate::mesh::rows_of_three;
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
