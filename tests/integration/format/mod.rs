//! The canonical layout: what it looks like, as `tests/format` says, and what holds of every text.
//!
//! Beside each `NAME.scn` of `tests/format` stands `NAME.formatted.scn`.

pub mod any;
mod laws;

use std::{fs, path::Path};

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

/// Rows of a text and its layout, or the codes of its mistakes: those of syntax, and no others.
#[test]
fn little_texts() {
    for [text, expected] in rows(
        r"
        ->
        \n \t\r\n ->
        \n\nlet a=1 -> let a = 1\n
        // only  \n\n\n\n/* comments */\n -> // only\n\n/* comments */\n
        let a=1\r\nlet b=2\r\n -> let a = 1\r\nlet b = 2\r\n
        let a=1\r\nlet b=2 -> let a = 1\r\nlet b = 2\r\n
        let a=1\r\nlet b=2\n -> let a = 1\nlet b = 2\n
        let a=1\rlet b=2\r -> let a = 1\nlet b = 2\n
        /* a \r\n b */let a=1\r\n -> /* a\r\n b */ let a = 1\r\n
        let a=2/ /* two */3 -> let a = 2 / /* two */ 3\n
        let a=2/ // two\n3 -> let a = 2 /  // two\n  3\n
        let a=-// minus\n3 -> let a = -  // minus\n  3\n
        let a=max(// c\n1,2/* d */) -> let a = max(  // c\n  1, 2 /* d */)\n
        let a=f(\n/* c */\n) -> let a = f(\n  /* c */)\n
        let a=(1,/* c */\n2,3) -> let a = (1, /* c */ 2, 3)\n
        let a=(1 // c\n) -> let a = (1  // c\n  )\n
        box A{min a max(b)} -> box A { min a  max (b) }\n
        image{x 1+max(1,1)} -> image { x 1 + max(1, 1) }\n
        -- What the names mean does not matter.
        ball { radus 1 / 0  radus b }\n -> ball { radus 1 / 0  radus b }\n
        let a = 1; sphere { radus b } -> needless_separator
        sphere { center (1, 2, 3) radius } -> missing_value
        sphere { center (1 -> unclosed_block unclosed_parenthesis
        -- Where the field is no field, that is mistake enough.
        sphere { radus } -> unknown_field
        ball { radius } -> missing_value
        -- Not so with a value that could not be read.
        sphere { center (0, 1, 0)  radus (2 } -> unclosed_parenthesis
        sphere { center (0, 1, 0)  radus 2) } -> stray_closing
        sphere { center (0, 1, 0)  radus 2.5.5 } -> bad_number
        sphere { center (0, 1, 0)  radus #ff } -> bad_color_code
        sphere { center (0, 1, 0)  radus , color red } -> needless_separator
        sphere { center (0, 1, 0)  radus ) } -> unexpected
    ",
    ) {
        match formatted(text) {
            Ok(formatted) => {
                assert_eq!(formatted, expected, "{text:?}");
                the_laws_hold(text, expected);
                let marked = self::formatted(&format!("\u{feff}{text}"));
                assert_eq!(marked.unwrap(), format!("\u{feff}{expected}"));
            }
            Err(codes) => assert_eq!(codes.join(" ").replace("pinhole::", ""), expected, "{text}"),
        }
    }
    let source = Source::from_bytes("a.scn", b"// \xff\nsphere { }".to_vec());
    let mistakes = format(&source).unwrap_err();
    assert_eq!(mistakes[0].code, "pinhole::invalid_utf8");
}

#[test]
fn deep_and_long_values_are_laid_out() {
    let deep = format!("let a = {}1{}\n", "(".repeat(256), ")".repeat(256));
    assert_eq!(formatted(&deep).as_ref(), Ok(&deep));
    let signs = format!("let a = {}(2 - {}1)\n", "-".repeat(100), "-".repeat(100));
    let calls = format!("let a={}1{}", "max(1,".repeat(200), ")".repeat(200));
    let sum = format!("let a = 1{}", "+ 22 * 3".repeat(10_000));
    let [.., sum] = [signs, calls, sum].map(|text| {
        let formatted = formatted(&text).unwrap();
        the_laws_hold(&text, &formatted);
        formatted
    });
    assert!(sum.lines().all(|line| line.len() <= 100));
}
