//! One test binary, a module per subject.

mod camera;
#[cfg(feature = "cli")]
mod diagnostics;
mod language;
mod oracle;
mod overrides;
#[cfg(feature = "cli")]
mod robustness;
mod syntax;
mod tracer;
