//! Comments as other languages write them, behind a `#` or a `--`.
//!
//! In: a text and a place in it. Out: whether a comment begins there by its looks. A `#` may also begin a colour, and two
//! minuses may be a difference: both stay what they are wherever they can be right, or a slip in it.

use std::{collections::HashSet, ops::Range};

use crate::suggest;

/// Fields that take a colour: behind their names a `#` is meant as one.
const COLOR_FIELDS: [&str; 3] = ["color", "colors", "background"];

/// Constants of the language, which stand behind a minus as a `let` does.
const CONSTANTS: [&str; 3] = ["pi", "deg", "rad"];

/// The first sign of a comment of another language, and those like it right behind, if one begins at an offset.
pub fn sign<'t>(text: &'t str, at: usize, lets: &mut Lets<'t>) -> Option<Range<usize>> {
    let rest = text.get(at..)?;
    let first = rest.chars().next()?;
    let written = text.get(..at)?;
    if written.ends_with(first) {
        return None;
    }
    // A line may be a megabyte: no more of it is read than it takes.
    let after = rest.trim_start_matches(first);
    let run = rest.len() - after.len();
    let before = Before::of(written);
    let is_comment = match (first, run) {
        ('#', 1) => !before.may_be_color(after),
        ('#', _) => true,
        ('-', 2..) => is_dashed(after, before, lets),
        _ => false,
    };
    is_comment.then_some(at..at + run)
}

/// Two minuses: a difference, unless no value can stand before them, or what follows is the name of nothing.
fn is_dashed<'t>(after: &'t str, before: Before<'_>, lets: &mut Lets<'t>) -> bool {
    if before == Before::Edge {
        return true;
    }
    // `a --b` may be a slip in `b`.
    if !after.starts_with(is_blank) {
        return false;
    }
    let (word, rest) = split_word(after.trim_start_matches(is_blank));
    let is_call = rest.trim_start_matches(is_blank).starts_with('(');
    word.starts_with(|c: char| c.is_ascii_alphabetic())
        && !is_call
        && !CONSTANTS.contains(&word)
        && !lets.contain(word)
}

/// What stands before a place, as far as it takes to tell what can follow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Before<'t> {
    /// A brace, or nothing: no value can go on.
    Edge,
    /// The end of a line, with a value or a name at the end of one before.
    Line,
    /// A word.
    Word(&'t str),
    /// A number, a colour, or what closes a value.
    Value,
    /// An operator, or what opens a value.
    Open,
}

impl<'t> Before<'t> {
    fn of(text: &'t str) -> Self {
        let written = text.trim_end();
        let gap = text.get(written.len()..).unwrap_or_default();
        let last = written.chars().next_back();
        match last {
            None | Some('{' | '}') => Self::Edge,
            _ if gap.contains('\n') => Self::Line,
            Some(')' | ']' | '"' | '\'') => Self::Value,
            Some(c) if is_of_word(c) => {
                let before = written.trim_end_matches(|c| is_of_word(c) || c == '.');
                let word = written.get(before.len()..).unwrap_or_default();
                let is_name = word.starts_with(|c: char| !c.is_ascii_digit() && c != '.');
                match is_name && !before.ends_with('#') {
                    true => Self::Word(word),
                    false => Self::Value,
                }
            }
            Some(_) if written.ends_with("*/") => Self::Line,
            Some(_) => Self::Open,
        }
    }

    /// Whether a `#` may be that of a colour, or of a slip in one, by what stands around it.
    fn may_be_color(self, after: &str) -> bool {
        let written = after.trim_start_matches(is_blank);
        let blanks = after.len() - written.len();
        let (code, rest) = split_word(written);
        let rest = rest.trim_start_matches(is_blank);
        let is_last = rest.is_empty() || rest.starts_with(['\n', '\r']);
        let is_hex = !code.is_empty() && code.bytes().all(|byte| byte.is_ascii_hexdigit());
        let is_code = is_hex && matches!(code.len(), 3 | 6);
        // `# fff` is a slip, `# add the ball` a comment; a list goes on behind either.
        let is_listed = rest.starts_with([',', ')']);
        match self {
            Self::Open => match blanks {
                0 => true,
                _ => is_code,
            },
            Self::Word(word) if suggest::nearest(word, COLOR_FIELDS).is_some() => match blanks {
                0 => true,
                _ => is_code || code.is_empty(),
            },
            // A field of another name, as far as one can tell.
            Self::Word(_) => blanks == 0 && (is_hex || is_listed || rest.starts_with('}')),
            Self::Value | Self::Edge => blanks == 0 && is_code,
            Self::Line => match blanks {
                0 => is_code || is_hex && (is_last || is_listed),
                _ => is_code && is_listed,
            },
        }
    }
}

/// The names that are defined somewhere in a text; read when they are asked for.
pub struct Lets<'t> {
    text: &'t str,
    names: Option<HashSet<&'t str>>,
}

impl<'t> Lets<'t> {
    /// Those of this text.
    pub fn of(text: &'t str) -> Self {
        Self { text, names: None }
    }

    fn contain(&mut self, name: &str) -> bool {
        let names = self.names.get_or_insert_with(|| {
            let behind = self.text.split("let").skip(1);
            behind.map(|rest| split_word(rest.trim_start()).0).collect()
        });
        names.contains(name)
    }
}

/// The word that a text starts with, and what stands behind it.
fn split_word(text: &str) -> (&str, &str) {
    let end = text.find(|c| !is_of_word(c)).unwrap_or(text.len());
    text.split_at_checked(end).unwrap_or((text, ""))
}

fn is_of_word(c: char) -> bool {
    c.is_ascii_alphanumeric() || c == '_'
}

fn is_blank(c: char) -> bool {
    c == ' ' || c == '\t'
}
