//! One test binary, a module per subject.

mod oracle;
mod sampling;
mod tracer;
