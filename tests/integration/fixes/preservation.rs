//! Tests that safe fixes keep what the author wrote. The texts are all examples and fixtures with
//! random mistakes, and files of other programs and languages.

use std::{fs, path::Path};

use super::{Trial, lost_words};
use crate::{
    diagnostics::fixtures,
    program::names,
    scenes::{examples, sources},
};

/// Returns the texts of files of other programs and languages.
fn foreign() -> Vec<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/foreign");
    let names = names(&folder);
    assert!(names.len() >= 30, "{names:?}");
    let read = |name| fs::read_to_string(folder.join(name)).unwrap();
    names.into_iter().map(read).collect()
}

/// Returns each line of a file, and for each line the text from this line to the end. The first
/// words of a text may reveal its language, so texts with many different beginnings are tested.
fn pieces(text: &str) -> Vec<String> {
    let lines: Vec<&str> = text.lines().collect();
    let rest = (0..lines.len()).map(|at| lines[at..].join("\n"));
    let each = lines.iter().map(|line| (*line).to_owned());
    each.chain(rest).collect()
}

#[track_caller]
fn assert_none(complaints: &[String]) {
    assert!(complaints.is_empty(), "{}", complaints.join("\n====\n"));
}

#[test]
fn safe_fixes_keep_numbers_and_names_of_foreign_files() {
    let mut complaints = Vec::new();
    for text in foreign().iter().flat_map(|text| pieces(text)) {
        complaints.extend(lost_words::fix_safely(&text).1);
    }
    assert_none(&complaints);
}

/// A fix may reveal a mistake that was not reported because of an earlier error. Even so, each fix
/// must leave fewer errors than before.
#[test]
fn every_fix_of_a_foreign_file_leaves_fewer_errors() {
    let mut trial = Trial::default();
    for text in foreign() {
        trial.apply_fixes(&sources(&text), |_, _| true);
    }
    let is_broken = |complaint: &String| complaint.contains("leaves as many errors");
    trial.complaints.retain(is_broken);
    trial.finish_with_more_than(30);
}

/// `PINHOLE_SLIPS=100000 cargo test` tries a hundred thousand texts instead of a thousand.
#[test]
fn safe_fixes_keep_numbers_and_names_of_mistyped_scenes() {
    let asked = std::env::var("PINHOLE_SLIPS").ok();
    let count = asked.map_or(1000, |count| count.parse().unwrap());
    let fixtures = fixtures().map(|(_, sources)| sources.file.text().to_owned());
    let mut texts: Vec<String> = examples().into_iter().chain(fixtures).collect();
    texts.extend(foreign());
    texts.retain(|text| text.len() <= 3000);
    let mut complaints = Vec::new();
    lost_words::slips(&texts, count, |text| {
        complaints.extend(lost_words::fix_safely(text).1)
    });
    assert_none(&complaints);
}

/// The texts come from a run with a hundred thousand random mistakes. In each, a fix had removed
/// something that the author wrote.
#[test]
fn texts_that_once_lost_content_to_a_fix_keep_it() {
    let texts = [
        // A comment in the style of another language, after a value, is not part of this value.
        "triangle { centroid (0, 1, 0)  sides (2, 2, 1)  normal 0 0 1\n#ff8800\n}",
        "sphere { center 0 1 0 // R\n radius 2 }",
        "sphere { center 0 1 0\n-- R\n radius 2 }",
        // A fix must not split a word with a number attached, such as `min1.6`, into two values.
        "box { min (-3, 0, -0.1)  max (- min1.6, 2.5, ) }",
        "sphere { center (a.5, 2) }",
        "let ball = { center1.6, 1, 0 }",
        // An `x` may mean multiplication, and a unit may be apart from its number.
        "let a = 30 0.5x1.5x2 deg",
        "Transform { translation -0.5x.15x21.6 1 0 }",
        "triangle { centroid (0, 1, 0)  spin 30 degrees lookat }",
        "sphere { center (0, 1, 0)  radius 30°° }",
        "checkerboard { y -1  square 1e-\u{200b}101 }",
    ];
    for text in texts {
        assert_none(&lost_words::fix_safely(text).1);
    }
}
