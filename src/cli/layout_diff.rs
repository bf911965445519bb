//! A unified diff between a text and its layout, in time and memory linear in their length.
//!
//! A layout changes only white space. Therefore, the number of other characters before a line gives
//! the line's place in the other text. One pass over both texts finds the unchanged lines, without
//! a search for a shortest edit.

use std::{fmt::Write, ops::Range};

use super::output;
use crate::{
    diagnostic::{visible, visible_line},
    source::Source,
};

/// Number of unchanged lines that are shown around a change, as is usual in diffs.
const CONTEXT: usize = 3;

/// Returns a unified diff from the source to the formatted text. If the source has both kinds of
/// line ends, carriage returns are shown, since lines may differ only in them.
pub fn layout_diff(source: &Source, formatted: &str) -> String {
    let text = source.text();
    let printer = Printer {
        color: output::style().color,
        is_mixed: text.matches('\n').count() != text.matches("\r\n").count(),
    };
    let name = visible_line(source.name());
    let mut out = format!("--- {name}\n+++ {name}, formatted\n");
    let mut hunk: Vec<LineChange> = Vec::new();
    for change in LineChanges::of(text, formatted) {
        let is_near = |last: &LineChange| change.before.first - last.before.end() <= 2 * CONTEXT;
        if !hunk.last().is_none_or(is_near) {
            printer.hunk(&mut out, &hunk, text, formatted);
            hunk.clear();
        }
        hunk.push(change);
    }
    printer.hunk(&mut out, &hunk, text, formatted);
    out
}

/// Consecutive lines of a text: the index of the first, their count, and their bytes.
#[derive(Clone, Debug, PartialEq, Eq)]
struct LineSpan {
    first: usize,
    count: usize,
    bytes: Range<usize>,
}

impl LineSpan {
    fn end(&self) -> usize {
        self.first + self.count
    }
}

/// Lines of the old text and the lines that replace them.
#[derive(Clone, Debug, PartialEq, Eq)]
struct LineChange {
    before: LineSpan,
    after: LineSpan,
}

/// A position in a text that is read line by line.
struct LineCursor<'t> {
    text: &'t str,
    /// Index of the next line.
    next: usize,
    /// Offset of the byte at which the next line starts.
    at: usize,
    /// Number of characters before the next line, except white space.
    solid_before: usize,
}

impl<'t> LineCursor<'t> {
    fn new(text: &'t str) -> Self {
        Self {
            text,
            next: 0,
            at: 0,
            solid_before: 0,
        }
    }

    /// Returns the next line with its line end; `None` at the end of the text.
    fn line(&self) -> Option<&'t str> {
        self.text[self.at..].split_inclusive('\n').next()
    }

    /// Moves to the end of `line`, which must be the next line.
    fn pass(&mut self, line: &str) {
        self.next += 1;
        self.at += line.len();
        self.solid_before += line.chars().filter(|c| !c.is_whitespace()).count();
    }
}

/// Iterator over the changes from one text to the other.
struct LineChanges<'t> {
    before: LineCursor<'t>,
    after: LineCursor<'t>,
}

impl<'t> LineChanges<'t> {
    fn of(before: &'t str, after: &'t str) -> Self {
        let [before, after] = [before, after].map(LineCursor::new);
        Self { before, after }
    }
}

impl Iterator for LineChanges<'_> {
    type Item = LineChange;

    fn next(&mut self) -> Option<LineChange> {
        let Self { before, after } = self;
        let is_same =
            |before: &LineCursor<'_>, after: &LineCursor<'_>| match (before.line(), after.line()) {
                (None, None) => true,
                (old, new) => before.solid_before == after.solid_before && old == new,
            };
        while let Some(line) = before.line().filter(|_| is_same(before, after)) {
            before.pass(line);
            after.pass(line);
        }
        let start = [(before.next, before.at), (after.next, after.at)];
        while !is_same(before, after) {
            let (old, new) = (before.line(), after.line());
            let [mut is_removed, mut is_added] = [old.is_some(), new.is_some()];
            if let (Some(old), Some(new)) = (old, new) {
                // The text whose next line has fewer characters before it, not counting white
                // space, is advanced first; if equally many, the one whose next line is empty;
                // otherwise both.
                let is_empty = |line: &str| line.trim().is_empty();
                let [old, new] = [
                    (before.solid_before, !is_empty(old)),
                    (after.solid_before, !is_empty(new)),
                ];
                (is_removed, is_added) = (old <= new, new <= old);
            }
            for (reader, is_passed) in [(&mut *before, is_removed), (&mut *after, is_added)] {
                if let Some(line) = reader.line().filter(|_| is_passed) {
                    reader.pass(line);
                }
            }
        }
        let lines = |(first, at): (usize, usize), reader: &LineCursor<'_>| LineSpan {
            first,
            count: reader.next - first,
            bytes: at..reader.at,
        };
        let change = LineChange {
            before: lines(start[0], before),
            after: lines(start[1], after),
        };
        (change.before.count + change.after.count > 0).then_some(change)
    }
}

