//! Parses a text into a syntax tree.
//!
//! In: a text. Out: its syntax tree, its comments and its problems. Parsing always succeeds. An
//! item is a block or a `let`. pest, a parser generated from the grammar, reads each item that
//! follows the grammar (`parser`). Error recovery (`tokens`, `recovery`) reads any other item token
//! by token. It reports one problem for each mistake and makes nodes for the parts that it can
//! read. The parser accepts unknown names. It looks up a name only to explain a mistake, for
//! example to tell a field from a value.

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
mod plain;
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

/// Maximum depth of nested parentheses, signs and calls in a value. A deeper value is reported as a
/// problem, because parsing it could overflow the stack. Usual values nest far less. A larger
/// maximum would need threads with a larger stack.
pub const NESTING_LIMIT: usize = 256;

/// Returns whether a text has the form of a name: it is made of the letters a to z, digits and `_`,
/// and does not start with a digit.
pub fn is_name(text: &str) -> bool {
    let is_letter = |c: char| c.is_ascii_alphanumeric() || c == '_';
    !text.is_empty()
        && !text.starts_with(|c: char| c.is_ascii_digit())
        && text.chars().all(is_letter)
}

/// Result of parsing.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Parsed<'s> {
    /// The tree of the whole text.
    pub tree: Tree<'s>,
    /// The comments, in the order of the text.
    pub comments: Vec<Span>,
    /// The syntax problems.
    pub problems: Vec<Diagnostic>,
    /// Whether a mistake, such as an unclosed comment, hides a part of the text. If so, no missing
    /// block or field is reported, since the hidden part may contain it.
    pub is_cut: bool,
    /// Whether an item follows the grammar but looks wrong, such as a block with an unknown field,
    /// and error recovery found no better reading of it. The item is accepted. Error recovery
    /// depends on line ends, however, so it may reject the same item in a formatted copy of the
    /// text. The formatter must therefore parse its result again.
    pub is_doubtful: bool,
}
