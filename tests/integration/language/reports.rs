//! What is said of mistakes.

use super::{CAMERA, assert_codes, codes};
use crate::{diagnostics::found, table::rows};

#[test]
fn one_mistake_gives_one_report() {
    assert_codes(
        r#"
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
        sampler { per_pixel 16 total 9 } -> conflicting_fields
        -- Neither word is a kind.
        let a = 2 spere\nB { center (0, 1, 0) } -> unknown_kind
    "#,
    );
    // All are reported in the order of the text.
    let text = "camera { eye (0, 2, 8) lookat (0, 1, 0) rol 3deg }
        sphere { center (0, 1, 0), radius -1 }
        let a = 1 + red
        triangle { centroid (0, 0, 0) normal (0, 0 1) color olvie }
        sphere { radius 2 }";
    let expected = "unknown_field needless_separator out_of_range operand_types missing_comma unknown_color missing_field";
    assert_eq!(codes(text), expected);
}

/// What follows from a definition that failed is not reported again, here or in what is set.
#[test]
fn consequences_are_not_reported() {
    assert_codes(
        r#"
        let red = 5  let a = red  let b = a * 2 -> predefined_name
        let red = 5  let a = (red)  let b = a  sphere { center (0, b + 1, 0)  radius b } -> predefined_name
        let red = 5  let a = (red, 1) -> predefined_name
        let pi = 30deg  let a = sin(pi)  let b = 2 * pi  let c = sin(b) -> predefined_name
        let deg = 3  sphere { center (0, 1, 0)  radius deg } -> predefined_name
        let gray = 2  let a = (0, gray, 0)  let b = 1 + gray -> predefined_name
        let max = 3  let a = max  sphere { center (0, 1, 0)  radius a } -> predefined_name
        red = 5\nlet a = red  sphere { center (0, 1, 0)  radius a } -> missing_let
        let my-red = 5  sphere { center (0, 1, 0)  radius my-red } -> bad_name
        let red = 5 -> S.radius=red -> predefined_name
        let red = 5 -> S.radius=2 * red -> predefined_name
        let max = 3 -> S.radius=max -> predefined_name
        let red = 5  let a = red -> S.radius=a -> predefined_name
        let red = 5  let a = 1 -> a=2 * red -> predefined_name
        let red = 5  let a = 1  let b = 2 * a -> a=red -> predefined_name
        let red = 5  let a = 2 * red -> red=3 -> predefined_name

        -- Above the definition the name means what it means in the language.
        let a = red  let red = 5  let b = 2 * a -> predefined_name operand_types
        let a = 1  let red = 5 -> a=red; S.radius=a -> predefined_name wrong_type
        -- What is set in place of a value has nothing to do with it.
        let red = 5  let a = red  let b = 2 * a -> a=blue -> predefined_name operand_types
        let red = 5  let a = (1, green, 3) -> predefined_name part_type
        let red = 5 -> rad=3 -> predefined_name no_such_target
        let max = 3  sphere { center (0, 1, 0)  radius min } -> predefined_name function_without_arguments

        -- The names in what cannot be one are known, but they are not defined.
        let mut a = 5\nlet b = a  sphere { center (0, b, 0)  radius 2 * a } -> bad_name
        let vec a = 5\nlet b = a  sphere { center (0, b, 0)  radius 2 * a } -> bad_name
        let a() = 5\nlet b = a  sphere { center (0, b, 0)  radius 2 * a } -> bad_name
        let "a" = 5\nlet b = a  sphere { center (0, b, 0)  radius 2 * a } -> bad_name
        let mut a = 5 -> S.radius=2 * a -> bad_name
        let vec a = 5 -> S.radius=2 * a -> bad_name
        let a() = 5 -> S.radius=2 * a -> bad_name
        let "a" = 5 -> S.radius=2 * a -> bad_name
        let my-size = 5\nlet size = 2\nsphere { center (0, 1, 0)  radius size } -> bad_name
        let my-size = 5\nlet size = 2\nsphere { center (0, 1, 0)  radius size } -> size=3 -> bad_name
        let my-size = 5\nlet size = 2deg\nsphere { center (0, 1, 0)  radius size } -> bad_name wrong_type
        let my-size = 5\nlet size = 2\nlet size = 3 -> bad_name duplicate_let
    "#,
    );
}

/// An unknown name is told once, at each of its places, also where the field that it is first used for is unknown, too.
#[test]
fn uses_of_a_name_are_places_of_its_own_report() {
    let text = format!(
        "{CAMERA} sphere {{ center (0, 1, 0) glow (1e999, 1e999, foo) }}
         sphere {{ center (0, 1, 0) radius -1 }} sphere {{ center foo }}"
    );
    let uses = text.match_indices("foo").map(|(at, _)| at);
    let uses: Vec<_> = uses.collect();
    for found in found(&text, &[]) {
        let places = found.labels.iter().map(|label| label.span.start);
        let places: Vec<_> = places.collect();
        match found.code.as_str() {
            "pinhole::unknown_name" => assert_eq!(places, uses),
            _ => assert_eq!(places.len(), 1, "{found:#?}"),
        }
    }
}

/// Each row has a part of the message, the label or the help of the one mistake.
#[test]
fn digits_that_decide_are_shown_and_ways_out_are_true() {
    for [items, part] in rows("
        camera { eye (0, 2, 8) lookat (0, 1, 0) near 5.0000001 far 5 } -> write a number above 5.0000001 after `far`
        triangle { centroid (0, 0, 0) normal (0, 0, 1) sides (0.1, 0.2, 0.30000000000000004) } -> 0.30000000000000004 is not less than 0.1 + 0.2
        image { width 9e5 + 0.1 } -> and it is 900000.1
        sphere { center (0, 0, 0) color rgb(255.0000001, 0, 0) } -> this is 255.0000001
        camera { eye (0, 2, 8) lookat (0, 1, 0) fov 180.00000001deg + 0deg } -> and it is 180.00000001deg
        sampler { per_pixel 1e300 } -> 1e300 samples in each of
        sphere { center (0, 0, 0) radius 1e-400 } -> and it is 1e-400, which rounds to 0
        camera { eye (0, 2, 8) direction (3, 3, 3) up (1, 1, 1) } -> the top of the picture is towards (-0.5, -0.5, 1) here; write `up (-0.5, -0.5, 1)` to say so yourself
        camera { eye (0, 2, 8) up (1e200, 0, 0) direction (1e200, 0, 0) } -> towards (0, 0, 1) here
        camera { eye (0, 2, 8) direction (0, 0, 0) } -> write, for example, `direction (0, 0, -1)`
        camera { eye (0, 2, 8) lookat S } -> an object is no value: define its place with `let`, and use that in both
        let x = 3 - x -> a `let` cannot use itself: write a value, or the name of an earlier `let`
        let x = length(1, 2, 3) -> write `length((1, 2, 3))`
        let x = rgb((255, 0, 0)) -> write `rgb(255, 0, 0)`
        box { center (0, 0, 0) size (1, 2) } -> write a third number, such as `(1, 2, 2)`
    ") {
        let camera = if items.contains("camera") { "" } else { CAMERA };
        let balls = "sphere S { center (0, 0, 0) } sphere { center (9, 11, 17) }";
        let found = found(&format!("{camera}{items} {balls}"), &[]);
        let [found] = &found[..] else {
            panic!("{items}: {found:?}");
        };
        let help = found.help.as_deref().unwrap_or_default();
        let said = [&found.message, &found.labels[0].message, help];
        assert!(said.iter().any(|words| words.contains(part)), "{found:?}");
    }
}
