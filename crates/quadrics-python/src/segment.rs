//! `segment`: arrays and options in, labels and plain values out.

use numpy::{IntoPyArray, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use quadrics::constrain::Demands;
use quadrics::options::{Coarse, Method, Preset, Seeds};
use quadrics::result::{Region, Segmentation, Side};
use quadrics::{Options, pipeline};

use crate::{constraints, context, mesh, surface};

/// Segments a mesh. `options` holds every field of `Options` by its name.
#[pyfunction]
#[pyo3(signature = (positions, faces, options, initial_labels=None, progress=None))]
pub fn segment<'py>(
    py: Python<'py>,
    positions: PyReadonlyArray2<'py, f64>,
    faces: PyReadonlyArray2<'py, u32>,
    options: &Bound<'py, PyDict>,
    initial_labels: Option<PyReadonlyArray1<'py, u32>>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let mesh = mesh::mesh_from(py, &positions, &faces)?;
    let options = read_options(options)?;
    let labels = initial_labels.map(|labels| labels.as_array().to_vec());
    let size = mesh.size();
    let result = context::run(py, options.seed, progress, move |context| {
        pipeline::segment(context, &mesh, &options, labels.as_deref())
    })?;
    describe(py, result, size)
}

/// Reads and writes every field by its name; a field that is forgotten here does not compile.
macro_rules! by_name {
    ($($field:ident),*) => {
        fn read_options(dict: &Bound<'_, PyDict>) -> PyResult<Options> {
            Ok(Options { $($field: {
                let value = dict.get_item(stringify!($field))?;
                let value = value.ok_or_else(|| PyTypeError::new_err(concat!("no option ", stringify!($field))))?;
                Field::read(&value)?
            }),* })
        }

        /// The defaults of the core, for the test that compares them with Python's.
        #[pyfunction]
        pub fn default_options(py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
            let Options { $($field),* } = Options::default();
            let dict = PyDict::new(py);
            $(dict.set_item(stringify!($field), Field::write(&$field, py)?)?;)*
            Ok(dict)
        }
    };
}

by_name!(
    method,
    preset,
    regions,
    constraints,
    seed,
    threads,
    coarse,
    max_edge,
    alpha,
    epsilon,
    tau,
    beta,
    seeds,
    seed_candidates,
    seed_fraction,
    planarity,
    merge_angle_deg,
    insertion_threshold,
    max_iterations,
    convergence
);

/// A field's value in Python and back.
trait Field: Sized {
    fn read(value: &Bound<'_, PyAny>) -> PyResult<Self>;
    fn write<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>>;
}

/// Numbers and optional numbers are themselves.
macro_rules! plain {
    ($($kind:ty),*) => {$(
        impl Field for $kind {
            fn read(value: &Bound<'_, PyAny>) -> PyResult<Self> {
                value.extract()
            }
            fn write<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
                Ok(self.into_pyobject(py)?.to_owned().into_any())
            }
        }
    )*};
}

plain!(usize, u64, f64, Option<usize>, Option<f64>);

/// Off is False, on is True, or a dictionary of demands.
impl Field for Option<Demands> {
    fn read(value: &Bound<'_, PyAny>) -> PyResult<Self> {
        if let Ok(on) = value.extract::<bool>() {
            return Ok(on.then(Demands::default));
        }
        constraints::demands(value.cast::<PyDict>()?).map(Some)
    }
    fn write<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        Ok(self.is_some().into_pyobject(py)?.to_owned().into_any())
    }
}

/// A choice is its name.
macro_rules! choice {
    ($kind:ident { $($variant:ident = $name:literal),* }) => {
        impl Field for $kind {
            fn read(value: &Bound<'_, PyAny>) -> PyResult<Self> {
                match value.extract::<String>()?.as_str() {
                    $($name => Ok(Self::$variant),)*
                    other => Err(PyValueError::new_err(format!("no {} '{other}'", stringify!($kind)))),
                }
            }
            fn write<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
                let name = match self { $(Self::$variant => $name),* };
                Ok(name.into_pyobject(py)?.into_any())
            }
        }
    };
}

choice!(Coarse { Auto = "auto", On = "on", Off = "off" });
choice!(Method {
    Quadrics = "quadrics",
    Vsa = "vsa",
    Qsf = "qsf",
    Hfp = "hfp",
    Ransac = "ransac"
});
choice!(Preset { Default = "default", Paper = "paper" });
choice!(Seeds { Region = "region", Triangle = "triangle" });

/// A segmentation as Python's `result.py` takes it.
fn describe(py: Python<'_>, result: Segmentation, size: f64) -> PyResult<Bound<'_, PyDict>> {
    let dict = PyDict::new(py);
    let regions: PyResult<Vec<_>> = result.regions.iter().map(|r| region(py, r, size)).collect();
    let relations: PyResult<Vec<_>> =
        result.relations.iter().map(|r| constraints::relation(py, r)).collect();
    let dimensions = result.dimensions.iter().map(|d| constraints::dimension(py, d));
    let dimensions: PyResult<Vec<_>> = dimensions.collect();
    dict.set_item("labels", result.labels.into_pyarray(py))?;
    dict.set_item("regions", PyList::new(py, regions?)?)?;
    dict.set_item("relations", PyList::new(py, relations?)?)?;
    dict.set_item("dimensions", PyList::new(py, dimensions?)?)?;
    dict.set_item("noise", (result.noise.position, result.noise.normal_deg))?;
    dict.set_item("repairs", mesh::repairs(result.repairs))?;
    dict.set_item("energy", result.energy)?;
    dict.set_item("timing", result.timing)?;
    Ok(dict)
}

fn region<'py>(py: Python<'py>, region: &Region, size: f64) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    let side = match region.side {
        Side::Outside => "outside",
        Side::Inside => "inside",
    };
    dict.set_item("id", region.id)?;
    dict.set_item("surface", surface::describe(py, &region.surface, size)?)?;
    dict.set_item("side", side)?;
    dict.set_item("confidence", region.confidence)?;
    dict.set_item("runner_up", region.runner_up)?;
    dict.set_item("faces", region.faces)?;
    dict.set_item("area", region.area)?;
    dict.set_item("rms", region.rms)?;
    dict.set_item("max_deviation", region.max_deviation)?;
    dict.set_item("mean_normal_deviation_deg", region.mean_normal_deviation_deg)?;
    dict.set_item("uncertainty", region.uncertainty.clone())?;
    dict.set_item("neighbours", region.neighbours.clone())?;
    Ok(dict)
}
