//! Safe fixes keep what the author wrote, whatever the text: slips made by a program in every
//! example and fixture, and files of other programs and languages.

use std::{fs, path::Path};

use super::{Trial, kept};
use crate::{
    diagnostics::fixtures,
    program::names,
    scenes::{examples, sources},
};

/// Files of other programs and languages.
fn foreign() -> Vec<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/foreign");
    let names = names(&folder);
    assert!(names.len() >= 30, "{names:?}");
    let read = |name| fs::read_to_string(folder.join(name)).unwrap();
    names.into_iter().map(read).collect()
}

/// Each file, each of its lines, and what is left of it behind each line: a file as a whole may be
/// known at once.
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
fn files_of_other_languages_keep_their_numbers_and_names() {
    let mut complaints = Vec::new();
    for text in foreign().iter().flat_map(|text| pieces(text)) {
        complaints.extend(kept::fixed(&text).1);
    }
    assert_none(&complaints);
}

/// What a fix shows that another mistake hid may be new, but it never outweighs the fix.
#[test]
fn every_fix_of_a_file_of_another_language_leaves_fewer_errors() {
    let mut trial = Trial::default();
    for text in foreign() {
        trial.type_in(&sources(&text), |_, _| true);
    }
    let is_broken = |complaint: &String| complaint.contains("leaves as many errors");
    trial.complaints.retain(is_broken);
    trial.ends_with_more_than(30);
}

/// `PINHOLE_SLIPS=100000 cargo test` tries as many.
#[test]
fn texts_with_slips_keep_their_numbers_and_names() {
    let asked = std::env::var("PINHOLE_SLIPS").ok();
    let count = asked.map_or(1000, |count| count.parse().unwrap());
    let fixtures = fixtures().map(|(_, sources)| sources.file.text().to_owned());
    let mut texts: Vec<String> = examples().into_iter().chain(fixtures).collect();
    texts.extend(foreign());
    texts.retain(|text| text.len() <= 3000);
    let mut complaints = Vec::new();
    kept::slips(&texts, count, |text| complaints.extend(kept::fixed(text).1));
    assert_none(&complaints);
}

/// What a hundred thousand slips once found.
#[test]
fn texts_that_once_lost_something_keep_it() {
    let texts = [
        // A comment of another language is no part of the values before it.
        "triangle { centroid (0, 1, 0)  sides (2, 2, 1)  normal 0 0 1\n#ff8800\n}",
        "sphere { center 0 1 0 // R\n radius 2 }",
        "sphere { center 0 1 0\n-- R\n radius 2 }",
        // One torn word is not two values.
        "box { min (-3, 0, -0.1)  max (- min1.6, 2.5, ) }",
        "sphere { center (a.5, 2) }",
        "let ball = { center1.6, 1, 0 }",
        // Extents, and their unit apart from them.
        "let a = 30 0.5x1.5x2 deg",
        "Transform { translation -0.5x.15x21.6 1 0 }",
        "triangle { centroid (0, 1, 0)  spin 30 degrees lookat }",
        "sphere { center (0, 1, 0)  radius 30°° }",
        "checkerboard { y -1  square 1e-\u{200b}101 }",
    ];
    for text in texts {
        assert_none(&kept::fixed(text).1);
    }
}
