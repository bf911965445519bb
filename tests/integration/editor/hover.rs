//! What the word under the cursor means.

use pinhole::{
    editor::{hover, signature},
    explain,
    scene::schema::{BLOCKS, METHODS},
};

use super::{at_cursor, under};

/// The text that the answer is about, and the answer.
fn hovered(text: &str) -> (String, String) {
    at_cursor(text, |analysis, at| match hover(analysis, at) {
        Some(hover) => (under(analysis, hover.span).to_owned(), hover.markdown),
        None => (String::new(), String::new()),
    })
}

fn markdown(text: &str) -> String {
    hovered(text).1
}

#[test]
fn fields_say_what_the_table_says() {
    assert_eq!(
        hovered("sphere { center (0, 1, 0) ra$0dius 2 }"),
        (
            "radius".into(),
            "`radius` of a sphere: its radius\n\n(number, `1` by default); must be more than 0"
                .into()
        )
    );
    assert_eq!(
        markdown("camera { fo$0v 40deg }"),
        "`fov` of a camera: the angle that the window's height takes up, instead of d\n\n(angle); must be more than 0 and less than 180deg; not together with `d` or `hfov`"
    );
    for (text, rule) in [
        ("camera { fa$0r 5 }", "near < far"),
        ("camera { loo$0kat 5 }", "lookat ≠ eye"),
        ("box { mi$0n 5 }", "min < max on every axis"),
        (
            "triangle { sid$0es 5 }",
            "each is shorter than the two others together",
        ),
        (
            "sampler { per_p$0ixel 5 }",
            "per_pixel times the number of pixels is at most 2^53",
        ),
    ] {
        assert!(markdown(text).contains(rule), "{}", markdown(text));
    }
    assert!(!markdown("camera { ro$0ll 5deg }").contains('<'));
    // A number is about its field.
    assert_eq!(hovered("sphere { radius $02 }").0, "2");
    assert_eq!(
        markdown("sampler { method so$0bol }"),
        "`sobol`: Sobol' points with Owen scrambling, per pixel"
    );
    assert_eq!(
        markdown("$0let a = 1"),
        "`let NAME = VALUE` gives a value a name, for what stands further down."
    );
}

#[test]
fn definitions_say_their_value() {
    let about = "`let a = 2 * (1, 2, 3)` (line 1)\n\na vector: `(2, 4, 6)`";
    assert_eq!(
        hovered("let $0a = 2 * (1, 2, 3)"),
        ("a".into(), about.into())
    );
    assert_eq!(
        hovered("let a = 2 * (1, 2, 3)\nsphere { center a$0 }"),
        ("a".into(), about.into())
    );
    assert_eq!(markdown("let a = 2 $0 let b = 1"), "");
    assert_eq!(
        markdown("let $0a = 1 + olive"),
        "`let a = 1 + olive` (line 1)\n\nit has no value: see what is reported there"
    );
}

#[test]
fn expressions_say_what_they_come_to() {
    let text = |place: usize| {
        let mut text = "let a = 30deg let b = 2 * sin(a) + (1 - 0.5)".to_owned();
        text.insert_str(place, "$0");
        text
    };
    let at = |word: &str| text(text(0).find(word).expect("it stands there") - 2);
    assert_eq!(
        hovered(&at("* ")),
        ("2 * sin(a)".into(), "`2 * sin(a)` is a number: `1`".into())
    );
    assert_eq!(
        hovered(&at("+ ")),
        (
            "2 * sin(a) + (1 - 0.5)".into(),
            "`2 * sin(a) + (1 - 0.5)` is a number: `1.5`".into()
        )
    );
    assert_eq!(
        hovered(&at("- 0")),
        ("1 - 0.5".into(), "`1 - 0.5` is a number: `0.5`".into())
    );
    assert_eq!(
        hovered(&at("sin")),
        (
            "sin".into(),
            "`sin(angle) → number`: the sine of an angle\n\nhere a number: `0.5`".into()
        )
    );
    // A number says itself what it is, but not what it is a part of.
    for (text, about) in [
        ("let a = 2$0*3", "`2*3` is a number: `6`"),
        ("let a = 0.1+$00.2", "`0.1+0.2` is a number: `0.3`"),
        ("sphere { center (1, 2*$03, 3) }", "`2*3` is a number: `6`"),
        (
            "let v = $0(1,2,3)*2",
            "`(1,2,3)*2` is a vector: `(2, 4, 6)`",
        ),
        ("let a = max(1, $02)", "`max(1, 2)` is a number: `2`"),
    ] {
        assert_eq!(markdown(text), about, "{text}");
    }
    assert_eq!(markdown("let a = (1, $02, 3)"), "");
    assert_eq!(
        markdown("let a = $090deg"),
        "an angle: `90deg`, `1.5708rad`"
    );
    assert_eq!(
        markdown("let a = p$0i"),
        "`pi`: the number 3.141592653589793"
    );
}

#[test]
fn colors_are_shown_in_every_spelling() {
    assert_eq!(
        markdown("sphere { color ol$0ive }"),
        "`olive` is a colour: `#808000`, `rgb(128, 128, 0)`; in linear light (0.215861, 0.215861, 0)"
    );
    assert_eq!(
        markdown("let a = #f$000"),
        "a colour: `#ff0000`, `rgb(255, 0, 0)`; in linear light (1, 0, 0)"
    );
}

