//! Finds the set of mistakes that explains a picture.
//!
//! In: a `judge`, which contains a scene, a picture of it at several resolutions, and a budget of
//! work. Out: the best hypothesis about the program, and whether it explains the picture. A
//! hypothesis explains the picture if its `residual`, i.e. the difference that it leaves, is
//! sampling noise.
//!
//! `forward_selection` extends the few best sets of mistakes by one mistake at a time. It tries
//! three kinds of mistakes. The first are rows of the table of mistakes, alone or in combinations
//! that explain the picture only together (`joint`). The second are wrong numbers of the scene
//! (`numeric_mistakes`). The third is an extra `patch`. Numbers are fitted by
//! `levenberg_marquardt`, and simplified by `plain_numbers`. `edge_rows` adds mistakes that are
//! visible only at edges.

mod edge_rows;
pub mod forward_selection;
mod joint;
mod judge;
mod levenberg_marquardt;
mod numeric_mistakes;
mod patch;
mod plain_numbers;
mod residual;

pub use self::judge::{Judge, JudgedCandidate};
