//! The generator: parts, noise, scans.

use numpy::{IntoPyArray, PyArray2, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use quadrics::Context;
use quadrics::synth::{self, Distribution, Noise, Part, Scanner};

use crate::error::to_python;
use crate::mesh::{mesh_from, rows_of_three};
use crate::{context, surface};

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

/// A scan of a part; `surfaces` are pairs of a type and its numbers.
#[pyfunction]
#[allow(clippy::too_many_arguments)] // Keyword arguments in Python.
pub fn scan<'py>(
    py: Python<'py>,
    positions: PyReadonlyArray2<'py, f64>,
    faces: PyReadonlyArray2<'py, u32>,
    labels: PyReadonlyArray1<'py, u32>,
    surfaces: Vec<(String, Vec<f64>)>,
    scanner: &Bound<'py, PyDict>,
    seed: u64,
    progress: Option<Py<PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let surfaces: PyResult<Vec<_>> =
        surfaces.iter().map(|(kind, numbers)| surface::build(kind, numbers)).collect();
    let part = Part {
        mesh: mesh_from(py, &positions, &faces)?,
        labels: labels.as_array().to_vec(),
        surfaces: surfaces?,
    };
    let number = |name: &str| scanner.as_any().get_item(name);
    let scanner = Scanner {
        faces: number("faces")?.extract()?,
        waviness: number("waviness")?.extract()?,
        wavelength: number("wavelength")?.extract()?,
        jitter: number("jitter")?.extract()?,
        density: number("density")?.extract()?,
        holes: number("holes")?.extract()?,
        hole_radius: number("hole_radius")?.extract()?,
    };
    let scan =
        context::run(py, seed, progress, move |context| synth::scan(context, &part, &scanner))?;
    describe(py, scan)
}

/// The scanner of the core, for the test that compares it with Python's.
#[pyfunction]
pub fn default_scanner(py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
    let scanner = Scanner::default();
    let dict = PyDict::new(py);
    dict.set_item("faces", scanner.faces)?;
    dict.set_item("waviness", scanner.waviness)?;
    dict.set_item("wavelength", scanner.wavelength)?;
    dict.set_item("jitter", scanner.jitter)?;
    dict.set_item("density", scanner.density)?;
    dict.set_item("holes", scanner.holes)?;
    dict.set_item("hole_radius", scanner.hole_radius)?;
    Ok(dict)
}

/// New positions of the vertices of a mesh, with the noise of eq. 5 or of section 5.5.
#[pyfunction]
pub fn noise<'py>(
    py: Python<'py>,
    positions: PyReadonlyArray2<'py, f64>,
    faces: PyReadonlyArray2<'py, u32>,
    sigma: f64,
    ratio: f64,
    gaussian: bool,
    seed: u64,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let mesh = mesh_from(py, &positions, &faces)?;
    let distribution = if gaussian { Distribution::Gaussian } else { Distribution::Uniform };
    let noise = Noise { sigma, ratio, distribution };
    let noisy = py.detach(|| synth::add_noise(&mut Context::new(seed), &mesh, &noise));
    let noisy = noisy.map_err(|error| to_python(py, &error))?;
    let positions = noisy.positions.iter().flat_map(|p| [p.x, p.y, p.z]).collect();
    Ok(rows_of_three(positions).into_pyarray(py))
}

fn describe(py: Python<'_>, part: Part) -> PyResult<Bound<'_, PyDict>> {
    let dict = PyDict::new(py);
    let size = part.mesh.size();
    let surfaces: PyResult<Vec<_>> =
        part.surfaces.iter().map(|s| surface::describe(py, s, size)).collect();
    let positions = part.mesh.positions.iter().flat_map(|p| [p.x, p.y, p.z]).collect();
    dict.set_item("positions", rows_of_three(positions).into_pyarray(py))?;
    dict.set_item("faces", rows_of_three(part.mesh.faces.into_flattened()).into_pyarray(py))?;
    dict.set_item("labels", part.labels.into_pyarray(py))?;
    dict.set_item("surfaces", PyList::new(py, surfaces?)?)?;
    Ok(dict)
}
