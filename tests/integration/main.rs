//! One test binary, a module per subject.

mod camera;
#[cfg(feature = "cli")]
mod cli;
mod figure;
mod film;
mod oracle;
mod render;
mod sampling;
mod tracer;
