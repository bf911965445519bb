//! What the word under the cursor means.

use pinhole::{
    editor::{hover, signature},
    explain,
    schema::{BLOCKS, METHODS},
};

use super::{at_cursor, under};
use crate::table::rows;

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

/// Each row has a text, the part of it that the answer is about, and the answer.
#[test]
fn a_word_says_what_it_is_and_comes_to() {
    let table = r"
        sphere { center (0, 1, 0) ra$0dius 2 } -> radius -> `radius` of a sphere: its radius\n\n(number, `1` by default); must be more than 0
        camera { fo$0v 40deg } -> fov -> `fov` of a camera: the angle that the window's height takes up, instead of d\n\n(angle); must be more than 0 and less than 180deg; not together with `d` or `hfov`
        sampler { method so$0bol } -> sobol -> `sobol`: Sobol' points with Owen scrambling, per pixel
        $0let a = 1 -> let -> `let NAME = VALUE` gives a value a name, for what stands further down.
        let $0a = 2 * (1, 2, 3) -> a -> `let a = 2 * (1, 2, 3)` (line 1)\n\na vector: `(2, 4, 6)`
        let a = 2 * (1, 2, 3)\nsphere { center a$0 } -> a -> `let a = 2 * (1, 2, 3)` (line 1)\n\na vector: `(2, 4, 6)`
        let $0a = 1 + olive -> a -> `let a = 1 + olive` (line 1)\n\nit has no value: see what is reported there
        let a = 2 $0 let b = 1 -> ->

        let a = 30deg let b = 2 $0* sin(a) + (1 - 0.5) -> 2 * sin(a) -> `2 * sin(a)` is a number: `1`
        let a = 30deg let b = 2 * sin(a) $0+ (1 - 0.5) -> 2 * sin(a) + (1 - 0.5) -> `2 * sin(a) + (1 - 0.5)` is a number: `1.5`
        let a = 30deg let b = 2 * sin(a) + (1 $0- 0.5) -> 1 - 0.5 -> `1 - 0.5` is a number: `0.5`
        let a = 30deg let b = 2 * $0sin(a) + (1 - 0.5) -> sin -> `sin(angle) → number`: the sine of an angle\n\nhere a number: `0.5`
        -- A number says itself what it is, but not what it is a part of.
        let a = 2$0*3 -> 2*3 -> `2*3` is a number: `6`
        let a = 0.1+$00.2 -> 0.1+0.2 -> `0.1+0.2` is a number: `0.3`
        sphere { center (1, 2*$03, 3) } -> 2*3 -> `2*3` is a number: `6`
        let v = $0(1,2,3)*2 -> (1,2,3)*2 -> `(1,2,3)*2` is a vector: `(2, 4, 6)`
        let a = max(1, $02) -> max(1, 2) -> `max(1, 2)` is a number: `2`
        let a = (1, $02, 3) -> ->
        let a = $090deg -> 90deg -> an angle: `90deg`, `1.5708rad`
        let a = p$0i -> pi -> `pi`: the number 3.141592653589793

        sphere { color ol$0ive } -> olive -> `olive` is a colour: `#808000`, `rgb(128, 128, 0)`; in linear light (0.215861, 0.215861, 0)
        let a = #f$000 -> #f00 -> a colour: `#ff0000`, `rgb(255, 0, 0)`; in linear light (1, 0, 0)
        sphere Ba$0ll { center (0, 1, 0) } -> Ball -> sphere `Ball`: center (0, 1, 0), radius 1, #808000
        sphere Ba$0ll { radius 0 } -> Ball -> sphere `Ball`
    ";
    for [text, about, markdown] in rows(table) {
        assert_eq!(
            hovered(text),
            (about.to_owned(), markdown.to_owned()),
            "{text}"
        );
    }
    // A number is about its field.
    assert_eq!(hovered("sphere { radius $02 }").0, "2");
    let table = "
        camera { fa$0r 5 } -> near < far
        camera { loo$0kat 5 } -> lookat ≠ eye
        box { mi$0n 5 } -> min < max on every axis
        triangle { sid$0es 5 } -> each is shorter than the two others together
        sampler { per_p$0ixel 5 } -> per_pixel times the number of pixels is at most 2^53
    ";
    for [text, rule] in rows(table) {
        assert!(markdown(text).contains(rule), "{}", markdown(text));
    }
    assert!(!markdown("camera { ro$0ll 5deg }").contains('<'));
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
    let table = "
        let a = sin($0 -> sin(‹angle›) → number
        let a = atan2(1, $0) -> atan2(y, ‹x›) → angle
        sphere { color rgb(1, 2, max(3, $0 -> max(number, ‹number›, …) → number
        sphere { color rgb(1, max(3, 4), $0 } -> rgb(red, green, ‹blue›) → colour
        let a = max(1, 2, 3, $0 -> max(number, number, ‹…›) → number
        let a = sin(1deg, $0 -> sin(angle) → number
        -- What the cursor touches belongs to the call, be it a number, an angle or a colour.
        let a = rgb(2$0 -> rgb(‹red›, green, blue) → colour
        let a = rgb(2$0) -> rgb(‹red›, green, blue) → colour
        let a = rgb(2$03 -> rgb(‹red›, green, blue) → colour
        let a = rgb(#f$0 -> rgb(‹red›, green, blue) → colour
        let a = rgb(255, 1$0 -> rgb(red, ‹green›, blue) → colour
        let a = atan2(1, 2$0) -> atan2(y, ‹x›) → angle
        let a = sin(30deg$0) -> sin(‹angle›) → number
        let a = max(1,2,3$0) -> max(number, number, ‹…›) → number
        let a = max((1+2$0), 3) -> max(‹number›, number, …) → number
        let a = sin(1deg)$0 ->
        let a = sin(1deg /* $0 */) ->
        let a = 12$0 ->
        let a = (1, $0 ->
        let a = sin(1deg) $0 ->
    ";
    for [text, label] in rows(table) {
        assert_eq!(called(text).unwrap_or_default(), label, "{text}");
    }
}

#[test]
fn a_method_is_one_of_a_list() {
    let found = at_cursor("sampler { met$0hod sobol }", hover).expect("a hover");
    for (method, help) in METHODS {
        let line = format!("\n- `{}`: {help}", method.name());
        assert!(found.markdown.contains(&line), "{}", found.markdown);
    }
}
