//! Tests of the editor's answers about a text with `$0` at the cursor, and of drags in the picture.

mod answers;
mod drags;
mod outside;
mod prefixes;
mod rules;
mod semantic_tokens;

use pinhole::{editor::Analysis, source::Sources};

use crate::scenes::sources;

/// Returns `text` without its `$0`, and the offset of the `$0`. Panics if there is no `$0`.
fn cursor(text: &str) -> (Sources, usize) {
    let at = text.find("$0").expect("a cursor");
    let text = text.replacen("$0", "", 1);
    (sources(&text), at)
}

/// Analyses `text` without its `$0`, and calls `ask` with the analysis and the offset of the `$0`.
fn at_cursor<T>(text: &str, ask: impl FnOnce(&Analysis<'_>, usize) -> T) -> T {
    let (sources, at) = cursor(text);
    ask(&Analysis::new(&sources), at)
}

/// Analyses `text` and calls `ask` with the analysis.
fn about_text<T>(text: &str, ask: impl FnOnce(&Analysis<'_>) -> T) -> T {
    ask(&Analysis::new(&sources(text)))
}
