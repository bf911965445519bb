//! The canonical layout: what it looks like, as `tests/format` says, and what holds of every text.
//!
//! Beside each `NAME.scn` of `tests/format` stands `NAME.formatted.scn`.

pub mod any;
mod laws;

use std::{fs, path::Path, time::Instant};

use pinhole::{format::format, source::Source};

use self::laws::the_laws_hold;
use crate::{scenes::scenes, snapshot::assert_file, table::rows};

/// The canonical layout, or the codes of the mistakes, of which there is an error.
pub fn formatted(text: &str) -> Result<String, Vec<String>> {
    format(&Source::from_text("a.scn", text)).map_err(|mistakes| {
        assert!(mistakes.iter().any(|d| d.is_error()), "{text}");
        mistakes.into_iter().map(|d| d.code).collect()
    })
}

/// The texts of all scenes below the folders of the examples and the tests, right or wrong.
pub fn all_scenes() -> Vec<String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let (mut texts, mut folders) = (Vec::new(), vec![root.join("examples"), root.join("tests")]);
    while let Some(folder) = folders.pop() {
        texts.extend(scenes(&folder).into_iter().map(fs::read_to_string));
        let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap());
        folders.extend(
            entries
                .map(|entry| entry.path())
                .filter(|path| path.is_dir()),
        );
    }
    texts.into_iter().flatten().collect()
}

#[test]
fn the_layout_is_as_it_stands_beside() {
    for path in scenes("tests/format") {
        if path.file_stem().unwrap().to_string_lossy().contains('.') {
            continue;
        }
        let formatted = formatted(&fs::read_to_string(&path).unwrap()).unwrap();
        assert_file(&path.with_extension("formatted.scn"), &formatted);
    }
}

#[test]
fn mistakes_of_syntax_are_told_and_no_others() {
    let codes = |codes: &[&str]| Err(codes.iter().map(|c| format!("pinhole::{c}")).collect());
    assert_eq!(
        formatted("let a = 1; sphere { radus b }"),
        codes(&["needless_separator"])
    );
    assert_eq!(
        formatted("sphere { center (1, 2, 3) radius }"),
        codes(&["missing_value"])
    );
    // Where the field is no field, that is mistake enough.
    assert_eq!(formatted("sphere { radus }"), codes(&["unknown_field"]));
    assert_eq!(formatted("ball { radius }"), codes(&["missing_value"]));
    // Not so with a value that could not be read.
    let table = "
        (2 -> unclosed_parenthesis
        2) -> stray_closing
        2.5.5 -> bad_number
        #ff -> bad_color_code
        , color red -> needless_separator
        ) -> unexpected
    ";
    for [value, code] in rows(table) {
        let text = format!("sphere {{ center (0, 1, 0)  radus {value} }}");
        assert_eq!(formatted(&text), codes(&[code]), "{text}");
    }
    assert_eq!(
        formatted("sphere { center (1"),
        codes(&["unclosed_block", "unclosed_parenthesis"])
    );
    assert_eq!(
        formatted("let a=1\rlet b=2\r").unwrap(),
        "let a = 1\nlet b = 2\n"
    );
    let source = Source::from_bytes("a.scn", b"// \xff\nsphere { }".to_vec());
    let mistakes = format(&source).unwrap_err();
    assert_eq!(mistakes[0].code, "pinhole::invalid_utf8");
    // What the names mean does not matter.
    let text = "ball { radus 1 / 0  radus b }\n";
    assert_eq!(formatted(text).as_deref(), Ok(text));
}

#[test]
fn little_texts() {
    let cases = [
        ("", ""),
        ("\n \t\r\n", ""),
        ("\u{feff}", "\u{feff}"),
        ("\u{feff}\n\nlet a=1", "\u{feff}let a = 1\n"),
        (
            "// only  \n\n\n\n/* comments */\n",
            "// only\n\n/* comments */\n",
        ),
        ("let a=1\r\nlet b=2\r\n", "let a = 1\r\nlet b = 2\r\n"),
        ("let a=1\r\nlet b=2", "let a = 1\r\nlet b = 2\r\n"),
        ("let a=1\r\nlet b=2\n", "let a = 1\nlet b = 2\n"),
        ("/* a \r\n b */let a=1\r\n", "/* a\r\n b */ let a = 1\r\n"),
        ("let a=2/ /* two */3", "let a = 2 / /* two */ 3\n"),
        ("let a=2/ // two\n3", "let a = 2 /  // two\n  3\n"),
        ("let a=-// minus\n3", "let a = -  // minus\n  3\n"),
        (
            "let a=max(// c\n1,2/* d */)",
            "let a = max(  // c\n  1, 2 /* d */)\n",
        ),
        ("let a=f(\n/* c */\n)", "let a = f(\n  /* c */)\n"),
        ("let a=(1,/* c */\n2,3)", "let a = (1, /* c */ 2, 3)\n"),
        ("let a=(1 // c\n)", "let a = (1  // c\n  )\n"),
        ("box A{min a max(b)}", "box A { min a  max (b) }\n"),
    ];
    for (text, expected) in cases {
        assert_eq!(formatted(text).as_deref(), Ok(expected), "{text:?}");
        the_laws_hold(text, expected);
    }
}

#[test]
fn deep_and_long_values_are_laid_out() {
    let deep = format!("let a = {}1{}\n", "(".repeat(256), ")".repeat(256));
    assert_eq!(formatted(&deep).as_ref(), Ok(&deep));
    let signs = format!("let a = {}(2 - {}1)\n", "-".repeat(100), "-".repeat(100));
    the_laws_hold(&signs, &formatted(&signs).unwrap());
    let calls = format!("let a={}1{}", "max(1,".repeat(200), ")".repeat(200));
    the_laws_hold(&calls, &formatted(&calls).unwrap());
    let sum = format!("let a = 1{}", "+ 22 * 3".repeat(10_000));
    let formatted = formatted(&sum).unwrap();
    assert!(formatted.lines().all(|line| line.len() <= 100));
    the_laws_hold(&sum, &formatted);
}

/// Ten times the text takes some ten times as long, not a hundred.
#[test]
fn the_time_is_linear() {
    let text = |count: usize| {
        let object = |n: usize| {
            format!(
                "sphere S{n} {{center({n},{},-1) radius 1}} // {n}\nbox {{\nmin (1,2,3)}}",
                n % 7
            )
        };
        let lines: Vec<String> = (0..count).map(object).collect();
        lines.join("\n")
    };
    let time = |count: usize| {
        let source = Source::from_text("a.scn", text(count));
        let start = Instant::now();
        let formatted = format(&source).unwrap();
        assert!(formatted.len() > source.text().len());
        start.elapsed()
    };
    time(1000);
    let (short, long) = (time(2000), time(20_000));
    assert!(long < 40 * short, "{short:?}, {long:?}");
}
