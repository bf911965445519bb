//! Measures how the error of each sampling method decreases with time and with the number of
//! samples.
//!
//! A [`Request`] contains the methods, the numbers of samples and the number of runs. [`measure`]
//! times renders of a scene and compares them with the exact picture. The result is a
//! [`Measurement`], which is plain data. A measurement is written as a table for a terminal
//! ([`text()`]), as files for programs ([`to_csv`], [`to_json`]), as charts ([`against_time`],
//! [`against_samples`]), and as an HTML page with a table, charts and pictures ([`page()`]).

mod chart;
mod estimate;
mod export;
mod line_style;
mod machine;
mod mixture;
mod notation;
mod page;
mod reasons;
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
    mixture::Mixture,
    page::page,
    results::{
        EndSlope, MeasuredScene, Measurement, MethodPicture, MethodSeries, Request, Run,
        SeriesPoint,
    },
    session::measure,
    summary::verdict,
    text::text,
};
