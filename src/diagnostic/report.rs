//! Reports for people.
//!
//! In: diagnostics and the texts that they point into. Out: text for a terminal, drawn by miette or
//! as sentences. miette receives only the labelled lines, shortened to what can be shown.

use std::{cmp::Reverse, collections::BTreeMap, fmt::Write, ops::Range};

use miette::{
    GraphicalReportHandler, GraphicalTheme, LabeledSpan, MietteError, MietteSpanContents,
    SourceCode, SourceSpan, SpanContents,
};

use super::{
    Diagnostic, Label, Severity, clamp, problems, summary,
    visible::{push_visible, visible_line},
};
use crate::{
    explain::short,
    source::{Source, SourceId, Sources, Span},
};

/// Style of the reports for people.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Style {
    /// How a report is drawn.
    pub drawing: Drawing,
    /// Whether colours are used.
    pub color: bool,
    /// Width in columns to which help is wrapped.
    pub width: usize,
    /// Width of the terminal in columns. Lines of an excerpt are cut to it, and labels and titles
    /// are wrapped. If it is `None`, there is no terminal, and only very long lines are cut.
    pub excerpt: Option<usize>,
}

/// How a report is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drawing {
    /// Box-drawing characters.
    Unicode,
    /// ASCII only, except characters of the scene itself.
    Ascii,
    /// Nothing is drawn: every label is a sentence, for screen readers.
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

/// Returns a line for each kind of diagnostic with its count, the most frequent kind first.
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
    /// Maximum number of reports that are shown in full. If there are more, only the first
    /// [`Self::FIRST_SHOWN`] and the count of each kind are shown; JSON has all of them.
    pub const MOST_SHOWN: usize = 100;
    /// Number of reports that are shown if there are more than [`Self::MOST_SHOWN`].
    pub const FIRST_SHOWN: usize = 20;

    /// Makes a printer for diagnostics about `sources`.
    pub fn new(sources: &'s Sources, style: Style) -> Self {
        Self { sources, style }
    }

    /// Returns the reports, separated by empty lines, and a summary of their number. Returns an
    /// empty text if there are no diagnostics.
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
        for diagnostic in &diagnostics[..shown] {
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
        if let Some(first) = diagnostics.first() {
            let which = match diagnostics.len() {
                1 => "it",
                _ => "the first",
            };
            let code = short(&first.code);
            let _ = writeln!(text, "more about {which}: pinhole explain {code}");
        }
        text
    }

    /// Returns the report of one diagnostic, drawn or narrated.
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
            let span = clamp(label.span, source);
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

/// An excerpt and a help in the form that miette takes.
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

/// Excerpt of a source: the labelled lines, with long lines cut to the parts around the labels.
///
/// miette reads the excerpt instead of the text, so a line of ten megabytes is neither printed nor
/// scanned, and every label lies within the text that miette sees. (miette omits a label at the end
/// of a text, and panics at a label past it.)
#[derive(Debug)]
struct Excerpt<'s> {
    source: &'s Source,
    text: String,
    lines: Vec<ExcerptLine>,
    labels: Vec<LabeledSpan>,
}

#[derive(Debug)]
struct ExcerptLine {
    /// Line number in the source, counted from 1.
    number: usize,
    /// Start of the line in the excerpt, in bytes.
    start: usize,
    /// End of the line in the excerpt, in bytes, without the line feed.
    end: usize,
    /// Offsets of each shown character in the source and in the excerpt, and those of the end of
    /// each shown part.
    shown: Vec<(usize, usize)>,
}

/// Maximum length, in bytes, of a line that is shown whole if the width of the terminal is unknown.
const LONG_LINE_BYTES: usize = 160;
/// Minimum width of an excerpt, in columns, even if the terminal is narrower.
const MIN_COLUMNS: usize = 30;
/// Number of columns between a label and its message.
const HOOK_COLUMNS: usize = 4;
/// Minimum number of columns for a message, even if its label stands far to the right.
const MIN_MESSAGE_COLUMNS: usize = 16;
/// Maximum number of lines of a label. A longer label is drawn under its first line only.
const MAX_LABEL_LINES: usize = 6;

