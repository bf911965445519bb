//! Evaluates expressions.
//!
//! In: the tree of a value, and the names that are defined. Out: the value, or problems. A value
//! with errors is unknown (`None`), and an expression that uses it is not reported again.
//! Evaluation knows only which type is wanted, not which field the value is for.
//!
//! `evaluator` handles literals; lists, operators, calls and names have a file each.

mod calls;
mod color;
mod evaluator;
mod lists;
mod lookup;
mod names;
mod operators;
mod origin;
mod suggestion;

pub use evaluator::{Evaluator, literal, suits, value_of};
pub use names::Names;
pub use suggestion::Suggestion;
