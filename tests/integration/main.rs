//! One test binary, a module per subject.

mod answers;
mod camera;
mod cli;
#[cfg(feature = "cli")]
mod diagnostics;
mod figure;
mod film;
mod images;
mod language;
mod oracle;
mod overrides;
mod readme;
mod render;
#[cfg(feature = "cli")]
mod robustness;
mod sampling;
mod syntax;
mod tracer;
