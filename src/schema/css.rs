//! The named colours of CSS (CSS Color Module Level 4, section 6.1).
//!
//! The table is a copy, because a library that contains it would add nine crates to the build.

use std::sync::LazyLock;

use crate::color::Color;

/// Table of colours, in alphabetical order. A line holds a name in lower case and its hexadecimal
/// digits.
const COLORS: &str = include_str!("css_colors.txt");

fn rows() -> impl Iterator<Item = (&'static str, &'static str)> {
    COLORS.lines().filter_map(|line| line.split_once(" #"))
}

/// Returns the colour of a name, in any capitalization. Returns `None` if there is no such colour.
pub fn color(name: &str) -> Option<Color> {
    static ROWS: LazyLock<Vec<(&str, &str)>> = LazyLock::new(|| rows().collect());
    let name = &*name.to_ascii_lowercase();
    let row = ROWS.binary_search_by_key(&name, |&(name, _)| name).ok()?;
    let (_, digits) = ROWS.get(row)?;
    let [_, bytes @ ..] = u32::from_str_radix(digits, 16).ok()?.to_be_bytes();
    Some(Color::from_bytes(bytes))
}

/// Returns the names of the colours, in lower case and alphabetical order.
pub fn names() -> impl Iterator<Item = &'static str> {
    rows().map(|(name, _)| name)
}
