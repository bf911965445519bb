//! Fixes of values: calls, operands, powers, corners.

use super::{of_scene, offered, offers};

/// A message shortens what is long; an edit does not.
#[test]
fn edits_keep_all_that_is_written() {
    let sum = "1 + 2 + 3 + 4 + 5 + 6 + 7 + 8 + 9 + 10 + 11 + 12 + 13 + 14 + 15";
    let text = |roll: &str| {
        format!("checkerboard {{}} camera {{ eye (0, 1, 5)  lookat (0, 1, 0)  roll {roll} }}")
    };
    let fixes = offered(&text(sum));
    assert_eq!(fixes[0].1, text(&format!("({sum}) * 1deg")));
    assert_eq!(fixes[1].1, text(&format!("({sum}) * 1rad")));
}

#[test]
fn a_function_is_called_and_all_else_multiplied() {
    for (written, meant) in [
        ("sin 30deg", "sin(30deg)"),
        ("sqrt 2", "sqrt(2)"),
        ("b 2", "b * 2"),
        ("pi 2", "pi * 2"),
        ("2 b", "2 * b"),
    ] {
        let title = format!("write `{meant}`");
        let text = |value: &str| {
            format!(
                "let b = 2\nlet a = {value}\ncheckerboard {{}} camera {{ eye (0, 1, 5)  lookat (0, 1, 0) }}"
            )
        };
        offers(&text(written), &[(&title, &text(meant))]);
        if written == "sin 30deg" {
            continue;
        }
        let text = |value: &str| {
            format!(
                "let b = 2\ncamera {{ eye (0, 1, 5)  lookat (0, 1, 0)  d {value} }} checkerboard {{}}"
            )
        };
        offers(&text(written), &[(&title, &text(meant))]);
    }
}

#[test]
fn operands_that_do_not_go_together_are_made_to() {
    let of = |value: &str, rest: &str| {
        of_scene(&format!(
            "let v = (0, 1, 2)\nlet w = (1, 2, 3)\n{rest}{value}"
        ))
    };
    let fixed = |rest: &str, before: &str, after: &[&str]| {
        let offered = offered(&of(before, rest));
        let texts: Vec<&str> = offered.iter().map(|(_, text)| text.as_str()).collect();
        let after: Vec<String> = after.iter().map(|after| of(after, rest)).collect();
        assert_eq!(texts, after);
    };
    let value = "let a = ";
    fixed(value, "v + 2", &["v + (2, 2, 2)"]);
    fixed(value, "2 - v", &["(2, 2, 2) - v"]);
    fixed(value, "1 + 2 + v", &["(1 + 2, 1 + 2, 1 + 2) + v"]);
    fixed(value, "v + w - 2 * 3", &["v + w - (2 * 3, 2 * 3, 2 * 3)"]);
    fixed(value, "v * w", &[]);
    fixed(value, "30deg + 2", &["30deg + 2deg", "30deg + 2rad"]);
    fixed(value, "v + // two\n2", &["v + // two\n(2, 2, 2)"]);
    // What is wanted decides.
    fixed("sphere { center v  radius ", "v + 2 }", &[]);
    fixed("let a = ", "red + blue", &[]);
    // No comment is lost.
    fixed("let a = ", "v * /* dot */ w", &[]);
}

#[test]
fn a_third_number_is_offered() {
    let offered = offered(&of_scene("sphere { center (1, 2) }"));
    let texts: Vec<&str> = offered.iter().map(|(_, text)| text.as_str()).collect();
    assert_eq!(texts, [of_scene("sphere { center (1, 2, 2) }")]);
}

#[test]
fn a_corner_lies_on_the_right_side_of_the_other() {
    let camera = "camera { eye (0, 1, 5)  lookat (0, 1, 0) }\n";
    for (given, title, added) in [
        ("max (-5, -5, -5)", "add `min`", "min (-6, -6, -6)"),
        ("min 2 * (1, 0.3, -4)", "add `max`", "max (3, 1.6, -7)"),
        // 1 is lost beside it.
        ("max (1e20, 0, 0)", "add `min`", "min (-1, -1, -1)"),
    ] {
        offers(
            &format!("{camera}box {{ {given} }}"),
            &[(title, &format!("{camera}box {{ {given}  {added} }}"))],
        );
    }
    offers(
        &format!("{camera}box {{ min (1, 2, 3)  max (-1, 0, -1) }}"),
        &[(
            "put the corners in order",
            &format!("{camera}box {{ min (-1, 0, -1)  max (1, 2, 3) }}"),
        )],
    );
    // They would be as wrong the other way round.
    assert!(offered(&format!("{camera}box {{ min (0, 0, 0)  max (1, 0, 1) }}")).is_empty());
}
