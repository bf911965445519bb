//! Parses a text into a syntax tree.
//!
//! In: a text. Out: its syntax tree, its comments and its problems. Parsing always succeeds: pest
//! reads the items that follow the grammar (`parser`). Any other item is read token by token
//! (`tokens`, `recovery`): recovery reports one problem for each mistake and makes nodes of what
//! can be understood. Names are looked up only to choose between explanations of a mistake.

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
pub use problem::{further_places, shorten};
pub use tree::Tree;

use crate::{diagnostic::Diagnostic, source::Span};

/// Maximum depth of nested parentheses, signs and calls in a value.
pub const NESTING_LIMIT: usize = 256;

/// Result of parsing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Parsed<'s> {
    /// The tree of the whole text.
    pub tree: Tree<'s>,
    /// The comments, in the order of the text.
    pub comments: Vec<Span>,
    /// The syntax problems.
    pub problems: Vec<Diagnostic>,
    /// Whether a mistake hides the rest of the text, so that nothing may be reported as missing.
    pub is_cut: bool,
    /// Whether something follows the grammar but was probably not meant so, such as fields that
    /// their block does not have. With other line ends, the same text may be a syntax error.
    pub is_doubtful: bool,
}
