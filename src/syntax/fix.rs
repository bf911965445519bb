//! What can be done about problems of syntax.

use std::fmt;

use super::{
    Problem,
    tokens::{Lexer, TokenKind},
};
use crate::{
    diagnostic::{Edit, Fix, Fixable, with_comments},
    source::{Sources, Span},
};

/// A way out of a problem: what to do, and what has to be changed for that, if a program can do it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Way {
    /// What to do, as a request: "write `30deg`".
    pub help: String,
    /// What there is to say beside it.
    pub note: &'static str,
    /// What is written.
    pub edits: Vec<Edit>,
    /// What is taken away.
    pub removed: Vec<Span>,
}

impl Way {
    /// What the author has to do.
    pub fn told(help: impl Into<String>) -> Self {
        Self {
            help: help.into(),
            ..Self::default()
        }
    }

    /// Writes these edits.
    pub fn write(help: impl Into<String>, edits: impl IntoIterator<Item = Edit>) -> Self {
        Self {
            edits: edits.into_iter().collect(),
            ..Self::told(help)
        }
    }

    /// Writes a text in a place; the help shows it.
    pub fn replace(span: Span, text: impl Into<String>) -> Self {
        let text = text.into();
        Self::write(
            format!("write `{}`", super::shorten(&text)),
            [Edit::new(span, text)],
        )
    }

    /// Takes away what stands in a place.
    pub fn remove(help: impl Into<String>, span: Span) -> Self {
        Self {
            removed: vec![span],
            ..Self::told(help)
        }
    }

    /// Leaves it to the author.
    pub fn leave(&mut self) {
        self.edits.clear();
        self.removed.clear();
    }

    /// In how many places something is taken away.
    pub fn places(&self) -> usize {
        self.removed.len().max(1)
    }

    fn fixes(&self, sources: &Sources) -> Vec<Fix> {
        let removed = self.removed.iter().map(|span| Edit::remove(*span, sources));
        let edits: Vec<Edit> = self.edits.iter().cloned().chain(removed).collect();
        match edits.is_empty() {
            true => Vec::new(),
            false => vec![Fix::new(&self.help, edits)],
        }
    }
}

impl fmt::Display for Way {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.help)?;
        f.write_str(self.note)
    }
}

impl Problem {
    /// Leaves what to do to the author, as other mistakes stand beside this one.
    pub(super) fn leave(&mut self) {
        match self {
            Self::NestedComment { way, .. }
            | Self::UnclosedParenthesis { way, .. }
            | Self::StrayClosing { way, .. }
            | Self::MissingOperand { way, .. }
            | Self::NeedlessEquals { way, .. }
            | Self::NeedlessSeparator { way, .. }
            | Self::MissingEquals { way, .. }
            | Self::MissingOperator { way, .. }
            | Self::MissingComma { way, .. }
            | Self::MissingSpace { way, .. }
            | Self::NeedlessComma { way, .. }
            | Self::DecimalComma { way, .. }
            | Self::MissingParentheses { way, .. }
            | Self::Brackets { way, .. }
            | Self::UnknownOperator { way, .. }
            | Self::PlusSign { way, .. }
            | Self::BadNumber { way, .. }
            | Self::MissingFieldName { way, .. }
            | Self::MissingLet { way, .. } => way.leave(),
            Self::MisplacedLet { is_alone, .. } => *is_alone = false,
            _ => {}
        }
    }

    /// Whether it makes doubtful where its block's fields end.
    pub(super) fn is_structural(&self) -> bool {
        matches!(
            self,
            Self::NestedBraces { .. }
                | Self::UnclosedParenthesis { .. }
                | Self::StrayClosing { .. }
                | Self::Unexpected { .. }
                | Self::MissingFieldName { .. }
                | Self::MissingParentheses { .. }
        )
    }
}

impl Fixable for Problem {
    fn is_needless(&self) -> bool {
        matches!(
            self,
            Self::NeedlessEquals { .. }
                | Self::NeedlessSeparator { .. }
                | Self::NeedlessComma { .. }
                | Self::PlusSign { .. }
        )
    }

    fn is_of_syntax(&self) -> bool {
        true
    }

