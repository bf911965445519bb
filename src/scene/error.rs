//! Makes diagnostics about the meaning of a scene, as opposed to its syntax.

use crate::{
    diagnostic::{Applicability, Diagnostic, Fix, Label, Problems, Severity},
    source::Span,
};

/// Returns an error whose code is `pinhole::` followed by `code`.
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

/// Returns a warning whose code is `pinhole::` followed by `code`.
pub fn warning(code: &str, message: impl Into<String>) -> Diagnostic {
    Diagnostic {
        severity: Severity::Warning,
        ..error(code, message)
    }
}

/// Returns the error for a duplicate, such as a second definition of a name. `first` and `second`
/// are the spans of the two definitions.
pub fn twice(code: &str, message: String, [first, second]: [Span; 2]) -> Diagnostic {
    error(code, message)
        .at(second, "and again here")
        .at(first, "first here")
}

impl Diagnostic {
    /// Adds a label at `span`. Editors jump to the first label of a diagnostic.
    pub(super) fn at(mut self, span: Span, label: impl Into<String>) -> Self {
        let message = label.into();
        self.labels.push(Label { span, message });
        self
    }

    /// Sets the help, a text that says how to correct the mistake.
    pub(super) fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// Adds alternative fixes, the likeliest first.
    pub(super) fn fixes(mut self, fixes: impl IntoIterator<Item = Fix>) -> Self {
        self.fixes.extend(fixes);
        self
    }

    /// Adds one fix for each of `texts`. Each fix replaces the source text at `span` by one of
    /// them.
    pub(super) fn writing<S: Into<String>>(
        self,
        span: Span,
        applicability: Applicability,
        texts: impl IntoIterator<Item = S>,
    ) -> Self {
        let texts = texts.into_iter();
        self.fixes(texts.map(|text| Fix::write(span, text).with_applicability(applicability)))
    }

    /// Adds the diagnostic to `problems`.
    pub(super) fn report(self, problems: &mut Problems) {
        problems.push(self);
    }

    /// Returns whether the diagnostic's code is `pinhole::` followed by `code`.
    pub(super) fn is(&self, code: &str) -> bool {
        self.code.strip_prefix("pinhole::") == Some(code)
    }

    /// Returns whether the diagnostic is about an undefined name or about a function's name without
    /// a call. The help of such a diagnostic may suggest another name, or a call.
    pub(super) fn is_of_suggestion(&self) -> bool {
        self.is_of_name() || self.is("function_without_arguments")
    }

    /// Returns whether the diagnostic is about an undefined name.
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
