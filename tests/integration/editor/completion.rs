//! What is offered while one types.

use pinhole::{
    color::Color,
    editor::{Analysis, Completion, CompletionKind, Piece, completions},
    schema::{BLOCKS, Preset},
};

use super::{at_cursor, cursor, of_whole};
use crate::table::rows;

fn complete(text: &str) -> Vec<Completion> {
    at_cursor(text, completions)
}

fn labels(text: &str) -> String {
    let labels: Vec<String> = complete(text).into_iter().map(|c| c.label).collect();
    labels.join(" ")
}

/// What one of them puts in, with `‹›` around what is typed over, in the text.
fn done(text: &str, label: &str) -> String {
    let (sources, at) = cursor(text);
    let all = completions(&Analysis::new(&sources), at);
    let found = all
        .iter()
        .find(|c| c.label == label)
        .expect("it is offered");
    let insert = found.insert.iter().map(|piece| match piece {
        Piece::Text(text) => text.clone(),
        Piece::Hole(value) => format!("‹{value}›"),
    });
    let insert: String = insert.collect();
    let text = sources.file.text();
    format!(
        "{}{insert}{}",
        &text[..found.replaces.start],
        &text[found.replaces.end..]
    )
}

/// One of those that are offered.
fn offered(text: &str, label: &str) -> Completion {
    let found = complete(text).into_iter().find(|c| c.label == label);
    found.unwrap_or_else(|| panic!("{label} is not offered in {text}"))
}

