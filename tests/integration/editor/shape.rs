//! Answers about a whole text: its outline, its folds, its colours, and its remarks.

use std::time::{Duration, Instant};

use pinhole::{
    color::Color,
    diagnostic::{Edit, apply},
    editor::{FoldKind, Symbol, fixes, folds, formatting, hints, presentations, swatches, symbols},
    source::{SourceId, Span},
};

use super::{at_cursor, of_whole, under};
use crate::table::{lines, list, rows};

#[test]
fn the_outline_has_definitions_blocks_and_fields() {
    let text =
        "let a = 1\ncamera {\n  eye a\n}\nsphere Ball { center (0, 1, 0) radius 2 * a }\nbox {";
    let shown = |symbol: &Symbol| format!("{:?} {} {}", symbol.kind, symbol.name, symbol.detail);
    of_whole(text, |analysis| {
        let mut outline = Vec::new();
        for symbol in symbols(analysis) {
            let children = symbol.children.iter();
            outline.push(shown(&symbol));
            outline.extend(children.map(|child| format!("  {}", shown(child))));
        }
        let expected = [
            "Definition a 1",
            "Setting camera ",
            "  Field eye a",
            "Object Ball sphere",
            "  Field center (0, 1, 0)",
            "  Field radius 2 * a",
            "Object box ",
        ];
        assert_eq!(outline, expected);
    })
}

#[test]
fn blocks_and_runs_of_comments_fold() {
    let text = "// a\n// b\n\n// c\nsphere { // x\n  // y\n  // z\n}\nbox {} // d\n// e\n// f\n/* g\n */\nlet a /* h\n */ = 1\n";
    of_whole(text, |analysis| {
        let folds: Vec<(FoldKind, &str)> = folds(analysis)
            .into_iter()
            .map(|fold| (fold.kind, under(analysis, fold.span)))
            .collect();
        let expected = [
            (FoldKind::Comment, "// a\n// b"),
            (FoldKind::Block, "sphere { // x\n  // y\n  // z\n}"),
            (FoldKind::Comment, "// y\n  // z"),
            (FoldKind::Comment, "// e\n// f\n/* g\n */"),
            (FoldKind::Comment, "/* h\n */"),
        ];
        assert_eq!(folds, expected);
    })
}

#[test]
fn colors_are_found_wherever_they_are_written_out() {
    let text = "let olivey = Olive let c = rgb(1, 5, 4) image { background #fA0 } sampler { method tan } checkerboard { colors (c, #123456) } sphere { color olivey }";
    of_whole(text, |analysis| {
        let found = swatches(analysis).into_iter();
        let found = found.map(|s| format!("{} {}", under(analysis, s.span), s.color));
        let expected = [
            "Olive #808000",
            "rgb(1, 5, 4) #010504",
            "#fA0 #ffaa00",
            "#123456 #123456",
        ];
        assert!(found.eq(expected));
    })
}

#[test]
fn a_color_that_is_more_than_numbers_has_no_picker() {
    for text in [
        "rgb(1, /*c*/ 2, 3)",
        "rgb(1.5, 2 + 1, min(3, 4))",
        "rgb(a, 2, 3)",
        "rgb((1), 2, 3)",
        "rgb(1, 2, 3 // blue\n)",
    ] {
        of_whole(&format!("let a = 1 let c = {text} // c"), |analysis| {
            assert_eq!(swatches(analysis), [], "{text}");
            let start = analysis.text().find("rgb").unwrap();
            let span = Span::new(SourceId::File, start, start + text.len());
            let found = presentations(analysis, span, Color::from_bytes([1, 2, 3]));
            assert!(found.is_empty(), "{found:?}");
        });
    }
    of_whole("let c = /* a */ rgb(1.5, 2, 3) // b", |analysis| {
        assert_eq!(swatches(analysis).len(), 1);
    });
}

#[test]
fn colors_are_written_back_in_their_spelling() {
    let table = "
        olive -> 008080 -> teal | #008080 | rgb(0, 128, 128)
        olive -> 010203 -> #010203 | rgb(1, 2, 3)
        #fa0 -> 1122cc -> #1122cc | rgb(17, 34, 204)
        #ffaa00 -> ffffff -> #ffffff | white | rgb(255, 255, 255)
        rgb(1, 2, 3) -> ffa500 -> rgb(255, 165, 0) | orange | #ffa500
    ";
    for [text, other, expected] in rows(table) {
        let [.., red, green, blue] = u32::from_str_radix(other, 16).unwrap().to_be_bytes();
        of_whole(&format!("let a = {text}"), |analysis| {
            let span = swatches(analysis)[0].span;
            let found = presentations(analysis, span, Color::from_bytes([red, green, blue]));
            assert_eq!(found.join(" | "), expected, "{text}");
        });
    }
}

