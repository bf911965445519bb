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
        let is_word = self.is(ahead, "for") && !self.is_on_new_line(ahead);
        is_word && (self.is_name(ahead + 1) || self.is(ahead + 1, "("))
    }

    /// Reads `for i < 8, j < i`. In what other languages write for it there is one mistake, whatever
    /// stands before the `{`.
    pub(super) fn repetition(&mut self) -> Result<Repetition<'s>, Span> {
        let told = self.problems.len();
        let mut repetition = Repetition::begun(self.bump());
        while self.is_name(0) && self.is(1, "<") && !self.is(2, "=") {
            let (name, less, count) = (self.name(), self.bump(), self.expression());
            let comma = self.is(0, ",").then(|| self.bump());
            repetition.push(Index {
                name,
                less,
                count,
                comma,
            });
            if comma.is_none() && self.is(0, "{") {
                return Ok(repetition);
            }
            if comma.is_none() {
                break;
            }
        }
        while !matches!(self.word(0), "{" | "}" | "let") && self.kind(0) != TokenKind::End {
            self.bump();
        }
        let span = repetition.keyword.to(self.behind());
        if self.problems.len() == told {
            self.report(&say::BAD_REPETITION, span, &[], None);
        }
        Err(span)
    }
}
