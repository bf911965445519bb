//! Speed against error, method by method.
//!
//! In: a scene and a [`Request`]: the methods, how many samples and runs. [`measure`] times renders
//! and compares them with the exact picture. Out: a [`Measurement`], plain data. [`text()`] makes a
//! table of it for a terminal, [`to_csv`] and [`to_json`] make files for programs, [`against_time`]
//! and [`against_samples`] charts, and [`page()`] makes HTML with all of that and pictures.

mod chart;
mod estimate;
mod export;
mod line_style;
mod machine;
mod notation;
mod page;
mod results;
mod session;
pub mod statistics;
mod summary;
mod text;

pub use self::{
    chart::{against_samples, against_time},
    estimate::Estimate,
    export::{to_csv, to_json},
    machine::Machine,
    page::page,
    results::{Measurement, Point, Request, Run, Series, Shown, Subject},
    session::measure,
    summary::verdict,
    text::text,
};
