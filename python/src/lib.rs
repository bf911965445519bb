//! The compiled part of the Python module `pinhole`.
//!
//! In: texts, numbers and arrays that the Python part of the module has checked. Out: arrays of
//! NumPy, and the JSON of the command line, which the Python part converts to objects. Long
//! computations run on another thread without the interpreter's lock, and Ctrl-C ends them.

#![forbid(unsafe_code)]

mod background;
mod picture;
mod saving;
mod scene;

use std::ffi::OsString;

use pinhole::cli::{self, Interrupt};
use pyo3::prelude::*;

/// Runs the command-line program and returns its exit status. The first argument is the program's
/// name.
#[pyfunction]
fn program(py: Python<'_>, args: Vec<OsString>) -> PyResult<u8> {
    let interrupt = Interrupt::default();
    let pressed = interrupt.clone();
    background::run(
        py,
        move || cli::run_with(args, &interrupt),
        // After Ctrl-C, no exception is raised, because the command cleans up and ends by itself.
        move |_| {
            pressed.press();
            None
        },
    )
}

/// The compiled part of the module `pinhole`.
#[pymodule]
mod _native {
    #[pymodule_export]
    use super::{
        program,
        saving::{save_exr, save_png, write_exr, write_png},
        scene::{Scene, carried, read},
    };
}