#[test]
fn words_are_offered_where_they_can_stand() {
    let table = r"
        $0 -> camera box checkerboard image sampler sphere triangle let
        camera {} im$0 -> box checkerboard image sampler sphere triangle let
        let a = 1\n$0\nsphere {} -> camera box checkerboard image sampler sphere triangle let
        sphere { center (0, 1, 0) }\nima$0\ncamera { eye (0, 0, 0) } -> box checkerboard image sampler sphere triangle let
        -- No field that is given, or that another one excludes.
        sphere { $0 } -> center color radius
        sphere { $0 center (0, 1, 0) } -> color radius
        sphere { center (0, 1, 0) ra$0 color olive } -> radius
        box { center (0, 0, 0) $0 } -> color size
        box { $0 } -> center max min color size
        -- Corners, which are called like functions.
        box {\n  $0\n  min (0, 0, 0)\n  max (1, 1, 1)\n} -> color
        camera { eye (0, 0, 0) fov 40deg $0 } -> direction lookat far near roll up view_height
        -- In broken texts, too.
        sphere { center (0, 1, 0) $0 -> color radius
        sphere {\n  rad$0\nbox { center (0, 0, 0) } -> center color radius
        sphere { radius = 2 $0 } box { -> center color
        sampler { method $0 -> exact halton hammersley jittered multi_jittered n_rooks random regular scatter sobol
        spere { $0 } -> center color radius
        -- A pair of colours is no single colour.
        let sky = #123456 let pair = (red, white) let n = 1 checkerboard { colors $0 } -> (gray, white) pair
        let sky = #123456 let pair = (red, white) let n = 1 checkerboard { colors p$0 } -> pair
        -- Nothing where a new name stands, or no word.
        // a $0 ->
        /* $0 */ ->
        let $0 ->
        let a$0 ->
        sphere B$0 { ->
        sphere { radius 12$0 } ->
        sphere { color #ff$0 } ->
    ";
    for [text, expected] in rows(table) {
        assert_eq!(labels(text), expected, "{text}");
    }
}

#[test]
fn what_is_put_in_fits_what_is_there() {
    let table = r"
        cam$0 -> camera -> camera {\n  eye    (‹0›, ‹2›, ‹8›)\n  lookat (‹0›, ‹1›, ‹0›)\n}
        $0 -> sphere -> sphere { center (‹0›, ‹1›, ‹0›) }
        $0 -> image -> image { ‹› }
        $0 -> let -> let ‹name› = ‹1›
        -- What is there already stays.
        sp$0 { center (0, 0, 0) } -> sphere -> sphere { center (0, 0, 0) }
        sp$0 Ball { center (0, 0, 0) } -> sphere -> sphere Ball { center (0, 0, 0) }
        -- A field comes with a value that it can have.
        sphere { $0 } -> radius -> sphere { radius ‹1› }
        sphere { rad$0 2 } -> radius -> sphere { radius 2 }
        box { min (0, 0, 0) $0 } -> max -> box { min (0, 0, 0) max (‹1›, ‹1›, ‹1›) }
        checkerboard { $0 } -> colors -> checkerboard { colors (‹gray›, ‹white›) }
        box { min (5, 5, 5) $0 } -> max -> box { min (5, 5, 5) max (‹6›, ‹6›, ‹6›) }
        let a = (5, 5, 5) box { $0 max a } -> min -> let a = (5, 5, 5) box { min (‹-1›, ‹0›, ‹-1›) max a }
        box { min (5, 5, 5) max $0 } -> (6, 6, 6) -> box { min (5, 5, 5) max (‹6›, ‹6›, ‹6›) }
        camera { near 500 $0 } -> far -> camera { near 500 far ‹1000› }
        camera {\n  near 500\n  $0 -> far -> camera {\n  near 500\n  far ‹1000›
        camera { near 5 $0 } -> far -> camera { near 5 far ‹100› }
        camera { eye (0, 1, 0) $0 } -> lookat -> camera { eye (0, 1, 0) lookat (‹0›, ‹1›, ‹-1›) }
        -- Not straight down, either, nor along an `up` of its own.
        camera { eye (0, 5, 0) $0 } -> lookat -> camera { eye (0, 5, 0) lookat (‹0›, ‹5›, ‹-1›) }
        camera { lookat (0, 2, 8) $0 } -> eye -> camera { lookat (0, 2, 8) eye (‹0›, ‹2›, ‹9›) }
        camera { up (0, 0, 1) $0 } -> direction -> camera { up (0, 0, 1) direction (‹1›, ‹0›, ‹0›) }
        camera { eye (0, 5, 0) lookat (0, 0, 0) $0 } -> up -> camera { eye (0, 5, 0) lookat (0, 0, 0) up (‹0›, ‹0›, ‹-1›) }
        -- A function comes with its arguments, unless they are there.
        let a = 2 * $0 -> cross -> let a = 2 * cross(‹(1, 0, 0)›, ‹(0, 1, 0)›)
        let a = si$0(30deg) -> sin -> let a = sin(30deg)
    ";
    for [text, label, expected] in rows(table) {
        assert_eq!(done(text, label), expected, "{text}");
    }
    let radius = offered("sphere { $0 }", "radius");
    assert_eq!(radius.kind, CompletionKind::Field);
    assert_eq!(radius.detail, "number, 1 by default");
    assert_eq!(
        radius.help,
        "`radius` of a sphere: its radius\n\n(number, `1` by default); must be more than 0"
    );
}

#[test]
fn values_fit_their_field() {
    let lets = "let sky = #123456 let place = (1, 2, 3) let size = 2 ";
    let table = "
        sphere { center p$0 } -> place size cross normalize
        sphere { radius s$0 } -> size place abs
        sphere { color s$0 } -> sky aliceblue
        camera { roll s$0 } -> place size acos
        checkerboard { colors (s$0 } -> sky aliceblue
        sphere { center (0, 1, s$0 -> size place abs
        camera { roll atan2(1, s$0 -> size place
    ";
    for [text, expected] in rows(table) {
        let found = labels(&format!("{lets}{text}"));
        assert!(
            format!("{found} ").starts_with(&format!("{expected} ")),
            "{text}: {found}"
        );
    }
    let sky = offered(&format!("{lets}sphere {{ color s$0 }}"), "sky");
    assert_eq!(sky.detail, "#123456");
    let teal = offered("sphere { color t$0 }", "teal");
    for (word, bytes) in [(sky, [0x12, 0x34, 0x56]), (teal, [0, 128, 128])] {
        let color = Color::from_bytes(bytes);
        assert_eq!(word.kind, CompletionKind::Color(color));
    }
    assert_eq!(offered("let a = $0", "atan2").detail, "atan2(y, x) → angle");
}

#[test]
fn only_names_that_are_defined_before_are_offered() {
    let text = "let a = 1 let b = $0 let c = 3";
    let labels = labels(text);
    let words: Vec<&str> = labels.split(' ').collect();
    assert!(words.contains(&"a") && !words.contains(&"b") && !words.contains(&"c"));
}

#[test]
fn a_whole_value_is_offered_only_where_one_starts() {
    let first = |text: &str| complete(text).swap_remove(0).label;
    assert_eq!(first("sphere { radius $0 }"), "1");
    for text in [
        "sphere { radius 1 + $0 }",
        "let f = 2 camera { fov f * $0 }",
        "sphere { radius -$0 }",
    ] {
        let offered = complete(text);
        assert!(!offered.is_empty());
        assert!(
            offered.iter().all(|c| c.kind != CompletionKind::Value),
            "{text}"
        );
    }
}

#[test]
fn no_function_is_offered_with_a_value_that_is_an_error() {
    for block in [
        "sphere { center (0, 1, 0) radius $0 }",
        "checkerboard { square $0 }",
    ] {
        let functions = complete(block).into_iter();
        let functions = functions.filter(|c| c.kind == CompletionKind::Function && c.rank <= 3);
        for function in functions {
            let text = done(block, &function.label).replace(['‹', '›'], "");
            let text = format!("camera {{ eye (0, 1, 5) lookat (0, 1, 0) }} {text}");
            let found = of_whole(&text, |analysis| analysis.diagnostics().len());
            assert_eq!(found, 0, "{text}");
        }
    }
}

#[test]
fn only_a_default_is_called_one() {
    let mut defaults = 0;
    for (row, field) in BLOCKS
        .iter()
        .flat_map(|row| row.fields.iter().map(move |field| (row, field)))
    {
        let offered = complete(&format!("{} {{ {} $0 }}", row.name, field.name));
        for value in offered.iter().filter(|c| c.kind == CompletionKind::Value) {
            let is_preset = matches!(field.preset, Preset::Value(preset) if preset == value.label);
            assert_eq!(value.detail == "the default", is_preset, "{}", field.name);
            defaults += usize::from(is_preset);
        }
    }
    assert!(defaults > 10, "{defaults}");
    assert_eq!(offered("camera { roll $0 }", "30deg").detail, "angle");
}
