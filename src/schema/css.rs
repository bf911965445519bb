//! The named colours of CSS (CSS Color Module Level 4, section 6.1).
//!
//! They are a table here, because a library with the same table brings nine crates to compile.

use std::{collections::HashMap, sync::LazyLock};

use crate::color::Color;

/// Lines of a name and its colour, in lower case and alphabetical order.
const COLORS: &str = include_str!("css_colors.txt");

fn rows() -> impl Iterator<Item = (&'static str, &'static str)> {
    COLORS.lines().filter_map(|line| line.split_once(" #"))
}

/// Returns the colour of a name, whatever its case.
pub fn color(name: &str) -> Option<Color> {
    static ROWS: LazyLock<HashMap<&str, &str>> = LazyLock::new(|| rows().collect());
    let digits = ROWS.get(&*name.to_ascii_lowercase())?;
    let [_, bytes @ ..] = u32::from_str_radix(digits, 16).ok()?.to_be_bytes();
    Some(Color::from_bytes(bytes))
}

/// Returns the names, in lower case and alphabetical order.
pub fn names() -> impl Iterator<Item = &'static str> {
    rows().map(|(name, _)| name)
}
