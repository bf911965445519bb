//! What follows from a definition that failed is not reported again.

use pinhole::{
    scene,
    source::{Source, Sources},
};

/// The codes of what is wrong with some items beside a camera and a sphere, in order.
fn codes(items: &str, sets: &[&str]) -> Vec<String> {
    let text = format!(
        "{items}\ncamera {{ eye (0, 1, 5)  lookat (0, 0, 0) }}\nsphere S {{ center (0, 1, 0) }}\n"
    );
    let sources = Sources::new(Source::from_text("a.scn", text)).with_sets(sets);
    let found = scene::read(&sources).diagnostics.into_iter();
    found.map(|d| d.code.replace("pinhole::", "")).collect()
}

#[track_caller]
fn assert_only(code: &str, items: &str, sets: &[&str]) {
    assert_eq!(codes(items, sets), [code], "{items} {sets:?}");
}

const PREDEFINED: &str = "predefined_name";

#[test]
fn a_predefined_name_is_reported_once_however_it_is_used() {
    for items in [
        "let red = 5  let a = red  let b = a * 2",
        "let red = 5  let a = (red)  let b = a  sphere { center (0, b + 1, 0)  radius b }",
        "let red = 5  let a = (red, 1)",
        "let pi = 30deg  let a = sin(pi)  let b = 2 * pi  let c = sin(b)",
        "let deg = 3  sphere { center (0, 1, 0)  radius deg }",
        "let gray = 2  let a = (0, gray, 0)  let b = 1 + gray",
        "let max = 3  let a = max  sphere { center (0, 1, 0)  radius a }",
    ] {
        assert_only(PREDEFINED, items, &[]);
    }
    // So it is where the `let` was left out, or the name is a part of what cannot be one.
    let sphere = "let a = red  sphere { center (0, 1, 0)  radius a }";
    assert_only("missing_let", &format!("red = 5\n{sphere}"), &[]);
    let part = "let my-red = 5  sphere { center (0, 1, 0)  radius my-red }";
    assert_only("bad_name", part, &[]);
}

#[test]
fn so_it_is_in_what_is_set() {
    for (items, sets) in [
        ("let red = 5", ["S.radius=red"].as_slice()),
        ("let red = 5", &["S.radius=2 * red"]),
        ("let max = 3", &["S.radius=max"]),
        ("let red = 5  let a = red", &["S.radius=a"]),
        ("let red = 5  let a = 1", &["a=2 * red"]),
        ("let red = 5  let a = 1  let b = 2 * a", &["a=red"]),
        ("let red = 5  let a = 2 * red", &["red=3"]),
    ] {
        assert_only(PREDEFINED, items, sets);
    }
}

#[test]
fn what_does_not_follow_from_it_is_reported() {
    let both = |items: &str, sets: &[&str]| {
        let found = codes(items, sets);
        assert_eq!(found.len(), 2, "{items} {sets:?}: {found:?}");
        assert!(found.contains(&PREDEFINED.to_owned()), "{found:?}");
    };
    // Above the definition the name means what it means in the language.
    both("let a = red  let red = 5  let b = 2 * a", &[]);
    both("let a = 1  let red = 5", &["a=red", "S.radius=a"]);
    // What is set in place of a value has nothing to do with it.
    both("let red = 5  let a = red  let b = 2 * a", &["a=blue"]);
    both("let red = 5  let a = (1, green, 3)", &[]);
    both("let red = 5", &["rad=3"]);
    both("let max = 3  sphere { center (0, 1, 0)  radius min }", &[]);
}

#[test]
fn the_names_in_what_cannot_be_one_are_known() {
    let uses = "let b = a  sphere { center (0, b, 0)  radius 2 * a }";
    for start in [
        "let mut a = 5",
        "let vec a = 5",
        "let a() = 5",
        "let \"a\" = 5",
    ] {
        assert_only("bad_name", &format!("{start}\n{uses}"), &[]);
        assert_only("bad_name", start, &["S.radius=2 * a"]);
    }
    // But they are not defined.
    let size = "let my-size = 5\nlet size = 2\nsphere { center (0, 1, 0)  radius size }";
    assert_only("bad_name", size, &[]);
    assert_only("bad_name", size, &["size=3"]);
    let other = "let my-size = 5\nlet size = 2deg\nsphere { center (0, 1, 0)  radius size }";
    assert_eq!(codes(other, &[]), ["bad_name", "wrong_type"]);
    assert_eq!(
        codes("let my-size = 5\nlet size = 2\nlet size = 3", &[]),
        ["bad_name", "duplicate_let"]
    );
}
