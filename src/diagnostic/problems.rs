//! A stage's problems, limited in number.
//!
//! A megabyte of signs may contain a million mistakes, and the report of one takes a thousand times
//! the memory of its text; nobody reads the hundredth.

use std::ops::{Deref, DerefMut};

use super::{Diagnostic, Label, Severity};
use crate::source::Span;

/// Maximum number of problems that a stage reports, and of places that one fix changes.
pub const MOST_PROBLEMS: usize = 10_000;

/// Message in place of the problems that are left out; it is not a mistake itself.
pub const LEFT_OUT: &str = "there are too many mistakes, and the others are left out";

/// A stage's problems, at most [`MOST_PROBLEMS`].
#[derive(Debug, Default)]
pub struct Problems {
    kept: Vec<Diagnostic>,
    /// The place of the first problem that was left out.
    left_out: Option<Span>,
}

impl Problems {
    /// Adds a problem, unless the limit is reached or one was left out before it.
    pub fn push(&mut self, problem: Diagnostic) {
        if self.is_full() {
            return;
        }
        if self.kept.len() < MOST_PROBLEMS {
            self.kept.push(problem);
        } else if let Some(label) = problem.labels.first() {
            self.leave_out(label.span);
        }
    }

    /// Adds a problem that was found before another one was left out, unless the limit is reached.
    pub fn push_earlier(&mut self, problem: Diagnostic) {
        if self.kept.len() < MOST_PROBLEMS {
            self.kept.push(problem);
        }
    }

    /// Records that a problem at a place is left out.
    pub fn leave_out(&mut self, span: Span) {
        self.left_out.get_or_insert(span);
    }

    /// Returns whether a problem was left out, so that looking for others is of no use.
    pub fn is_full(&self) -> bool {
        self.left_out.is_some()
    }

    /// Removes the problems from index `length` on.
    pub fn truncate(&mut self, length: usize) {
        self.split_off(length);
    }

    /// Removes and returns the problems from index `length` on, which makes room again.
    pub fn split_off(&mut self, length: usize) -> Vec<Diagnostic> {
        if length < self.kept.len() {
            self.left_out = None;
        }
        self.kept.split_off(length.min(self.kept.len()))
    }
}

/// Returns the problems; if others were left out, the last one says so.
impl From<Problems> for Vec<Diagnostic> {
    fn from(Problems { mut kept, left_out }: Problems) -> Self {
        kept.extend(left_out.map(|span| Diagnostic {
            severity: Severity::Error,
            code: "pinhole::unexpected".to_owned(),
            message: LEFT_OUT.to_owned(),
            help: Some(
                "mend those before it first; perhaps this is no scene of Pinhole".to_owned(),
            ),
            labels: vec![Label {
                span,
                message: "the first one that is left out".to_owned(),
            }],
            fixes: Vec::new(),
            is_needless: false,
            is_of_syntax: true,
        }));
        kept
    }
}

impl Extend<Diagnostic> for Problems {
    fn extend<I: IntoIterator<Item = Diagnostic>>(&mut self, problems: I) {
        problems.into_iter().for_each(|problem| self.push(problem));
    }
}

impl Deref for Problems {
    type Target = [Diagnostic];

    fn deref(&self) -> &[Diagnostic] {
        &self.kept
    }
}

impl DerefMut for Problems {
    fn deref_mut(&mut self) -> &mut [Diagnostic] {
        &mut self.kept
    }
}
