//! Texts: what is read of them, what is offered to mend them, and how they are laid out.

use pinhole::{
    diagnostic::{Applicability, apply},
    scene,
    source::{Source, SourceId, Sources},
};

use super::{each, scene as any_scene};
use crate::{
    format::{formatted, laws::the_laws_hold},
    parts, robustness,
};

#[test]
fn whatever_is_read_gets_an_answer() {
    each(60, |random| gets_an_answer(any_scene(random)));
}

fn gets_an_answer(bytes: Vec<u8>) {
    if let Ok(text) = str::from_utf8(&bytes) {
        parts::check(text, 1 + bytes.len() % 99, &[]);
    }
    robustness::read(bytes);
}

/// Each fix changes the text, and all of them together come to an end: what is done again changes
/// nothing.
#[test]
fn fixes_change_what_is_there_and_come_to_an_end() {
    each(60, |random| {
        // What is no text is not mended.
        if let Ok(text) = String::from_utf8(any_scene(random)) {
            is_mended(text);
        }
    });
}

fn is_mended(text: String) {
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
fn what_can_be_laid_out_means_the_same_afterwards() {
    each(60, |random| {
        if let Ok(text) = str::from_utf8(&any_scene(random)) {
            is_laid_out(text);
        }
    });
}

fn is_laid_out(text: &str) {
    if let Ok(laid_out) = formatted(text) {
        the_laws_hold(text, &laid_out);
    }
}

/// Texts that once were not: fixes that take the same space away, a label in the middle of a sign,
/// a parenthesis for each of two hundred fixes in one place, and a comment with empty lines. A
/// comment in the middle of a hyphenated name, and functions of other languages and values on a new
/// line. Indices without a `{` in the place of a field.
#[test]
fn what_was_found_stays_mended() {
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
        gets_an_answer(text.clone().into());
        is_laid_out(&text);
        is_mended(text);
    }
}
