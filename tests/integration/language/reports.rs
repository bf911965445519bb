//! What is said of mistakes.

use pinhole::scene::{self};

use super::{CAMERA, codes, number, sources};
use crate::table::rows;

#[test]
fn one_mistake_gives_one_report() {
    let table = r#"
        let r = nothing sphere { center (0, r, 0) radius r + 1 } -> unknown_name
        let r = 1/0 let s = r + red sphere { center (0, 0, 0) radius s } -> not_finite
        sphere { cneter (0, 0, 0) } -> unknown_field
        cube { center (0, 0, 0) size (1, 1, 1) } -> unknown_kind
        torus { center (0, 0, 0) } -> unknown_kind
        sphere { center (0, 0, 0 } -> unclosed_parenthesis
        sphere { center (0, 0, 0) radius 2 -> unclosed_block
        sphere { center (0, 0, 0) color "red" } -> quoted
        sphere { center (0, 0) } -> part_count
        sphere { center (1 2 3) } -> missing_comma
    "#;
    for [text, expected] in rows(table) {
        assert_eq!(codes(&format!("{CAMERA} {text}")), [expected], "{text}");
    }
}

/// An unknown name is told once, at each of its places, also where the field that it is first used for is unknown, too.
#[test]
fn uses_of_a_name_are_places_of_its_own_report() {
    let text = format!(
        "{CAMERA} sphere {{ center (0, 1, 0) glow (1e999, 1e999, foo) }}
         sphere {{ center (0, 1, 0) radius -1 }} sphere {{ center foo }}"
    );
    let sources = sources(&text);
    let found = scene::read(&sources).diagnostics;
    let of_name = found
        .iter()
        .find(|found| found.code == "pinhole::unknown_name");
    let places: Vec<_> = of_name
        .unwrap()
        .labels
        .iter()
        .map(|label| label.span.start)
        .collect();
    let uses: Vec<_> = text.match_indices("foo").map(|(at, _)| at).collect();
    assert_eq!(places, uses);
    for other in found
        .iter()
        .filter(|found| found.code != "pinhole::unknown_name")
    {
        assert_eq!(other.labels.len(), 1, "{other:#?}");
    }
}

#[test]
fn all_mistakes_are_reported_in_the_order_of_the_text() {
    let text = "camera { eye (0, 2, 8) lookat (0, 1, 0) rol 3deg }
        sphere { center (0, 1, 0), radius -1 }
        let a = 1 + red
        triangle { centroid (0, 0, 0) normal (0, 0 1) color olvie }
        sphere { radius 2 }";
    assert_eq!(
        codes(text),
        [
            "unknown_field",
            "needless_separator",
            "out_of_range",
            "operand_types",
            "missing_comma",
            "unknown_color",
            "missing_field"
        ]
    );
}

/// The first diagnostic of a scene that has this one: its words and its help.
fn said(items: &str) -> [String; 3] {
    let sources = match items.contains("camera") {
        true => sources(&format!(
            "{items} sphere S {{ center (0, 0, 0) }} sphere {{ center (9, 11, 17) }}"
        )),
        false => sources(&format!("{CAMERA} {items} sphere {{ center (0, 0, 0) }}")),
    };
    let mut found = scene::read(&sources).diagnostics;
    assert_eq!(found.len(), 1, "{items}: {found:?}");
    let found = found.remove(0);
    [
        found.message,
        found.labels[0].message.clone(),
        found.help.unwrap_or_default(),
    ]
}

#[test]
fn digits_that_decide_are_shown() {
    for [items, part] in rows("
        camera { eye (0, 2, 8) lookat (0, 1, 0) near 5.0000001 far 5 } -> write a number above 5.0000001 after `far`
        triangle { centroid (0, 0, 0) normal (0, 0, 1) sides (0.1, 0.2, 0.30000000000000004) } -> 0.30000000000000004 is not less than 0.1 + 0.2
        image { width 9e5 + 0.1 } -> and it is 900000.1
        sphere { center (0, 0, 0) color rgb(255.0000001, 0, 0) } -> this is 255.0000001
        camera { eye (0, 2, 8) lookat (0, 1, 0) fov 180.00000001deg + 0deg } -> and it is 180.00000001deg
        sampler { per_pixel 1e300 } -> 1e300 samples in each of
        sphere { center (0, 0, 0) radius 1e-400 } -> and it is 1e-400, which rounds to 0
    ") {
        let found = said(items);
        assert!(found.iter().any(|words| words.contains(part)), "{found:?}");
    }
}

#[test]
fn ways_out_are_true() {
    for [items, help] in rows("
        camera { eye (0, 2, 8) direction (3, 3, 3) up (1, 1, 1) } -> the top of the picture is towards (-0.5, -0.5, 1) here; write `up (-0.5, -0.5, 1)` to say so yourself
        camera { eye (0, 2, 8) up (1e200, 0, 0) direction (1e200, 0, 0) } -> towards (0, 0, 1) here
        camera { eye (0, 2, 8) direction (0, 0, 0) } -> write, for example, `direction (0, 0, -1)`
        camera { eye (0, 2, 8) lookat S } -> an object is no value: define its place with `let`, and use that in both
        let x = 3 - x -> a `let` cannot use itself: write a value, or the name of an earlier `let`
        let x = length(1, 2, 3) -> write `length((1, 2, 3))`
        let x = rgb((255, 0, 0)) -> write `rgb(255, 0, 0)`
        box { center (0, 0, 0) size (1, 2) } -> write a third number, such as `(1, 2, 2)`
    ") {
        let found = said(items);
        assert!(found[2].contains(help), "{found:?}");
    }
    let text = format!("{CAMERA} sphere {{ center (0, 0, 0) }} sampler {{ per_pixel 16 total 9 }}");
    assert_eq!(codes(&text), ["conflicting_fields"]);
    assert_eq!(number("(atan2(sin(180deg), -1) / 1deg)"), 180.0);
}
