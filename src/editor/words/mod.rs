//! The words and signs of a text, each with what it is by its place.
//!
//! In: a text and what is known of it. Out: its tokens in order, and what could stand at any place of it. What the tree has
//! read, it says; the reader says something of every text, also of the half of a field that is being typed. Both agree on
//! texts without mistakes, which tests hold them to.

mod reader;
mod scan;
mod settled;
#[cfg(test)]
mod tests;

use std::collections::HashSet;

use self::{reader::Reader, scan::scan, settled::settle};
use crate::{
    scene::{
        SemanticModel,
        schema::{self, Type},
    },
    source::{SourceId, Span},
};

/// A word or sign.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Token {
    /// Its place.
    pub span: Span,
    /// What it is.
    pub role: Role,
}

/// What a word or sign is by its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// `let`
    Let,
    /// The name that a `let` defines.
    Defined,
    /// The word that a block starts with.
    Kind,
    /// The name of an object.
    ObjectName,
    /// The name of a field.
    Field,
    /// A name that is a value: of a `let`, a colour, a constant.
    Name,
    /// The name of a function, with its `(` after it.
    Function,
    /// The word of a sampling method.
    Method,
    /// A number, with its unit.
    Number,
    /// `#rgb` or `#rrggbb`.
    ColorCode,
    /// `+ - * /`
    Operator,
    /// `=`
    Equals,
    /// `{`
    Open,
    /// `}`
    Close,
    /// `(`
    OpenList,
    /// `)`
    CloseList,
    /// `,`
    Comma,
    /// Nothing of the language.
    Other,
}

/// What could stand at a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Expected {
    /// `let`, or a block.
    Item,
    /// The name of a new `let`, or what follows it.
    Definition,
    /// The name of an object, or `{`.
    Head,
    /// A field of the block, or whatever else goes on behind a value.
    Field,
    /// A value, or a part of one.
    Value,
}

/// A place in a text, with what stands around it.
#[derive(Clone, Debug)]
pub struct Situation {
    /// What could stand here.
    pub expected: Expected,
    /// The block around it, if its kind is known.
    pub block: Option<&'static schema::Block>,
    /// The fields that are given in that block, the word at the place excepted.
    pub given: Vec<&'static str>,
    /// The field whose value it is.
    pub field: Option<&'static schema::Field>,
    /// The type that would fit, if it is known.
    pub wanted: Option<Type>,
    /// The name that is being defined: it cannot use itself.
    pub defining: Option<Span>,
    /// Whether a value starts here: nothing of it stands before.
    pub is_start: bool,
    /// The word that is being typed, or nothing.
    pub word: Span,
    /// What stands behind the word.
    pub next: Option<Token>,
}

/// The tokens of a text.
pub fn tokens(survey: &SemanticModel<'_>) -> Vec<Token> {
    let mut tokens = read(survey.sources().file.text(), &survey.parsed.comments);
    settle(&mut tokens, survey);
    tokens
}

/// The tokens of a text, by their places alone.
fn read(text: &str, comments: &[Span]) -> Vec<Token> {
    let mut tokens = scan(text, comments);
    let lets = defined_names(text, &tokens);
    let mut reader = Reader::new(text, &lets);
    for index in 0..tokens.len() {
        let role = reader.step(&tokens, index);
        if let Some(token) = tokens.get_mut(index) {
            token.role = role;
        }
    }
    tokens
}

