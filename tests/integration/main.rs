//! One test binary, a module per subject.

mod camera;
mod diagnostics;
mod language;
mod oracle;
mod overrides;
mod robustness;
mod syntax;
mod tracer;
