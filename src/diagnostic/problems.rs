//! Collects the problems that one stage of reading a scene finds, up to a maximum number.
//!
//! The number is limited because a megabyte of punctuation may contain a million mistakes. A report
//! needs about a thousand times the memory of the text it refers to, and nobody reads a million
//! reports.

use std::ops::{Deref, DerefMut};

use super::{Diagnostic, Label, Severity};
use crate::source::Span;

/// Maximum number of problems that one stage of reading a scene reports, and of edits in one fix.
/// Further problems are omitted, and a last diagnostic says so. The number is far above what anyone
/// reads. Without a limit, a large file that is no scene would cause so many reports that they fill
/// the memory.
pub const MOST_PROBLEMS: usize = 10_000;

/// Message of the last diagnostic if problems were omitted. The summary of a report does not count
/// this diagnostic as a mistake.
pub const LEFT_OUT: &str = "there are too many mistakes, and the others are left out";

/// List of at most [`MOST_PROBLEMS`] problems that one stage of reading a scene found.
#[derive(Debug, Default)]
pub struct Problems {
    kept: Vec<Diagnostic>,
    /// The place of the first omitted problem.
    left_out: Option<Span>,
}

impl Problems {
    /// Adds a problem. If [`MOST_PROBLEMS`] problems are stored already, omits the new one and
    /// records its place. Does nothing if a problem was omitted before.
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

    /// Adds a problem that is reported late although its place in the text is earlier. Unlike
    /// [`Self::push`], adds the problem even if another one was omitted before. Does nothing if
    /// [`MOST_PROBLEMS`] problems are stored.
    pub fn push_earlier(&mut self, problem: Diagnostic) {
        if self.kept.len() < MOST_PROBLEMS {
            self.kept.push(problem);
        }
    }

    /// Records that a problem at `span` is omitted. Only the first such call has an effect.
    pub fn leave_out(&mut self, span: Span) {
        self.left_out.get_or_insert(span);
    }

    /// Returns whether a problem was omitted. The search for further problems can then stop.
    pub fn is_full(&self) -> bool {
        self.left_out.is_some()
    }

    /// Removes the problems from the index `length` on. If at least one is removed, the list is no
    /// longer full, and further problems are added again.
    pub fn truncate(&mut self, length: usize) {
        self.split_off(length);
    }

    /// Removes and returns the problems from the index `length` on. If at least one is removed, the
    /// list is no longer full, and further problems are added again.
    pub fn split_off(&mut self, length: usize) -> Vec<Diagnostic> {
        if length < self.kept.len() {
            self.left_out = None;
        }
        self.kept.split_off(length.min(self.kept.len()))
    }
}

/// Converts to a list of diagnostics. If problems were omitted, the last diagnostic says so.
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
