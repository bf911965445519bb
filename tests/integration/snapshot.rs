//! Expected outputs that are files; `PINHOLE_BLESS=1 cargo test` writes them anew.

use std::{fs, path::Path};

/// Checks that a file holds this, or writes it.
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