#[test]
fn the_camera_says_what_it_comes_to() {
    let text = "ca$0mera { eye (0, 1, 5) lookat (0, 1, 0) d 1 } sphere { radius oops }";
    let expected = "```text
camera    looks level
  eye     (0, 1, 5)
  u       (1, 0, 0)  the picture's right
  v       (0, 1, 0)  the picture's top
  w       (0, 0, 1)  against the view direction
  d       1, view height 2: a field of view of 90 degrees, 121.284 across
  depth   from 0 to endless

vanishing points, in pixels from the top left corner
  x       none: parallel to the view plane
  y       none: parallel to the view plane
  z       (400, 225)
```";
    assert!(markdown(text).starts_with(expected), "{}", markdown(text));
    assert!(
        markdown(text).contains("- `eye` (vector, required): the point that all rays pass through")
    );
    // A camera that looks nowhere comes to nothing.
    let nowhere = markdown("ca$0mera { eye (0, 1, 0) lookat (0, 1, 0) }");
    assert!(nowhere.starts_with("`camera`: "), "{nowhere}");
}

#[test]
fn objects_say_what_they_are() {
    assert_eq!(
        hovered("sphere Ba$0ll { center (0, 1, 0) }"),
        (
            "Ball".into(),
            "sphere `Ball`: center (0, 1, 0), radius 1, #808000".into()
        )
    );
    assert_eq!(markdown("sphere Ba$0ll { radius 0 }"), "sphere `Ball`");
}

#[test]
fn mistakes_are_explained() {
    let (about, text) = hovered("sphere { center (0, 1, 0) rad$0us 2 }");
    assert_eq!(about, "radus");
    let page = |code| explain::page(code).expect("a page").text.trim_end();
    assert_eq!(text, page("unknown_field"));
    let text = markdown("camera { eye (0, 0, 0) lookat (1, 0, 0) roll $030 }");
    assert!(text.starts_with("`roll` of a camera: "), "{text}");
    let end = format!("\n\n---\n\n{}", page("bare_angle"));
    assert!(text.ends_with(&end), "{text}");
}

#[test]
fn every_rule_between_fields_is_told_of_one_of_them() {
    for row in BLOCKS {
        for rule in row.together {
            let mut fields = row.fields.iter();
            let is_told = fields.any(|field| row.rules_of(field.name).any(|told| told == *rule));
            assert!(is_told, "{rule}");
        }
    }
}

/// The label with the active parameter in `‹›`.
fn called(text: &str) -> Option<String> {
    let found = at_cursor(text, signature)?;
    let mut label = found.label;
    if let Some(parameter) = found.parameters.get(found.active) {
        label.insert(parameter.end, '›');
        label.insert(parameter.start, '‹');
    }
    Some(label)
}

#[test]
fn calls_say_what_they_take() {
    let label = |text| called(text).unwrap_or_default();
    assert_eq!(label("let a = sin($0"), "sin(‹angle›) → number");
    assert_eq!(label("let a = atan2(1, $0)"), "atan2(y, ‹x›) → angle");
    assert_eq!(
        label("sphere { color rgb(1, 2, max(3, $0"),
        "max(number, ‹number›, …) → number"
    );
    assert_eq!(
        label("sphere { color rgb(1, max(3, 4), $0 }"),
        "rgb(red, green, ‹blue›) → colour"
    );
    assert_eq!(
        label("let a = max(1, 2, 3, $0"),
        "max(number, number, ‹…›) → number"
    );
    assert_eq!(label("let a = sin(1deg, $0"), "sin(angle) → number");
    // What the cursor touches belongs to the call, be it a number, an angle or a colour.
    let rgb = "rgb(‹red›, green, blue) → colour";
    assert_eq!(label("let a = rgb(2$0"), rgb);
    assert_eq!(label("let a = rgb(2$0)"), rgb);
    assert_eq!(label("let a = rgb(2$03"), rgb);
    assert_eq!(label("let a = rgb(#f$0"), rgb);
    assert_eq!(
        label("let a = rgb(255, 1$0"),
        "rgb(red, ‹green›, blue) → colour"
    );
    assert_eq!(label("let a = atan2(1, 2$0)"), "atan2(y, ‹x›) → angle");
    assert_eq!(label("let a = sin(30deg$0)"), "sin(‹angle›) → number");
    assert_eq!(
        label("let a = max(1,2,3$0)"),
        "max(number, number, ‹…›) → number"
    );
    assert_eq!(
        label("let a = max((1+2$0), 3)"),
        "max(‹number›, number, …) → number"
    );
    assert_eq!(label("let a = sin(1deg)$0"), "");
    assert_eq!(label("let a = sin(1deg /* $0 */)"), "");
    assert_eq!(label("let a = 12$0"), "");
    assert_eq!(label("let a = (1, $0"), "");
    assert_eq!(label("let a = sin(1deg) $0"), "");
}

#[test]
fn a_method_is_one_of_a_list() {
    let found = at_cursor("sampler { met$0hod sobol }", hover).expect("a hover");
    for (method, help) in METHODS {
        let line = format!("\n- `{}`: {help}", method.name());
        assert!(found.markdown.contains(&line), "{}", found.markdown);
    }
}
