//! Text → tree.
//!
//! In: a text. Out: its syntax tree, its comments and its problems. Parsing always succeeds: pest
//! reads the items that are right (`parser`); an item that is not is read token by token (`tokens`,
//! `recovery`), which makes one problem of each slip and nodes of what can be understood. Names are
//! looked up only to choose between explanations of a mistake.

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

#[rustfmt::skip]
mod messages;
mod parser;
mod parts;
mod problem;
mod recovery;
mod scan;
pub mod tokens;
pub mod tree;
mod vocabulary;

pub use messages::{FOREIGN_FILE, INVALID_UTF8, UTF16};
pub use parser::{parse, parse_unless, parse_value};
pub use parts::parse_in_parts;
pub use problem::{shorten, times};
pub use tree::Tree;

use crate::{diagnostic::Diagnostic, source::Span};

/// Parentheses, signs and calls nest at most this deep.
pub const NESTING_LIMIT: usize = 256;

/// What parsing yields.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Parsed<'s> {
    /// The tree of the whole text.
    pub tree: Tree<'s>,
    /// The comments in their order.
    pub comments: Vec<Span>,
    /// What is wrong with the text.
    pub problems: Vec<Diagnostic>,
    /// Whether a mistake took the rest of the text, so that nothing is reported to be missing.
    pub is_cut: bool,
    /// Whether something follows the grammar and was hardly meant so, such as fields that their
    /// block does not know: with other line ends it may be a mistake of syntax.
    pub is_doubtful: bool,
}
