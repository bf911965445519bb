//! A unified diff in the format that `patch` reads.
//!
//! In: a text before and after changes. Out: the lines that differ, with three lines of context.

use std::ops::Range;

/// Number of unchanged lines that are shown before and after a change, as is usual in diffs.
const AROUND: usize = 3;

/// Maximum number of lines, in both texts together, that are passed after a difference in the
/// search for the place where the texts agree again. If it is farther away, all remaining lines
/// count as changed.
const MOST_STEPS: usize = 1000;

/// Lines of the old text, and the lines of the new text that replace them.
struct ReplacedLines {
    old: Range<usize>,
    new: Range<usize>,
}

/// Returns the changes of a file as a unified diff; empty if there are none.
pub fn unified_diff(name: &str, old: &str, new: &str) -> String {
    let lines = |text| str::split_inclusive(text, '\n').collect::<Vec<&str>>();
    let (old, new) = (lines(old), lines(new));
    let changes = changes(&old, &new);
    let mut text = String::new();
    let mut rest = changes.as_slice();
    while !rest.is_empty() {
        // Changes belong to one hunk if the unchanged lines around them touch.
        let near = |pair: &[ReplacedLines]| pair[1].old.start - pair[0].old.end <= 2 * AROUND;
        let together = 1 + rest.windows(2).take_while(|pair| near(pair)).count();
        let (hunk, behind) = rest.split_at(together);
        if text.is_empty() {
            text = format!("--- {name}\n+++ {name}\n");
        }
        push_hunk(&mut text, hunk, &old, &new);
        rest = behind;
    }
    text
}

fn push_hunk(text: &mut String, hunk: &[ReplacedLines], old: &[&str], new: &[&str]) {
    let (Some(first), Some(last)) = (hunk.first(), hunk.last()) else {
        return;
    };
    let before = first.old.start.min(AROUND);
    let after = (old.len() - last.old.end).min(AROUND);
    let place = |start: usize, end: usize| {
        let (start, end) = (start - before, end + after);
        // An empty range comes after the line whose number is given.
        let first = if start == end { start } else { start + 1 };
        format!("{first},{}", end - start)
    };
    let places = [
        place(first.old.start, last.old.end),
        place(first.new.start, last.new.end),
    ];
    *text += &format!("@@ -{} +{} @@\n", places[0], places[1]);
    let mut push = |sign, lines: &[&str]| {
        for line in lines {
            *text += &format!("{sign}{line}");
            if !line.ends_with('\n') {
                *text += "\n\\ No newline at end of file\n";
            }
        }
    };
    let mut at = first.old.start - before;
    for change in hunk {
        push(' ', &old[at..change.old.start]);
        push('-', &old[change.old.clone()]);
        push('+', &new[change.new.clone()]);
        at = change.old.end;
    }
    push(' ', &old[at..last.old.end + after]);
}

/// Returns the changes from `old` to `new`. Walks through both texts. After a difference, the walk
/// continues at the nearest place where the next two lines of both texts agree or both texts end.
/// The list may be longer than the shortest one, but is always correct.
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

    /// Generates texts of up to 14 lines out of a few different ones, with and without a line feed
    /// at the end.
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
            // If the new text is empty, `patch` may remove the file.
            let made = fs::read_to_string(folder.path().join("old")).unwrap_or_default();
            prop_assert_eq!(made, new, "{}", diff);
        }
    }
}
