//! One test binary, a module per subject.

mod answers;
mod camera;
#[cfg(feature = "cli")]
mod cli;
mod figure;
mod film;
mod images;
mod oracle;
mod readme;
mod render;
mod sampling;
mod tracer;
