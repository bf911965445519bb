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
    let (before, after) = (lines(text), lines(formatted));
    let changes = changes(&before, &after);
    let printer = Printer {
        color: output::style().color,
        is_mixed: text.matches('\n').count() != text.matches("\r\n").count(),
    };
    let name = visible_line(source.name());
    let mut out = format!("--- {name}\n+++ {name}, formatted\n");
    let is_near = |a: &Change, b: &Change| b.before.start - a.before.end <= 2 * CONTEXT;
    for hunk in changes.chunk_by(is_near) {
        printer.hunk(&mut out, hunk, &before, &after);
    }
    out
}

/// A line with its line end, and the number of characters before it that are no blanks.
struct Line<'t> {
    text: &'t str,
    place: usize,
}

fn lines(text: &str) -> Vec<Line<'_>> {
    let mut next = 0;
    let lines = text.split_inclusive('\n').map(|text| {
        let place = next;
        next += text.chars().filter(|c| !c.is_whitespace()).count();
        Line { text, place }
    });
    lines.collect()
}

/// Lines that are replaced by others.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Change {
    before: Range<usize>,
    after: Range<usize>,
}

/// The changes that make one text of the other.
fn changes(before: &[Line], after: &[Line]) -> Vec<Change> {
    let mut changes: Vec<Change> = Vec::new();
    let (mut i, mut j) = (0, 0);
    while i < before.len() || j < after.len() {
        let (old, new) = (before.get(i), after.get(j));
        let [mut is_removed, mut is_added] = [old.is_some(), new.is_some()];
        if let (Some(old), Some(new)) = (old, new) {
            if old.place == new.place && old.text == new.text {
                (i, j) = (i + 1, j + 1);
                continue;
            }
            // An empty line has no place of its own, so it goes before the other one.
            let is_empty = |line: &Line| line.text.trim().is_empty();
            let (old, new) = ((old.place, !is_empty(old)), (new.place, !is_empty(new)));
            (is_removed, is_added) = (old <= new, new <= old);
        }
        let (to_i, to_j) = (i + usize::from(is_removed), j + usize::from(is_added));
        match changes.last_mut() {
            Some(last) if (last.before.end, last.after.end) == (i, j) => {
                (last.before.end, last.after.end) = (to_i, to_j);
            }
            _ => changes.push(Change {
                before: i..to_i,
                after: j..to_j,
            }),
        }
        (i, j) = (to_i, to_j);
    }
    changes
}

/// How lines are printed.
struct Printer {
    color: bool,
    /// Whether lines end in different ways.
    is_mixed: bool,
}

impl Printer {
    /// Prints changes that lie near each other.
    fn hunk(&self, out: &mut String, changes: &[Change], before: &[Line], after: &[Line]) {
        let (Some(first), Some(last)) = (changes.first(), changes.last()) else {
            return;
        };
        let lead = first.before.start.min(CONTEXT);
        let trail = (before.len() - last.before.end).min(CONTEXT);
        let old = range(first.before.start - lead..last.before.end + trail);
        let new = range(first.after.start - lead..last.after.end + trail);
        let _ = writeln!(out, "@@ -{old} +{new} @@");
        let mut at = first.before.start - lead;
        for change in changes {
            self.lines(out, ' ', &before[at..change.before.start]);
            self.lines(out, '-', &before[change.before.clone()]);
            self.lines(out, '+', &after[change.after.clone()]);
            at = change.before.end;
        }
        self.lines(out, ' ', &before[at..at + trail]);
    }

    fn lines(&self, out: &mut String, sign: char, lines: &[Line]) {
        let (paint, end) = match sign {
            '-' if self.color => ("\x1b[31m", "\x1b[0m"),
            '+' if self.color => ("\x1b[32m", "\x1b[0m"),
            _ => ("", ""),
        };
        for line in lines {
            let shown = visible(line.text.trim_end_matches(['\n', '\r']));
            let is_marked = self.is_mixed && line.text.trim_end_matches('\n').ends_with('\r');
            let mark = if is_marked { "␍" } else { "" };
            let _ = writeln!(out, "{paint}{sign}{shown}{mark}{end}");
            if !line.text.ends_with('\n') {
                out.push_str("\\ No newline at end of file\n");
            }
        }
    }
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