    fn fixes(&self, sources: &Sources) -> Vec<Fix> {
        match self {
            Self::OddSpace { places, span, .. } => odd_spaces(places, sources.text(*span)),
            Self::LoneReturn { span } => vec![with_line_ends(*span, sources)],
            Self::ForeignComment { is_sure: false, .. } => Vec::new(),
            Self::ForeignComment { right, places, .. } => vec![Fix::new(
                format!("write `{right}`"),
                places.iter().map(|place| Edit::new(*place, "//")),
            )],
            Self::UnclosedComment { span } => unclosed_comment(*span, sources),
            Self::UnclosedBlock {
                kind, open, end, ..
            } => {
                let written = sources.text(open.to(*end));
                let apart = match written.contains('\n') {
                    true => sources.get(open.source).line_end(),
                    false => " ",
                };
                let edit = Edit::new(*end, format!("{apart}}}"));
                vec![Fix::new(format!("close the block of `{kind}`"), [edit])]
            }
            Self::MisplacedLet {
                is_alone: false, ..
            } => Vec::new(),
            Self::MisplacedLet {
                definitions, block, ..
            } => vec![moved_before(*definitions, *block, sources)],
            Self::NestedComment { way, .. }
            | Self::UnclosedParenthesis { way, .. }
            | Self::StrayClosing { way, .. }
            | Self::MissingOperand { way, .. }
            | Self::NeedlessEquals { way, .. }
            | Self::NeedlessSeparator { way, .. }
            | Self::MissingEquals { way, .. }
            | Self::MissingOperator { way, .. }
            | Self::MissingComma { way, .. }
            | Self::MissingSpace { way, .. }
            | Self::NeedlessComma { way, .. }
            | Self::DecimalComma { way, .. }
            | Self::MissingParentheses { way, .. }
            | Self::Brackets { way, .. }
            | Self::UnknownOperator { way, .. }
            | Self::PlusSign { way, .. }
            | Self::Quoted { way, .. }
            | Self::BadNumber { way, .. }
            | Self::SpacedUnit { way, .. }
            | Self::BadColorCode { way, .. }
            | Self::ForeignFunction { way, .. }
            | Self::UnopenedBlock { way, .. }
            | Self::BadHead { way, .. }
            | Self::MissingFieldName { way, .. }
            | Self::MissingLet { way, .. } => way.fixes(sources),
            // What is missing or meant is for the author to say.
            Self::InvalidUtf8 { .. }
            | Self::Utf16 { .. }
            | Self::ForeignFile { .. }
            | Self::NotInLanguage { .. }
            | Self::TooDeep { .. }
            | Self::MissingValue { .. }
            | Self::FieldWithoutValue { .. }
            | Self::MissingPart { .. }
            | Self::SetWithoutValue { .. }
            | Self::MissingName { .. }
            | Self::BadName { .. }
            | Self::MissingKind { .. }
            | Self::NestedBraces { .. }
            | Self::OutsideBlock { .. }
            | Self::Unexpected { .. } => Vec::new(),
        }
    }
}

/// A comment of one line is meant, as a rule. It ends with its line, before what closes something that was opened before it.
fn unclosed_comment(span: Span, sources: &Sources) -> Vec<Fix> {
    let text = sources.get(span.source).text();
    let before = text.get(..span.start).unwrap_or_default();
    let before = before.rsplit('\n').next().unwrap_or_default();
    let taken = text.get(span.start..).unwrap_or_default();
    let line = taken.lines().next().unwrap_or_default().trim_end();
    let opened = before.matches(['{', '(']).count();
    let closed = before.matches(['}', ')']).count();
    let is_closing = |c: char| matches!(c, '}' | ')' | ' ');
    let closing: String = match opened > closed {
        true => line.chars().rev().take_while(|c| is_closing(*c)).collect(),
        false => String::new(),
    };
    let after = taken.get(line.len()..).unwrap_or_default();
    if !is_read_on(after) {
        let end = span.start + taken.trim_end().len();
        let edit = Edit::insert(span.source, end, " */");
        return vec![Fix::new("close it at the end", [edit])];
    }
    let at = span.start + line.len() - closing.len();
    let mut fixes = vec![Fix::new(
        "close it in its line",
        [Edit::insert(span.source, at, " */")],
    )];
    if closing.is_empty() {
        fixes.push(Fix::new("begin it with `//`", [Edit::new(span, "//")]));
    }
    fixes
}

/// Whether what a comment took from a line on looks like a part of a scene, or is nothing.
fn is_read_on(after: &str) -> bool {
    let mut lexer = Lexer::new(after, 0);
    let (first, second, third) = (lexer.token(), lexer.token(), lexer.token());
    let word = after.get(first.start..first.end).unwrap_or_default();
    let opens = matches!(after.get(second.start..second.end), Some("{" | "(" | "-"));
    let ends = matches!(after.get(third.start..third.end), Some("{" | "}"));
    match first.kind {
        TokenKind::End => true,
        TokenKind::Name => opens || ends || word == "let" || second.kind == TokenKind::Number,
        _ => word == "}",
    }
}

/// What has no width, as a rule, is not meant to keep words apart.
fn odd_spaces(places: &[Span], sort: &str) -> Vec<Fix> {
    let all = |text| -> Vec<Edit> {
        let edits = places.iter().map(|place| Edit::new(*place, text));
        edits.collect()
    };
    let spaces = Fix::new("write plain spaces", all(" "));
    match sort.chars().all(char::is_whitespace) {
        true => vec![spaces],
        false => vec![Fix::new("take it away", all("")), spaces],
    }
}

/// Ends all lines that end at a carriage return alone.
fn with_line_ends(span: Span, sources: &Sources) -> Fix {
    let source = sources.get(span.source);
    let text = source.text();
    let returns = text.match_indices('\r');
    let lone = returns.filter(|(at, _)| text.as_bytes().get(at + 1) != Some(&b'\n'));
    let edits = lone.map(|(at, _)| {
        let place = Span::new(span.source, at, at + 1);
        Edit::new(place, source.line_end())
    });
    Fix::new("end these lines as text files do", edits)
}

/// Moves definitions out of a block.
fn moved_before(definitions: Span, block: Span, sources: &Sources) -> Fix {
    let source = sources.get(block.source);
    let before = source.text().get(..block.start).unwrap_or_default();
    let line = before.rsplit('\n').next().unwrap_or_default();
    let indent = if line.trim().is_empty() { line } else { "" };
    let definitions = with_comments(definitions, sources);
    let text = format!("{}{}{indent}", sources.text(definitions), source.line_end());
    Fix::new(
        "move it before the block",
        [
            Edit::insert(block.source, block.start, text),
            Edit::remove(definitions, sources),
        ],
    )
}

/// The length of a text without the white space and the comments at its end.
pub fn written_length(text: &str) -> usize {
    let mut lexer = Lexer::new(text, 0);
    let mut end = 0;
    loop {
        let token = lexer.token();
        match token.kind {
            TokenKind::End => return end,
            TokenKind::Comment | TokenKind::OpenComment => {}
            _ => end = token.end,
        }
    }
}
