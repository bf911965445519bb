//! The canonical layout of a scene's text.
//!
//! Formatting keeps all tokens and comments in the same order, and puts the white space between
//! them that `grammar/language.md` describes under "Layout". A text with syntax errors is not
//! formatted. The meaning of names does not matter, so a scene with other mistakes can be
//! formatted.
//!
//! Of the original white space, only line ends matter: they decide whether a block stands on one
//! line, where blank lines separate groups, and to which line a comment belongs. Two texts that
//! differ only in blanks get the same layout. `token_stream` reads tokens and comments from the
//! tree and the text, `entries` makes entries of them, `columns` aligns the entries, and `writer`
//! writes them.

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

/// Returns the canonical layout of a scene's text.
///
/// # Errors
///
/// The text has errors of syntax, all of which are returned.
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
    let formatted = layout(source, entries::of_file(source, &comments, tree.items));
    if is_doubtful && !is_right_text(&formatted) {
        let mistakes = mistakes(source);
        if !mistakes.is_empty() {
            return Err(mistakes);
        }
    }
    Ok(formatted)
}

/// Returns the canonical layout of a text that is parsed already; `None` if the text has syntax
/// errors.
pub fn format_parsed(source: &Source, parsed: &Parsed<'_>) -> Option<String> {
    if !is_right(source, parsed) {
        return None;
    }
    let entries = entries::of_file(source, &parsed.comments, &parsed.tree.items);
    let formatted = layout(source, entries);
    (!parsed.is_doubtful || is_right_text(&formatted)).then_some(formatted)
}

/// Returns whether `text`, a formatted text, has no syntax errors. Formatting may cause some, since
/// it changes line ends, and error recovery takes line ends into account.
fn is_right_text(text: &str) -> bool {
    let source = Source::from_text("", text);
    is_right(&source, &syntax::parse(&source, SourceId::File))
}

/// Returns whether a text has no syntax errors.
fn is_right(source: &Source, parsed: &Parsed<'_>) -> bool {
    parsed.problems.is_empty() && source.invalid_utf8().is_empty() && is_whole(&parsed.tree)
}

/// Returns the canonical layout of a text. `entries` are its definitions, blocks and comments.
fn layout(source: &Source, mut entries: Vec<entries::Entry<'_>>) -> String {
    columns::align(&mut entries);
    let written = writer::written(&entries);
    drop(entries);
    let text = source.text();
    let formatted = with_line_ends(&written, text, source.bom_len());
    debug_assert!(
        visible_bytes(text).eq(visible_bytes(&formatted)),
        "only white space changes"
    );
    formatted
}

/// Returns whether every item was understood and every field has a value. The parser itself does
/// not report a missing value.
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

/// Returns the mistakes that prevent a text from being formatted, as `check` reports them. Other
/// mistakes of the scene are left out. As in `check`, the meaning of names is analyzed first, since
/// a missing value is not reported if its field is unknown.
fn mistakes(source: &Source) -> Vec<Diagnostic> {
    let sources = Sources::new(source.clone());
    let SemanticModel {
        parsed,
        diagnostics,
        ..
    } = scene::analyze(&sources);
    let of_syntax = diagnostics.iter().filter(|it| it.is_of_syntax);
    // Mistakes of syntax and missing values prevent formatting. If a field or kind is unknown,
    // `check` reports the unknown name instead of a missing value. If it reports no mistake of
    // syntax, the unknown names are returned, because they explain why the text is not formatted.
    let codes = ["pinhole::unknown_field", "pinhole::unknown_kind"];
    let is_unknown = |it: &&Diagnostic| codes.contains(&it.code.as_str());
    let unknown = diagnostics.iter().filter(is_unknown);
    let unknown = unknown.cloned().collect();
    let lists = [of_syntax.cloned().collect(), parsed.problems, unknown];
    let mut lists = lists.into_iter().filter(|list| !list.is_empty());
    lists.next().unwrap_or_default()
}

/// Returns the formatted text `written` with the byte order mark and the line ends of the original
/// `text`: CRLF if all line ends of the original are CRLF, and otherwise LF. Blanks at the ends of
/// lines are removed, also in comments. `bom` is the length of the original's byte order mark, in
/// bytes.
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

/// Returns the bytes of a text without white space.
fn visible_bytes(text: &str) -> impl Iterator<Item = u8> {
    text.bytes().filter(|byte| !byte.is_ascii_whitespace())
}
