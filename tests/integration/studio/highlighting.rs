//! Tests that the words that the page highlights are exactly the words of the language.

use std::{collections::BTreeSet, fs, path::Path};

use pinhole::schema::{BLOCKS, FUNCTIONS};

/// Returns the quoted words in a constant of a source file of the page.
fn words(file: &str, constant: &str) -> BTreeSet<String> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("studio/page/src");
    let text = fs::read_to_string(path.join(file)).unwrap();
    let (_, value) = text.split_once(&format!("const {constant} = ")).unwrap();
    let (value, _) = value.split_once(";\n").unwrap();
    let quoted = value.split('"').skip(1).step_by(2);
    let words = quoted.flat_map(str::split_whitespace);
    words.map(str::to_owned).collect()
}

fn set<'a>(words: impl Iterator<Item = &'a str>) -> BTreeSet<String> {
    words.map(str::to_owned).collect()
}

#[test]
fn the_page_adds_every_kind_of_object() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("studio/page/src/index.html");
    let text = fs::read_to_string(path).unwrap();
    let buttons = text.split("data-kind=\"").skip(1);
    let kinds = buttons.map(|rest| rest.split('"').next().unwrap());
    let objects = BLOCKS.iter().filter(|it| it.is_object);
    assert_eq!(set(kinds), set(objects.map(|it| it.name)));
}

#[test]
fn the_page_highlights_exactly_the_words_of_the_language() {
    let file = "language.ts";
    let fields = || BLOCKS.iter().flat_map(|block| block.fields);
    assert_eq!(words(file, "KINDS"), set(BLOCKS.iter().map(|it| it.name)));
    assert_eq!(words(file, "FIELDS"), set(fields().map(|it| it.name)));
    assert_eq!(
        words(file, "FUNCTIONS"),
        set(FUNCTIONS.iter().map(|it| it.name))
    );
}
