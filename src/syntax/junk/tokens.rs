//! The tokens of junk.

use crate::{
    source::Span,
    syntax::{comments::is_odd_space, tree::Name},
};

pub(super) fn tokens<'s>(text: &'s str, span: Span) -> Vec<Token<'s>> {
    // A piece of junk can be a megabyte; what is wrong with it shows at its beginning.
    const ENOUGH: usize = 10_000;
    let written = text.get(span.range()).unwrap_or_default();
    Tokens::new(written, 0).take(ENOUGH).collect()
}

/// A token of junk.
#[derive(Clone, Copy, Debug)]
pub(super) struct Token<'s> {
    pub(super) kind: Kind,
    pub(super) text: &'s str,
    pub(super) start: usize,
    pub(super) end: usize,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Word,
    Number,
    Color,
    Quoted,
    /// A sign that the language has.
    Sign,
    /// A sign that it has not, or not within a value.
    Odd,
}

impl<'s> Token<'s> {
    pub(super) fn is(&self, text: &str) -> bool {
        self.text == text
    }

    pub(super) fn is_operator(&self) -> bool {
        matches!(self.text, "+" | "-" | "*" | "/")
    }

    pub(super) fn starts_value(&self) -> bool {
        !matches!(self.kind, Kind::Sign | Kind::Odd) || self.is("(")
    }

    pub(super) fn ends_value(&self) -> bool {
        !matches!(self.kind, Kind::Sign | Kind::Odd) || self.is(")")
    }

    pub(super) fn span(&self, within: Span) -> Span {
        Span::new(
            within.source,
            within.start + self.start,
            within.start + self.end,
        )
    }

    pub(super) fn name(&self, text: &'s str, within: Span) -> Name<'s> {
        let span = self.span(within);
        Name {
            text: text.get(span.range()).unwrap_or_default(),
            span,
        }
    }
}

/// The tokens of a text; comments and white space are passed over.
pub(super) struct Tokens<'s> {
    text: &'s str,
    at: usize,
}

impl<'s> Tokens<'s> {
    pub(super) fn new(text: &'s str, at: usize) -> Self {
        Self { text, at }
    }

    fn rest(&self) -> &'s str {
        self.text.get(self.at..).unwrap_or_default()
    }

    fn skip_gap(&mut self) {
        loop {
            let rest = self.rest();
            let gap = |c: char| matches!(c, ' ' | '\t' | '\r' | '\n') || is_odd_space(c);
            let trimmed = rest.trim_start_matches(gap);
            self.at += rest.len() - trimmed.len();
            let length = if trimmed.starts_with("//") {
                trimmed.find('\n')
            } else if trimmed.starts_with("/*") {
                trimmed.find("*/").map(|end| end + 2)
            } else {
                return;
            };
            self.at += length.unwrap_or(trimmed.len());
        }
    }
}

impl<'s> Iterator for Tokens<'s> {
    type Item = Token<'s>;

    fn next(&mut self) -> Option<Token<'s>> {
        self.skip_gap();
        let rest = self.rest();
        let first = rest.chars().next()?;
        let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
        let run = |is: &dyn Fn(char) -> bool| rest.find(|c| !is(c)).unwrap_or(rest.len());
        let point = rest.strip_prefix('.');
        let (kind, length) = match first {
            '0'..='9' => (Kind::Number, run(&|c| is_word(c) || c == '.')),
            '.' if point.is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit())) => {
                (Kind::Number, run(&|c| is_word(c) || c == '.'))
            }
            '#' => (Kind::Color, 1 + run_after(rest, is_word)),
            '"' | '\'' => {
                let inner = rest.get(1..).unwrap_or_default();
                let end = inner.find([first, '\n']);
                let closed = end.is_some_and(|end| inner.as_bytes().get(end) != Some(&b'\n'));
                let length = end.map_or(rest.len(), |end| 1 + end + usize::from(closed));
                (Kind::Quoted, length)
            }
            _ if is_word(first) => (Kind::Word, run(&is_word)),
            '+' | '-' | '*' | '/' | '(' | ')' | ',' | '[' | ']' if !rest.starts_with("**") => {
                (Kind::Sign, 1)
            }
            '*' => (Kind::Odd, 2),
            _ => (Kind::Odd, first.len_utf8()),
        };
        let start = self.at;
        self.at += length;
        Some(Token {
            kind,
            text: self.text.get(start..self.at).unwrap_or_default(),
            start,
            end: self.at,
        })
    }
}

fn run_after(rest: &str, is: impl Fn(char) -> bool) -> usize {
    let inner = rest.get(1..).unwrap_or_default();
    inner.find(|c| !is(c)).unwrap_or(inner.len())
}
