//! Finds the set of mistakes that explains a picture.
//!
//! In: a picture and its scene, as a `judge`, which has a level for each grid and a budget of work.
//! Out: the best candidate, and whether it explains the picture, that is, whether its `residual` is
//! sampling noise. `forward_selection` extends a few best sets by one mistake at a time: rows of
//! the table, rows that only explain something together (`joint`), numbers (`numeric_mistakes`,
//! fitted by `levenberg_marquardt` and simplified by `plain_numbers`), or an extra `patch`.
//! `edge_rows` adds what is visible only at edges. `labels` tell which object a cell shows.

mod edge_rows;
pub mod forward_selection;
mod joint;
mod judge;
mod labels;
mod levenberg_marquardt;
mod numeric_mistakes;
mod patch;
mod plain_numbers;
mod residual;

pub use self::{
    judge::{Judge, Judged},
    labels::labels,
};
