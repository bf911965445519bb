//! The values of expressions.
//!
//! In: the tree of a value, and the names that are defined. Out: the value, or problems. A value
//! with errors is unknown (`None`), and expressions that use it stay silent. The purpose of a value
//! is not known here, except the type that is wanted.
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

pub use evaluator::{Evaluator, literal, suits};
pub use names::Names;
pub use suggestion::Suggestion;
