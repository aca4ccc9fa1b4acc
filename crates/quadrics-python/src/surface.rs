//! Surfaces in Python's words: a type name and its parameters, named as in the result files.
//!
//! On the way in the parameters come flat, in the order of the fields of `quadrics.surfaces`.

use numpy::ndarray::Array2;
use numpy::{IntoPyArray, PyArray1, PyArray2, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use quadrics::Surface;
use quadrics::math::{Point, Unit, Vector};
use quadrics::surface::kind::{Class, kind};
use quadrics::surface::{Cone, Cylinder, Plane, Quadric, Sphere, Torus};

/// `type` and the parameters of a surface in a part whose longest side is `size`.
pub fn describe<'py>(
    py: Python<'py>,
    surface: &Surface,
    size: f64,
) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("type", surface.type_name())?;
    let vector = |v: &Vector| [v.x, v.y, v.z];
    let point = |p: &Point| [p.x, p.y, p.z];
    match surface {
        Surface::Plane(s) => {
            dict.set_item("normal", vector(&s.normal))?;
            dict.set_item("offset", s.offset)?;
        }
        Surface::Sphere(s) => {
            dict.set_item("center", point(&s.center))?;
            dict.set_item("radius", s.radius)?;
        }
        Surface::Cylinder(s) => {
            dict.set_item("point", point(&s.point))?;
            dict.set_item("axis", vector(&s.axis))?;
            dict.set_item("radius", s.radius)?;
        }
        Surface::Cone(s) => {
            dict.set_item("apex", point(&s.apex))?;
            dict.set_item("axis", vector(&s.axis))?;
            dict.set_item("half_angle_deg", s.half_angle.to_degrees())?;
        }
        Surface::Torus(s) => {
            dict.set_item("center", point(&s.center))?;
            dict.set_item("axis", vector(&s.axis))?;
            dict.set_item("major_radius", s.major_radius.abs())?;
            dict.set_item("minor_radius", s.minor_radius)?;
            if s.major_radius < 0.0 {
                dict.set_item("inner", true)?;
            }
        }
        Surface::Quadric(s) => describe_quadric(&dict, s, size)?,
        Surface::FreeForm => {}
    }
    Ok(dict)
}

/// The class by its name, and what it has of centre, axes and semi-axes.
fn describe_quadric(dict: &Bound<'_, PyDict>, quadric: &Quadric, size: f64) -> PyResult<()> {
    let kind = kind(quadric, size);
    dict.set_item("coefficients", quadric.coefficients)?;
    // A free fit may be a sphere to the eye: as ten coefficients it is still none of our spheres.
    let typed = matches!(kind.class, Class::Plane | Class::Sphere | Class::Cylinder | Class::Cone);
    if typed || kind.class == Class::Other {
        dict.set_item("class", kind.class.name())?;
        return Ok(());
    }
    dict.set_item("type", kind.class.name())?;
    dict.set_item("center", kind.center.map(|p| [p.x, p.y, p.z]))?;
    dict.set_item("axes", kind.axes.map(|axis| [axis.x, axis.y, axis.z]))?;
    dict.set_item("semi_axes", (!kind.semi_axes.is_empty()).then_some(kind.semi_axes))
}

/// A type name and the parameters, flat.
pub type Flat = (String, Vec<f64>);

/// The surface with these parameters.
pub fn build(kind: &str, numbers: &[f64]) -> PyResult<Surface> {
    let at = |i: usize| Point::new(numbers[i], numbers[i + 1], numbers[i + 2]);
    let unit = |i: usize| Unit::new_normalize(at(i).coords);
    Ok(match (kind, numbers.len()) {
        ("plane", 4) => Surface::Plane(Plane { normal: unit(0), offset: numbers[3] }),
        ("sphere", 4) => Surface::Sphere(Sphere { center: at(0), radius: numbers[3] }),
        ("cylinder", 7) => {
            Surface::Cylinder(Cylinder { point: at(0), axis: unit(3), radius: numbers[6] })
        }
        ("cone", 7) => {
            Surface::Cone(Cone { apex: at(0), axis: unit(3), half_angle: numbers[6].to_radians() })
        }
        ("torus", 9) => Surface::Torus(Torus {
            center: at(0),
            axis: unit(3),
            major_radius: if numbers[8] == 0.0 { numbers[6] } else { -numbers[6] },
            minor_radius: numbers[7],
        }),
        ("quadric", 10) => {
            let coefficients = numbers.try_into().expect("ten numbers");
            Surface::Quadric(Quadric { coefficients })
        }
        _ => {
            let text = format!("no surface '{kind}' of {} numbers", numbers.len());
            return Err(PyValueError::new_err(text));
        }
    })
}

/// Runs `ask` for every point, three numbers a row.
fn rows(
    points: &PyReadonlyArray2<f64>,
    ask: impl Fn(Point) -> Option<[f64; 3]>,
) -> PyResult<Array2<f64>> {
    let points = points.as_array();
    if points.ncols() != 3 {
        return Err(PyValueError::new_err("points must be (n, 3)"));
    }
    let mut answers = Array2::from_elem(points.raw_dim(), f64::NAN);
    for (point, mut answer) in points.rows().into_iter().zip(answers.rows_mut()) {
        if let Some(values) = ask(Point::new(point[0], point[1], point[2])) {
            answer.iter_mut().zip(values).for_each(|(slot, value)| *slot = value);
        }
    }
    Ok(answers)
}

/// Signed orthogonal distances of points, positive on the side of the normal.
#[pyfunction]
pub fn distance<'py>(
    py: Python<'py>,
    kind: &str,
    numbers: Vec<f64>,
    points: PyReadonlyArray2<'py, f64>,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let surface = build(kind, &numbers)?;
    let answers = rows(&points, |p| surface.distance(p).map(|d| [d; 3]))?;
    Ok(answers.column(0).to_owned().into_pyarray(py))
}

/// Unit normals at the feet of points; NaN where geometry has no answer.
#[pyfunction]
pub fn normal<'py>(
    py: Python<'py>,
    kind: &str,
    numbers: Vec<f64>,
    points: PyReadonlyArray2<'py, f64>,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let surface = build(kind, &numbers)?;
    let answers = rows(&points, |p| surface.normal(p).map(|n| [n.x, n.y, n.z]))?;
    Ok(answers.into_pyarray(py))
}

/// Nearest points of the surface; NaN where they are not unique.
#[pyfunction]
pub fn project<'py>(
    py: Python<'py>,
    kind: &str,
    numbers: Vec<f64>,
    points: PyReadonlyArray2<'py, f64>,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let surface = build(kind, &numbers)?;
    let answers = rows(&points, |p| surface.project(p).map(|q| [q.x, q.y, q.z]))?;
    Ok(answers.into_pyarray(py))
}

/// The ten coefficients, or `None` where the surface is no quadric.
#[pyfunction]
pub fn coefficients(kind: &str, numbers: Vec<f64>) -> PyResult<Option<[f64; 10]>> {
    Ok(build(kind, &numbers)?.quadric().map(|quadric| quadric.coefficients))
}