/// Returns an excerpt of every source that has labels, in the order of the labels.
fn excerpts<'s>(diagnostic: &Diagnostic, sources: &'s Sources, columns: usize) -> Vec<Excerpt<'s>> {
    let mut ids: Vec<SourceId> = Vec::new();
    for label in &diagnostic.labels {
        if !ids.contains(&label.span.source) {
            ids.push(label.span.source);
        }
    }
    let excerpt = |id| {
        let labels = diagnostic.labels.iter().filter(|l| l.span.source == id);
        Excerpt::new(sources.get(id), labels, columns)
    };
    ids.into_iter().map(excerpt).collect()
}

impl<'s> Excerpt<'s> {
    /// Makes the excerpt of a source, with lines of at most about `columns` bytes.
    fn new<'l>(
        source: &'s Source,
        labels: impl Iterator<Item = &'l Label>,
        columns: usize,
    ) -> Self {
        let labels: Vec<_> = labels
            .map(|label| (shorten(label.span, source, columns), label.message.as_str()))
            .collect();
        let mut numbers: Vec<usize> = labels
            .iter()
            .flat_map(|(span, _)| source.line(span.start)..=source.line(span.end))
            .collect();
        numbers.sort_unstable();
        numbers.dedup();
        let mut excerpt = Self {
            source,
            text: String::new(),
            lines: Vec::new(),
            labels: Vec::new(),
        };
        for number in numbers {
            excerpt.push_line(number, &labels, columns);
        }
        for (index, (span, message)) in labels.into_iter().enumerate() {
            let start = excerpt.offset_of(span.start);
            let end = excerpt.offset_of(span.end).max(start + 1);
            let inner = SourceSpan::from((start, end - start));
            let line = excerpt.line_at(start).map_or(start, |(_, line)| line.start);
            // miette draws the hook of a label at the label's middle.
            let left = start.midpoint(end) - line + HOOK_COLUMNS;
            let room = columns.saturating_sub(left).max(MIN_MESSAGE_COLUMNS);
            let message = textwrap::fill(&visible_line(message), room);
            // miette shows the line and column of the primary label in its header.
            excerpt.labels.push(match index {
                0 => LabeledSpan::new_primary_with_span(Some(message), inner),
                _ => LabeledSpan::new_with_span(Some(message), inner),
            });
        }
        excerpt
    }

    fn push_line(&mut self, number: usize, labels: &[(Span, &str)], columns: usize) {
        let mut range = self.source.line_range(number);
        if number == 1 {
            range.start = self.source.bom_len().min(range.end);
        }
        // miette joins the frames of labels on consecutive lines and numbers the lines onwards from
        // the first, so lines that are not consecutive are separated by an empty one.
        let apart = self.lines.last().is_some_and(|l| l.number + 1 < number);
        if apart {
            self.text.push('\n');
        }
        let start = self.text.len();
        let mut shown = Vec::new();
        for piece in shown_pieces(self.source, range.clone(), labels, columns) {
            if piece.start > range.start {
                self.text.push('…');
            }
            for (at, character) in self.source.slice(piece.clone()).char_indices() {
                shown.push((piece.start + at, self.text.len()));
                // A control character is escaped, which is longer than its own bytes.
                push_visible(&mut self.text, character);
            }
            shown.push((piece.end, self.text.len()));
        }
        if shown.last().is_some_and(|(end, _)| *end < range.end) {
            self.text.push('…');
        }
        // A label at the end of the line needs a character to be drawn under.
        self.text.push(' ');
        self.lines.push(ExcerptLine {
            number,
            start,
            end: self.text.len(),
            shown,
        });
        self.text.push('\n');
    }

    /// Converts an offset in the source to an offset in the excerpt.
    fn offset_of(&self, offset: usize) -> usize {
        let number = self.source.line(offset);
        let line = self.lines.iter().find(|line| line.number == number);
        let mut shown = line.into_iter().flat_map(|line| line.shown.iter().rev());
        let found = shown.find(|(at, _)| *at <= offset);
        // A byte order mark is not shown, so an offset before all shown characters is the line's
        // start.
        let start = line.map_or(0, |line| line.start);
        found.map_or(start, |(_, place)| *place)
    }

    fn line_at(&self, offset: usize) -> Option<(usize, &ExcerptLine)> {
        let index = self.lines.partition_point(|line| line.start <= offset);
        let index = index.checked_sub(1)?;
        Some((index, self.lines.get(index)?))
    }
}

