//! Measurements of speed against error for each sampling method.
//!
//! In: a scene and a [`Request`], which has the methods, the numbers of samples and the number of
//! runs. [`measure`] times renders and compares them with the exact picture. Out: a
//! [`Measurement`], which is plain data. [`text()`] formats it as a table for a terminal;
//! [`to_csv`] and [`to_json`] as files for programs; [`against_time`] and [`against_samples`] as
//! charts; and [`page()`] as HTML with all of these and pictures.

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
