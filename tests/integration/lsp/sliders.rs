//! Tests of the limits and ranges that the language server gives for the sliders of numbers.

use serde_json::{Value, json};

use super::local_client::LocalClient;

/// Returns a list of the properties of a slider: the minimum and the maximum that the field allows,
/// the step, and the numbers at the two ends of the slider. Returns null if `found` is null.
fn limits(found: &Value) -> Value {
    match found {
        Value::Null => Value::Null,
        _ => json!([found["least"], found["most"], found["step"], found["ends"]]),
    }
}

/// A slider offers only numbers that the language allows for the number's field.
#[test]
fn a_slider_takes_the_limits_of_its_field() {
    let text = "camera { eye (0, 0, 5) lookat (0, 0, 0) fov 1rad }\nsampler { per_pixel 16 }\nsphere { center (0, 0, 0) radius 1 }\nbox for i < 3 { center (i, 0, -0.25) size (1, 2, 3) }\nlet a = 3\nsphere { center (0, 0, 0) radius a + 1 }\nsphere { radius 8 / 2 }";
    let mut client = LocalClient::with(text);
    for (before, expected) in [
        ("radius 1", json!([0.1, null, 0.1, [0.1, 6.0]])),
        ("per_pixel 16", json!([1.0, null, 1.0, [1.0, 32.0]])),
        ("fov 1", json!([0.1, 3.0, 0.1, [0.1, 3.0]])),
        ("size (1, 2", json!([0.1, null, 0.1, [0.1, 7.0]])),
        ("eye (0", json!([null, null, 0.1, [-5.0, 5.0]])),
        ("(i, 0, -0.25", json!([null, null, 0.01, [-0.75, 0.25]])),
        ("i < 3", json!([0.0, null, 1.0, [0.0, 13.0]])),
        // The limits of the field also apply if the number is a part of a formula.
        ("let a = 3", json!([-0.9, null, 0.1, [-0.9, 8.0]])),
        ("radius a + 1", json!([-2.9, null, 0.1, [-2.9, 6.0]])),
        ("radius 8", json!([0.1, null, 0.1, [0.1, 16.0]])),
        ("8 / 2", json!([0.1, null, 0.1, [0.1, 7.0]])),
        ("radius a", Value::Null),
    ] {
        let at = text.find(before).expect("it is there") + before.len();
        let lines: Vec<&str> = text[..at].split('\n').collect();
        let character = lines[lines.len() - 1].len();
        let position = json!({ "line": lines.len() - 1, "character": character });
        let found = client.ask("pinhole/limits", json!({ "position": position }));
        assert_eq!(limits(&found), expected, "{before}");
    }
}

