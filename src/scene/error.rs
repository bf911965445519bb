//! How problems of meaning are written where they arise.

use crate::{
    diagnostic::{Applicability, Diagnostic, Fix, Label, Severity},
    source::Span,
};

/// An error by its code, which stands behind `pinhole::`.
pub fn error(code: &str, message: impl Into<String>) -> Diagnostic {
    Diagnostic {
        severity: Severity::Error,
        code: format!("pinhole::{code}"),
        message: message.into(),
        help: None,
        labels: Vec::new(),
        fixes: Vec::new(),
        is_needless: false,
        is_of_syntax: false,
    }
}

/// The same of a warning.
pub fn warning(code: &str, message: impl Into<String>) -> Diagnostic {
    Diagnostic {
        severity: Severity::Warning,
        ..error(code, message)
    }
}

/// An error of a thing that is there twice.
pub fn twice(code: &str, message: String, [first, second]: [Span; 2]) -> Diagnostic {
    error(code, message)
        .at(second, "and again here")
        .at(first, "first here")
}

impl Diagnostic {
    /// Adds a label. The first one is the place to jump to.
    pub(super) fn at(mut self, span: Span, label: impl Into<String>) -> Self {
        let message = label.into();
        self.labels.push(Label { span, message });
        self
    }

    /// Says what to do.
    pub(super) fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// Adds ways out that are edits, the likeliest first. None of them needs another one.
    pub(super) fn fixes(mut self, fixes: impl IntoIterator<Item = Fix>) -> Self {
        self.fixes.extend(fixes);
        self
    }

    /// Offers to write one of some texts in a place.
    pub(super) fn writing<S: Into<String>>(
        self,
        span: Span,
        applicability: Applicability,
        texts: impl IntoIterator<Item = S>,
    ) -> Self {
        let texts = texts.into_iter();
        self.fixes(texts.map(|text| Fix::write(span, text).with_applicability(applicability)))
    }

    /// Whether it has this code.
    pub(super) fn is(&self, code: &str) -> bool {
        self.code.strip_prefix("pinhole::") == Some(code)
    }

    /// Whether it suggests a name, or a call, in place of one that stands for nothing.
    pub(super) fn is_of_suggestion(&self) -> bool {
        self.is_of_name() || self.is("function_without_arguments")
    }

    /// Whether it is about a name that stands for nothing.
    pub(super) fn is_of_name(&self) -> bool {
        const CODES: [&str; 4] = [
            "unknown_name",
            "unknown_color",
            "unknown_function",
            "used_before_definition",
        ];
        CODES.iter().any(|code| self.is(code))
    }
}