/// The text with its remarks in `‹›`.
fn remarked(text: &str) -> String {
    of_whole(text, |analysis| {
        let mut text = analysis.text().to_owned();
        for hint in hints(analysis, 0..text.len()).into_iter().rev() {
            text.insert_str(hint.at, &format!("‹{}›", hint.text));
        }
        text
    })
}

#[test]
fn remarks_say_what_the_text_does_not() {
    for text in list("
        let a = 2 let b = a * 2‹= 4› sphere { center (0, a + b, 0)‹= (0, 6, 0)› radius -a‹= -2› color olive }
        let c = rgb(1, 2, 3) let d = rgb(1, 1 + 1, 3)‹= #010203›
        camera { eye (0, 1, 5) lookat (0, 1, 0) d 1‹fov 90deg› }
        camera { eye (0, 1, 5) lookat (0, 1, 0) fov 2 * 45deg‹= 90deg, d 1› }
        sampler { per_pixel 16‹5_760_000 in all› }
        sampler { total 720_000‹2 per pixel› }
        sampler { method exact per_pixel 16 }
        -- The word of a method is no name of the text.
        let random = 3 sampler { method random }
        -- Nothing is said of a value that another one stands against, or that the scene does not have.
        camera { eye (0, 1, 5) lookat (0, 1, 0) d 2 fov 30deg }
        camera { eye (0, 1, 5) lookat (0, 1, 0) d 2 d 3 }
        camera { eye (0, 1, 5) lookat (0, 1, 0) } camera { eye (0, 1, 5) lookat (0, 1, 0) d 7 }
        sampler { total 100 per_pixel 3 }
    ") {
        let parts = text.split('‹').map(|part| part.split_once('›').map_or(part, |(_, rest)| rest));
        assert_eq!(remarked(&parts.collect::<String>()), text);
    }
}

#[test]
fn the_layout_is_one_change_of_what_differs() {
    for (text, expected) in [
        ("let a = 1\nlet b = 2\n", Some(None)),
        (
            "let a  =  1+1\nlet b = 2",
            Some(Some((6, 23, "= 1 + 1\nlet b = 2\n"))),
        ),
        ("let a = ", None),
    ] {
        let found = of_whole(text, formatting);
        let shown = |edit: &Edit| (edit.span.start, edit.span.end, edit.text.clone());
        let found = found.map(|changes| changes.iter().map(shown).collect::<Vec<_>>());
        let expected =
            expected.map(|change| change.map(|(start, end, text)| (start, end, text.to_owned())));
        assert_eq!(
            found,
            expected.map(|change| change.into_iter().collect()),
            "{text}"
        );
    }
}

#[test]
fn fixes_are_offered_where_the_problem_is() {
    for row in lines("
        sphere { center (0, 1, 0) rad$0us 2 } -> unknown_field: sphere { center (0, 1, 0) radius 2 }
        camera { eye (0, 0, 0) lookat (1, 0, 0) roll 3$00 } -> bare_angle: camera { eye (0, 0, 0) lookat (1, 0, 0) roll 30deg } -> bare_angle: camera { eye (0, 0, 0) lookat (1, 0, 0) roll 30rad }
        sphere { $0center (0, 1, 0) radus 2 }
    ") {
        let found = at_cursor(row[0], |analysis, at| {
            let found = fixes(analysis, Span::new(SourceId::File, at, at));
            let shown = found.map(|(diagnostic, fix)| {
                let text = apply(fix, SourceId::File, analysis.text());
                format!("{}: {text}", diagnostic.code.replace("pinhole::", ""))
            });
            shown.collect::<Vec<_>>()
        });
        assert_eq!(found, row[1..], "{}", row[0]);
    }
}

/// One walk takes some hundredths of a second; one for each term took half a minute.
#[test]
fn a_long_line_is_laid_out_in_one_walk() {
    let text = format!("let b = {}1\n", "1+".repeat(100_000));
    let start = Instant::now();
    let changes = of_whole(&text, |analysis| formatting(analysis).map(|all| all.len()));
    assert_eq!(changes, Some(1));
    assert!(start.elapsed() < Duration::from_secs(5));
}
