//! Speed against error, method by method.
//!
//! In: a scene and a [`Request`]: the methods, how many samples and runs. [`measure()`] times renders and compares them with the exact picture. Out:
//! a [`Measurement`], plain data. [`text()`] makes a table of it for a terminal, [`to_csv`] and [`to_json`] make files for
//! programs, [`against_time`] and [`against_samples`] charts, and [`page()`] makes HTML with all of that and pictures.

mod chart;
mod export;
mod machine;
mod marker;
mod measure;
mod measurement;
mod needed;
mod page;
mod picture;
pub mod statistics;
mod summary;
mod text;
mod units;

pub use self::{
    chart::{against_samples, against_time},
    export::{to_csv, to_json},
    machine::Machine,
    measure::measure,
    measurement::{Measurement, Point, Request, Series, Shown, Subject, Times},
    needed::Needed,
    page::page,
    summary::verdict,
    text::text,
};
