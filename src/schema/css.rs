//! The colours that CSS names (CSS Color Module Level 4, section 6.1).

use csscolorparser::NAMED_COLORS;

use crate::color::Color;

/// The colour of a name, in upper or lower case.
pub fn color(name: &str) -> Option<Color> {
    NAMED_COLORS
        .get(name.into())
        .copied()
        .map(Color::from_bytes)
}

/// The names, in lower case and alphabetical order.
pub fn names() -> impl Iterator<Item = &'static str> {
    NAMED_COLORS.keys().map(|name| name.as_str())
}
