//! One test binary, a module per subject.

mod camera;
mod oracle;
mod tracer;
