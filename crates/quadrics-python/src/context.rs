//! Runs the core beside the interpreter: other threads go on, progress is told, Ctrl-C is heard.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::Duration;

use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use quadrics::{Context, Error};

use crate::error::{panicked, to_python};

/// How often the interpreter is asked for signals: far below what a person notices.
const POLL: Duration = Duration::from_millis(20);
/// How long a cancelled run may take to notice before it is left to end on its own.
const PATIENCE: Duration = Duration::from_millis(500);

/// What the worker tells the thread that waits for it.
#[derive(Default)]
struct Shared {
    stop: AtomicBool,
    latest: Mutex<Option<(&'static str, f64)>>,
}

/// Runs `work` on a thread of its own and waits for it.
///
/// # Errors
/// Those of `work`; what `progress` raises; `KeyboardInterrupt` after Ctrl-C or when `progress`
/// returns `False`.
pub fn run<T: Send + 'static>(
    py: Python<'_>,
    seed: u64,
    progress: Option<Py<PyAny>>,
    work: impl FnOnce(&mut Context) -> Result<T, Error> + Send + 'static,
) -> PyResult<T> {
    let shared = Arc::new(Shared::default());
    let (send, receive) = channel();
    let told = Arc::clone(&shared);
    thread::spawn(move || {
        let listener = Arc::clone(&told);
        let mut context = Context::with_progress(seed, move |stage, fraction| {
            *listener.latest.lock().expect("no panic while held") = Some((stage, fraction));
            !listener.stop.load(Ordering::Relaxed)
        });
        // Nobody listens any more when the run was abandoned.
        let _ = send.send(catch_unwind(AssertUnwindSafe(|| work(&mut context))));
    });
    let outcome = py.detach(move || {
        loop {
            let outcome = receive.recv_timeout(POLL);
            if let Err(error) = Python::attach(|py| tell(py, &shared, progress.as_ref())) {
                shared.stop.store(true, Ordering::Relaxed);
                let _ = receive.recv_timeout(PATIENCE);
                return Err(error);
            }
            match outcome {
                Ok(outcome) => return Ok(outcome),
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => return Err(panicked()),
            }
        }
    })?;
    match outcome {
        Ok(Ok(value)) => Ok(value),
        Ok(Err(error)) => Err(to_python(py, &error)),
        Err(_) => Err(panicked()),
    }
}

/// Hears signals and passes on the latest progress, if there is any.
fn tell(py: Python<'_>, shared: &Shared, progress: Option<&Py<PyAny>>) -> PyResult<()> {
    py.check_signals()?;
    let latest = shared.latest.lock().expect("no panic while held").take();
    let (Some(progress), Some((stage, fraction))) = (progress, latest) else { return Ok(()) };
    let answer = progress.call1(py, (stage, fraction))?;
    // `None`, what a function returns that returns nothing, means go on.
    if answer.bind(py).is(pyo3::types::PyBool::new(py, false).as_any()) {
        return Err(PyKeyboardInterrupt::new_err("stopped by the progress callback"));
    }
    Ok(())
}
