//! Formats diagnostics for people, as text for a terminal.
//!
//! A report is either drawn by the library miette, with an excerpt of the scene, or consists of
//! sentences, for screen readers. miette receives only the labelled lines, cut to the parts that
//! are shown.

use std::{cmp::Reverse, collections::BTreeMap, fmt::Write};

use miette::{GraphicalReportHandler, GraphicalTheme, LabeledSpan, SourceCode};

use super::{
    Diagnostic, Severity,
    excerpt::{Excerpt, LONG_LINE_BYTES, MIN_COLUMNS, excerpts},
    problems, summary,
    visible::visible_line,
};
use crate::{explain::short, source::Sources};

/// Style of the reports for people.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Style {
    /// How a report is drawn.
    pub drawing: Drawing,
    /// Whether colours are used.
    pub color: bool,
    /// Width, in columns, to which the help is wrapped.
    pub width: usize,
    /// Width of the terminal, in columns. Lines of the scene are cut to this width, and labels and
    /// titles are wrapped to it. `None` means that the output is no terminal; only very long lines
    /// are then cut.
    pub excerpt: Option<usize>,
}

/// How a report is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Drawing {
    /// Box-drawing characters.
    Unicode,
    /// ASCII characters only. Excerpts of the scene keep their own characters.
    Ascii,
    /// No drawing: every label is a sentence, for screen readers.
    Narrated,
}

impl Default for Style {
    fn default() -> Self {
        Self {
            drawing: Drawing::Unicode,
            color: false,
            width: 100,
            excerpt: None,
        }
    }
}

/// Printer of diagnostics for people.
#[derive(Clone, Copy, Debug)]
pub struct Report<'s> {
    sources: &'s Sources,
    style: Style,
}

/// Returns one line for each code among the diagnostics, with the number of diagnostics that have
/// this code. The most frequent code comes first.
fn counts(diagnostics: &[Diagnostic]) -> String {
    let mut kinds: BTreeMap<&str, usize> = BTreeMap::new();
    for diagnostic in diagnostics
        .iter()
        .filter(|it| it.message != problems::LEFT_OUT)
    {
        *kinds.entry(short(&diagnostic.code)).or_default() += 1;
    }
    let mut kinds: Vec<_> = kinds.into_iter().collect();
    kinds.sort_by_key(|&(_, count)| Reverse(count));
    let lines = kinds
        .iter()
        .map(|(kind, count)| format!("{count:>7} {kind}\n"));
    lines.collect()
}

impl<'s> Report<'s> {
    /// Maximum number of diagnostics that are all shown as reports. If there are more, only the
    /// first [`Self::FIRST_SHOWN`] are shown, and the summary counts all by their codes. Reports of
    /// several hundred mistakes would hide the first ones from the reader. The JSON output always
    /// contains all diagnostics.
    pub const MOST_SHOWN: usize = 100;
    /// Number of diagnostics that are shown as reports if there are more than [`Self::MOST_SHOWN`].
    /// A user can correct this many mistakes before checking the scene again. More reports would
    /// only lengthen the output.
    pub const FIRST_SHOWN: usize = 20;

    /// Makes a printer for diagnostics about `sources`.
    pub fn new(sources: &'s Sources, style: Style) -> Self {
        Self { sources, style }
    }

    /// Returns the reports, separated by empty lines, and a summary of their number. Errors come
    /// before warnings, since a warning may be a consequence of an error. Otherwise, the reports
    /// are in the order of `diagnostics`. Returns an empty text if there are no diagnostics.
    pub fn human(&self, diagnostics: &[Diagnostic]) -> String {
        if diagnostics.is_empty() {
            return String::new();
        }
        let mut text = String::new();
        let are_all = diagnostics.len() <= Self::MOST_SHOWN;
        let shown = if are_all {
            diagnostics.len()
        } else {
            Self::FIRST_SHOWN
        };
        let mut ordered: Vec<_> = diagnostics.iter().collect();
        ordered.sort_by_key(|diagnostic| diagnostic.severity != Severity::Error);
        for diagnostic in &ordered[..shown] {
            text.push_str(&self.one(diagnostic));
            text.push('\n');
        }
        text.push_str(&summary(diagnostics));
        if !are_all {
            let _ = write!(
                text,
                "; the first {shown} are shown, `check --format json` lists them all:"
            );
        }
        text.push('\n');
        if !are_all {
            text.push_str(&counts(diagnostics));
        }
        if let Some(first) = ordered.first() {
            let which = match diagnostics.len() {
                1 => "it",
                _ => "the first",
            };
            let code = short(&first.code);
            let _ = writeln!(text, "more about {which}: pinhole explain {code}");
        }
        text
    }

