//! Tests of positions in texts, of texts as a terminal shows them, and of names of colours.

use pinhole::{
    diagnostic::visible,
    schema::css::{color, names},
    source::Source,
};

#[test]
fn line_and_column_count_characters_from_one() {
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

#[test]
fn control_and_direction_characters_are_shown_as_escapes() {
    for (text, shown) in [
        ("a\tb\n", "a\tb\n"),
        ("\x1b]0;x\x07", "\\u{1b}]0;x\\u{7}"),
        ("\u{9b}31m\u{7f}\r", "\\u{9b}31m\\u{7f}\\u{d}"),
        (
            "red \u{202e}der\u{202c} \u{2067}",
            "red \\u{202e}der\\u{202c} \\u{2067}",
        ),
        ("é 🎱 e\u{301} \u{200d}", "é 🎱 e\u{301} \\u{200d}"),
    ] {
        assert_eq!(visible(text), shown);
    }
}

#[test]
fn css_colour_names_are_found_in_any_case() {
    assert_eq!(names().count(), 148);
    assert!(names().is_sorted());
    for name in names() {
        assert_eq!(name, name.to_lowercase());
        assert!(color(name).is_some() && color(&name.to_uppercase()) == color(name));
    }
}
