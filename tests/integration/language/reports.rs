//! What is said of mistakes.

use pinhole::scene::{self};

use super::{CAMERA, codes, number, sources};

#[test]
fn one_mistake_gives_one_report() {
    for (text, expected) in [
        (
            "let r = nothing sphere { center (0, r, 0) radius r + 1 }",
            "unknown_name",
        ),
        (
            "let r = 1/0 let s = r + red sphere { center (0, 0, 0) radius s }",
            "not_finite",
        ),
        ("sphere { cneter (0, 0, 0) }", "unknown_field"),
        ("cube { center (0, 0, 0) size (1, 1, 1) }", "unknown_kind"),
        ("torus { center (0, 0, 0) }", "unknown_kind"),
        ("sphere { center (0, 0, 0 }", "unclosed_parenthesis"),
        ("sphere { center (0, 0, 0) radius 2 ", "unclosed_block"),
        ("sphere { center (0, 0, 0) color \"red\" }", "quoted"),
        ("sphere { center (0, 0) }", "part_count"),
        ("sphere { center (1 2 3) }", "missing_comma"),
    ] {
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

/// The first diagnostic of a scene: its message, the text and the words of its first label, and its help.
fn first(text: &str) -> [String; 4] {
    let sources = sources(text);
    let found = scene::read(&sources).diagnostics.swap_remove(0);
    let label = &found.labels[0];
    let under = sources.text(label.span).to_owned();
    [
        found.message,
        under,
        label.message.clone(),
        found.help.unwrap_or_default(),
    ]
}

#[test]
fn digits_that_decide_are_shown() {
    let sphere = "sphere { center (0, 0, 0) }";
    let camera = "camera { eye (0, 2, 8) lookat (0, 1, 0)";
    for (text, part) in [
        (
            format!("{camera} near 5.0000001 far 5 }} {sphere}"),
            "write a number above 5.0000001 after `far`",
        ),
        (
            format!(
                "{CAMERA} triangle {{ centroid (0, 0, 0) normal (0, 0, 1) sides (0.1, 0.2, 0.30000000000000004) }}"
            ),
            "0.30000000000000004 is not less than 0.1 + 0.2",
        ),
        (
            format!("{CAMERA} {sphere} image {{ width 9e5 + 0.1 }}"),
            "and it is 900000.1",
        ),
        (
            format!("{CAMERA} sphere {{ center (0, 0, 0) color rgb(255.0000001, 0, 0) }}"),
            "this is 255.0000001",
        ),
        (
            format!("{camera} fov 180.00000001deg + 0deg }} {sphere}"),
            "and it is 180.00000001deg",
        ),
        (
            format!("{CAMERA} {sphere} sampler {{ per_pixel 1e300 }}"),
            "1e300 samples in each of",
        ),
        (
            format!("{CAMERA} sphere {{ center (0, 0, 0) radius 1e-400 }}"),
            "and it is 1e-400, which rounds to 0",
        ),
    ] {
        let found = first(&text);
        assert!(found.iter().any(|words| words.contains(part)), "{found:?}");
        assert_eq!(codes(&text).len(), 1, "{text}");
    }
}

#[test]
fn ways_out_are_true() {
    let camera = |fields: &str| {
        format!(
            "camera {{ eye (0, 2, 8) {fields} }} sphere S {{ center (0, 0, 0) }} sphere {{ center (9, 11, 17) }}"
        )
    };
    for (text, help) in [
        (
            camera("direction (3, 3, 3) up (1, 1, 1)"),
            "the top of the picture is towards (-0.5, -0.5, 1) here; write `up (-0.5, -0.5, 1)` to say so yourself",
        ),
        (
            camera("direction (0, 0, 0)"),
            "write, for example, `direction (0, 0, -1)`",
        ),
        (
            camera("lookat S"),
            "an object is no value: define its place with `let`, and use that in both",
        ),
        (
            format!("{} let x = 3 - x", camera("lookat (0, 0, 0)")),
            "a `let` cannot use itself: write a value, or the name of an earlier `let`",
        ),
        (
            format!("{} let x = length(1, 2, 3)", camera("lookat (0, 0, 0)")),
            "write `length((1, 2, 3))`",
        ),
        (
            format!("{} let x = rgb((255, 0, 0))", camera("lookat (0, 0, 0)")),
            "write `rgb(255, 0, 0)`",
        ),
        (
            format!("{CAMERA} box {{ center (0, 0, 0) size (1, 2) }}"),
            "write a third number, such as `(1, 2, 2)`",
        ),
    ] {
        let found = first(&text);
        assert!(found[3].contains(help), "{found:?}");
        assert_eq!(codes(&text).len(), 1, "{text}");
    }
    let text = format!("{CAMERA} sphere {{ center (0, 0, 0) }} sampler {{ per_pixel 16 total 9 }}");
    assert_eq!(codes(&text), ["conflicting_fields"]);
    let text = camera("up (1e200, 0, 0) direction (1e200, 0, 0)");
    assert!(
        first(&text)[3].contains("towards (0, 0, 1) here"),
        "{:?}",
        first(&text)
    );
    assert_eq!(number("(atan2(sin(180deg), -1) / 1deg)"), 180.0);
}
