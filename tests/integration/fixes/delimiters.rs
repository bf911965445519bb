//! Tests of texts that lack one brace or parenthesis. The first diagnostic must be about the
//! missing delimiter, and no fix may remove anything that the author wrote.

use std::{collections::BTreeSet, fs};

use pinhole::{diagnostic::Applicability, scene};

use super::diagnostics;
use crate::scenes::{scenes, sources};

/// Scenes with mistakes, most of them before the opening brace of a block. The test removes one
/// delimiter at a time, and the program must report it as missing in spite of the mistakes.
const WITH_MISTAKES: [&str; 3] = [
    "\
camera { eye (0, 3, 8)  lookat (0, 1, 0) }
box Tower[i] for i < 4 { center (i * 2 - 3, 1, 0)  size (1, 2, 1)  colors (red, green, blue) }
box Low for i < 4 j < 3 { center (i, j, 0) }
sphere C for i = 0 to 5 { center (i, 0, 0)  radius 1 }
",
    "\
camera {
  eye (0, 3, 8)
  lookat (0, 1, 0)
}
box Big Low for i < 4 {
  center (i, 1, 0)
  color (wheat, tan)
}
sphere B for 0 <= i < 3 {
  center (2 * cos(10deg * i), 0.2, 2 * sin(10deg * i))
}
sphere repeat 5 { center (1, 1, 0) }
",
    "\
let w = 30
camera { eye (0, 3, 8)  lookat (0, 1, 0)  fov w }
sphere Ball[3] { center (0, 1, 0)  radus 2 }
cube for i < 3 and j < 3 { center (i, j, 0) }
",
];

/// Codes of the diagnostics about delimiters, without the prefix `pinhole::`. If a scene lacks a
/// delimiter, its first diagnostic must have one of these codes.
const OF_DELIMITERS: [&str; 7] = [
    "unclosed_block",
    "unopened_block",
    "unclosed_parenthesis",
    "stray_closing",
    "missing_parentheses",
    "missing_kind",
    "nested_braces",
];

/// Returns whether all characters of a text, except white space, remain in order when the fixes of
/// its diagnostics are applied. If `most` is `Safe`, only safe fixes are applied.
fn keeps_all(text: &str, most: Applicability) -> bool {
    let fixed = scene::fix_all(&sources(text), most).text;
    let mut left = fixed.chars();
    let mut written = text.chars().filter(|c| !c.is_whitespace());
    written.all(|c| left.any(|other| other == c))
}

#[test]
fn a_missing_delimiter_is_reported_first_and_fixes_delete_nothing() {
    let folders = ["examples", "examples/course"].into_iter();
    let paths = folders.flat_map(scenes);
    let texts = paths.map(|path| fs::read_to_string(path).unwrap());
    let texts = texts.chain(WITH_MISTAKES.map(str::to_owned));
    let (mut tried, mut complaints) = (0, Vec::new());
    for text in texts.filter(|text| text.len() < 3000) {
        let own = diagnostics(&sources(&text)).into_iter();
        let own: BTreeSet<(String, String)> = own.map(|d| (d.code, d.message)).collect();
        let all = [Applicability::Safe, Applicability::Unsafe];
        let all = all.map(|most| (most, keeps_all(&text, most)));
        for (at, _) in text.match_indices(['(', ')', '{', '}']) {
            let line = text[..at].rsplit('\n').next().unwrap();
            if line.contains("//") {
                continue;
            }
            tried += 1;
            let wrong = format!("{}{}", &text[..at], &text[at + 1..]);
            let found = diagnostics(&sources(&wrong)).into_iter();
            let mut found = found.filter(|d| !own.contains(&(d.code.clone(), d.message.clone())));
            let first = found.next().map(|d| d.code.replace("pinhole::", ""));
            if !first
                .as_deref()
                .is_some_and(|code| OF_DELIMITERS.contains(&code))
            {
                complaints.push(format!("{first:?} is told first\n{wrong}"));
            }
            let second = found.next();
            if own.is_empty() && second.is_some() {
                complaints.push(format!("two things are told, {second:?}\n{wrong}"));
            }
            for (most, _) in all.iter().filter(|(_, keeps)| *keeps) {
                if !keeps_all(&wrong, *most) {
                    complaints.push(format!("{most:?} fixes take something away\n{wrong}"));
                }
            }
        }
    }
    assert!(complaints.is_empty(), "{}", complaints.join("\n====\n"));
    assert!(tried > 800, "{tried}");
}