/// Options for printing lines.
struct Printer {
    color: bool,
    /// Whether the text has both kinds of line ends, LF and CRLF.
    is_mixed: bool,
}

impl Printer {
    /// Prints a hunk: changes that are close together, with the unchanged lines around them.
    fn hunk(&self, out: &mut String, changes: &[LineChange], before: &str, after: &str) {
        let (Some(first), Some(last)) = (changes.first(), changes.last()) else {
            return;
        };
        let lead = first.before.first.min(CONTEXT);
        let start = lines_back(before, first.before.bytes.start, lead);
        let context = before[last.before.bytes.end..].split_inclusive('\n');
        let context: Vec<&str> = context.take(CONTEXT).collect();
        let trail = context.len();
        let old = range(first.before.first - lead..last.before.end() + trail);
        let new = range(first.after.first - lead..last.after.end() + trail);
        let _ = writeln!(out, "@@ -{old} +{new} @@");
        let mut at = start;
        for change in changes {
            self.lines(out, ' ', &before[at..change.before.bytes.start]);
            self.lines(out, '-', &before[change.before.bytes.clone()]);
            self.lines(out, '+', &after[change.after.bytes.clone()]);
            at = change.before.bytes.end;
        }
        self.lines(out, ' ', &context.concat());
    }

    fn lines(&self, out: &mut String, sign: char, lines: &str) {
        let (paint, end) = match sign {
            '-' if self.color => ("\x1b[31m", "\x1b[0m"),
            '+' if self.color => ("\x1b[32m", "\x1b[0m"),
            _ => ("", ""),
        };
        for line in lines.split_inclusive('\n') {
            let shown = visible(line.trim_end_matches(['\n', '\r']));
            let is_marked = self.is_mixed && line.trim_end_matches('\n').ends_with('\r');
            let mark = if is_marked { "␍" } else { "" };
            let _ = writeln!(out, "{paint}{sign}{shown}{mark}{end}");
            if !line.ends_with('\n') {
                out.push_str("\\ No newline at end of file\n");
            }
        }
    }
}

/// Returns the byte offset at which the line starts that is `lines` lines before the line at
/// `start`.
fn lines_back(text: &str, start: usize, lines: usize) -> usize {
    (0..lines).fold(start, |start, _| {
        let before = &text[..start];
        let before = before.strip_suffix('\n').unwrap_or(before);
        before.rfind('\n').map_or(0, |at| at + 1)
    })
}

/// Formats a range of lines as in a hunk's head: the number of the first line, from 1, and the
/// count unless it is 1. An empty range has the number of the line before it.
fn range(lines: Range<usize>) -> String {
    match lines.len() {
        0 => format!("{},0", lines.start),
        1 => format!("{}", lines.start + 1),
        length => format!("{},{length}", lines.start + 1),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_that_stay_are_found_by_their_place() {
        for (before, after, expected) in [
            ("a\nb\n", "a\nb\n", ""),
            (
                "a\n\n\n\nb\n",
                "a\n\nb\n",
                "@@ -1,5 +1,3 @@\n a\n \n-\n-\n b\n",
            ),
            ("\n\na\n", "a\n", "@@ -1,3 +1 @@\n-\n-\n a\n"),
            ("a\nb\n", "a\n\nb\n", "@@ -1,2 +1,3 @@\n a\n+\n b\n"),
            (
                "a b\nc\n",
                "a\nb\nc\n",
                "@@ -1,2 +1,3 @@\n-a b\n+a\n+b\n c\n",
            ),
            (
                "a\nb\nc\n",
                "a\nb c\n",
                "@@ -1,3 +1,2 @@\n a\n-b\n-c\n+b c\n",
            ),
            // A `}` is matched only with the `}` at the same place, not with an earlier or later
            // one.
            (
                "}\n}\n x\n}\n",
                "}\n}\nx\n}\n",
                "@@ -1,4 +1,4 @@\n }\n }\n- x\n+x\n }\n",
            ),
            ("\n", "", "@@ -1 +0,0 @@\n-\n"),
        ] {
            let diff = layout_diff(&Source::from_text("a", before), after);
            let hunks = diff.strip_prefix("--- a\n+++ a, formatted\n").unwrap();
            assert_eq!(hunks, expected, "{before:?}");
        }
    }

    #[test]
    fn changes_with_more_than_six_lines_between_stand_apart() {
        let text = |a: &str, b: &str, between| format!("{a}\n{}{b}\n", "x\n".repeat(between));
        for (between, hunks) in [(6, 1), (7, 2)] {
            let (before, after) = (text(" a", " b", between), text("a", "b", between));
            let diff = layout_diff(&Source::from_text("a", &before), &after);
            assert_eq!(diff.matches("@@ -").count(), hunks, "{diff}");
        }
    }
}
