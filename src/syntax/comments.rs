//! What must be known of a text before it is parsed: its comments, and where it nests too deep.
//!
//! In: a text. Out: the places of comments, and of values that would make every recursion after this one too deep. They
//! are found by walking the text once, without recursion. The rest is the parser's.

use std::{ops::Range, sync::atomic::AtomicBool};

use super::foreign::{self, Lets};
use crate::cancel;

/// Parentheses, signs and calls nest at most this deep.
pub const NESTING_LIMIT: usize = 256;

/// So many parentheses may be closed where it takes the grammar to tell whether that was in quotes. What is read with them
/// nests at most so much deeper than the limit.
const DOUBTFUL_LIMIT: usize = 4 * NESTING_LIMIT;

/// What the walk finds.
#[derive(Debug, Default)]
pub struct Walk {
    /// Every comment, from `//` to before the line's end, or from `/*` to `*/`; those of other languages, too.
    pub comments: Vec<Range<usize>>,
    /// Comments as other languages write them, each by the sign that it begins with, and where it ends.
    pub foreign: Vec<(Range<usize>, usize)>,
    /// Whether the last comment has no `*/`.
    pub unclosed: bool,
    /// Values that nest too deep.
    pub deep: Vec<Deep>,
    /// Where every `}` outside of comments ends.
    pub braces: Vec<usize>,
    /// Characters outside of comments that cannot be seen and are no white space of the language.
    pub odd_spaces: Vec<Range<usize>>,
}

impl Walk {
    /// Moves all places by so many bytes.
    pub fn shift(&mut self, by: usize) {
        let places = self.deep.iter_mut().map(|deep| &mut deep.value);
        for range in self
            .comments
            .iter_mut()
            .chain(places)
            .chain(&mut self.odd_spaces)
        {
            *range = range.start + by..range.end + by;
        }
        for (sign, end) in &mut self.foreign {
            *sign = sign.start + by..sign.end + by;
            *end += by;
        }
        for deep in &mut self.deep {
            deep.at += by;
        }
        for end in &mut self.braces {
            *end += by;
        }
    }
}

/// A value that nests too deep.
#[derive(Debug)]
pub struct Deep {
    /// The parenthesis or sign that is one too many.
    pub at: usize,
    /// From the value's outermost parenthesis or sign to its end.
    pub value: Range<usize>,
}

/// So many bytes are walked before anybody is asked whether that is still wanted: a fraction of a millisecond.
const STRIDE: usize = 1 << 16;

/// Walks a text that starts with items (a file), or with a value (a `--set` argument's). Cancelled, it stops on the way.
pub fn walk(text: &str, start: Start, cancel: &AtomicBool) -> Walk {
    let mut nesting = Nesting {
        operand_may_follow: start == Start::Value,
        ..Nesting::default()
    };
    let mut found = Walk::default();
    let mut lets = Lets::of(text);
    let bytes = text.as_bytes();
    let (mut at, mut asked) = (0, 0);
    while let Some(&byte) = bytes.get(at) {
        if at >= asked {
            if cancel::is_set(cancel) {
                break;
            }
            asked = at + STRIDE;
        }
        let next = bytes.get(at + 1).copied();
        let foreign = match (byte, next) {
            (b'#', _) | (b'-', Some(b'-')) if start == Start::Items && !nesting.quote_before => {
                foreign::sign(text, at, &mut lets)
            }
            _ => None,
        };
        let end = match (byte, next) {
            (b'/', Some(b'/')) => {
                let end = end_of_line(bytes, at);
                found.comments.push(at..end);
                end
            }
            (b'/', Some(b'*')) => {
                let close = find(bytes, at + 2, b"*/");
                found.unclosed = close.is_none();
                let end = close.map_or(bytes.len(), |close| close + 2);
                found.comments.push(at..end);
                end
            }
            _ if foreign.is_some() => {
                let end = end_of_line(bytes, at);
                found.comments.push(at..end);
                found.foreign.extend(foreign.map(|sign| (sign, end)));
                end
            }
            (b' ' | b'\t' | b'\r', _) => at + 1,
            (b'\n', _) => {
                nesting.quote_before = false;
                at + 1
            }
            (0..=0x1F | 0x80.., _) if odd_space(text, at) > 0 => {
                let end = at + odd_space(text, at);
                found.odd_spaces.push(at..end);
                end
            }
            (b'0'..=b'9' | b'a'..=b'z' | b'A'..=b'Z' | b'_' | b'.' | b'#', _) => {
                let end = end_of_word(bytes, at);
                let word = bytes.get(at..end).unwrap_or_default();
                nesting.word(word, at, &mut found.deep);
                end
            }
            _ => {
                nesting.sign(byte, at, &mut found.deep);
                if byte == b'}' {
                    found.braces.push(at + 1);
                }
                at + 1
            }
        };
        at = end;
    }
    nesting.leave(bytes.len(), &mut found.deep);
    found
}

