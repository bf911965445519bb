//! Finds out what can be typed at an offset of the text.
//!
//! The word at the offset is replaced by a made-up name, and the text is parsed as usual. The
//! position of this name in the syntax tree determines what can be typed.

use super::{
    analysis::{Analysis, Path},
    tokens::{Role, RoleToken, file},
};
use crate::{
    schema::{self, Type},
    source::{Source, SourceId, Span},
    syntax::{
        self,
        tree::{self, Block, ValueKind},
    },
};

/// Made-up name that replaces the word at the cursor while the text is parsed. Any name that no
/// scene uses would do.
const CURSOR: &str = "__cursor__";

/// The context of an offset in the text: what can be typed, and where.
#[derive(Clone, Debug)]
pub struct Situation {
    /// Kind of text that can be typed: an item, a field or a value.
    pub expected: Expected,
    /// The language's description of the current block; `None` if the block's keyword is unknown.
    pub block: Option<&'static schema::BlockRow>,
    /// Names of the fields that the current block has. A name that is just being typed is not among
    /// them.
    pub given: Vec<&'static str>,
    /// The field whose value is being typed; `None` if no value is being typed.
    pub field: Option<&'static schema::FieldRow>,
    /// Type that the typed value should have; `None` if it is not known.
    pub wanted: Option<Type>,
    /// Span of the name whose definition is being typed. The definition's value cannot use this
    /// name.
    pub defining: Option<Span>,
    /// Whether the cursor is where the value of a field or definition belongs, and no part of the
    /// value is typed yet.
    pub is_whole_value: bool,
    /// Whether the text that must follow the typed word already exists: the braces of a block, the
    /// value of a field, or the arguments of a function.
    pub goes_on: bool,
    /// Span of the word that is being typed; empty if no word is being typed.
    pub word: Span,
}

/// Kind of text that can be typed at an offset.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Expected {
    /// A definition with `let`, or a block.
    Item,
    /// A field of the block.
    Field,
    /// A value, or a part of a value.
    Value,
}

/// Returns what can be typed at the offset `at`. Returns `None` within a comment, a number, or a
/// name that is being defined.
pub fn situation(analysis: &Analysis<'_>, at: usize) -> Option<Situation> {
    let ends = |token: &RoleToken| token.span.end == at && !is_part(analysis, token);
    let word = touched(analysis, at, |token| token.span.start < at && !ends(token))?;
    let is_word = word.range().is_empty() || analysis.slice(word).starts_with(is_letter);
    let ask = |path: Path<'_, '_>| of_path(path, word);
    is_word.then(|| with_cursor(analysis, word, ask)).flatten()
}

/// Finds the innermost function call around the offset `at`. Returns the span of the function's
/// name, and the index of the argument at the offset. Returns `None` if no argument of a call is at
/// the offset.
pub fn call(analysis: &Analysis<'_>, at: usize) -> Option<(Span, usize)> {
    let word = touched(analysis, at, |token| is_part(analysis, token))?;
    with_cursor(analysis, word, |path| {
        let around = path.values.iter().zip(path.values.iter().skip(1));
        let mut calls = around.filter_map(|(outer, inner)| match &outer.kind {
            ValueKind::Call(call) => {
                let mut arguments = call.arguments.iter();
                let index = arguments.position(|it| it.value.span == inner.span)?;
                Some((call.function.span, index))
            }
            _ => None,
        });
        calls.next_back()
    })
}

/// Returns whether a token is a word, a number or a colour code.
fn is_part(analysis: &Analysis<'_>, token: &RoleToken) -> bool {
    matches!(token.role, Role::Number | Role::ColorCode)
        || analysis.slice(token.span).starts_with(is_letter)
}

fn is_letter(c: char) -> bool {
    c.is_ascii_alphabetic() || c == '_'
}

/// Returns the span of the first token that touches the offset `at` and satisfies `is_meant`. If
/// there is none, returns the empty span at `at`. Returns `None` if `at` is in a comment.
fn touched(
    analysis: &Analysis<'_>,
    at: usize,
    is_meant: impl Fn(&RoleToken) -> bool,
) -> Option<Span> {
    let comments = analysis.comments();
    let next = comments.partition_point(|comment| comment.end < at);
    let is_in_comment = comments.get(next).is_some_and(|comment| {
        // The offset after `*/` is outside of the comment, but the end of a line comment is inside.
        let is_closed = comment.end == at && analysis.slice(*comment).ends_with("*/");
        comment.start < at && !is_closed
    });
    let tokens = analysis.tokens();
    let first = tokens.partition_point(|token| token.span.end < at);
    let mut touching = tokens.iter().skip(first);
    let token = touching
        .by_ref()
        .take_while(|token| token.span.start <= at)
        .find(|token| is_meant(token));
    (!is_in_comment).then(|| token.map_or(file(at, at), |token| token.span))
}

/// Parses the text with the made-up name [`CURSOR`] in place of `word`. Calls `ask` with the path
/// to this name in the syntax tree, and returns its result. Returns `None` if `word` is not in the
/// text.
fn with_cursor<T>(
    analysis: &Analysis<'_>,
    word: Span,
    ask: impl FnOnce(Path<'_, '_>) -> Option<T>,
) -> Option<T> {
    let (before, after) = (
        analysis.text().get(..word.start)?,
        analysis.text().get(word.end..)?,
    );
    let apart = if word.range().is_empty() { " " } else { "" };
    // A list without a closing parenthesis is missing from the tree. If the name is in such a list,
    // the text is parsed again with closing parentheses after the name.
    let mut closing = String::new();
    loop {
        let text = format!("{before}{CURSOR}{closing}{apart}{after}");
        let source = Source::from_text("", text);
        let parsed = syntax::parse(&source, SourceId::File);
        let path = Path::new(&parsed.tree.items, word.start + 1);
        let is_lost = path
            .values
            .last()
            .is_some_and(|it| matches!(it.kind, ValueKind::Bad));
        if !is_lost || !closing.is_empty() {
            return ask(path);
        }
        closing = ")".repeat(open_lists(analysis, word.start).max(1));
    }
}

