//! Escapes text so that it is safe to print to a terminal.
//!
//! The text may come from a scene, a file name, a picture or an argument. Characters are escaped if
//! they could control a terminal, change the order of the printed text, or be invisible. They are
//! the control characters and the characters that Unicode calls ignorable.

use std::{borrow::Cow, fmt::Write};

/// Returns `text` with its invisible characters escaped, as in `\u{1b}`. Line feeds and tabs are
/// not escaped.
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

/// Returns a text for use within one line, such as a name or a message. Also escapes line feeds and
/// tabs, so that the text cannot imitate a second line or another cell of a table.
pub fn visible_line(text: &str) -> Cow<'_, str> {
    let breaks = |character| matches!(character, '\n' | '\t' | '\u{2028}' | '\u{2029}');
    let shown = visible(text);
    if !shown.contains(breaks) {
        return shown;
    }
    let mut line = String::with_capacity(shown.len());
    for character in shown.chars() {
        if breaks(character) {
            line.extend(character.escape_unicode())
        } else {
            line.push(character)
        }
    }
    Cow::Owned(line)
}

/// Escapes a text as [`visible_line`] does, and in addition for HTML and XML, including attributes.
pub fn escaped(text: &str) -> String {
    visible_line(text)
        .replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}

/// Appends a character to a text. An invisible character is escaped, as in `\u{1b}`.
pub fn push_visible(text: &mut String, character: char) {
    if is_invisible(character) {
        // Writing to a string does not fail.
        let _ = write!(text, "{}", character.escape_unicode());
    } else {
        text.push(character)
    }
}

/// Returns whether a character must be escaped: a control character, an annotation mark (U+FFF9 to
/// U+FFFB), or a character with the property `Default_Ignorable_Code_Point` of the Unicode
/// Character Database (DerivedCoreProperties), which includes the controls of bidirectional text.
fn is_invisible(character: char) -> bool {
    // This is the fast path: most characters are ASCII.
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
