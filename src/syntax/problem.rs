//! How a problem of syntax is made. Each is written where it arises.

use crate::{
    diagnostic::{Diagnostic, Edit, Fix, Label, Severity},
    source::Span,
};

/// What is wrong, and the place to jump to.
pub fn problem(
    code: &str,
    message: impl Into<String>,
    span: Span,
    label: impl Into<String>,
) -> Diagnostic {
    Diagnostic {
        severity: Severity::Error,
        code: format!("pinhole::{code}"),
        message: message.into(),
        help: None,
        labels: vec![Label {
            span,
            message: label.into(),
        }],
        fixes: Vec::new(),
        is_needless: false,
        is_of_syntax: true,
    }
}

/// Some bytes are part of no character.
pub fn invalid_utf8(span: Span, more: usize) -> Diagnostic {
    let more = match more {
        0 => String::new(),
        1 => ", here and at one more byte".to_owned(),
        _ => format!(", here and at {more} more bytes"),
    };
    problem(
        "invalid_utf8",
        format!("this file is not valid UTF-8{more}"),
        span,
        "this byte is part of no character",
    )
    .with_help("save the file as UTF-8")
}

/// The text starts with the byte order mark of UTF-16.
pub fn utf16(span: Span) -> Diagnostic {
    problem(
        "invalid_utf8",
        "this file is UTF-16, not UTF-8",
        span,
        "the byte order mark of UTF-16",
    )
    .with_help("save the file as UTF-8")
}

/// A field has no value.
pub fn field_without_value(name: &str, span: Span) -> Diagnostic {
    problem(
        "missing_value",
        format!("`{name}` has no value"),
        span,
        "a value should follow this",
    )
    .with_help("write a value after it")
}

/// Writes a text in a place.
pub fn replace(span: Span, text: impl Into<String>) -> Fix {
    let text = text.into();
    Fix::new(
        format!("write `{}`", shorten(&text)),
        [Edit::new(span, text)],
    )
}

/// That a slip was made so many times more.
pub fn times(more: usize) -> String {
    match more {
        0 => String::new(),
        1 => ", and at one more place".to_owned(),
        _ => format!(", and at {more} more places"),
    }
}

/// What stands at some place, in a message: on one line, and not too long.
pub fn shorten(written: &str) -> String {
    const LONGEST: usize = 40;
    let mut short = String::new();
    for (index, word) in written.split_whitespace().enumerate() {
        if index > 0 {
            short.push(' ');
        }
        short.extend(word.chars().take(LONGEST + 1));
        if short.chars().count() > LONGEST {
            let mut cut: String = short.chars().take(LONGEST).collect();
            cut.push('…');
            return cut;
        }
    }
    short
}
