//! Builds diagnostics where problems of meaning arise.

use crate::{
    diagnostic::{Applicability, Diagnostic, Fix, Label, Problems, Severity},
    source::Span,
};

/// Returns an error with a code, which is written behind `pinhole::`.
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

/// Returns a warning with a code, which is written behind `pinhole::`.
pub fn warning(code: &str, message: impl Into<String>) -> Diagnostic {
    Diagnostic {
        severity: Severity::Warning,
        ..error(code, message)
    }
}

/// Returns the error of a thing that is given twice.
pub fn twice(code: &str, message: String, [first, second]: [Span; 2]) -> Diagnostic {
    error(code, message)
        .at(second, "and again here")
        .at(first, "first here")
}

impl Diagnostic {
    /// Adds a label. Editors jump to the first one.
    pub(super) fn at(mut self, span: Span, label: impl Into<String>) -> Self {
        let message = label.into();
        self.labels.push(Label { span, message });
        self
    }

    /// Sets the help, which says what to do.
    pub(super) fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// Adds fixes, the likeliest first. Each can be applied alone.
    pub(super) fn fixes(mut self, fixes: impl IntoIterator<Item = Fix>) -> Self {
        self.fixes.extend(fixes);
        self
    }

    /// Adds fixes, each of which writes one of several texts in a place.
    pub(super) fn writing<S: Into<String>>(
        self,
        span: Span,
        applicability: Applicability,
        texts: impl IntoIterator<Item = S>,
    ) -> Self {
        let texts = texts.into_iter();
        self.fixes(texts.map(|text| Fix::write(span, text).with_applicability(applicability)))
    }

    /// Adds the diagnostic to others.
    pub(super) fn report(self, problems: &mut Problems) {
        problems.push(self);
    }

    /// Whether the diagnostic has a code.
    pub(super) fn is(&self, code: &str) -> bool {
        self.code.strip_prefix("pinhole::") == Some(code)
    }

    /// Whether the diagnostic suggests a name or a call instead of an undefined name.
    pub(super) fn is_of_suggestion(&self) -> bool {
        self.is_of_name() || self.is("function_without_arguments")
    }

    /// Whether the diagnostic is about an undefined name.
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
