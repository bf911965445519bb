//! The answers to one who writes a scene: a text with `$0` where the cursor is, and what comes of
//! it.

mod answers;
mod drags;
mod prefixes;
mod rules;
mod words;

use pinhole::{editor::Analysis, source::Sources};

use crate::scenes::sources;

/// The text without `$0`, and where that was.
fn cursor(text: &str) -> (Sources, usize) {
    let at = text.find("$0").expect("a cursor");
    let text = text.replacen("$0", "", 1);
    (sources(&text), at)
}

/// What is asked at the cursor of a text.
fn at_cursor<T>(text: &str, ask: impl FnOnce(&Analysis<'_>, usize) -> T) -> T {
    let (sources, at) = cursor(text);
    ask(&Analysis::new(&sources), at)
}

/// What is asked of a whole text.
fn of_whole<T>(text: &str, ask: impl FnOnce(&Analysis<'_>) -> T) -> T {
    ask(&Analysis::new(&sources(text)))
}
