//! The problems that a stage has found so far, of which it keeps a limited number.
//!
//! A megabyte of signs may hold a million mistakes, and what is said of one takes a thousand times
//! its text in memory; nobody reads the hundredth.

use std::ops::{Deref, DerefMut};

use super::{Diagnostic, Label, Severity};
use crate::source::Span;

/// Maximum number of problems that a stage reports, and of places that one fix changes.
pub const MOST_PROBLEMS: usize = 10_000;

/// What is said in place of the others; it is none of the mistakes itself.
pub const LEFT_OUT: &str = "there are too many mistakes, and the others are left out";

/// The problems that a stage has found, as far as there is room.
#[derive(Debug, Default)]
pub struct Problems {
    kept: Vec<Diagnostic>,
    /// Where the first one is that was left out.
    left_out: Option<Span>,
}

impl Problems {
    /// Adds one, if there is room, and none was left out before it.
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

    /// Adds one, if there is room, that was found before another was left out.
    pub fn push_earlier(&mut self, problem: Diagnostic) {
        if self.kept.len() < MOST_PROBLEMS {
            self.kept.push(problem);
        }
    }

    /// Says that there is another one at a place, which is left out.
    pub fn leave_out(&mut self, span: Span) {
        self.left_out.get_or_insert(span);
    }

    /// Whether one was left out, so that there is no use in looking for others.
    pub fn is_full(&self) -> bool {
        self.left_out.is_some()
    }

    /// Forgets all but so many.
    pub fn truncate(&mut self, length: usize) {
        self.split_off(length);
    }

    /// Takes away all but so many, which makes room again.
    pub fn split_off(&mut self, length: usize) -> Vec<Diagnostic> {
        if length < self.kept.len() {
            self.left_out = None;
        }
        self.kept.split_off(length.min(self.kept.len()))
    }
}

/// All that are kept, and last that others are left out.
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
