//! One test binary, a module per subject.

mod answers;
mod camera;
mod cli;
mod diagnostics;
mod diff;
mod exact;
mod figure;
mod film;
mod images;
mod language;
mod laws;
mod numerics;
mod overrides;
mod parts;
mod readme;
mod render;
#[cfg(feature = "report")]
mod report;
mod robustness;
mod sampling;
mod syntax;
mod tracer;
