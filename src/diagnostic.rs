//! The list of problems, and its two forms: for people and for programs.
//!
//! In: [`Diagnostic`]s, which the stages make where a problem arises, with the edits that may help. Out: the same in the order of the text, as a terminal shows
//! them or as lines of JSON. Where to print them, and in which style, is the caller's decision.

mod fix;
#[cfg(feature = "cli")]
mod report;
#[cfg(feature = "cli")]
mod visible;

pub use fix::{Edit, Fix, apply, with_comments};
#[cfg(feature = "cli")]
pub use report::{Drawing, Report, Style};
#[cfg(feature = "cli")]
pub use visible::visible;

use std::fmt::Write;

use crate::source::{Source, SourceId, Sources, Span};

/// Whether a problem keeps the scene from being read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Severity {
    /// There is no scene.
    Error,
    /// There is one, perhaps not the one that was meant.
    Warning,
}

impl Severity {
    /// The word that stands before the message: `error` or `warning`.
    pub fn word(self) -> &'static str {
        match self {
            Self::Error => "error",
            Self::Warning => "warning",
        }
    }
}

/// A problem of a scene: what is wrong, where, and a way out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// How grave it is.
    pub severity: Severity,
    /// What kind of problem it is, such as `pinhole::unknown_field`.
    pub code: String,
    /// What is wrong, in the scene's own words; it stands alone.
    pub message: String,
    /// What to do.
    pub help: Option<String>,
    /// The places that explain it; the first one is the place to jump to.
    pub labels: Vec<Label>,
    /// The ways out that are edits, the likeliest first.
    pub fixes: Vec<Fix>,
    /// Whether what stands at the place to jump to could be left out without any change of meaning.
    pub is_needless: bool,
    /// Whether the text cannot be taken apart, whatever its names mean.
    pub is_of_syntax: bool,
}

/// A place with a few words.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Label {
    /// The place.
    pub span: Span,
    /// The words.
    pub message: String,
}

impl Diagnostic {
    /// Whether it is an error.
    pub fn is_error(&self) -> bool {
        self.severity == Severity::Error
    }
}

/// Puts diagnostics in the order of the text by the place to jump to, the file's before the arguments'.
pub fn sort(diagnostics: &mut [Diagnostic]) {
    diagnostics.sort_by_key(|diagnostic| {
        let first = diagnostic.labels.first();
        first.map_or((SourceId::File, 0), |label| {
            (label.span.source, label.span.start)
        })
    });
}

/// Every diagnostic as a line of JSON, as the command line's contract says.
pub fn json_lines(diagnostics: &[Diagnostic], sources: &Sources) -> String {
    let mut lines = String::new();
    for diagnostic in diagnostics {
        push_json(&mut lines, diagnostic, sources);
        lines.push('\n');
    }
    lines
}

/// A diagnostic as a JSON value.
pub fn to_json(diagnostic: &Diagnostic, sources: &Sources) -> serde_json::Value {
    let mut line = String::new();
    push_json(&mut line, diagnostic, sources);
    serde_json::from_str(&line).unwrap_or_default()
}

// The objects are written field by field: a megabyte of garbage has hundreds of thousands of them.
fn push_json(line: &mut String, diagnostic: &Diagnostic, sources: &Sources) {
    push_field(line, "{\"file\":", sources.file.name());
    push_field(line, ",\"severity\":", diagnostic.severity.word());
    push_field(line, ",\"code\":", &diagnostic.code);
    push_field(line, ",\"message\":", &diagnostic.message);
    match &diagnostic.help {
        Some(help) => push_field(line, ",\"help\":", help),
        None => line.push_str(",\"help\":null"),
    }
    line.push_str(",\"labels\":[");
    for (index, label) in diagnostic.labels.iter().enumerate() {
        if index > 0 {
            line.push(',');
        }
        push_label(line, label, sources);
    }
    line.push_str("],\"fixes\":[");
    for (index, fix) in diagnostic.fixes.iter().enumerate() {
        if index > 0 {
            line.push(',');
        }
        push_fix(line, fix, sources);
    }
    line.push_str("]}");
}

fn push_fix(line: &mut String, fix: &Fix, sources: &Sources) {
    push_field(line, "{\"title\":", &fix.title);
    line.push_str(",\"edits\":[");
    for (index, edit) in fix.edits.iter().enumerate() {
        line.push_str(if index > 0 { ",{" } else { "{" });
        let source = sources.get(edit.span.source);
        let span = clamp(edit.span, source);
        if span.source != SourceId::File {
            push_field(line, "\"file\":", source.name());
            line.push(',');
        }
        // Writing to a string does not fail.
        let (start, length) = (span.start, span.end - span.start);
        let _ = write!(line, "\"offset\":{start},\"length\":{length}");
        push_field(line, ",\"text\":", &edit.text);
        line.push('}');
    }
    line.push_str("]}");
}

fn push_label(line: &mut String, label: &Label, sources: &Sources) {
    let source = sources.get(label.span.source);
    let span = clamp(label.span, source);
    let (start, end) = (source.place(span.start), source.place(span.end));
    line.push('{');
    if span.source != SourceId::File {
        push_field(line, "\"file\":", source.name());
        line.push(',');
    }
    // Writing to a string does not fail.
    let _ = write!(
        line,
        "\"offset\":{},\"length\":{},\"line\":{},\"column\":{},\"end_line\":{},\"end_column\":{}",
        span.start,
        span.end - span.start,
        start.line,
        start.column,
        end.line,
        end.column
    );
    push_field(line, ",\"message\":", &label.message);
    line.push('}');
}

fn push_field(line: &mut String, name: &str, text: &str) {
    line.push_str(name);
    // A text is always JSON.
    line.push_str(&serde_json::to_string(text).unwrap_or_default());
}

/// A span that lies in its source, between characters: whatever a stage says, no printer reaches past the text.
fn clamp(span: Span, source: &Source) -> Span {
    let start = source.floor_char_boundary(span.start);
    let end = source.floor_char_boundary(span.end.max(start));
    Span::new(span.source, start, end)
}

/// How many errors and warnings there are, such as `2 errors, 1 warning`.
pub fn summary(diagnostics: &[Diagnostic]) -> String {
    let errors = diagnostics.iter().filter(|d| d.is_error()).count();
    let warnings = diagnostics.len() - errors;
    let count = |number: usize, word: &str| match number {
        1 => format!("1 {word}"),
        _ => format!("{number} {word}s"),
    };
    match (errors, warnings) {
        (_, 0) => count(errors, "error"),
        (0, _) => count(warnings, "warning"),
        _ => format!("{}, {}", count(errors, "error"), count(warnings, "warning")),
    }
}
