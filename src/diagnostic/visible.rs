//! Text that a terminal may show.
//!
//! In: text from a scene, a file's name, a picture or an argument. Out: the same with everything
//! made visible by which it could act on a terminal, or be shown in another order than it is
//! written, or which is not seen at all: control characters, and those that Unicode says to show
//! nothing of.

use std::{borrow::Cow, fmt::Write};

/// The text with such characters as `\u{1b}`; line feeds and tabs stay as they are.
pub fn visible(text: &str) -> Cow<'_, str> {
    if !text.chars().any(is_invisible) {
        return Cow::Borrowed(text);
    }
    let mut shown = String::with_capacity(text.len());
    for character in text.chars() {
        push_visible(&mut shown, character);
    }
    Cow::Owned(shown)
}

/// A name, a message, or whatever else is to stand within one line: line feeds and tabs are made
/// visible too, so that it can forge neither a second line nor a cell of a table.
pub fn visible_line(text: &str) -> Cow<'_, str> {
    let breaks = |character| matches!(character, '\n' | '\t' | '\u{2028}' | '\u{2029}');
    let shown = visible(text);
    if !shown.contains(breaks) {
        return shown;
    }
    let mut line = String::with_capacity(shown.len());
    for character in shown.chars() {
        match breaks(character) {
            true => line.extend(character.escape_unicode()),
            false => line.push(character),
        }
    }
    Cow::Owned(line)
}

/// The visible text of a line as it stands in HTML and XML, in an attribute too.
pub fn escaped(text: &str) -> String {
    visible_line(text)
        .replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}

/// Adds a character as [`visible`] shows it.
pub fn push_visible(text: &mut String, character: char) {
    match is_invisible(character) {
        // Writing to a string does not fail.
        true => {
            let _ = write!(text, "{}", character.escape_unicode());
        }
        false => text.push(character),
    }
}

/// Whether a character is shown as its code: control characters, what the Unicode Character
/// Database (DerivedCoreProperties) gives the property `Default_Ignorable_Code_Point`, which
/// includes the controls of bidirectional text, and the marks of annotations.
fn is_invisible(character: char) -> bool {
    // Nearly all characters are among these.
    if character.is_ascii() {
        return character.is_ascii_control() && !matches!(character, '\n' | '\t');
    }
    match character {
        '\u{ad}'
        | '\u{34f}'
        | '\u{61c}'
        | '\u{115f}'..='\u{1160}'
        | '\u{17b4}'..='\u{17b5}'
        | '\u{180b}'..='\u{180f}'
        | '\u{200b}'..='\u{200f}'
        | '\u{202a}'..='\u{202e}'
        | '\u{2060}'..='\u{206f}'
        | '\u{3164}'
        | '\u{fe00}'..='\u{fe0f}'
        | '\u{feff}'
        | '\u{ffa0}'
        | '\u{fff0}'..='\u{fffb}'
        | '\u{1bca0}'..='\u{1bca3}'
        | '\u{1d173}'..='\u{1d17a}'
        | '\u{e0000}'..='\u{e0fff}' => true,
        _ => character.is_control(),
    }
}