/// A slider leaves out numbers that cause errors. The slider of a count has the step 1, even if the
/// number is in a definition.
#[test]
fn a_slider_never_reaches_a_value_that_is_an_error() {
    let many = "sphere { center (1, 2, 3) }\n".repeat(3000);
    for (value, rest, expected) in [
        (
            "1",
            "sphere { radius a / 2 }",
            json!([0.1, null, 0.1, [0.1, 6.0]]),
        ),
        (
            "-1",
            "sphere { radius -a / 2 }",
            json!([null, -0.1, 0.1, [-6.0, -0.1]]),
        ),
        (
            "1.25",
            "sphere { radius 2 - a }",
            json!([null, 1.99, 0.01, [0.0, 1.99]]),
        ),
        (
            "(1)",
            "sphere { center (0, sqrt(a), 0) }",
            json!([0.0, null, 0.1, [0.0, 6.0]]),
        ),
        (
            "0.5",
            "sphere { center (0, asin(a) / 1rad, 0) }",
            json!([null, null, 0.01, [0.0, 1.0]]),
        ),
        (
            "40deg",
            "camera { eye (0, 0, 9) lookat (0, 0, 0) fov 2 * a }",
            json!([1.0, 89.0, 1.0, [1.0, 89.0]]),
        ),
        // The number is used as it is in one field, and in a formula in another. The limits of both
        // fields apply.
        (
            "1",
            "sphere { radius a }\nsphere { radius 3 - a }",
            json!([0.1, 2.9, 0.1, [0.1, 2.9]]),
        ),
        // The number is a count of repetitions, which must be whole.
        (
            "4",
            "sphere for i < a { center (i, 0, 0) }",
            json!([0.0, null, 1.0, [0.0, 14.0]]),
        ),
        (
            "4",
            "sphere for i < 2 * a { center (i, 0, 0) }",
            json!([0.0, null, 1.0, [0.0, 14.0]]),
        ),
        (
            "4",
            "sphere for i < a - 2 { center (i, 0, 0) }",
            json!([2.0, null, 1.0, [2.0, 14.0]]),
        ),
        (
            "100",
            "sphere for i < a { center (i, 0, 0) }",
            json!([0.0, null, 1.0, [0.0, 200.0]]),
        ),
        (
            "4",
            "sampler { per_pixel a }",
            json!([1.0, null, 1.0, [1.0, 14.0]]),
        ),
        (
            "4",
            "sampler { per_pixel a * a }",
            json!([1.0, null, 1.0, [1.0, 14.0]]),
        ),
        (
            "4",
            "sampler { seed a }",
            json!([0.0, 9_007_199_254_740_991.0, 1.0, [0.0, 14.0]]),
        ),
        (
            "4 // [0.5:0.5:8.5]",
            "sphere for i < a { center (i, 0, 0) }",
            json!([1.0, 8.0, 1.0, [1.0, 8.0]]),
        ),
        // A number at the end of its valid range has a slider, too.
        (
            "1",
            "sphere { center (0, asin(a) / 1rad, 0) }",
            json!([-1.0, 1.0, 0.1, [-1.0, 1.0]]),
        ),
        // Errors that the text already has do not limit the slider. If all nearby numbers cause
        // errors, the slider has no limits.
        (
            "1",
            "sphere { radios 1 radius a / 2 }",
            json!([0.1, null, 0.1, [0.1, 6.0]]),
        ),
        (
            "4",
            "sphere for i < a / 4 { center (i, 0, 0) }",
            json!([null, null, 0.1, [-1.0, 9.0]]),
        ),
        // To find the limits of a number that is used in a formula, the server reads the text with
        // several values of the number. This would take too long for so long a text, so the slider
        // has no limits.
        (
            "1",
            &format!("{many}sphere {{ radius a / 2 }}"),
            json!([null, null, 0.1, [-4.0, 6.0]]),
        ),
    ] {
        let camera = if rest.contains("camera") {
            ""
        } else {
            "camera { eye (0, 0, 9) lookat (0, 0, 0) }\n"
        };
        let mut client = LocalClient::with(&format!("let a = {value}\n{camera}{rest}\n"));
        let found = &client.ask("pinhole/sliders", json!({}))[0];
        assert_eq!(limits(&found["limits"]), expected, "{value}: {rest:.100}");
    }
}

