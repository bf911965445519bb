//! Problems of a scene, and their output formats for people and for programs.
//!
//! Each stage that reads a scene makes a [`Diagnostic`] for each problem that it finds, with fixes
//! if possible. This module sorts the diagnostics in the order of the text, and formats them as
//! reports for a terminal or as lines of JSON. The caller chooses a style and prints the result.

#[cfg(feature = "fancy")]
mod excerpt;
mod fix;
#[cfg(feature = "json")]
mod json;
mod mistakes;
mod problems;
#[cfg(feature = "fancy")]
mod report;
#[cfg(any(feature = "fancy", feature = "report"))]
mod visible;

pub use fix::{Applicability, Edit, Fix, apply};
#[cfg(feature = "json")]
pub use json::{json_lines, to_json};
pub use mistakes::Mistakes;
pub use problems::{MOST_PROBLEMS, Problems};
#[cfg(feature = "fancy")]
pub use report::{Drawing, Report, Style};
#[cfg(any(feature = "fancy", feature = "report"))]
pub use visible::{escaped, visible, visible_line};

use crate::source::{SourceId, Span, sort_by_span};

/// Whether a problem prevents the scene from being read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Severity {
    /// The scene cannot be read.
    Error,
    /// The scene can be read, but may differ from what the author meant.
    Warning,
}

impl Severity {
    /// Returns the word that stands before the message: `error` or `warning`.
    pub fn word(self) -> &'static str {
        match self {
            Self::Error => "error",
            Self::Warning => "warning",
        }
    }
}

/// A problem of a scene: what is wrong, where, and how to solve it.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Diagnostic {
    /// Whether the problem is an error or a warning.
    pub severity: Severity,
    /// The code of the kind of problem, such as `pinhole::unknown_field`.
    pub code: String,
    /// The message: a sentence that says what is wrong, in the words of the scene. It can be
    /// understood without the labels.
    pub message: String,
    /// Advice on how to solve the problem.
    pub help: Option<String>,
    /// Places that explain the problem; the first one is the primary label.
    pub labels: Vec<Label>,
    /// Suggested edits of the scene that solve the problem, the most probable one first.
    pub fixes: Vec<Fix>,
    /// Whether the text at the primary label is superfluous. Editors show such text in grey.
    pub is_needless: bool,
    /// Whether the problem is a violation of the grammar, rather than a wrong name or value. If a
    /// scene violates the grammar, the formatter reports no other problems.
    pub is_of_syntax: bool,
}

/// A place with a short explanation.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Label {
    /// The labelled place.
    pub span: Span,
    /// The explanation of the place.
    pub message: String,
}

impl Diagnostic {
    /// Returns whether the severity is an error.
    pub fn is_error(&self) -> bool {
        self.severity == Severity::Error
    }
}

/// Sorts diagnostics by the place of their primary label. Diagnostics of the file come before
/// diagnostics of `--set` arguments.
pub fn sort(diagnostics: &mut Vec<Diagnostic>) {
    sort_by_span(diagnostics, |diagnostic| {
        let first = diagnostic.labels.first();
        let (source, start) = first.map_or((SourceId::File, 0), |label| {
            (label.span.source, label.span.start)
        });
        Span::new(source, start, start)
    });
}

/// Returns the numbers of errors and warnings as text, such as `2 errors, 1 warning`.
pub fn summary(diagnostics: &[Diagnostic]) -> String {
    let cut = usize::from(diagnostics.iter().any(|d| d.message == problems::LEFT_OUT));
    let errors = diagnostics.iter().filter(|d| d.is_error()).count() - cut;
    let warnings = diagnostics.len() - cut - errors;
    let count = |number: usize, word: &str| match number {
        1 => format!("1 {word}"),
        _ if cut > 0 && word == "error" => format!("more than {number} errors"),
        _ => format!("{number} {word}s"),
    };
    match (errors, warnings) {
        (_, 0) => count(errors, "error"),
        (0, _) => count(warnings, "warning"),
        _ => format!("{}, {}", count(errors, "error"), count(warnings, "warning")),
    }
}