    /// Returns the report of one diagnostic, drawn or as sentences.
    pub fn one(&self, diagnostic: &Diagnostic) -> String {
        match self.style.drawing {
            Drawing::Narrated => self.narrated(diagnostic),
            Drawing::Unicode | Drawing::Ascii => self.drawn(diagnostic),
        }
    }

    fn drawn(&self, diagnostic: &Diagnostic) -> String {
        let word = diagnostic.severity.word();
        let (on, off) = match (self.style.color, diagnostic.severity) {
            (false, _) => ("", ""),
            (true, Severity::Error) => ("\x1b[1;31m", "\x1b[0m"),
            (true, Severity::Warning) => ("\x1b[1;33m", "\x1b[0m"),
        };
        let code = &diagnostic.code;
        let message = visible_line(&diagnostic.message);
        let title = format!("{on}{word}[{code}]:{off} {message}");
        let columns = self.style.excerpt.map(|columns| columns.max(MIN_COLUMNS));
        let mut text = match columns {
            Some(columns) => {
                let columns = textwrap::Options::new(columns).subsequent_indent("  ");
                textwrap::fill(&title, columns) + "\n"
            }
            None => title + "\n",
        };
        let excerpts = excerpts(diagnostic, self.sources, columns.unwrap_or(LONG_LINE_BYTES));
        if excerpts.is_empty()
            && let Some(help) = &diagnostic.help
        {
            let _ = writeln!(text, "  help: {}", visible_line(help));
        }
        let last = excerpts.len().saturating_sub(1);
        for (index, excerpt) in excerpts.into_iter().enumerate() {
            let help = diagnostic.help.as_ref().filter(|_| index == last);
            let help = help.map(|help| visible_line(help).into_owned());
            text.push_str(&self.snippet(excerpt, help));
        }
        if self.style.drawing == Drawing::Ascii {
            text = text.replace('−', "-").replace('…', "...");
        }
        text
    }

    /// Returns the labelled lines of one source and the help, drawn by miette.
    fn snippet(&self, excerpt: Excerpt<'_>, help: Option<String>) -> String {
        let theme = match (self.style.drawing, self.style.color) {
            (Drawing::Unicode, true) => GraphicalTheme::unicode(),
            (Drawing::Unicode, false) => GraphicalTheme::unicode_nocolor(),
            (_, true) => GraphicalTheme::ascii(),
            (_, false) => GraphicalTheme::none(),
        };
        let handler = GraphicalReportHandler::new_themed(theme)
            .with_width(self.style.width.max(40))
            .with_context_lines(0)
            .with_links(false)
            .without_syntax_highlighting();
        let mut text = String::new();
        let snippet = Snippet { excerpt, help };
        // Rendering cannot fail: writing to a string does not fail, and an excerpt contains all of
        // its labels.
        let _ = handler.render_report(&mut text, &snippet);
        // The first line is miette's own header with an icon. It is dropped, since the report has a
        // header already.
        match text.split_once('\n') {
            Some((_, rest)) => rest
                .lines()
                .map(|line| line.trim_end().to_owned() + "\n")
                .collect(),
            None => String::new(),
        }
    }

    fn narrated(&self, diagnostic: &Diagnostic) -> String {
        let mut text = format!(
            "{} {}: {}\n",
            diagnostic.severity.word(),
            diagnostic.code,
            visible_line(&diagnostic.message)
        );
        for label in &diagnostic.labels {
            let source = self.sources.get(label.span.source);
            let span = source.clamped(label.span);
            let place = source.place(span.start);
            let under = source.slice(span.range());
            let _ = write!(
                text,
                "  {}, line {}, column {}",
                visible_line(source.name()),
                place.line,
                place.column
            );
            let one_line = under.lines().next().unwrap_or_default();
            if !one_line.is_empty() {
                let shown: String = one_line.chars().take(60).collect();
                let rest = if shown.len() < under.len() { "…" } else { "" };
                let _ = write!(text, ", at `{}{rest}`", visible_line(&shown));
            }
            let _ = writeln!(text, ": {}", visible_line(&label.message));
        }
        if let Some(help) = &diagnostic.help {
            let _ = writeln!(text, "  help: {}", visible_line(help));
        }
        text
    }
}

/// An excerpt and a help text in the form that miette requires.
#[derive(Debug)]
struct Snippet<'s> {
    excerpt: Excerpt<'s>,
    help: Option<String>,
}

impl std::fmt::Display for Snippet<'_> {
    fn fmt(&self, _: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        Ok(())
    }
}

impl std::error::Error for Snippet<'_> {}

impl miette::Diagnostic for Snippet<'_> {
    fn help<'a>(&'a self) -> Option<Box<dyn std::fmt::Display + 'a>> {
        self.help.as_ref().map(|help| Box::new(help) as _)
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        Some(&self.excerpt)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        Some(Box::new(self.excerpt.labels.iter().cloned()))
    }
}