/// Returns the number of parentheses that are open at the offset `at`.
fn open_lists(analysis: &Analysis<'_>, at: usize) -> usize {
    let before = analysis.tokens().iter();
    let before = before.take_while(|token| token.span.end <= at);
    before.fold(0, |open, token| match analysis.slice(token.span) {
        "(" => open + 1,
        ")" => usize::saturating_sub(open, 1),
        "{" | "}" | "let" => 0,
        _ => open,
    })
}

/// Returns what can be typed in place of `word`. `path` is the path in the syntax tree to the name
/// that replaces `word` while the text is parsed. Returns `None` if `word` is the name of a
/// definition, or stands between the keyword and the braces of a block.
fn of_path(path: Path<'_, '_>, word: Span) -> Option<Situation> {
    let row = path
        .block
        .and_then(|block| schema::block_or_nearest(block.kind?.text));
    let given = path.block.into_iter().flat_map(|block| &block.fields);
    let given = given.filter_map(|field| Some(row?.field(field.name.text)?.name));
    let mut situation = Situation {
        expected: Expected::Item,
        block: row,
        given: given.collect(),
        field: None,
        wanted: None,
        defining: path.definition.and_then(|it| it.name).map(|name| name.span),
        is_whole_value: false,
        goes_on: false,
        word,
    };
    if let (Some(last), true) = (path.values.last(), holds_value(&path)) {
        situation.expected = Expected::Value;
        situation.field = path.field.and_then(|field| row?.field(field.name.text));
        situation.wanted = wanted(&path, situation.field.map(|field| field.takes));
        situation.is_whole_value =
            path.values.len() == 1 && is_cursor(last) && word.start == word.end;
        situation.goes_on = matches!(last.kind, ValueKind::Call(_));
    } else if let Some(field) = path.field {
        situation.expected = Expected::Field;
        // If the value of a field is missing, the parser reads the next field's name as this value.
        // The next field is then treated as given, too.
        let next = match &field.value.kind {
            ValueKind::Name(name) => Some(*name),
            ValueKind::Call(call) => Some(call.function.text),
            _ => None,
        };
        let next = next.and_then(|name| row?.field(name));
        situation.given.extend(next.map(|next| next.name));
        let is_empty = matches!(field.value.kind, ValueKind::Missing | ValueKind::Bad);
        situation.goes_on = !is_empty && next.is_none();
    } else if let Some(block) = path.block {
        situation.expected = expected_in(block, word.start)?;
        // If a complete block follows the typed word, the parser reads the following keyword as the
        // name of the typed block. The braces then belong to the following block.
        let is_own =
            |block: &Block<'_>| block.name.is_none_or(|it| schema::block(it.text).is_none());
        situation.goes_on = block.open.is_some() && is_own(block);
    } else if path.definition.is_some() {
        return None;
    }
    situation.goes_on &= word.start < word.end;
    Some(situation)
}

/// Returns whether [`CURSOR`] is in a value rather than the name of a field or a definition.
fn holds_value(path: &Path<'_, '_>) -> bool {
    path.field.is_none_or(|field| field.name.text != CURSOR)
        && path
            .definition
            .and_then(|it| it.name)
            .is_none_or(|name| name.text != CURSOR)
}

fn is_cursor(value: &tree::Value<'_>) -> bool {
    matches!(value.kind, ValueKind::Name(CURSOR))
}

/// Returns what can be typed at the offset `at`, which is in a block but not in one of its fields:
/// a keyword at the start of the block, or a field between the braces. Returns `None` between the
/// keyword and the braces.
fn expected_in(block: &Block<'_>, at: usize) -> Option<Expected> {
    if block.kind.is_some_and(|kind| kind.text == CURSOR) {
        return Some(Expected::Item);
    }
    let is_inside = block.open.is_some_and(|open| open.end <= at);
    is_inside.then_some(Expected::Field)
}

/// Returns the type that the innermost part of a value should have, or `None` if any type may be
/// right. `takes` is the type that the whole value should have.
fn wanted(path: &Path<'_, '_>, takes: Option<Type>) -> Option<Type> {
    let mut wanted = takes;
    for (outer, inner) in path.values.iter().zip(path.values.iter().skip(1)) {
        wanted = match &outer.kind {
            ValueKind::Call(call) => {
                let mut arguments = call.arguments.iter();
                let index = arguments.position(|it| it.value.span == inner.span)?;
                schema::function(call.function.text)?.parameter(index)
            }
            ValueKind::Tuple(_) | ValueKind::Parentheses(_) => match wanted {
                Some(Type::Colors | Type::FaceColors) => Some(Type::Color),
                // A part of a vector is a number. In an expression whose value is a vector,
                // parentheses usually contain a number, too.
                Some(Type::Vector) => Some(Type::Number),
                wanted => wanted,
            },
            _ => wanted,
        };
    }
    wanted
}
