//! The one canonical layout of a scene's text.
//!
//! In: a text without mistakes of syntax. Out: the same tokens and comments in the same order, with
//! the white space between them that `grammar/language.md` describes under "Layout". What the names
//! mean does not matter, so that a scene with other mistakes can be laid out.
//!
//! Of the white space that was there, only the ends of lines tell something: whether a block stands
//! on one line, where blank lines separate groups, and which line a comment belongs to. Blanks tell
//! nothing, so that two texts that differ in them alone are laid out alike. On the way,
//! `token_stream` reads tokens and comments from tree and text, `entries` makes lines of
//! them, `columns` decides what stands under what, and `page` writes it all.

mod columns;
mod entries;
mod token_stream;
mod writer;

pub use token_stream::WIDTH;

use crate::{
    diagnostic::Diagnostic,
    scene::{self, SemanticModel},
    source::{Source, SourceId, Sources},
    syntax::{
        self, Parsed,
        tree::{Item, Tree, ValueKind},
    },
};

/// The canonical layout of a scene's text; or, if it has mistakes of syntax, these.
pub fn format(source: &Source) -> Result<String, Vec<Diagnostic>> {
    let parsed = syntax::parse(source, SourceId::File);
    if !is_right(source, &parsed) {
        return Err(mistakes(source));
    }
    let Parsed {
        tree,
        comments,
        is_doubtful,
        ..
    } = parsed;
    let formatted = laid_out(source, entries::of_file(source, &comments, tree.items));
    if is_doubtful && !is_right_text(&formatted) {
        let mistakes = mistakes(source);
        if !mistakes.is_empty() {
            return Err(mistakes);
        }
    }
    Ok(formatted)
}

/// The canonical layout of a text that is parsed already; none if it has mistakes of syntax.
pub fn format_parsed(source: &Source, parsed: &Parsed<'_>) -> Option<String> {
    if !is_right(source, parsed) {
        return None;
    }
    let entries = entries::of_file(source, &parsed.comments, &parsed.tree.items);
    let formatted = laid_out(source, entries);
    (!parsed.is_doubtful || is_right_text(&formatted)).then_some(formatted)
}

/// Whether a text that was laid out can be laid out again: line ends tell what was hardly meant.
fn is_right_text(text: &str) -> bool {
    let source = Source::from_text("", text);
    is_right(&source, &syntax::parse(&source, SourceId::File))
}

/// Whether a text has no mistakes of syntax.
fn is_right(source: &Source, parsed: &Parsed<'_>) -> bool {
    parsed.problems.is_empty() && source.invalid_utf8().is_empty() && is_whole(&parsed.tree)
}

/// The text of what stands on lines by itself.
fn laid_out(source: &Source, mut entries: Vec<entries::Entry<'_>>) -> String {
    columns::align(&mut entries);
    let written = writer::written(&entries);
    drop(entries);
    let text = source.text();
    let formatted = with_line_ends(&written, text, source.bom_len());
    debug_assert!(ink(text).eq(ink(&formatted)), "only white space changes");
    formatted
}

/// Whether every item was understood, and every field has a value: where it is missing, nothing was
/// reported yet.
fn is_whole(tree: &Tree<'_>) -> bool {
    tree.items.iter().all(|item| match item {
        Item::Definition(_) => true,
        Item::Block(block) => {
            let mut fields = block.fields.iter();
            fields.all(|field| field.value.kind != ValueKind::Missing)
        }
        Item::Bad(_) => false,
    })
}

/// What keeps a text from being laid out, as `check` reports it: only reading the scene tells what
/// a field without a value is called. What else is wrong with the scene is left out.
fn mistakes(source: &Source) -> Vec<Diagnostic> {
    let sources = Sources::new(source.clone());
    let SemanticModel {
        parsed,
        diagnostics,
        ..
    } = scene::analyze(&sources);
    let of_syntax = diagnostics.iter().filter(|it| it.is_of_syntax);
    // A field that its block does not know is mistake enough for `check`, however its value is
    // written.
    let codes = ["pinhole::unknown_field", "pinhole::unknown_kind"];
    let is_unknown = |it: &&Diagnostic| codes.contains(&it.code.as_str());
    let unknown = diagnostics.iter().filter(is_unknown);
    let unknown = unknown.cloned().collect();
    let lists = [of_syntax.cloned().collect(), parsed.problems, unknown];
    let mut lists = lists.into_iter().filter(|list| !list.is_empty());
    lists.next().unwrap_or_default()
}

/// What was written with the byte order mark and the line ends of the text: CRLF if all of them
/// are, or else LF. No line ends with blanks, in comments neither.
fn with_line_ends(written: &str, text: &str, bom: usize) -> String {
    let mut ends = text.split('\n');
    let last = ends.next_back();
    let mut ends = ends.peekable();
    let crlf = last.is_some() && ends.peek().is_some() && ends.all(|line| line.ends_with('\r'));
    let mut formatted = String::with_capacity(written.len() + bom);
    formatted.push_str(text.get(..bom).unwrap_or_default());
    for line in written.lines() {
        formatted.push_str(line.trim_end_matches([' ', '\t', '\r']));
        formatted.push_str(if crlf { "\r\n" } else { "\n" });
    }
    formatted
}

/// All of a text but its white space.
fn ink(text: &str) -> impl Iterator<Item = u8> {
    text.bytes().filter(|byte| !byte.is_ascii_whitespace())
}