impl SourceCode for Excerpt<'_> {
    fn read_span<'a>(
        &'a self,
        span: &SourceSpan,
        _before: usize,
        _after: usize,
    ) -> Result<Box<dyn SpanContents<'a> + 'a>, MietteError> {
        let last = (span.offset() + span.len()).saturating_sub(1);
        let (Some((first_index, first)), Some((last_index, last))) = (
            self.line_at(span.offset()),
            self.line_at(last.max(span.offset())),
        ) else {
            return Err(MietteError::OutOfBounds);
        };
        // Lines that are not consecutive are refused, so that miette draws them in frames of their
        // own.
        if last.number - first.number != last_index - first_index {
            return Err(MietteError::OutOfBounds);
        }
        let data = self.text.as_bytes();
        let data = data.get(first.start..last.end).unwrap_or_default();
        let mut shown = first.shown.iter().rev();
        let real = shown.find(|(_, place)| *place <= span.offset());
        let real = real.map_or(0, |(at, _)| *at);
        Ok(Box::new(MietteSpanContents::new_named(
            visible_line(self.source.name()).into_owned(),
            data,
            (first.start, last.end - first.start).into(),
            first.number - 1,
            self.source.place(real).column - 1,
            last_index - first_index + 1,
        )))
    }
}

/// Returns the part of a label that is drawn: its first line if it has too many lines, and at most
/// half of the columns if its line is long.
fn shorten(span: Span, source: &Source, columns: usize) -> Span {
    let mut span = clamp(span, source);
    let first = source.line(span.start);
    let line = source.line_range(first);
    if source.line(span.end) - first >= MAX_LABEL_LINES {
        span.end = line.end.max(span.start);
    }
    if source.line(span.end) == first && line.len() > columns {
        let long = source.floor_char_boundary(span.start + columns / 2);
        span.end = span.end.min(long);
    }
    span
}

/// Returns the parts of a line that are shown. A line that fits is shown whole. A line that is too
/// long, or leaves no room for a label's message, is shown for a quarter of the columns to the left
/// and right of each label.
fn shown_pieces(
    source: &Source,
    line: Range<usize>,
    labels: &[(Span, &str)],
    columns: usize,
) -> Vec<Range<usize>> {
    let mut ends: Vec<usize> = labels
        .iter()
        .flat_map(|(span, _)| [span.start, span.end])
        .filter(|&end| line.start <= end && end <= line.end)
        .collect();
    ends.sort_unstable();
    let with_message = ends.last().unwrap_or(&line.start) + HOOK_COLUMNS + MIN_MESSAGE_COLUMNS;
    if line.end.max(with_message) - line.start <= columns {
        return vec![line];
    }
    let around = columns / 4;
    let mut pieces: Vec<Range<usize>> = Vec::new();
    for end in ends {
        let from = source.floor_char_boundary(end.saturating_sub(around).max(line.start));
        let to = source.floor_char_boundary((end + around).min(line.end));
        match pieces.last_mut() {
            // Parts with up to three bytes between them are joined, since an ellipsis would not be
            // shorter.
            Some(last) if from <= last.end + 3 => last.end = last.end.max(to),
            _ => pieces.push(from..to),
        }
    }
    if pieces.is_empty() {
        let to = source.floor_char_boundary((line.start + 2 * around).min(line.end));
        pieces.push(line.start..to);
    }
    pieces
}
