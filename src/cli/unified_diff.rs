//! Unified diffs, in the format that `patch` reads. A unified diff of two texts contains the lines
//! that differ, with three unchanged lines around them.

use std::ops::Range;

/// Number of unchanged lines that are shown before and after a change. Three is the usual number in
/// unified diffs.
const AROUND: usize = 3;

/// Maximum number of lines, in both texts together, that are skipped after a difference to find the
/// place where the texts agree again. If no such place is found, all remaining lines are reported
/// as changed. The time grows with the square of the limit, since every pair of a place in one text
/// and a place in the other may be tried.
const MOST_STEPS: usize = 1000;

/// A change: lines of the old text, by their indices, and the lines of the new text that replace
/// them.
pub struct ReplacedLines {
    pub old: Range<usize>,
    pub new: Range<usize>,
}

/// Returns the differences of two texts as a unified diff, or an empty text if there are none.
/// `name` is the file's name.
pub fn unified_diff(name: &str, old: &str, new: &str) -> String {
    let (old, new) = (lines(old), lines(new));
    let shown = |sign: char, line: &str| format!("{sign}{line}");
    match hunks(&changes(&old, &new), &old, &new, shown) {
        hunks if hunks.is_empty() => hunks,
        hunks => format!("--- {name}\n+++ {name}\n{hunks}"),
    }
}

/// Returns the lines of a text, each with its line end.
pub fn lines(text: &str) -> Vec<&str> {
    text.split_inclusive('\n').collect()
}

/// Writes changes in the unified diff format. Changes that are close to each other form a group,
/// which begins with a line `@@ … @@` that gives its position. The function `shown` formats a line,
/// given the character that precedes it in the diff (space, `-` or `+`) and its text without line
/// feed.
pub fn hunks(
    changes: &[ReplacedLines],
    old: &[&str],
    new: &[&str],
    shown: impl Fn(char, &str) -> String,
) -> String {
    let mut text = String::new();
    let is_near = |a: &ReplacedLines, b: &ReplacedLines| b.old.start - a.old.end <= 2 * AROUND;
    for hunk in changes.chunk_by(is_near) {
        let (first, last) = (&hunk[0], &hunk[hunk.len() - 1]);
        let before = first.old.start.min(AROUND);
        let after = (old.len() - last.old.end).min(AROUND);
        let [of_old, of_new] = [
            first.old.start - before..last.old.end + after,
            first.new.start - before..last.new.end + after,
        ];
        text += &format!("@@ -{} +{} @@\n", place(&of_old), place(&of_new));
        let mut push = |sign, lines: &[&str]| {
            for line in lines {
                text += &shown(sign, line.strip_suffix('\n').unwrap_or(line));
                text += if line.ends_with('\n') {
                    "\n"
                } else {
                    "\n\\ No newline at end of file\n"
                };
            }
        };
        let mut at = of_old.start;
        for change in hunk {
            push(' ', &old[at..change.old.start]);
            push('-', &old[change.old.clone()]);
            push('+', &new[change.new.clone()]);
            at = change.old.end;
        }
        push(' ', &old[at..of_old.end]);
    }
    text
}

/// Formats a range of lines as in unified diffs: first line and count, with lines counted from 1. A
/// count of 1 is omitted. An empty range is given by the line before it.
fn place(lines: &Range<usize>) -> String {
    match lines.len() {
        0 => format!("{},0", lines.start),
        1 => format!("{}", lines.start + 1),
        length => format!("{},{length}", lines.start + 1),
    }
}

/// Returns the changes from `old` to `new`. After a difference, finds the nearest pair of
/// positions, one in each text, whose next two lines are equal. There may be more changes than
/// necessary, but applying them always yields `new`.
fn changes(old: &[&str], new: &[&str]) -> Vec<ReplacedLines> {
    let (mut a, mut b, mut changes) = (0, 0, Vec::new());
    while a < old.len() || b < new.len() {
        if a < old.len() && b < new.len() && old[a] == new[b] {
            (a, b) = (a + 1, b + 1);
            continue;
        }
        let (old_rest, new_rest) = (&old[a..], &new[b..]);
        let is_same = |&(i, j): &(usize, usize)| {
            i <= old_rest.len() && j <= new_rest.len() && {
                let (old, new) = (old_rest[i..].iter(), new_rest[j..].iter());
                old.take(2).eq(new.take(2))
            }
        };
        let steps = (1..=MOST_STEPS).flat_map(|sum| (0..=sum).map(move |i| (i, sum - i)));
        let (i, j) = steps
            .into_iter()
            .find(is_same)
            .unwrap_or((old_rest.len(), new_rest.len()));
        changes.push(ReplacedLines {
            old: a..a + i,
            new: b..b + j,
        });
        (a, b) = (a + i, b + j);
    }
    changes
}

#[cfg(all(test, unix))]
#[allow(
    clippy::disallowed_methods,
    reason = "the tests are another program here"
)]
mod tests {
    use std::{fs, process::Command};

    use proptest::prelude::*;

    use super::*;

    /// Generates texts of up to 14 lines, made from few different lines so that repetitions occur.
    /// The last line may lack a line feed.
    fn text() -> impl Strategy<Value = String> {
        ("((a|b|c|)\n){0,14}", "(a|b)?").prop_map(|(lines, last)| lines + &last)
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 100, failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn patch_makes_the_new_text_of_the_old_one(old in text(), new in text()) {
            let folder = tempfile::tempdir()?;
            let write = |name, text: &str| fs::write(folder.path().join(name), text);
            write("old", &old)?;
            let diff = unified_diff("old", &old, &new);
            prop_assert_eq!(diff.is_empty(), old == new);
            write("diff", &diff)?;
            let mut patch = Command::new("patch");
            patch.args(["--silent", "--fuzz=0", "old", "diff"]);
            let Ok(output) = patch.current_dir(folder.path()).output() else {
                return Ok(());
            };
            prop_assert!(diff.is_empty() || output.status.success(), "{:?} {}", output, diff);
            // If the new text is empty, `patch` may remove the file, so a missing file is read as
            // empty.
            let made = fs::read_to_string(folder.path().join("old")).unwrap_or_default();
            prop_assert_eq!(made, new, "{}", diff);
        }
    }
}
