//! Speed against error, method by method.
//!
//! In: a scene, the methods, how many samples and runs. A [`Plan`] decides what fits into the time there is, [`measure()`] times the
//! renders and compares them with the exact picture, and [`Checks`] take the samples that an error should take by extrapolation. Out: a
//! [`Measurement`], plain data, of which `table` makes text for a terminal, `export` CSV and JSON, `chart` SVG and `page` HTML, which
//! shows the crops of `picture`.

mod account;
mod chart;
mod check;
mod export;
pub mod fit;
mod machine;
mod marker;
mod measure;
mod needed;
mod notes;
mod page;
mod picture;
mod plan;
mod table;
mod ticks;

pub use self::{
    chart::{against_samples, against_time},
    check::Checks,
    export::{to_csv, to_json},
    machine::Machine,
    measure::{Computed, Measurement, Point, Series, Subject, further, measure, measure_further},
    needed::{Check, Fastest, Needed},
    notes::{NOISY, notes},
    page::page,
    plan::{Plan, Request},
    table::table,
};
