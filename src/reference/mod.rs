//! References that Pinhole is compared with: textbook formulas, an oracle (a tracer of very high
//! precision), and scenes.
//!
//! The report on the arithmetic, the tests and the benchmarks compare the tracer with [`oracle`]
//! and [`textbook`], on scenes made by [`scenes`]. `grading` imitates students' programs with
//! [`formulas`]. The references use none of the tracer's code. Both use the scene and its
//! functions, such as `level_direction`.

#[cfg(test)]
pub(crate) mod exact_board;
pub mod formulas;
#[cfg(any(test, feature = "report"))]
pub mod oracle;
#[cfg(any(test, feature = "report"))]
pub mod scenes;
#[cfg(feature = "report")]
pub mod textbook;
#[cfg(test)]
pub(crate) mod tightness;
