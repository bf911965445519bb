//! Text → tree.
//!
//! In: a text. Out: its syntax tree, its comments and its problems. Parsing always succeeds: what cannot be understood
//! becomes a problem and a `Bad` node, and the rest of the text is read as if nothing had been there. What the names mean is
//! not known here.

#![cfg_attr(
    not(test),
    deny(
        clippy::unwrap_used,
        clippy::expect_used,
        clippy::panic,
        clippy::indexing_slicing,
        clippy::unreachable
    )
)]

mod comments;
mod error;
mod fixes;
mod foreign;
mod grammar;
mod junk;
mod parser;
pub mod tree;

pub use comments::NESTING_LIMIT;
pub use error::Problem;
pub use junk::{is_unit, missing_field, missing_operator, shorten};
pub use parser::{parse, parse_in_parts, parse_unless, parse_value};
pub use tree::Tree;

use crate::source::Span;

/// What parsing yields.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Parsed<'s> {
    /// The tree of the whole text.
    pub tree: Tree<'s>,
    /// The comments in their order.
    pub comments: Vec<Span>,
    /// What is wrong with the text.
    pub problems: Vec<Problem>,
    /// Where an unclosed comment took the rest of the text: what is missing after it is not the author's mistake.
    pub cut: Option<usize>,
}