/// The length of the character at an offset, if it cannot be seen and is no white space of the language; or 0.
fn odd_space(text: &str, at: usize) -> usize {
    let rest = text.get(at..).unwrap_or_default();
    let character = rest.chars().next().filter(|c| is_odd_space(*c));
    character.map_or(0, char::len_utf8)
}

/// Whether a character cannot be seen and is no white space of the language.
pub fn is_odd_space(c: char) -> bool {
    let other = c.is_whitespace() && !matches!(c, ' ' | '\t' | '\r' | '\n');
    other
        || c.is_ascii_control() && !c.is_whitespace()
        || matches!(
            c,
            '\u{200B}'..='\u{200F}' | '\u{2060}' | '\u{FEFF}' | '\u{AD}'
        )
}

/// What a text starts with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Start {
    /// Items, as a file does.
    Items,
    /// A value.
    Value,
}

/// How deep the walk is in, and whether an operand or an operator comes next: that tells a sign from a minus, and the name
/// of a field from a value.
#[derive(Debug, Default)]
struct Nesting {
    /// For every open parenthesis the signs before it.
    open: Vec<usize>,
    /// The signs in `open`.
    signs_outside: usize,
    /// Signs since the last operand.
    signs: usize,
    /// Whether a value is expected here, rather than an operator or a field's name.
    operand_may_follow: bool,
    /// Where the outermost parenthesis, function or sign stands.
    outermost: usize,
    /// Where the last token stands, if it is a word in the place of a value: a function, if a parenthesis follows.
    function: Option<usize>,
    /// Whether a quotation mark stands in this line: what follows may be in quotes, which end with their line.
    quote_before: bool,
    /// The parentheses that were closed behind a quotation mark since the last brace without one. In
    /// `( ")" ( ")" …` they are still open.
    doubtful: usize,
    /// Where it became too deep.
    too_deep: Option<usize>,
}

impl Nesting {
    fn word(&mut self, word: &[u8], at: usize, deep: &mut Vec<Deep>) {
        let value = self.operand_may_follow;
        let within = !self.open.is_empty();
        // After a value the next word is a field's name or a kind, and its own value follows. Where a `let` or a second
        // name comes first, a minus cannot follow, so that it does not matter here.
        self.operand_may_follow = !value && !within && word != b"let";
        self.function = value.then_some(at);
        if !value && !within {
            self.signs = 0;
            self.end(at, deep);
        }
    }

