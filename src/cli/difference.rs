//! A unified diff of a text and its layout, in time and memory that grow with their length and not
//! with its square.
//!
//! No search for a shortest edit is needed: a layout changes blanks and line ends alone. What
//! stands before a line, blanks left out, says where the line belongs in the other text, so one
//! walk over both finds the lines that stay.

use std::{fmt::Write, ops::Range};

use super::output;
use crate::{
    diagnostic::{visible, visible_line},
    source::Source,
};

/// Number of unchanged lines that are shown around a change, as everywhere.
const CONTEXT: usize = 3;

/// What would change, as a unified diff. Where lines end in different ways, carriage returns are
/// shown: lines can differ in them alone.
pub fn difference(source: &Source, formatted: &str) -> String {
    let text = source.text();
    let printer = Printer {
        color: output::style().color,
        is_mixed: text.matches('\n').count() != text.matches("\r\n").count(),
    };
    let name = visible_line(source.name());
    let mut out = format!("--- {name}\n+++ {name}, formatted\n");
    let mut hunk: Vec<Change> = Vec::new();
    for change in Changes::of(text, formatted) {
        let is_near = |last: &Change| change.before.first - last.before.end() <= 2 * CONTEXT;
        if !hunk.last().is_none_or(is_near) {
            printer.hunk(&mut out, &hunk, text, formatted);
            hunk.clear();
        }
        hunk.push(change);
    }
    printer.hunk(&mut out, &hunk, text, formatted);
    out
}

/// Lines of a text that follow each other: the number of the first, how many they are, and their
/// bytes.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Lines {
    first: usize,
    count: usize,
    bytes: Range<usize>,
}

impl Lines {
    fn end(&self) -> usize {
        self.first + self.count
    }
}

/// Lines that are replaced by others.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Change {
    before: Lines,
    after: Lines,
}

/// A text that is read line by line.
struct Reader<'t> {
    text: &'t str,
    /// The number of the next line, where it starts, and the number of characters before it that
    /// are no blanks.
    next: usize,
    at: usize,
    place: usize,
}

impl<'t> Reader<'t> {
    fn new(text: &'t str) -> Self {
        Self {
            text,
            next: 0,
            at: 0,
            place: 0,
        }
    }

    /// The next line, with its line end.
    fn line(&self) -> Option<&'t str> {
        self.text[self.at..].split_inclusive('\n').next()
    }

    /// Goes on behind a line.
    fn pass(&mut self, line: &str) {
        self.next += 1;
        self.at += line.len();
        self.place += line.chars().filter(|c| !c.is_whitespace()).count();
    }
}

/// The changes that make one text of the other, in their order.
struct Changes<'t> {
    before: Reader<'t>,
    after: Reader<'t>,
}

impl<'t> Changes<'t> {
    fn of(before: &'t str, after: &'t str) -> Self {
        let [before, after] = [before, after].map(Reader::new);
        Self { before, after }
    }
}

impl Iterator for Changes<'_> {
    type Item = Change;

    fn next(&mut self) -> Option<Change> {
        let Self { before, after } = self;
        let is_same = |before: &Reader<'_>, after: &Reader<'_>| match (before.line(), after.line())
        {
            (None, None) => true,
            (old, new) => before.place == after.place && old == new,
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
                // An empty line has no place of its own, so it goes before the other one.
                let is_empty = |line: &str| line.trim().is_empty();
                let [old, new] = [
                    (before.place, !is_empty(old)),
                    (after.place, !is_empty(new)),
                ];
                (is_removed, is_added) = (old <= new, new <= old);
            }
            for (reader, is_passed) in [(&mut *before, is_removed), (&mut *after, is_added)] {
                if let Some(line) = reader.line().filter(|_| is_passed) {
                    reader.pass(line);
                }
            }
        }
        let lines = |(first, at): (usize, usize), reader: &Reader<'_>| Lines {
            first,
            count: reader.next - first,
            bytes: at..reader.at,
        };
        let change = Change {
            before: lines(start[0], before),
            after: lines(start[1], after),
        };
        (change.before.count + change.after.count > 0).then_some(change)
    }
}

/// How lines are printed.
struct Printer {
    color: bool,
    /// Whether lines end in different ways.
    is_mixed: bool,
}

impl Printer {
    /// Prints changes that lie near each other.
    fn hunk(&self, out: &mut String, changes: &[Change], before: &str, after: &str) {
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

/// Where the line starts that is so many lines before one that starts at a byte.
fn lines_back(text: &str, start: usize, lines: usize) -> usize {
    (0..lines).fold(start, |start, _| {
        let before = &text[..start];
        let before = before.strip_suffix('\n').unwrap_or(before);
        before.rfind('\n').map_or(0, |at| at + 1)
    })
}

/// Lines as diffs name them: the first one from 1, and how many there are unless it is one. An
/// empty range has the line before it.
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
        for (before, after, told) in [
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
            // The same line elsewhere is not taken for it.
            (
                "}\n}\n x\n}\n",
                "}\n}\nx\n}\n",
                "@@ -1,4 +1,4 @@\n }\n }\n- x\n+x\n }\n",
            ),
            ("\n", "", "@@ -1 +0,0 @@\n-\n"),
        ] {
            let diff = difference(&Source::from_text("a", before), after);
            let hunks = diff.strip_prefix("--- a\n+++ a, formatted\n").unwrap();
            assert_eq!(hunks, told, "{before:?}");
        }
    }

    #[test]
    fn changes_with_more_than_six_lines_between_stand_apart() {
        let text = |a: &str, b: &str, between| format!("{a}\n{}{b}\n", "x\n".repeat(between));
        for (between, hunks) in [(6, 1), (7, 2)] {
            let (before, after) = (text(" a", " b", between), text("a", "b", between));
            let diff = difference(&Source::from_text("a", &before), &after);
            assert_eq!(diff.matches("@@ -").count(), hunks, "{diff}");
        }
    }
}
