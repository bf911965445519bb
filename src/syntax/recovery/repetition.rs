//! Indices: what stands between the name of an object and its `{`.

use super::{Recovery, is_name};
use crate::{
    diagnostic::{Edit, Fix},
    source::Span,
    syntax::{
        messages as say,
        problem::{replace, shorten},
        tokens::{TokenKind, is_name_char},
        tree::{Index, Repetition, ValueKind},
    },
};

impl<'s> Recovery<'_, 's> {
    /// Whether indices start at a token ahead: a line that starts with `for` is for others to tell.
    pub(super) fn is_repetition(&mut self, ahead: usize) -> bool {
        let words = ["for", "foreach", "loop", "repeat", "while"];
        let is_word = words.contains(&self.word(ahead)) && !self.is_on_new_line(ahead);
        let next = ahead + 1;
        is_word
            && (self.is_name(next) || self.is(next, "(") || self.kind(next) == TokenKind::Number)
    }

    /// Reads `for i < 8, j < i`. In what other languages write for it there is one mistake,
    /// whatever stands before the `{`.
    pub(super) fn repetition(&mut self) -> Result<Repetition<'s>, Span> {
        let told = self.problems.len();
        let (is_for, keyword) = (self.is(0, "for"), self.bump());
        let mut indices = Vec::new();
        while is_for && self.is_name(0) && self.is(1, "<") {
            let index = self.index();
            let is_last = index.comma.is_none();
            indices.push(index);
            if is_last && self.is(0, "{") {
                return Ok(Repetition { keyword, indices });
            }
            if is_last {
                break;
            }
        }
        while !matches!(self.word(0), "{" | "}" | "let")
            && self.kind(0) != TokenKind::End
            && !(self.is_on_new_line(0) && self.is_head(0))
        {
            self.bump();
        }
        let span = keyword.to(self.behind());
        if self.problems.len() == told {
            let fix = from_zero(self.written(span)).map(|right| replace(span, right));
            self.report(&say::BAD_REPETITION, span, &[], fix);
        }
        Err(span)
    }

    /// Reads `i < 8`, with the comma behind it, or `i <= 7`.
    pub(super) fn index(&mut self) -> Index<'s> {
        let (name, less) = (self.name(), self.bump());
        let equal = self.is(0, "=").then(|| self.bump());
        let count = self.expression();
        if let Some(equal) = equal {
            let sign = less.to(equal);
            let behind = match (&count.kind, self.written(count.span).parse::<u32>()) {
                (ValueKind::Number(_), Ok(last)) => format!("{}", u64::from(last) + 1),
                _ => format!("{} + 1", self.written(count.span)),
            };
            let right = format!("{} < {behind}", name.text);
            let title = format!("write `{}`: an index begins at 0", shorten(&right));
            let whole = name.span.to(count.span);
            let fix = Fix::new(title, [Edit::new(whole, right)]);
            self.report(&say::COUNT_WITH_LAST, sign, &[], fix);
        }
        let comma = self.is(0, ",").then(|| self.bump());
        Index {
            name,
            less,
            count,
            comma,
        }
    }
}

/// `for i in 0..8` and `for i in range(8)`, as they are written here.
fn from_zero(written: &str) -> Option<String> {
    let (index, range) = written.strip_prefix("for ")?.split_once(" in ")?;
    let range = range.trim();
    let of_python = range
        .strip_prefix("range(")
        .and_then(|rest| rest.strip_suffix(')'));
    let count = range.strip_prefix("0..").or(of_python)?;
    let is_count = !count.is_empty() && count.bytes().all(is_name_char);
    (is_count && is_name(index)).then(|| format!("for {index} < {count}"))
}
