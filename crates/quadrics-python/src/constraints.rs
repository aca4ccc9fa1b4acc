//! Demands of the user in, relations and dimensions out.

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use quadrics::constrain::{Demand, Demands, Fixed, Gate, Grid, of_pairs};
use quadrics::result::{Dimension, Parameter, Relation};

/// Reads what `constraints.py` has checked.
pub fn demands(dict: &Bound<'_, PyDict>) -> PyResult<Demands> {
    let item = |name: &str| -> PyResult<Bound<'_, PyAny>> { dict.as_any().get_item(name) };
    let mut demands = Demands::default();
    for entry in item("relations")?.try_iter()? {
        let (kind, regions, forced) = entry?.extract()?;
        demands.relations.push(Demand { kind, regions, forced });
    }
    for entry in item("fix")?.try_iter()? {
        let (region, parameter, value) = entry?.extract()?;
        demands.fixed.push(Fixed { region, parameter, value });
    }
    let radians = |degrees: Option<f64>| degrees.map(f64::to_radians);
    let (length, angle): (Option<f64>, Option<f64>) = item("gate")?.extract()?;
    demands.gate = Gate { length, angle: radians(angle) };
    let (length, angle): (Option<f64>, Option<f64>) = item("round")?.extract()?;
    demands.grid = Grid { length, angle: radians(angle) };
    Ok(demands)
}

/// A relation as `result.py` takes it.
pub fn relation<'py>(py: Python<'py>, relation: &Relation) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("kind", relation.kind)?;
    if of_pairs(relation.kind) {
        let pairs = relation.regions.chunks(2).map(|pair| PyTuple::new(py, pair));
        dict.set_item("regions", pairs.collect::<PyResult<Vec<_>>>()?)?;
    } else {
        dict.set_item("regions", &relation.regions)?;
    }
    dict.set_item("status", relation.status)?;
    dict.set_item("value", relation.value)?;
    let parameters = PyDict::new(py);
    for (name, value) in &relation.parameters {
        match value {
            Parameter::Count(count) => parameters.set_item(name, count)?,
            Parameter::Length(length) => parameters.set_item(name, length)?,
            Parameter::Vector(vector) => parameters.set_item(name, vector.to_vec())?,
        }
    }
    dict.set_item("parameters", (!parameters.is_empty()).then_some(parameters))?;
    dict.set_item("residual_before", relation.residual_before)?;
    dict.set_item("residual_after", relation.residual_after)?;
    dict.set_item("residual_unit", relation.residual_unit)?;
    dict.set_item("reason", &relation.reason)?;
    Ok(dict)
}

/// A dimension as `result.py` takes it.
pub fn dimension<'py>(py: Python<'py>, dimension: &Dimension) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("kind", dimension.kind)?;
    dict.set_item("regions", &dimension.regions)?;
    dict.set_item("value", dimension.value)?;
    dict.set_item("uncertainty", dimension.uncertainty)?;
    dict.set_item("rounded", dimension.rounded)?;
    Ok(dict)
}