/// What could stand at a place, where a word is being typed or none yet; none within comments and numbers.
pub fn situation(text: &str, tokens: &[Token], comments: &[Span], at: usize) -> Option<Situation> {
    if is_in_comment(text, comments, at) {
        return None;
    }
    let lets = defined_names(text, tokens);
    let mut tokens = tokens.to_vec();
    let index = tokens.partition_point(|token| token.span.end < at);
    let word = match tokens.get(index) {
        Some(token) if token.span.start < at && is_word(text, *token) => token.span,
        Some(token) if token.span.start < at && at < token.span.end => return None,
        Some(token) if is_literal(*token) && token.span.end == at => return None,
        _ => file(at, at),
    };
    let index = match word.range().is_empty() {
        // Behind the token that ends here.
        true => {
            let index = tokens.partition_point(|token| token.span.end <= at);
            let empty = Token {
                span: word,
                role: Role::Name,
            };
            tokens.insert(index, empty);
            index
        }
        false => index,
    };
    let mut reader = Reader::new(text, &lets);
    for before in 0..index {
        reader.step(&tokens, before);
    }
    let mut expected = reader.expected(&tokens, index);
    let placed = tokens.get(index).copied();
    if expected == Expected::Value
        && reader.after_value
        && placed.is_some_and(|token| reader.is_on_new_line(token))
    {
        // A list that was not closed in the line before: what comes next is no value.
        expected = match reader.in_block {
            true => Expected::Field,
            false => Expected::Item,
        };
    }
    let mut situation = Situation {
        expected,
        block: reader.row,
        given: reader.given.clone(),
        field: reader.field.filter(|_| expected == Expected::Value),
        wanted: reader.wanted(expected),
        defining: reader.defining,
        is_start: reader
            .last
            .is_some_and(|last| matches!(last.role, Role::Field | Role::Equals)),
        word,
        next: tokens.get(index + 1).copied(),
    };
    // What is given behind the place, in the same block.
    reader.step(&tokens, index);
    let mut later = Vec::new();
    let depth = reader.blocks;
    for after in index + 1..tokens.len() {
        let role = reader.step(&tokens, after);
        if role == Role::Close || reader.blocks != depth {
            break;
        }
        let token = tokens.get(after).filter(|_| role == Role::Field);
        let name = token.map(|token| slice(text, token.span));
        later.extend(name.and_then(|name| Some(situation.block?.field(name)?.name)));
    }
    situation.given.extend(later);
    Some(situation)
}

/// The innermost call around a place, by the place of the function's name, and how many commas stand before; none within
/// comments. What the place touches or lies within, be it a word or a number, is an argument of the call around it.
pub fn call(text: &str, tokens: &[Token], comments: &[Span], at: usize) -> Option<(Span, usize)> {
    if is_in_comment(text, comments, at) {
        return None;
    }
    let lets = defined_names(text, tokens);
    let mut reader = Reader::new(text, &lets);
    for (index, &token) in tokens.iter().enumerate() {
        let is_touched = token.span.end == at && (is_word(text, token) || is_literal(token));
        if token.span.end > at || is_touched {
            break;
        }
        reader.step(tokens, index);
    }
    reader.calls().pop()
}

/// A place in the file.
pub fn file(start: usize, end: usize) -> Span {
    Span::new(SourceId::File, start, end)
}

fn is_in_comment(text: &str, comments: &[Span], at: usize) -> bool {
    let next = comments.partition_point(|comment| comment.end < at);
    comments.get(next).is_some_and(|comment| {
        // Behind `*/` the comment is over; a comment to the end of the line is not over before it.
        let is_closed = comment.end == at && slice(text, *comment).ends_with("*/");
        comment.start < at && !is_closed
    })
}

fn slice(text: &str, span: Span) -> &str {
    text.get(span.range()).unwrap_or_default()
}

fn is_word(text: &str, token: Token) -> bool {
    slice(text, token.span).starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
}

fn is_literal(token: Token) -> bool {
    matches!(token.role, Role::Number | Role::ColorCode)
}

/// The names that stand behind a `let`, wherever.
fn defined_names<'t>(text: &'t str, tokens: &[Token]) -> HashSet<&'t str> {
    let pairs = tokens.iter().zip(tokens.iter().skip(1));
    let lets = pairs.filter(|(first, _)| slice(text, first.span) == "let");
    lets.map(|(_, name)| slice(text, name.span)).collect()
}
