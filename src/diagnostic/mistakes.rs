//! The error type for a text that is not a valid scene. It contains the mistakes of the text.

use std::{error::Error, fmt, slice, sync::Arc, vec};

use super::Diagnostic;
#[cfg(feature = "fancy")]
use super::{Report, Style};
use crate::source::Sources;

/// Error that a text is not a valid scene: its mistakes and warnings, in the order of the text.
///
/// `Display` prints the mistakes as the command line does, without colour. If the feature `fancy`
/// is disabled, it prints a line with the place of each mistake, and below it the help. `Debug`
/// prints the same text, so that a `main` function that returns this error ends with a readable
/// report.
///
/// ```
/// let text = "camera { eye (0, 2, 8)  lookt (0, 1, 0) }  checkerboard {}";
/// let mistakes = pinhole::Scene::parse(text).unwrap_err();
/// for mistake in &mistakes {
///     let place = mistakes.sources().place(mistake.labels[0].span);
///     assert_eq!((place.line, place.column), (1, 25));
///     assert_eq!(mistake.code, "pinhole::unknown_field");
///     assert_eq!(mistake.fixes[0].edits[0].text, "lookat");
/// }
/// ```
#[derive(Clone, PartialEq, Eq)]
pub struct Mistakes {
    sources: Arc<Sources>,
    diagnostics: Vec<Diagnostic>,
}

impl Mistakes {
    /// Makes the error that contains the problems of a scene.
    pub(crate) fn new(sources: Arc<Sources>, diagnostics: Vec<Diagnostic>) -> Self {
        Self {
            sources,
            diagnostics,
        }
    }

    /// Iterates over the mistakes and warnings, in the order of the text.
    pub fn iter(&self) -> slice::Iter<'_, Diagnostic> {
        self.diagnostics.iter()
    }

    /// Returns the number of mistakes and warnings.
    #[expect(clippy::len_without_is_empty, reason = "there is at least one mistake")]
    pub fn len(&self) -> usize {
        self.diagnostics.len()
    }

    /// Returns the texts to which the mistakes refer.
    pub fn sources(&self) -> &Sources {
        &self.sources
    }
}

impl<'a> IntoIterator for &'a Mistakes {
    type Item = &'a Diagnostic;
    type IntoIter = slice::Iter<'a, Diagnostic>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

impl IntoIterator for Mistakes {
    type Item = Diagnostic;
    type IntoIter = vec::IntoIter<Diagnostic>;

    fn into_iter(self) -> Self::IntoIter {
        self.diagnostics.into_iter()
    }
}

/// Writes a report of all mistakes.
#[cfg(feature = "fancy")]
impl fmt::Display for Mistakes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let report = Report::new(&self.sources, Style::default()).human(&self.diagnostics);
        f.write_str(report.trim_end())
    }
}

/// Writes one line for each mistake, and below it the help. Reports with excerpts of the text need
/// the feature `fancy`.
#[cfg(not(feature = "fancy"))]
impl fmt::Display for Mistakes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, it) in self.iter().enumerate() {
            let line_end = if index > 0 { "\n" } else { "" };
            let (severity, message) = (it.severity.word(), &it.message);
            write!(f, "{line_end}{severity}[{}]: {message}", it.code)?;
            if let Some(label) = it.labels.first() {
                let name = self.sources.get(label.span.source).name();
                let place = self.sources.place(label.span);
                write!(f, " ({name}:{}:{})", place.line, place.column)?;
            }
            if let Some(help) = &it.help {
                write!(f, "\n  help: {}", help.replace('\n', "\n  "))?;
            }
        }
        Ok(())
    }
}

impl fmt::Debug for Mistakes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl Error for Mistakes {}

#[cfg(all(test, not(feature = "fancy")))]
mod tests {
    use crate::Scene;

    #[test]
    fn a_report_without_excerpts_has_the_place_and_the_help() {
        let text = "camera { eye (0, 2, 8)\n  lookt (0, 1, 0) }\nspheree { center (0, 1, 0) }";
        let report = Scene::parse(text).unwrap_err().to_string();
        let lines: Vec<_> = report.lines().collect();
        assert!(
            lines[0].starts_with("error[pinhole::unknown_field]: "),
            "{report}"
        );
        assert!(lines[0].ends_with(" (scene:2:3)"), "{report}");
        assert!(
            lines[1].starts_with("  help: did you mean `lookat`?"),
            "{report}"
        );
        assert!(lines[2].ends_with(" (scene:3:1)"), "{report}");
    }
}
