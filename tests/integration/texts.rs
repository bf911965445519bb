//! Texts: places in them, edits of them, nearest names, and what a terminal shows.

use pinhole::{
    color::Color,
    diagnostic::{Fix, apply, visible},
    scene::css::{color, names},
    source::{Source, SourceId, Sources, Span},
    suggest::{choice, list, nearest},
};

#[test]
fn places_count_characters_from_one() {
    let source = Source::from_text("a.scn", "\u{feff}aé\r\nb\n");
    let place = |offset| {
        let place = source.place(offset);
        (place.line, place.column)
    };
    assert_eq!(place(0), (1, 1));
    assert_eq!(place(3), (1, 1));
    assert_eq!(place(4), (1, 2));
    assert_eq!(place(6), (1, 3));
    assert_eq!(place(8), (2, 1));
    assert_eq!(place(9), (2, 2));
    assert_eq!(place(10), (3, 1));
    assert_eq!(place(99), (3, 1));
    assert_eq!(source.slice(source.line_range(1)), "\u{feff}aé");
    assert_eq!(source.slice(source.line_range(2)), "b");
    assert_eq!(source.slice(source.line_range(3)), "");
}

#[test]
fn places_in_a_long_line_agree_with_counting() {
    let text = "aé✓".repeat(2000);
    let source = Source::from_text("a.scn", text.as_str());
    for (index, (offset, _)) in text.char_indices().enumerate() {
        assert_eq!(source.place(offset).column, index + 1);
    }
}

#[test]
fn invalid_bytes_keep_their_offsets() {
    let source = Source::from_bytes("a.scn", b"a\xff\xfeb\xc3".to_vec());
    assert_eq!(source.text(), "a__b_");
    assert_eq!(source.invalid_utf8(), [1, 2, 4]);
}

#[test]
fn what_is_alone_on_its_line_goes_with_its_comments() {
    let cases = [
        (
            "a\n  [b 1] // why\nc",
            "a\nc",
            "remove it, with its comment",
        ),
        (
            "a\r\n  [b 1] // why\r\nc",
            "a\r\nc",
            "remove it, with its comment",
        ),
        (
            "\u{feff}[b 1] /* x */ // y",
            "\u{feff}",
            "remove it, with its comment",
        ),
        (
            "a\n  [b 1] /* y\n z */\nc",
            "a\nc",
            "remove it, with its comment",
        ),
        (
            "a\n  // above\n  [b 1]\n  // below\nc",
            "a\n  // above\n  // below\nc",
            "remove it",
        ),
        ("a 1  [b 1] // both\nc", "a 1 // both\nc", "remove it"),
        ("[b 1] /* c */ c 1\nd", "/* c */ c 1\nd", "remove it"),
        ("/* a */ [b 1] // c", "/* a */ // c", "remove it"),
        ("{ [b 1] // c\n}", "{ // c\n}", "remove it"),
    ];
    for (text, expected, title) in cases {
        let (start, end) = (text.find('[').unwrap(), text.find(']').unwrap() - 1);
        let text = text.replace(['[', ']'], "");
        let sources = Sources::new(Source::from_text("a.scn", text.as_str()));
        let span = Span::new(SourceId::File, start, end);
        let fix = Fix::remove_whole("remove it", span, &sources);
        assert_eq!(apply(&fix, SourceId::File, &text), expected);
        assert_eq!(fix.title, title);
    }
}

#[test]
fn what_is_removed_leaves_no_gap() {
    let cases = [
        ("a\n  [b 1]\nc", "a\nc"),
        ("a\n  [b 1]", "a\n"),
        ("\u{feff}[b 1]\r\nc", "\u{feff}c"),
        ("{ a 1  [b 1]  c 1 }", "{ a 1  c 1 }"),
        ("{ [b 1]  c 1 }", "{ c 1 }"),
        ("{ a 1  [b 1] }", "{ a 1 }"),
        ("a 1[;]b 2", "a 1 b 2"),
        ("a [=] 2", "a 2"),
        ("a[=]2", "a 2"),
        ("(1, 2[,])", "(1, 2)"),
        ("  [b 1]  // why\nc", "  // why\nc"),
    ];
    for (text, expected) in cases {
        let (start, end) = (text.find('[').unwrap(), text.find(']').unwrap() - 1);
        let text = text.replace(['[', ']'], "");
        let sources = Sources::new(Source::from_text("a.scn", text.as_str()));
        let span = Span::new(SourceId::File, start, end);
        let fix = Fix::remove("remove it", span, &sources);
        assert_eq!(apply(&fix, SourceId::File, &text), expected);
    }
}

#[test]
fn near_names_only() {
    let fields = ["center", "radius", "color", "d", "up"];
    assert_eq!(nearest("radus", fields), Some("radius"));
    assert_eq!(nearest("colour", fields), Some("color"));
    assert_eq!(nearest("centre", fields), Some("center"));
    assert_eq!(nearest("UP", fields), Some("up"));
    assert_eq!(nearest("D", fields), Some("d"));
    assert_eq!(nearest("x", fields), None);
    assert_eq!(nearest("transparency", fields), None);
    assert_eq!(nearest("", fields), None);
}

#[test]
fn lists() {
    assert_eq!(list(["a"]), "a");
    assert_eq!(list(["a", "b"]), "a and b");
    assert_eq!(choice(["a", "b", "c"]), "a, b or c");
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
    assert_eq!(color("Olive"), Some(Color::from_bytes([128, 128, 0])));
    assert_eq!(color("transparent"), None);
    assert_eq!(color("olivey"), None);
}
