//! Work on another thread, while the calling thread handles the signals of Python.

use std::{
    panic,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
        mpsc::{self, RecvTimeoutError},
    },
    thread,
    time::Duration,
};

use pyo3::prelude::*;

/// Interval at which signals are handled. Together with [`GRACE`], it limits the time until Ctrl-C
/// ends a computation, which should be less than 100 ms. A shorter interval would cost more work.
const INTERVAL: Duration = Duration::from_millis(20);

/// Time that cancelled work gets to end, and to remove a temporary file. If the work takes longer,
/// it continues in the background, and its result is dropped.
const GRACE: Duration = Duration::from_millis(40);

/// Runs `work` without the interpreter's lock, and returns its result. If the handler of a signal
/// raises an exception, as the handler of Ctrl-C does, sets the flag that `work` was given and
/// raises the exception.
pub fn cancellable<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce(&AtomicBool) -> T + Send + 'static,
) -> PyResult<T> {
    let cancel = Arc::new(AtomicBool::new(false));
    let flag = Arc::clone(&cancel);
    run(
        py,
        move || work(&flag),
        move |signal| {
            cancel.store(true, Ordering::Relaxed);
            Some(signal)
        },
    )
}

/// Runs `work` without the interpreter's lock, and returns its result. If the handler of a signal
/// raises an exception, `interrupted` gets it. If `interrupted` returns an exception, waits for
/// `work` for at most [`GRACE`], drops its result, and raises the exception. If `interrupted`
/// returns `None`, `work` continues.
pub fn run<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce() -> T + Send + 'static,
    interrupted: impl Fn(PyErr) -> Option<PyErr> + Send,
) -> PyResult<T> {
    let (done, result) = mpsc::sync_channel(1);
    // Each call starts its own thread. Threads of a pool would be missing in a forked process.
    let worker = thread::Builder::new().spawn(move || {
        // If the caller no longer waits for the result, sending it fails, and the error is ignored.
        let _ = done.send(work());
    })?;
    py.detach(move || {
        loop {
            match result.recv_timeout(INTERVAL) {
                Ok(made) => return Ok(made),
                Err(RecvTimeoutError::Disconnected) => break,
                Err(RecvTimeoutError::Timeout) => {
                    let signal = Python::attach(|py| py.check_signals()).err();
                    if let Some(exception) = signal.and_then(&interrupted) {
                        let _ = result.recv_timeout(GRACE);
                        return Err(exception);
                    }
                }
            }
        }
        // The work has panicked, which PyO3 turns into an exception.
        match worker.join() {
            Err(panic) => panic::resume_unwind(panic),
            Ok(()) => unreachable!("the work has sent no result"),
        }
    })
}
