//! Finds the set of mistakes that explains a picture.
//!
//! In: a picture and its scene, as a `judge`, which holds the picture at several resolutions and a
//! budget of work. Out: the best hypothesis about the program, and whether it explains the picture.
//! A hypothesis explains the picture if its `residual`, i.e. what it leaves unexplained, is
//! sampling noise.
//!
//! `forward_selection` extends the few best sets of mistakes by one mistake at a time. It tries
//! three kinds of mistakes: rows of the table, alone or in combinations that explain something only
//! together (`joint`); wrong numbers of the scene (`numeric_mistakes`); and an extra `patch`.
//! Numbers are fitted by `levenberg_marquardt`, and simplified by `plain_numbers`. `edge_rows` adds
//! mistakes that are visible only at edges.

mod edge_rows;
pub mod forward_selection;
mod joint;
mod judge;
mod levenberg_marquardt;
mod numeric_mistakes;
mod patch;
mod plain_numbers;
mod residual;

pub use self::judge::{Judge, Judged};
