//! `evaluate`: two labellings of one mesh with their surfaces in, all measures out.

use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use quadrics::Surface;
use quadrics::evaluate::{self as judge, Answer, Named, Report, Verdict};

use crate::error::to_python;
use crate::mesh::mesh_from;
use crate::surface::{Flat, build};

/// A region: its type, its surface, and what a free-form one may as well be called.
type Row = (String, Option<Flat>, Option<(String, Flat)>);
/// Labels, -1 for none, and regions.
type Side<'py> = (PyReadonlyArray1<'py, i32>, Vec<Row>);

/// Judges `found` against `truth`; `beta` is that of the energy.
#[pyfunction]
pub fn evaluate<'py>(
    py: Python<'py>,
    positions: PyReadonlyArray2<'py, f64>,
    faces: PyReadonlyArray2<'py, u32>,
    found: Side<'py>,
    truth: Side<'py>,
    tolerance: f64,
    beta: f64,
) -> PyResult<Bound<'py, PyDict>> {
    let mesh = mesh_from(py, &positions, &faces)?;
    let (found, truth) = (answer(found)?, answer(truth)?);
    let (report, energy) = py
        .detach(|| {
            let report = judge::evaluate(&mesh, &found, &truth, tolerance)?;
            let surfaces: Vec<_> = found.regions.iter().map(|r| r.surface.as_ref()).collect();
            Ok((report, judge::energy(&mesh, &found.labels, &surfaces, beta)?))
        })
        .map_err(|error| to_python(py, &error))?;
    let dict = describe(py, &report)?;
    dict.set_item("energy", energy.total)?;
    dict.set_item("without_surface", energy.without_surface)?;
    Ok(dict)
}

fn answer((labels, rows): Side<'_>) -> PyResult<Answer> {
    // -1, no region, becomes u32::MAX, which says the same.
    let labels = labels.as_array().iter().map(|&label| label as u32).collect();
    let surface = |(kind, numbers): Flat| build(&kind, &numbers);
    let regions = rows.into_iter().map(|(kind, flat, near)| {
        let near = near.map(|(name, flat)| Ok::<_, PyErr>((name, surface(flat)?))).transpose()?;
        let surface = match kind.as_str() {
            "freeform" => Some(Surface::FreeForm),
            _ => flat.map(surface).transpose()?,
        };
        Ok(Named { kind, surface, near })
    });
    Ok(Answer { labels, regions: regions.collect::<PyResult<_>>()? })
}

fn describe<'py>(py: Python<'py>, report: &Report) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("hamming", report.hamming)?;
    dict.set_item("consistency", report.consistency)?;
    dict.set_item("rand_index", report.rand.index)?;
    dict.set_item("adjusted_rand_index", report.rand.adjusted)?;
    dict.set_item("mean_iou", report.mean_iou)?;
    dict.set_item("hits", report.hits(true))?;
    dict.set_item("hits_geometry", report.hits(false))?;
    dict.set_item("regions", report.regions)?;
    dict.set_item("unlabelled_area", report.unlabelled_area)?;
    let verdicts: PyResult<Vec<_>> = report.verdicts.iter().map(|v| verdict(py, v)).collect();
    dict.set_item("verdicts", PyList::new(py, verdicts?)?)?;
    Ok(dict)
}

fn verdict<'py>(py: Python<'py>, verdict: &Verdict) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("found", verdict.pair.found)?;
    dict.set_item("true", verdict.pair.truth)?;
    dict.set_item("iou", verdict.pair.iou)?;
    dict.set_item("type_found", &verdict.kinds.0)?;
    dict.set_item("type_true", &verdict.kinds.1)?;
    dict.set_item("rms", verdict.rms)?;
    dict.set_item("hit", verdict.is_hit())?;
    dict.set_item("hit_geometry", verdict.is_geometry())?;
    dict.set_item("errors", verdict.errors.clone())?;
    Ok(dict)
}
