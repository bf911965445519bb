//! Texts: places in them, edits of them, nearest names, and what a terminal shows.

use pinhole::{
    diagnostic::{Fix, apply, visible},
    schema::css::{color, names},
    source::{Source, SourceId, Sources, Span},
    suggest::nearest,
};

use crate::table::rows;

#[test]
fn places_count_characters_from_one() {
    let source = Source::from_text("a.scn", "\u{feff}aé\r\nb\n");
    let places = [0, 3, 4, 6, 8, 9, 10, 99].map(|offset| {
        let place = source.place(offset);
        format!("{}:{}", place.line, place.column)
    });
    assert_eq!(places.join(" "), "1:1 1:1 1:2 1:3 2:1 2:2 3:1 3:1");
    let lines = [1, 2, 3].map(|line| source.slice(source.line_range(line)));
    assert_eq!(lines, ["\u{feff}aé", "b", ""]);
    let text = "aé✓".repeat(2000);
    let source = Source::from_text("a.scn", text.as_str());
    for (index, (offset, _)) in text.char_indices().enumerate() {
        assert_eq!(source.place(offset).column, index + 1);
    }
    let source = Source::from_bytes("a.scn", b"a\xff\xfeb\xc3".to_vec());
    assert_eq!(source.text(), "a__b_");
    assert_eq!(source.invalid_utf8(), [1, 2, 4]);
}

/// The text without what stands in brackets, which is what is removed.
fn without(text: &str, remove: impl Fn(Span, &Sources) -> Fix) -> (String, String) {
    let (start, end) = (text.find('[').unwrap(), text.find(']').unwrap() - 1);
    let text = text.replace(['[', ']'], "");
    let sources = Sources::new(Source::from_text("a.scn", text.as_str()));
    let fix = remove(Span::new(SourceId::File, start, end), &sources);
    (apply(&fix, SourceId::File, &text), fix.title)
}

#[test]
fn what_is_alone_on_its_line_goes_with_its_comments() {
    let table = r"
        a\n  [b 1] // why\nc -> a\nc -> , with its comment
        a\r\n  [b 1] // why\r\nc -> a\r\nc -> , with its comment
        [b 1] /* x */ // y -> -> , with its comment
        a\n  [b 1] /* y\n z */\nc -> a\nc -> , with its comment
        a\n  // above\n  [b 1]\n  // below\nc -> a\n  // above\n  // below\nc ->
        a 1  [b 1] // both\nc -> a 1 // both\nc ->
        [b 1] /* c */ c 1\nd -> /* c */ c 1\nd ->
        /* a */ [b 1] // c -> /* a */ // c ->
        { [b 1] // c\n} -> { // c\n} ->
    ";
    for [text, expected, with] in rows(table) {
        let remove = |span, sources: &_| Fix::remove_whole("remove it", span, sources);
        let expected = (expected.to_owned(), format!("remove it{with}"));
        assert_eq!(without(text, remove), expected, "{text}");
    }
}

#[test]
fn what_is_removed_leaves_no_gap() {
    let table = r"
        a\n  [b 1]\nc -> a\nc
        a\n  [b 1] -> a\n
        { a 1  [b 1]  c 1 } -> { a 1  c 1 }
        { [b 1]  c 1 } -> { c 1 }
        { a 1  [b 1] } -> { a 1 }
        a 1[;]b 2 -> a 1 b 2
        a [=] 2 -> a 2
        a[=]2 -> a 2
        (1, 2[,]) -> (1, 2)
        \n  [b 1]  // why\nc -> \n  // why\nc
    ";
    let remove = |span, sources: &_| Fix::remove("remove it", span, sources);
    for [text, expected] in rows(table) {
        assert_eq!(without(text, remove).0, expected, "{text}");
    }
    let after_mark = without("\u{feff}[b 1]\r\nc", remove);
    assert_eq!(after_mark.0, "\u{feff}c");
}

#[test]
fn near_names_only() {
    let fields = ["center", "radius", "color", "d", "up"];
    let table = "
        radus -> radius
        colour -> color
        centre -> center
        UP -> up
        D -> d
        x ->
        transparency ->
    ";
    for [written, near] in rows(table) {
        let found = nearest(written, fields).unwrap_or_default();
        assert_eq!(found, near, "{written}");
    }
    assert_eq!(nearest("", fields), None);
}

#[test]
fn what_acts_on_a_terminal_is_shown_as_its_code() {
    for (text, shown) in [
        ("a\tb\n", "a\tb\n"),
        ("\x1b]0;x\x07", "\\u{1b}]0;x\\u{7}"),
        ("\u{9b}31m\u{7f}\r", "\\u{9b}31m\\u{7f}\\u{d}"),
        (
            "red \u{202e}der\u{202c} \u{2067}",
            "red \\u{202e}der\\u{202c} \\u{2067}",
        ),
        ("é 🎱 e\u{301} \u{200d}", "é 🎱 e\u{301} \u{200d}"),
    ] {
        assert_eq!(visible(text), shown);
    }
}

#[test]
fn names_are_found_in_any_case() {
    assert_eq!(names().count(), 148);
    assert!(names().is_sorted());
    for name in names() {
        assert_eq!(name, name.to_lowercase());
        assert!(color(name).is_some() && color(&name.to_uppercase()) == color(name));
    }
}
