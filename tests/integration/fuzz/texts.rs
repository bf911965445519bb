//! Tests that random texts are read, fixed and formatted without a panic.

use pinhole::{
    diagnostic::{Applicability, apply},
    scene,
    source::{Source, SourceId, Sources},
};

use super::{each, scene as any_scene};
use crate::{
    format::{formatted, laws::assert_formatter_laws},
    parts, robustness,
};

#[test]
fn random_texts_are_read_without_panics_or_hangs() {
    each(60, |random| assert_read(any_scene(random)));
}

fn assert_read(bytes: Vec<u8>) {
    if let Ok(text) = str::from_utf8(&bytes) {
        parts::assert_same_in_parts(text, 1 + bytes.len() % 99, &[]);
    }
    robustness::read(bytes);
}

/// Each fix must change the text, and fixing all problems a second time must change nothing.
#[test]
fn every_fix_changes_the_text_and_fixing_twice_equals_fixing_once() {
    each(60, |random| {
        // Texts that are not UTF-8 get no fixes.
        if let Ok(text) = String::from_utf8(any_scene(random)) {
            assert_fixes(text);
        }
    });
}

fn assert_fixes(text: String) {
    let sources = Sources::new(Source::from_text("a.scn", text));
    let text = sources.file.text();
    for problem in &scene::read(&sources).diagnostics {
        for fix in &problem.fixes {
            let after = apply(fix, SourceId::File, text);
            assert_ne!(after, text, "{}", fix.title);
        }
    }
    let once = scene::fix_all(&sources, Applicability::Safe).text;
    let again = Sources::new(Source::from_text("a.scn", once.as_str()));
    let twice = scene::fix_all(&again, Applicability::Safe).text;
    assert_eq!(twice, once, "{text}");
}

#[test]
fn formatting_a_random_text_keeps_its_meaning() {
    each(60, |random| {
        if let Ok(text) = str::from_utf8(&any_scene(random)) {
            assert_formatted(text);
        }
    });
}

fn assert_formatted(text: &str) {
    if let Ok(laid_out) = formatted(text) {
        assert_formatter_laws(text, &laid_out);
    }
}

/// Texts that once made a test of random texts fail, for example because two fixes removed the same
/// space, or because a label began inside a character.
#[test]
fn texts_found_by_fuzzing_stay_fixed() {
    let (deep, minuses) = ("(".repeat(220), "−".repeat(300));
    for text in [
        "sphere { center (0, 1, 0), , }".to_owned(),
        format!("let e = 2 {minuses} 3"),
        format!("camera {{ eye {deep}0, 1, 0) roll 45deg }}"),
        "triangle { /* nothing\n\n\nbut this */ }".to_owned(),
        "sampler { method multi-// no\n jittered }".to_owned(),
        "sampler { method multi /* no */ - jittered }".to_owned(),
        "camera { eye\nvec3(1, 2, 3) }".to_owned(),
        "let a =\nrgba(1, 2, 3, 4)".to_owned(),
        "camera { e for i < 8 image".to_owned(),
        "sphere { radius\nr - color olive\n(1) }".to_owned(),
    ] {
        assert_read(text.clone().into());
        assert_formatted(&text);
        assert_fixes(text);
    }
}
