//! Meshes: NumPy arrays to the core's and back.

use numpy::ndarray::Array2;
use numpy::{IntoPyArray, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use quadrics::math::Point;
use quadrics::result::Repair;
use quadrics::{Mesh, format, mesh};

use crate::error::to_python;

/// A mesh of the core, copied: the run goes on while Python may change its arrays.
///
/// # Errors
/// `InputError` for an index without a vertex: whatever follows may rely on them.
pub fn mesh_from(
    py: Python<'_>,
    positions: &PyReadonlyArray2<f64>,
    faces: &PyReadonlyArray2<u32>,
) -> PyResult<Mesh> {
    let (positions, faces) = (positions.as_array(), faces.as_array());
    if positions.ncols() != 3 || faces.ncols() != 3 {
        return Err(PyValueError::new_err("vertices must be (n, 3) and faces (m, 3)"));
    }
    let mesh = Mesh {
        positions: positions.rows().into_iter().map(|p| Point::new(p[0], p[1], p[2])).collect(),
        faces: faces.rows().into_iter().map(|f| [f[0], f[1], f[2]]).collect(),
    };
    mesh::check_indices(&mesh.faces, mesh.positions.len())
        .map_err(|error| to_python(py, &error))?;
    Ok(mesh)
}

/// Reads the bytes of a file; `open` answers with those of a file that it names, or `None`.
#[pyfunction]
pub fn read<'py>(
    py: Python<'py>,
    extension: &str,
    bytes: &[u8],
    open: Py<PyAny>,
) -> PyResult<Bound<'py, PyDict>> {
    let mut fault = None;
    let loaded = py.detach(|| {
        let mut ask = |name: &str| {
            let answer = Python::attach(|py| open.call1(py, (name,))?.extract(py));
            answer.unwrap_or_else(|error| {
                fault = Some(error);
                None
            })
        };
        format::read(extension, bytes, &mut ask)
    });
    // What the callable raised says more than that the file was not there.
    if let Some(error) = fault {
        return Err(error);
    }
    let loaded = loaded.map_err(|error| to_python(py, &error))?;
    let dict = PyDict::new(py);
    let whole = loaded.input_faces.count == loaded.mesh.faces.len();
    let parent = (!whole).then(|| loaded.input_faces.of_triangle.into_pyarray(py));
    let positions = loaded.mesh.positions.iter().flat_map(|p| [p.x, p.y, p.z]).collect();
    dict.set_item("positions", rows_of_three(positions).into_pyarray(py))?;
    dict.set_item("faces", rows_of_three(loaded.mesh.faces.into_flattened()).into_pyarray(py))?;
    dict.set_item("parent", parent)?;
    dict.set_item("face_count", loaded.input_faces.count)?;
    dict.set_item("units", loaded.units)?;
    dict.set_item("repairs", repairs(loaded.repairs))?;
    Ok(dict)
}

/// Counts, sizes, faults and repairs of a mesh, without segmenting it.
#[pyfunction]
pub fn inspect<'py>(
    py: Python<'py>,
    positions: PyReadonlyArray2<'py, f64>,
    faces: PyReadonlyArray2<'py, u32>,
) -> PyResult<Bound<'py, PyDict>> {
    let mesh = mesh_from(py, &positions, &faces)?;
    let seen = py.detach(|| mesh::inspect(&mesh)).map_err(|error| to_python(py, &error))?;
    let dict = PyDict::new(py);
    let corner = |p: Point| [p.x, p.y, p.z];
    dict.set_item("vertices", seen.vertices)?;
    dict.set_item("bounds", (corner(seen.bounds.0), corner(seen.bounds.1)))?;
    dict.set_item("size", seen.size)?;
    dict.set_item("area", seen.area)?;
    dict.set_item("volume", seen.volume)?;
    dict.set_item("components", seen.components)?;
    dict.set_item("closed_components", seen.closed_components)?;
    dict.set_item("border_edges", seen.border_edges)?;
    dict.set_item("non_manifold_edges", seen.non_manifold_edges)?;
    dict.set_item("euler", seen.euler)?;
    dict.set_item("median_edge", seen.median_edge)?;
    dict.set_item("repairs", repairs(seen.repairs))?;
    Ok(dict)
}

/// The bytes of a mesh file in the format that `extension` names.
#[pyfunction]
pub fn write<'py>(
    py: Python<'py>,
    extension: &str,
    positions: PyReadonlyArray2<'py, f64>,
    faces: PyReadonlyArray2<'py, u32>,
) -> PyResult<Bound<'py, PyBytes>> {
    let mesh = mesh_from(py, &positions, &faces)?;
    let bytes = py.detach(|| format::write(extension, &mesh));
    Ok(PyBytes::new(py, &bytes.map_err(|error| to_python(py, &error))?))
}

/// The bytes of a PLY with a label and a colour on every face.
#[pyfunction]
pub fn write_segmentation<'py>(
    py: Python<'py>,
    positions: PyReadonlyArray2<'py, f64>,
    faces: PyReadonlyArray2<'py, u32>,
    labels: PyReadonlyArray1<'py, i32>,
    colours: PyReadonlyArray2<'py, u8>,
) -> PyResult<Bound<'py, PyBytes>> {
    let mesh = mesh_from(py, &positions, &faces)?;
    let (labels, colours) = (labels.as_array().to_vec(), colours_from(&colours)?);
    if labels.len() != mesh.faces.len() || colours.len() != mesh.faces.len() {
        return Err(PyValueError::new_err("one label and one colour a face are needed"));
    }
    let bytes = py.detach(|| format::write_segmentation(&mesh, &labels, &colours));
    Ok(PyBytes::new(py, &bytes))
}

/// Red, green and blue, a row a face.
pub fn colours_from(colours: &PyReadonlyArray2<u8>) -> PyResult<Vec<[u8; 3]>> {
    let colours = colours.as_array();
    if colours.ncols() != 3 {
        return Err(PyValueError::new_err("colours must be (m, 3)"));
    }
    Ok(colours.rows().into_iter().map(|c| [c[0], c[1], c[2]]).collect())
}

/// Repairs as plain values.
pub fn repairs(repairs: Vec<Repair>) -> Vec<(&'static str, usize, String)> {
    repairs.into_iter().map(|repair| (repair.kind, repair.count, repair.detail)).collect()
}

pub fn rows_of_three<T>(flat: Vec<T>) -> Array2<T> {
    Array2::from_shape_vec((flat.len() / 3, 3), flat).expect("three a row")
}
