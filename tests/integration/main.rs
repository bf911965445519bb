//! The integration tests: a single test binary with one module for each subject.
#![allow(
    clippy::disallowed_methods,
    reason = "tests make the files that the program is tried with"
)]

mod browser;
mod camera;
mod cancel;
mod cli;
mod culling;
mod diagnostics;
mod diff;
mod editor;
mod effort;
mod exact;
mod explain;
mod extremes;
mod faces;
mod figure;
mod files;
mod film;
mod fixes;
mod format;
mod fuzz;
mod generated;
mod grade;
mod handout;
mod images;
mod inspect;
#[cfg(unix)]
mod interrupt;
mod language;
mod laws;
mod layers;
mod lessons;
mod library;
mod lsp;
mod numerics;
mod parts;
#[cfg(all(target_os = "linux", target_arch = "x86_64"))]
mod processors;
mod program;
mod random;
mod random_scenes;
mod readme;
mod refine;
mod render;
mod report;
mod robustness;
mod sampling;
mod scenes;
mod snapshot;
mod studio;
mod syntax;
mod table;
mod texts;
#[cfg(target_os = "linux")]
mod threads;
mod tracer;
#[cfg(unix)]
mod watch;
