//! Editor answers about a text with `$0` at the cursor, and drags in the picture.

mod answers;
mod drags;
mod prefixes;
mod rules;
mod semantic_tokens;

use pinhole::{editor::Analysis, source::Sources};

use crate::scenes::sources;

/// Returns the text without `$0`, and the offset of the cursor.
fn cursor(text: &str) -> (Sources, usize) {
    let at = text.find("$0").expect("a cursor");
    let text = text.replacen("$0", "", 1);
    (sources(&text), at)
}

/// Analyses a text and asks a question at its cursor.
fn at_cursor<T>(text: &str, ask: impl FnOnce(&Analysis<'_>, usize) -> T) -> T {
    let (sources, at) = cursor(text);
    ask(&Analysis::new(&sources), at)
}

/// Analyses a text and asks a question about all of it.
fn about_text<T>(text: &str, ask: impl FnOnce(&Analysis<'_>) -> T) -> T {
    ask(&Analysis::new(&sources(text)))
}
