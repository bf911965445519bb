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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_found_in_any_case() {
        assert_eq!(names().count(), 148);
        assert!(names().is_sorted());
        for name in names() {
            assert_eq!(name, name.to_lowercase());
            assert!(color(name).is_some() && color(&name.to_uppercase()) == color(name));
        }
        assert_eq!(color("Olive"), Some(Color::from_bytes([128, 128, 0])));
        assert_eq!(color("transparent"), None);
        assert_eq!(color("olivey"), None);
    }
}
