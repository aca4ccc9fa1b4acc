//! The rasteriser, for `quadrics.picture`.

use numpy::ndarray::Array3;
use numpy::{IntoPyArray, PyArray1, PyArray3};
use numpy::{PyReadonlyArray1, PyReadonlyArray2, PyReadonlyArray3};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use quadrics::math::Vector;
use quadrics::render::{self, NOTHING, SAMPLES, Seen, View};

use crate::mesh::{colours_from, mesh_from};

/// Faces, and samples.
type Pair<'py> = (Bound<'py, PyArray1<u32>>, Bound<'py, PyArray1<u32>>);

/// What is seen of a mesh: the faces, ascending, and for every sample the place of its face there.
#[pyfunction]
pub fn see<'py>(
    py: Python<'py>,
    positions: PyReadonlyArray2<'py, f64>,
    faces: PyReadonlyArray2<'py, u32>,
    toward_eye: [f64; 3],
    width: usize,
    height: usize,
) -> PyResult<Pair<'py>> {
    let mesh = mesh_from(py, &positions, &faces)?;
    let view = View { toward_eye: Vector::from(toward_eye), width, height };
    let Seen { faces, samples } = py.detach(|| render::see(&mesh, &view));
    Ok((faces.into_pyarray(py), samples.into_pyarray(py)))
}

/// Draws what is seen, one colour, normal and label for each face of it: pixels (height, width, 3).
#[pyfunction]
#[allow(clippy::too_many_arguments)] // Keyword arguments in Python.
pub fn paint<'py>(
    py: Python<'py>,
    samples: PyReadonlyArray1<'py, u32>,
    colours: PyReadonlyArray2<'py, u8>,
    normals: PyReadonlyArray2<'py, f64>,
    labels: PyReadonlyArray1<'py, i32>,
    toward_eye: [f64; 3],
    width: usize,
    height: usize,
) -> PyResult<Bound<'py, PyArray3<u8>>> {
    let samples = samples.as_slice()?;
    let colours = colours_from(&colours)?;
    let normals: Vec<Vector> =
        normals.as_array().rows().into_iter().map(|n| Vector::new(n[0], n[1], n[2])).collect();
    let labels = labels.as_array().to_vec();
    let count = colours.len();
    let faces =
        samples.iter().filter(|&&face| face != NOTHING).max().map_or(0, |&f| f as usize + 1);
    if normals.len() != count || labels.len() != count || faces > count {
        return Err(PyValueError::new_err("one colour, normal and label a face are needed"));
    }
    if samples.len() != width * height * SAMPLES * SAMPLES {
        return Err(PyValueError::new_err("these samples are of another view"));
    }
    let view = View { toward_eye: Vector::from(toward_eye), width, height };
    let pixels = py.detach(|| render::paint(samples, &colours, &normals, &labels, &view));
    let shape = (height, width, 3);
    let pixels = Array3::from_shape_vec(shape, pixels.into_flattened()).expect("as many as asked");
    Ok(pixels.into_pyarray(py))
}

/// A PNG file of pixels (height, width, 3), made fast rather than small.
#[pyfunction]
pub fn encode_png<'py>(
    py: Python<'py>,
    pixels: PyReadonlyArray3<'py, u8>,
) -> PyResult<Bound<'py, PyBytes>> {
    let (height, width, _) = pixels.as_array().dim();
    let pixels = pixels.as_slice()?;
    let encode = || {
        let mut file = Vec::new();
        let mut encoder = png::Encoder::new(&mut file, width as u32, height as u32);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_compression(png::Compression::Fast);
        encoder.write_header()?.write_image_data(pixels)?;
        Ok(file)
    };
    let file: Result<Vec<u8>, png::EncodingError> = py.detach(encode);
    Ok(PyBytes::new(py, &file.map_err(|error| PyValueError::new_err(error.to_string()))?))
}
