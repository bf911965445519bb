//! Indices: what stands between the name of an object and its `{`.

use super::Recovery;
use crate::{
    source::Span,
    syntax::{
        messages as say,
        tokens::TokenKind,
        tree::{Index, Repetition},
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
        while is_for && self.is_name(0) && self.is(1, "<") && !self.is(2, "=") {
            let (name, less, count) = (self.name(), self.bump(), self.expression());
            let comma = self.is(0, ",").then(|| self.bump());
            indices.push(Index {
                name,
                less,
                count,
                comma,
            });
            match comma {
                Some(_) => continue,
                None if self.is(0, "{") => return Ok(Repetition { keyword, indices }),
                None => break,
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
            self.report(&say::BAD_REPETITION, span, &[], None);
        }
        Err(span)
    }
}
