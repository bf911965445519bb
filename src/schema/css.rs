//! The colours that CSS names (CSS Color Module Level 4, section 6.1): a table, as a library with
//! the same one brings nine crates that have to be compiled.

use std::{collections::HashMap, sync::LazyLock};

use crate::color::Color;

/// A name and its colour a line, in lower case and alphabetical order.
const COLORS: &str = include_str!("css_colors.txt");

fn rows() -> impl Iterator<Item = (&'static str, &'static str)> {
    COLORS.lines().filter_map(|line| line.split_once(" #"))
}

/// The colour of a name, in upper or lower case.
pub fn color(name: &str) -> Option<Color> {
    static ROWS: LazyLock<HashMap<&str, &str>> = LazyLock::new(|| rows().collect());
    let digits = ROWS.get(&*name.to_ascii_lowercase())?;
    let [_, bytes @ ..] = u32::from_str_radix(digits, 16).ok()?.to_be_bytes();
    Some(Color::from_bytes(bytes))
}

/// The names, in lower case and alphabetical order.
pub fn names() -> impl Iterator<Item = &'static str> {
    rows().map(|(name, _)| name)
}
