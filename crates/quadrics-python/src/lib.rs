//! What Python sees of the core: arrays in, values out, the interpreter free meanwhile.

mod constraints;
mod context;
mod denoise;
mod error;
mod evaluate;
mod mesh;
mod picture;
mod segment;
mod surface;
mod synth;

use pyo3::prelude::*;

#[pymodule]
fn _core(module: &Bound<'_, PyModule>) -> PyResult<()> {
    error::hush_panics();
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_function(wrap_pyfunction!(mesh::read, module)?)?;
    module.add_function(wrap_pyfunction!(mesh::inspect, module)?)?;
    module.add_function(wrap_pyfunction!(mesh::write, module)?)?;
    module.add_function(wrap_pyfunction!(mesh::write_segmentation, module)?)?;
    module.add_function(wrap_pyfunction!(segment::segment, module)?)?;
    module.add_function(wrap_pyfunction!(segment::default_options, module)?)?;
    module.add_function(wrap_pyfunction!(denoise::denoise, module)?)?;
    module.add_function(wrap_pyfunction!(denoise::deviation, module)?)?;
    module.add_function(wrap_pyfunction!(evaluate::evaluate, module)?)?;
    module.add_function(wrap_pyfunction!(surface::distance, module)?)?;
    module.add_function(wrap_pyfunction!(surface::normal, module)?)?;
    module.add_function(wrap_pyfunction!(surface::project, module)?)?;
    module.add_function(wrap_pyfunction!(surface::coefficients, module)?)?;
    module.add_function(wrap_pyfunction!(picture::see, module)?)?;
    module.add_function(wrap_pyfunction!(picture::paint, module)?)?;
    module.add_function(wrap_pyfunction!(picture::encode_png, module)?)?;
    module.add_function(wrap_pyfunction!(synth::part_names, module)?)?;
    module.add_function(wrap_pyfunction!(synth::part, module)?)?;
    module.add_function(wrap_pyfunction!(synth::default_scanner, module)?)?;
    module.add_function(wrap_pyfunction!(synth::scan, module)?)?;
    module.add_function(wrap_pyfunction!(synth::noise, module)?)?;
    Ok(())
}
