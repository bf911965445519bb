//! Tests of the formatter's layout, by comparison with the files in `tests/format`, and of its
//! laws.
//!
//! In `tests/format`, the file `NAME.formatted.scn` is the expected layout of `NAME.scn`.

pub mod any;
pub mod laws;

use std::{fs, path::Path, time::Instant};

use pinhole::{format::format, source::Source};

use self::laws::assert_formatter_laws;
use crate::{program::Folder, scenes::scenes, snapshot::assert_file};

/// Formats a text. If the text has syntax errors, returns the codes of all its diagnostics instead.
pub fn formatted(text: &str) -> Result<String, Vec<String>> {
    format(&Source::from_text("a.scn", text)).map_err(|mistakes| {
        assert!(mistakes.iter().any(|d| d.is_error()), "{text}");
        mistakes.into_iter().map(|d| d.code).collect()
    })
}

/// Returns the texts of all scenes below `examples` and `tests`, including scenes with mistakes.
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
fn formatted_scenes_match_the_files_beside_them() {
    for path in scenes("tests/format") {
        if path.file_stem().unwrap().to_string_lossy().contains('.') {
            continue;
        }
        let formatted = formatted(&fs::read_to_string(&path).unwrap()).unwrap();
        assert_file(&path.with_extension("formatted.scn"), &formatted);
    }
}

#[test]
fn deep_and_long_values_are_formatted() {
    let deep = format!("let a = {}1{}\n", "(".repeat(256), ")".repeat(256));
    assert_eq!(formatted(&deep).as_ref(), Ok(&deep));
    let signs = format!("let a = {}(2 - {}1)\n", "-".repeat(100), "-".repeat(100));
    let calls = format!("let a={}1{}", "max(1,".repeat(200), ")".repeat(200));
    let sum = format!("let a = 1{}", "+ 22 * 3".repeat(10_000));
    let [.., sum] = [signs, calls, sum].map(|text| {
        let formatted = formatted(&text).unwrap();
        assert_formatter_laws(&text, &formatted);
        formatted
    });
    assert!(sum.lines().all(|line| line.len() <= 100));
}

#[test]
fn fmt_check_compares_long_texts_in_linear_time() {
    let lines = 40_000;
    let blank = "\n".repeat(lines);
    let mixed = "\n\n\nsphere {}\n\n".repeat(lines);
    let objects = "sphere{center (1,1,0)   radius 1}\n".repeat(lines);
    let every_other = "sphere {}\nsphere  {}\n".repeat(lines);
    for text in [blank, mixed, objects, every_other] {
        let folder = Folder::with([("a.scn", &*text)]);
        let start = Instant::now();
        let told = folder.told("fmt --check a.scn", 1);
        // The time limit excludes an algorithm that compares all pairs of lines, which would take
        // minutes.
        assert!(start.elapsed().as_secs() < 20, "{:?}", start.elapsed());
        assert!(told.starts_with("--- a.scn\n+++ a.scn, formatted\n@@ -1"));
    }
}
