//! Compares outputs with expected ones in files. `PINHOLE_BLESS=1 cargo test` rewrites the files.

use std::{fs, path::Path};

use crate::{
    program::names,
    table::{escaped, unescaped},
};

/// Asserts that a file has the content `content`. If the environment variable `PINHOLE_BLESS` is
/// set, writes the file instead.
#[track_caller]
pub fn assert_file(path: &Path, content: &str) {
    if std::env::var_os("PINHOLE_BLESS").is_some() {
        fs::write(path, content).expect("the file can be written");
    }
    let expected = fs::read_to_string(path).unwrap_or_default();
    for (index, (is, should)) in content.lines().zip(expected.lines()).enumerate() {
        assert_eq!(is, should, "line {} of {}", index + 1, path.display());
    }
    assert_eq!(content, expected, "{}", path.display());
}

/// Compares answers with those in the text files of a folder. In such a file, each line is a query,
/// and the lines below it that begin with `<` are the expected answer.
///
/// The first word of a query is its kind; the rest is the text that the query is about. A second
/// argument may follow after an arrow. `--` begins a comment.
#[track_caller]
pub fn assert_answers(folder: &str, answer: impl Fn(&str, &str, &str) -> String) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let names = names(&folder);
    assert!(!names.is_empty(), "{}", folder.display());
    for name in names {
        let path = folder.join(name);
        let mut real = String::new();
        let text = fs::read_to_string(&path).expect("a text");
        for line in text.lines().filter(|line| !line.starts_with('<')) {
            real += &format!("{line}\n");
            if !line.starts_with("--") {
                let (question, text) = line.split_once(' ').unwrap_or((line, ""));
                let (text, other) = text.split_once(" -> ").unwrap_or((text, ""));
                let answer = answer(question, &unescaped(text), &unescaped(other));
                real += format!("< {}", escaped(&answer)).trim_end();
                real.push('\n');
            }
        }
        assert_file(&path, &real);
    }
}
