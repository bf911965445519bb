//! The unified diff between a scene's text and the formatted text. Its time and memory are linear
//! in the length of the texts.
//!
//! Formatting changes only white space. Therefore, lines of the two texts can correspond only if
//! the same number of characters, not counting white space, precedes them. One pass over both texts
//! finds all unchanged lines, so that no general diff algorithm is needed.

use super::{
    output,
    unified_diff::{ReplacedLines, hunks, lines},
};
use crate::{
    diagnostic::{visible, visible_line},
    source::Source,
};

/// Returns a unified diff from the source to the formatted text. If the source mixes LF and CRLF
/// line ends, carriage returns are shown, since lines may differ only in them.
pub fn layout_diff(source: &Source, formatted: &str) -> String {
    let text = source.text();
    let has_color = output::style().color;
    let is_mixed = text.matches('\n').count() != text.matches("\r\n").count();
    let shown = |sign: char, line: &str| {
        let (paint, end) = match sign {
            '-' if has_color => ("\x1b[31m", "\x1b[0m"),
            '+' if has_color => ("\x1b[32m", "\x1b[0m"),
            _ => ("", ""),
        };
        let mark = if is_mixed && line.ends_with('\r') {
            "␍"
        } else {
            ""
        };
        let line = visible(line.trim_end_matches(['\n', '\r']));
        format!("{paint}{sign}{line}{mark}{end}")
    };
    let name = visible_line(source.name());
    let (old, new) = (lines(text), lines(formatted));
    let hunks = hunks(&changes(&old, &new), &old, &new, shown);
    format!("--- {name}\n+++ {name}, formatted\n{hunks}")
}

/// A position in a text, between two lines.
struct LineCursor<'t> {
    lines: &'t [&'t str],
    /// Index of the next line.
    next: usize,
    /// Number of characters before the next line, not counting white space.
    solid_before: usize,
}

impl<'t> LineCursor<'t> {
    fn new(lines: &'t [&'t str]) -> Self {
        Self {
            lines,
            next: 0,
            solid_before: 0,
        }
    }

    /// Returns the next line with its line end; `None` at the end of the text.
    fn line(&self) -> Option<&'t str> {
        self.lines.get(self.next).copied()
    }

    /// Moves past the next line, if there is one.
    fn pass(&mut self) {
        let line = self.line().unwrap_or_default();
        self.next += usize::from(self.next < self.lines.len());
        self.solid_before += line.chars().filter(|c| !c.is_whitespace()).count();
    }

    /// Returns whether the next lines of both texts are equal, with the same number of characters
    /// before them, not counting white space. Also returns `true` if both texts are at their ends.
    fn is_same(&self, other: &Self) -> bool {
        match (self.line(), other.line()) {
            (None, None) => true,
            (line, other_line) => self.solid_before == other.solid_before && line == other_line,
        }
    }
}

/// Returns the changes that turn the old lines into the new lines.
fn changes(old: &[&str], new: &[&str]) -> Vec<ReplacedLines> {
    let (mut before, mut after) = (LineCursor::new(old), LineCursor::new(new));
    let mut changes = Vec::new();
    loop {
        while before.line().is_some() && before.is_same(&after) {
            before.pass();
            after.pass();
        }
        let start = (before.next, after.next);
        while !before.is_same(&after) {
            let (old, new) = (before.line(), after.line());
            let [mut is_removed, mut is_added] = [old.is_some(), new.is_some()];
            if let (Some(old), Some(new)) = (old, new) {
                // The lines differ, so one of them or both are passed. White space is not counted
                // here. If fewer characters precede the old line than the new line, the old line is
                // passed, and vice versa. If equally many characters precede both lines and only
                // one of them is empty, the empty line is passed, since formatting adds and removes
                // empty lines. Otherwise, both lines are passed.
                let is_empty = |line: &str| line.trim().is_empty();
                let [old, new] = [
                    (before.solid_before, !is_empty(old)),
                    (after.solid_before, !is_empty(new)),
                ];
                (is_removed, is_added) = (old <= new, new <= old);
            }
            if is_removed {
                before.pass();
            }
            if is_added {
                after.pass();
            }
        }
        if start == (before.next, after.next) {
            return changes;
        }
        changes.push(ReplacedLines {
            old: start.0..before.next,
            new: start.1..after.next,
        });
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
            // Equal lines correspond only if the same number of characters precedes them, not
            // counting white space. So the last `}` of the old text corresponds to the last `}` of
            // the new text, not to an earlier `}`.
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
