//! What Pinhole says about itself: how right its decisions and numbers are, and how fast its methods come how near the truth.
//!
//! [`numerics`] asks the arithmetic. The rest is speed against error, and needs the feature `report`. In: a scene, the methods, how
//! many samples and runs. A [`Plan`] decides what fits into the time there is, [`measure()`] times the renders and compares them with
//! the exact picture. Out: a [`Measurement`], plain data, of which `table` makes text for a terminal, `export` CSV and JSON, `chart`
//! SVG and `page` HTML, which shows the crops of `picture`.

#[cfg(feature = "report")]
mod chart;
#[cfg(feature = "report")]
mod export;
#[cfg(feature = "report")]
pub mod fit;
#[cfg(feature = "report")]
mod machine;
#[cfg(feature = "report")]
mod marker;
#[cfg(feature = "report")]
mod measure;
#[cfg(feature = "report")]
mod notes;
pub mod numerics;
#[cfg(feature = "report")]
mod page;
#[cfg(feature = "report")]
mod picture;
#[cfg(feature = "report")]
mod plan;
#[cfg(feature = "report")]
mod table;
#[cfg(feature = "report")]
mod ticks;

#[cfg(feature = "report")]
pub use self::{
    chart::{against_samples, against_time},
    export::{to_csv, to_json},
    machine::Machine,
    measure::{Computed, Measurement, Needed, Point, Series, Subject, measure},
    notes::{NOISY, notes},
    page::page,
    plan::{Plan, Request},
    table::table,
};
