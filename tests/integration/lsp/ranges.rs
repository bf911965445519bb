//! Between which numbers a slider turns the numbers of a text.

use serde_json::{Value, json};

use super::talk::Talk;

/// A slider need not offer what the language forbids.
#[test]
fn a_number_has_the_limits_of_its_field() {
    let text = "camera { eye (0, 0, 5) lookat (0, 0, 0) fov 1rad }\nsampler { per_pixel 16 }\nsphere { center (0, 0, 0) radius 1 }\nbox { center (0, 0, 0) size (1, 2, 3) }\nlet a = 3\nsphere { center (0, 0, 0) radius a + 1 }";
    let mut talk = Talk::with(text);
    let limits = |least: Value, most: Value, open: bool, whole: bool| json!({ "least": least, "most": most, "open": open, "step": whole.then_some(1.0) });
    let pi = std::f64::consts::PI;
    for (before, expected) in [
        ("radius 1", limits(json!(0.0), Value::Null, true, false)),
        ("per_pixel 16", limits(json!(1.0), Value::Null, false, true)),
        ("fov 1", limits(json!(0.0), json!(pi), true, false)),
        ("size (1, 2", limits(json!(0.0), Value::Null, true, false)),
        ("eye (0", limits(Value::Null, Value::Null, false, false)),
        ("let a = 3", Value::Null),
        ("radius a + 1", Value::Null),
    ] {
        let at = text.find(before).expect("it is there") + before.len();
        let lines: Vec<&str> = text[..at].split('\n').collect();
        let character = lines[lines.len() - 1].len();
        let position = json!({ "line": lines.len() - 1, "character": character });
        let found = talk.ask("pinhole/limits", json!({ "position": position }));
        assert_eq!(found, expected, "{before}");
    }
}

/// Definitions have sliders: by the comment behind them, or by the fields that they stand in.
#[test]
fn definitions_have_ranges() {
    let pi = std::f64::consts::PI;
    let no_number = |it: &str| format!("`{it}` in the range is no number");
    // What is written behind `=`; the least, the greatest number and the step; why there are none.
    let cases = [
        ("1 // [0.5:0.1:2] how large", json!([0.5, 2.0, 0.1]), None),
        ("-2 //[-3:3]", json!([-3.0, 3.0, null]), None),
        ("3 // [3:1]", json!([1.0, 3.0, null]), None),
        ("3 // [5:1:0]", json!([0.0, 5.0, 1.0]), None),
        ("3 // [5:-1:0]", json!([0.0, 5.0, 1.0]), None),
        ("3000 // [1_000:1_000:9_000]", json!([1e3, 9e3, 1e3]), None),
        ("30deg // [0deg:5deg:90deg]", json!([0.0, 90.0, 5.0]), None),
        ("30deg // [ 0 : 5 : 90 deg ]", json!([0.0, 90.0, 5.0]), None),
        ("30deg // [90deg:-90deg]", json!([-90.0, 90.0, null]), None),
        ("1rad // [0deg:180deg]", json!([0.0, pi, null]), None),
        (
            "30deg // [0rad:1rad]",
            json!([0.0, 1_f64.to_degrees(), null]),
            None,
        ),
        ("1 // turn", json!([null, null, null]), None),
        ("1 // [see: below]", json!([null, null, null]), None),
        ("1 // [see: -> x]", json!([null, null, null]), None),
        ("1 // [from: ...]", json!([null, null, null]), None),
        ("1 // [1, 2]", json!([null, null, null]), None),
        (
            "1 // [1:x]",
            json!([null, null, null]),
            Some(no_number("x")),
        ),
        ("1 // [1:]", json!([null, null, null]), Some(no_number(""))),
        (
            "1 // [1:1e999]",
            json!([null, null, null]),
            Some(no_number("1e999")),
        ),
        (
            "1 // [1deg:2deg]",
            json!([null, null, null]),
            Some("the range is in deg, and the number has no unit".to_owned()),
        ),
        (
            "1 // [1:1]",
            json!([null, null, null]),
            Some("both ends of the range are the same".to_owned()),
        ),
        (
            "1 // [1:0:2]",
            json!([null, null, null]),
            Some("the step of the range is 0".to_owned()),
        ),
        (
            "1 // [1:2:3:4]",
            json!([null, null, null]),
            Some("a range has two ends, and at most a step between them".to_owned()),
        ),
    ];
    for (written, range, note) in cases {
        let mut talk = Talk::with(&format!("let a = {written}"));
        let found = &talk.ask("pinhole/sliders", json!({}))[0];
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
    let mut talk = Talk::with(text);
    let found = talk.ask("pinhole/sliders", json!({}));
    let found = found.as_array().expect("a list").iter().map(|it| {
        let limits = &it["limits"];
        json!([it["name"], limits["least"], limits["most"], limits["step"]])
    });
    let expected = [
        json!(["c", 0.0, null, null]),
        json!(["n", 1.0, null, 1.0]),
        json!(["m", 1.0, 10.0, 1.0]),
        json!(["t", 0.0, pi, null]),
    ];
    assert_eq!(found.collect::<Vec<_>>(), expected);
}
