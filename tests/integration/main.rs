//! One test binary, a module per subject.

mod camera;
mod figure;
mod film;
mod oracle;
mod render;
mod sampling;
mod tracer;