/// The range of a definition's slider comes from the comment after the definition. Without such a
/// comment, it comes from the fields that use the definition.
#[test]
fn definitions_take_slider_ranges_from_comments_or_fields() {
    let no_number = |it: &str| format!("`{it}` in the range is no number");
    let alone = || Some("a range is for a number or an angle that stands alone".to_owned());
    // Each case has three parts. The first is the text after `let a = `, i.e. a value and a
    // comment. The second is the minimum, the maximum and the step of the slider. The third is the
    // reason why the range in the comment is refused, or `None`.
    let cases = [
        ("1 // [0.5:0.1:2] how large", json!([0.5, 2.0, 0.1]), None),
        ("-2 //[-3:3]", json!([-3.0, 3.0, 0.1]), None),
        ("3 // [3:1]", json!([1.0, 3.0, 0.1]), None),
        ("3 // [5:1:0]", json!([0.0, 5.0, 1.0]), None),
        ("3 // [5:-1:0]", json!([0.0, 5.0, 1.0]), None),
        ("3000 // [1_000:1_000:9_000]", json!([1e3, 9e3, 1e3]), None),
        ("30deg // [0deg:5deg:90deg]", json!([0.0, 90.0, 5.0]), None),
        ("30deg // [ 0 : 5 : 90 deg ]", json!([0.0, 90.0, 5.0]), None),
        ("30deg // [90deg:-90deg]", json!([-90.0, 90.0, 1.0]), None),
        ("1rad // [0deg:180deg]", json!([0.0, 3.1, 0.1]), None),
        ("30deg // [0rad:1rad]", json!([0.0, 57.0, 1.0]), None),
        ("10deg // [0rad:0.1rad:1rad]", json!([0.0, 57.2, 5.7]), None),
        ("1 // [0:0.001:1e6]", json!([0.0, 1e6, 0.001]), None),
        ("1 // [-1e-3:+2.5E2]", json!([-0.001, 250.0, 0.1]), None),
        (
            "1 // [-1e308:1e308]",
            json!([null, null, 0.1]),
            Some("the ends of the range are too far apart".to_owned()),
        ),
        (
            "1 // [0:2:1]",
            json!([null, null, 0.1]),
            Some("the step of the range is longer than the range".to_owned()),
        ),
        ("1 + 2 // [0:3]", json!([null, null, null]), alone()),
        ("(1, 2) // [0:3]", json!([null, null, null]), alone()),
        ("-(1) // [0:3]", json!([null, null, null]), alone()),
        ("red // [0:3]", json!([null, null, null]), alone()),
        ("1 // turn", json!([null, null, 0.1]), None),
        ("1 // [see: below]", json!([null, null, 0.1]), None),
        ("1 // [see: -> x]", json!([null, null, 0.1]), None),
        ("1 // [from: ...]", json!([null, null, 0.1]), None),
        ("1 // [1, 2]", json!([null, null, 0.1]), None),
        ("1 // [1:x]", json!([null, null, 0.1]), Some(no_number("x"))),
        ("1 // [1:]", json!([null, null, 0.1]), Some(no_number(""))),
        (
            "1 // [1:1e999]",
            json!([null, null, 0.1]),
            Some(no_number("1e999")),
        ),
        (
            "1 // [1deg:2deg]",
            json!([null, null, 0.1]),
            Some("the range is in deg, and the number has no unit".to_owned()),
        ),
        (
            "1 // [1:1]",
            json!([null, null, 0.1]),
            Some("both ends of the range are the same".to_owned()),
        ),
        (
            "1 // [1:0:2]",
            json!([null, null, 0.1]),
            Some("the step of the range is 0".to_owned()),
        ),
        (
            "1 // [1:2:3:4]",
            json!([null, null, 0.1]),
            Some("a range has two ends, and at most a step between them".to_owned()),
        ),
    ];
    for (written, range, note) in cases {
        let mut client = LocalClient::with(&format!("let a = {written}"));
        let found = &client.ask("pinhole/sliders", json!({}))[0];
        let limits = &found["limits"];
        let found = json!([
            [limits["least"], limits["most"], limits["step"]],
            found["note"]
        ]);
        assert_eq!(found, json!([range, note]), "{written}");
    }

    let text = "let c = 3 // [3:3]\nlet n = 4\nlet m = 4 // [1:10]\nlet t = 0.5rad // turn\nlet v = (1, 2, 3) // [1:2]\n\
        let e = c + 1 // [1:2]\ncamera { eye (0, 0, 5) lookat (0, 0, 0) fov t }\n\
        sampler { per_pixel n }\nimage { width m }\nsphere { radius c }\nsphere { radius c + 1 }";
    let mut client = LocalClient::with(text);
    let found = client.ask("pinhole/sliders", json!({}));
    let found = found.as_array().expect("a list").iter().map(|it| {
        let limits = &it["limits"];
        json!([it["name"], limits["least"], limits["most"], limits["step"]])
    });
    let expected = [
        json!(["c", 0.1, null, 0.1]),
        json!(["n", 1.0, null, 1.0]),
        json!(["m", 1.0, 10.0, 1.0]),
        json!(["t", 0.01, 3.13, 0.01]),
        json!(["v", null, null, null]),
        json!(["e", null, null, null]),
    ];
    assert_eq!(found.collect::<Vec<_>>(), expected);
}
