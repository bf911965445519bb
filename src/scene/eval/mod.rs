//! The value of an expression.
//!
//! In: a value's tree and the names that are defined. Out: what it is, or problems. A value that
//! failed is unknown (`None`), and what uses it stays silent. What a value is for is not known
//! here, beyond the type that is wanted.
//!
//! `evaluator` has literals, and what messages call a value; what is made of parts has a file each.

mod calls;
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
