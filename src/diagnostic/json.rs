//! Diagnostics as JSON, for programs.

use serde_json::{Value, json};

use super::Diagnostic;
use crate::source::{Source, SourceId, Sources, Span};

/// Returns each diagnostic as a line of JSON, in the documented format of the command line.
pub fn json_lines(diagnostics: &[Diagnostic], sources: &Sources) -> String {
    let lines = diagnostics.iter().map(|it| to_json(it, sources));
    lines.map(|line| format!("{line}\n")).collect()
}

/// Returns a diagnostic as a JSON value.
#[doc(hidden)]
pub fn to_json(diagnostic: &Diagnostic, sources: &Sources) -> Value {
    let labels = diagnostic.labels.iter().map(|label| {
        let source = sources.get(label.span.source);
        let span = source.clamped(label.span);
        let (start, end) = (source.place(span.start), source.place(span.end));
        let mut json = place(span, source);
        json["line"] = start.line.into();
        json["column"] = start.column.into();
        json["end_line"] = end.line.into();
        json["end_column"] = end.column.into();
        json["message"] = label.message.as_str().into();
        json
    });
    let fixes = diagnostic.fixes.iter().map(|fix| {
        let edits = fix.edits.iter().map(|edit| {
            let source = sources.get(edit.span.source);
            let mut json = place(source.clamped(edit.span), source);
            json["text"] = edit.text.as_str().into();
            json
        });
        json!({
            "title": fix.title,
            "applicability": fix.applicability.word(),
            "edits": edits.collect::<Vec<_>>(),
        })
    });
    json!({
        "file": sources.file.name(),
        "severity": diagnostic.severity.word(),
        "code": diagnostic.code,
        "message": diagnostic.message,
        "help": diagnostic.help,
        "labels": labels.collect::<Vec<_>>(),
        "fixes": fixes.collect::<Vec<_>>(),
    })
}

/// Returns a span as JSON: its offset and length in bytes. If the span lies in a `--set` argument,
/// the name of this argument is added.
fn place(span: Span, source: &Source) -> Value {
    let (offset, length) = (span.start, span.end - span.start);
    match span.source {
        SourceId::File => json!({ "offset": offset, "length": length }),
        SourceId::Set(_) => json!({ "file": source.name(), "offset": offset, "length": length }),
    }
}