    fn sign(&mut self, byte: u8, at: usize, deep: &mut Vec<Deep>) {
        let function = self.function.take();
        match byte {
            b'(' | b'[' => {
                if self.depth() == 0 {
                    self.outermost = function.unwrap_or(at);
                }
                self.open.push(self.signs);
                self.signs_outside += self.signs;
                self.signs = 0;
                self.operand_may_follow = true;
            }
            b'"' | b'\'' => {
                self.quote_before = true;
                self.operand_may_follow = false;
            }
            b')' | b']' | b'{' | b'}' if self.is_doubtful(byte) => {}
            b')' | b']' => {
                let signs = self.open.pop().unwrap_or(0);
                self.signs_outside -= signs;
                self.signs = 0;
                self.operand_may_follow = false;
                if self.open.is_empty() {
                    self.end(at + 1, deep);
                }
            }
            b'{' | b'}' => {
                self.leave(at, deep);
                self.operand_may_follow = false;
            }
            b'-' | b'+' if self.operand_may_follow => {
                if self.depth() == 0 {
                    self.outermost = at;
                }
                self.signs += 1;
            }
            b'+' | b'-' | b'*' | b'/' | b',' | b'=' | b':' | b'^' | b'%' => {
                self.signs = 0;
                self.operand_may_follow = true;
                if self.open.is_empty() {
                    self.end(at, deep);
                }
            }
            _ => {
                self.operand_may_follow = false;
            }
        }
        if self.depth() > NESTING_LIMIT && self.too_deep.is_none() {
            self.too_deep = Some(at);
        }
    }

    /// Whether a sign would close more parentheses in doubt than are let pass.
    fn is_doubtful(&mut self, sign: u8) -> bool {
        let is_brace = matches!(sign, b'{' | b'}');
        self.doubtful = match (self.quote_before, is_brace) {
            (true, true) => self.doubtful.saturating_add(self.open.len()),
            (true, false) => self.doubtful.saturating_add(1),
            (false, true) => 0,
            (false, false) => return false,
        };
        self.doubtful > DOUBTFUL_LIMIT
    }

    fn depth(&self) -> usize {
        self.open.len() + self.signs_outside + self.signs
    }

    /// No parenthesis is open any more.
    fn leave(&mut self, at: usize, deep: &mut Vec<Deep>) {
        self.open.clear();
        self.signs_outside = 0;
        self.signs = 0;
        self.end(at, deep);
    }

    fn end(&mut self, at: usize, deep: &mut Vec<Deep>) {
        if let Some(too_deep) = self.too_deep.take() {
            deep.push(Deep {
                at: too_deep,
                value: self.outermost..at,
            });
        }
    }
}

/// Where the line ends; the carriage return of a CRLF belongs to its end.
fn end_of_line(bytes: &[u8], from: usize) -> usize {
    let end = find(bytes, from, b"\n").unwrap_or(bytes.len());
    let last = bytes.get(end.saturating_sub(1)).copied();
    end - usize::from(end < bytes.len() && last == Some(b'\r'))
}

fn end_of_word(bytes: &[u8], start: usize) -> usize {
    let rest = bytes.get(start..).unwrap_or_default();
    let word = |&byte: &u8| byte.is_ascii_alphanumeric() || matches!(byte, b'_' | b'.');
    let mut end = start + 1;
    end += rest.iter().skip(1).take_while(|byte| word(byte)).count();
    // The sign of an exponent belongs to its number.
    let numeric = rest
        .first()
        .is_some_and(|b| b.is_ascii_digit() || *b == b'.');
    let exponent = matches!(bytes.get(end.saturating_sub(1)), Some(b'e' | b'E'));
    if numeric && exponent && matches!(bytes.get(end), Some(b'+' | b'-')) {
        let rest = bytes.get(end + 1..).unwrap_or_default();
        let more = rest.iter().take_while(|byte| word(byte)).count();
        if more > 0 {
            end += 1 + more;
        }
    }
    end
}

fn find(bytes: &[u8], from: usize, what: &[u8]) -> Option<usize> {
    let rest = bytes.get(from..)?;
    let at = match *what {
        [byte] => rest.iter().position(|&b| b == byte),
        _ => rest.windows(what.len()).position(|window| window == what),
    };
    at.map(|at| from + at)
}
