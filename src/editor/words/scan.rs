//! A text cut into words and signs.

use super::{Role, Token, file};
use crate::source::Span;

/// The tokens without their roles, as far as those follow from places. None reaches into a comment.
pub fn scan(text: &str, comments: &[Span]) -> Vec<Token> {
    let bytes = text.as_bytes();
    let mut tokens = Vec::with_capacity(text.len() / 4);
    let mut comments = comments.iter().peekable();
    let mut at = 0;
    while let Some(&byte) = bytes.get(at) {
        if let Some(comment) = comments.next_if(|comment| comment.start <= at) {
            at = at.max(comment.end);
            continue;
        }
        let end = comments.peek().map_or(text.len(), |comment| comment.start);
        let rest = bytes.get(at..end).unwrap_or_default();
        let run = |of: fn(&u8) -> bool| rest.iter().take_while(|byte| of(byte)).count();
        let (length, role) = match byte {
            b' ' | b'\t' | b'\r' | b'\n' => (run(u8::is_ascii_whitespace).max(1), None),
            b'a'..=b'z' | b'A'..=b'Z' | b'_' => (run(is_word_byte), Some(Role::Name)),
            b'0'..=b'9' => (number_length(rest), Some(Role::Number)),
            b'.' if rest.get(1).is_some_and(u8::is_ascii_digit) => {
                (number_length(rest), Some(Role::Number))
            }
            b'#' => {
                let digits = rest.iter().skip(1);
                let count = digits
                    .take_while(|byte| byte.is_ascii_alphanumeric())
                    .count();
                (1 + count, Some(Role::ColorCode))
            }
            b'"' | b'\'' => {
                let inner = rest.iter().skip(1);
                let count = inner
                    .take_while(|b| !matches!(**b, b'\n') && **b != byte)
                    .count();
                let is_closed = rest.get(1 + count) == Some(&byte);
                (1 + count + usize::from(is_closed), Some(Role::Other))
            }
            b'+' | b'-' | b'*' | b'/' => (1, Some(Role::Operator)),
            b'=' => (1, Some(Role::Equals)),
            b'{' => (1, Some(Role::Open)),
            b'}' => (1, Some(Role::Close)),
            b'(' => (1, Some(Role::OpenList)),
            b')' => (1, Some(Role::CloseList)),
            b',' => (1, Some(Role::Comma)),
            _ => {
                let character = text.get(at..).and_then(|rest| rest.chars().next());
                let length = character.map_or(1, char::len_utf8);
                let is_blank = character.is_some_and(|c| c.is_whitespace() || c == '\u{feff}');
                (length, Some(Role::Other).filter(|_| !is_blank))
            }
        };
        let span = file(at, at + length);
        tokens.extend(role.map(|role| Token { span, role }));
        at += length;
    }
    tokens
}

fn is_word_byte(byte: &u8) -> bool {
    byte.is_ascii_alphanumeric() || *byte == b'_'
}

/// A number with its unit; the sign of an exponent belongs to it.
fn number_length(rest: &[u8]) -> usize {
    let run = |from: usize| {
        let rest = rest.iter().skip(from);
        rest.take_while(|byte| is_word_byte(byte) || **byte == b'.')
            .count()
    };
    let length = run(0);
    let is_exponent = matches!(rest.get(length.saturating_sub(1)), Some(b'e' | b'E'))
        && matches!(rest.get(length), Some(b'+' | b'-'))
        && rest.get(length + 1).is_some_and(u8::is_ascii_digit);
    match is_exponent {
        true => length + 1 + run(length + 1),
        false => length,
    }
}
