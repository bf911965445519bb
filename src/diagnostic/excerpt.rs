//! Extracts the labelled lines of a source for a report, cut to the width of a terminal.

use std::ops::Range;

use miette::{LabeledSpan, MietteError, MietteSpanContents, SourceCode, SourceSpan, SpanContents};

use super::{
    Diagnostic, Label,
    visible::{push_visible, visible_line},
};
use crate::source::{Source, SourceId, Sources, Span};

/// Excerpt of a source: its labelled lines. Long lines are cut to the parts around the labels.
///
/// miette, the library that draws reports, receives the excerpt instead of the whole text, so it
/// neither prints nor scans a line of ten megabytes. Every label ends before the end of the
/// excerpt, since miette omits a label at the end of a text, and panics at a label beyond it.
#[derive(Debug)]
pub struct Excerpt<'s> {
    source: &'s Source,
    text: String,
    lines: Vec<ExcerptLine>,
    /// The labels, at their places in the excerpt.
    pub labels: Vec<LabeledSpan>,
}

#[derive(Debug)]
struct ExcerptLine {
    /// Number of the line in the source, counted from 1.
    number: usize,
    /// Start of the line in the excerpt, in bytes.
    start: usize,
    /// End of the line in the excerpt, in bytes, without the line feed.
    end: usize,
    /// Pairs of a byte offset in the source and the matching byte offset in the excerpt. There is
    /// a pair for each shown character, and one for the end of each shown part of the line.
    shown: Vec<(usize, usize)>,
}

/// Maximum length, in bytes, of a line that is shown whole if the width of the terminal is unknown.
/// Longer lines are cut, because a line may be megabytes long. Most lines that people write are
/// shorter.
pub const LONG_LINE_BYTES: usize = 160;
/// Minimum width of an excerpt, in columns. An excerpt is this wide even if the terminal is
/// narrower, so that some text around each label is shown. A smaller minimum would cut this text to
/// a few characters.
pub const MIN_COLUMNS: usize = 30;
/// Number of columns that miette, the library that draws reports, needs for the line from the
/// middle of a label to the label's message, as in `╰── message`. The message is wrapped to the
/// columns that remain after this line.
const HOOK_COLUMNS: usize = 4;
/// Minimum width, in columns, to which a label's message is wrapped, even if the label stands so
/// far to the right that less room is left. A narrower message would be hard to read. With a larger
/// minimum, more lines of the scene would be cut to make room for messages.
const MIN_MESSAGE_COLUMNS: usize = 16;
/// Maximum number of lines of a label that is drawn whole. Of a longer label, only the first line
/// is drawn. With a much larger maximum, a label of a long block could fill the screen.
const MAX_LABEL_LINES: usize = 6;

/// Returns one excerpt for each source (the file or a `--set` argument) that contains labels of the
/// diagnostic. The sources are in the order in which the labels first mention them.
pub fn excerpts<'s>(
    diagnostic: &Diagnostic,
    sources: &'s Sources,
    columns: usize,
) -> Vec<Excerpt<'s>> {
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
    /// Makes the excerpt of a source for labels in it. Lines longer than about `columns` bytes are
    /// cut.
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
            // In miette's drawing, a line leads from the middle of the label to its message, so the
            // room for the message starts a few columns after the middle.
            let left = start.midpoint(end) - line + HOOK_COLUMNS;
            let room = columns.saturating_sub(left).max(MIN_MESSAGE_COLUMNS);
            let message = textwrap::fill(&visible_line(message), room);
            // The first label is the primary one, whose line and column miette shows in its header.
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
        // miette draws labels on consecutive lines in one frame. It gets only the number of the
        // frame's first line, and counts the other lines from there. Lines that are not consecutive
        // in the source are therefore separated by an empty line.
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
                // A control character is escaped and becomes longer, so offsets after it differ
                // between the source and the excerpt.
                push_visible(&mut self.text, character);
            }
            shown.push((piece.end, self.text.len()));
        }
        if shown.last().is_some_and(|(end, _)| *end < range.end) {
            self.text.push('…');
        }
        // Each line ends with a space, under which a label at the end of the line is drawn.
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
        // The excerpt does not contain the byte order mark. An offset before all shown characters,
        // such as that of the mark, is therefore mapped to the start of the line.
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
        // If this function returns an error, miette draws the labels in separate frames. An error
        // is therefore returned if lines between the labels are missing in the excerpt.
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

/// Returns the part of a label's span that is drawn. Of a label with too many lines, only the first
/// line is drawn. Of a label within one line of more than `columns` bytes, at most the first
/// `columns`/2 bytes are drawn.
fn shorten(span: Span, source: &Source, columns: usize) -> Span {
    let mut span = source.clamped(span);
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

/// Returns the parts of a line that are shown. A line that fits is shown whole. If the line is too
/// long, or leaves no room for a label's message, the text around the start and the end of each
/// label is shown: `columns`/4 bytes on each side.
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
            // An ellipsis `…` stands between two parts. It has three bytes, so in place of a gap of
            // at most three bytes it would save nothing. Parts with such a gap are joined.
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
