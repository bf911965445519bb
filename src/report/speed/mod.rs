//! Speed against error, method by method.
//!
//! In: a scene, the methods, how many samples and runs. A [`Plan`] decides what fits into the time there is, [`measure()`] times the
//! renders and compares them with the exact picture, and [`Tries`] take about as many samples as an error should take. Out: a
//! [`Measurement`], plain data, of which `table` makes text for a terminal, `export` CSV and JSON, `chart` SVG and `page` HTML, which
//! shows the crops of `picture`.

mod account;
mod chart;
mod export;
pub mod fit;
mod ladder;
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
mod tried;
mod tries;

pub use self::{
    chart::{against_samples, against_time},
    export::{to_csv, to_json},
    machine::Machine,
    measure::{Computed, Measurement, Point, Series, Subject, further, measure, measure_further},
    needed::{Fastest, Needed},
    notes::{NOISY, notes},
    page::page,
    plan::{Plan, Request},
    table::table,
    tried::Try,
    tries::Tries,
};
