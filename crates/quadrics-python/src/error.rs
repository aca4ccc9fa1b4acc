//! One match: what the core says, as the exception that Python raises.

use std::sync::Mutex;

use pyo3::exceptions::{PyKeyboardInterrupt, PyRuntimeError};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::PyType;
use quadrics::Error;

/// The exception for an error of the core.
pub fn to_python(py: Python<'_>, error: &Error) -> PyErr {
    match error {
        Error::Cancelled => PyKeyboardInterrupt::new_err(()),
        Error::Option(text) => named(py, "OptionError", text),
        fault => named(py, "InputError", &fault.to_string()),
    }
}

/// An exception of `quadrics.errors`, where the classes and their bases are defined.
pub fn named(py: Python<'_>, class: &'static str, text: &str) -> PyErr {
    static MODULE: PyOnceLock<Py<PyModule>> = PyOnceLock::new();
    let find = || -> PyResult<Bound<'_, PyType>> {
        let module = MODULE
            .get_or_try_init(py, || Ok::<_, PyErr>(py.import("quadrics.errors")?.unbind()))?;
        Ok(module.bind(py).getattr(class)?.cast_into::<PyType>()?)
    };
    match find() {
        Ok(class) => PyErr::from_type(class, text.to_owned()),
        Err(error) => error,
    }
}

/// Where and why the last panic was.
static LAST_PANIC: Mutex<String> = Mutex::new(String::new());

/// A panic is our fault and becomes one line: the hook's own three lines would come before it.
pub fn hush_panics() {
    std::panic::set_hook(Box::new(|info| {
        let place = info.location().map(ToString::to_string).unwrap_or_default();
        let payload = info.payload();
        let text = payload
            .downcast_ref::<String>()
            .map(String::as_str)
            .or_else(|| payload.downcast_ref::<&str>().copied())
            .unwrap_or("panic");
        *LAST_PANIC.lock().unwrap_or_else(|poison| poison.into_inner()) =
            format!("{place}: {text}");
    }));
}

/// The exception for a panic that was caught.
pub fn panicked() -> PyErr {
    let text = LAST_PANIC.lock().unwrap_or_else(|poison| poison.into_inner()).clone();
    PyRuntimeError::new_err(format!("a fault of ours, please report it: {text}"))
}
