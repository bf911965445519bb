//! One test binary, a module per subject.

mod figure;
mod film;
mod oracle;
mod render;
mod sampling;
mod tracer;
