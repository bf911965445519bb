//! The problems that a stage has found so far, of which it keeps a limited number.
//!
//! A megabyte of signs may hold a million mistakes, and what is said of one takes a thousand times its text in memory; nobody reads the hundredth.

use std::ops::{Deref, DerefMut};

use super::{Diagnostic, Label, Severity};
use crate::source::Span;

/// Maximum number of problems that a stage reports, and of places that one fix changes.
pub const MOST_PROBLEMS: usize = 10_000;

/// The problems that a stage has found. Behind the last that is kept stands one more, which says that there are others.
#[derive(Debug, Default)]
pub struct Problems {
    kept: Vec<Diagnostic>,
    /// The index of the one that says that there are others.
    last: Option<usize>,
}

impl Problems {
    /// Adds one, if there is room.
    pub fn push(&mut self, problem: Diagnostic) {
        if self.is_full() {
            return;
        }
        match (self.kept.len() < MOST_PROBLEMS, problem.labels.first()) {
            (false, Some(label)) => self.end(label.span),
            _ => self.kept.push(problem),
        }
    }

    /// Says that there are others from a place on. None is added any more.
    pub fn end(&mut self, span: Span) {
        if self.is_full() {
            return;
        }
        self.last = Some(self.kept.len());
        self.kept.push(Diagnostic {
            severity: Severity::Error,
            code: "pinhole::unexpected".to_owned(),
            message: format!(
                "there are more than {MOST_PROBLEMS} mistakes, and the others are left out"
            ),
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
        });
    }

    /// Whether no other one is kept.
    pub fn is_full(&self) -> bool {
        self.last.is_some_and(|last| last < self.kept.len())
    }

    /// Forgets all but so many.
    pub fn truncate(&mut self, length: usize) {
        self.kept.truncate(length);
    }

    /// Takes away all but so many.
    pub fn split_off(&mut self, length: usize) -> Vec<Diagnostic> {
        self.kept.split_off(length.min(self.kept.len()))
    }
}

impl From<Problems> for Vec<Diagnostic> {
    fn from(problems: Problems) -> Self {
        problems.kept
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
