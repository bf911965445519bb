//! Scans a text before it is parsed.
//!
//! In: a text. Out: its comments, the offsets where it can be split for parsing, its invisible
//! characters, and the offsets where it may nest too deep for pest. The scan runs the lexer once
//! and does not recurse.

use std::{collections::BTreeMap, sync::atomic::AtomicBool};

use super::{
    NESTING_LIMIT, Parsed, messages as say,
    problem::further_places,
    tokens::{Lexer, TokenKind},
};
use crate::{
    cancel,
    diagnostic::{Applicability, Diagnostic, Edit, Fix, MOST_PROBLEMS},
    source::{SourceId, Span},
};

/// Minimum distance, in bytes, between two recorded places where a text can be split for parsing.
/// Places between them are left out, which saves memory. With a much larger distance, the text
/// would be parsed in pieces much longer than [`CHUNK_BYTES`](super::parser::CHUNK_BYTES), their
/// minimum length.
const SPLIT_SPACING_BYTES: usize = 256;

/// Result of scanning a text.
#[derive(Debug, Default)]
pub struct Scan {
    /// All comments, in the order of the text.
    comments: Vec<Span>,
    /// Offsets where a value may nest deeper than [`NESTING_LIMIT`]. The scan counts parentheses
    /// and all minuses, although a minus that subtracts does not nest. Error recovery therefore
    /// reads the items that contain these offsets, and counts exactly.
    pub deep: Vec<usize>,
    /// Greatest nesting depth of a value. Every minus counts as a level, even one that subtracts.
    pub nesting: usize,
    /// Ascending offsets where a text without mistakes can be split: after a `}` or before a `let`.
    /// Neighbouring offsets are at least [`SPLIT_SPACING_BYTES`] apart.
    pub split_points: Vec<usize>,
    /// Invisible characters that are not white space of the language, and carriage returns that
    /// end no line.
    odd_spaces: Vec<Span>,
}

impl Scan {
    /// Scans a text from the offset `start` to its end, or until cancelled.
    pub fn of(text: &str, id: SourceId, start: usize, cancel: &AtomicBool) -> Self {
        let mut scan = Self::default();
        let mut lexer = Lexer::new(text, start);
        // `minuses` is the number of minuses since the last operand. `open` contains, for each open
        // parenthesis, the number of minuses directly before it, and `outside` is the sum of these.
        let (mut minuses, mut outside, mut open) = (0, 0, Vec::new());
        let mut is_told = false;
        // Number of tokens between two checks for cancellation. A much larger number would delay
        // cancellation, and a much smaller one would slow the scan.
        const STRIDE: usize = 1 << 14;
        for count in 0_usize.. {
            let token = lexer.token();
            if token.kind == TokenKind::End || (count % STRIDE == 0 && cancel::is_set(cancel)) {
                break;
            }
            let span = Span::new(id, token.start, token.end);
            match token.kind {
                TokenKind::Comment => scan.comments.push(span),
                TokenKind::OddSpace if scan.odd_spaces.len() < MOST_PROBLEMS => {
                    scan.odd_spaces.push(span);
                }
                TokenKind::Sign => match text.as_bytes().get(token.start) {
                    Some(b'-') => minuses += 1,
                    Some(b'(') => {
                        open.push(minuses);
                        outside += minuses;
                        minuses = 0;
                    }
                    Some(b')') => {
                        outside -= open.pop().unwrap_or(0);
                        minuses = 0;
                    }
                    Some(brace @ (b'{' | b'}')) => {
                        open.clear();
                        (minuses, outside, is_told) = (0, 0, false);
                        if *brace == b'}' {
                            scan.add_split_point(token.end);
                        }
                    }
                    _ => {}
                },
                TokenKind::Name => {
                    if text.get(token.start..token.end) == Some("let") {
                        scan.add_split_point(token.start);
                    }
                    minuses = 0;
                }
                _ => minuses = 0,
            }
            let depth = open.len() + outside + minuses;
            scan.nesting = scan.nesting.max(depth);
            let is_deep = depth > NESTING_LIMIT;
            if is_deep && !is_told {
                scan.deep.push(token.start);
            }
            is_told = is_deep;
        }
        scan.find_carriage_returns(text, id, start);
        scan
    }

    /// Records carriage returns that are not followed by a line feed. Carriage returns in comments
    /// matter, too: other programs show a new line after a carriage return, but to the parser the
    /// comment continues.
    fn find_carriage_returns(&mut self, text: &str, id: SourceId, start: usize) {
        let rest = text.get(start..).unwrap_or_default();
        let alone = rest.match_indices('\r').filter_map(|(at, _)| {
            let at = start + at;
            let is_alone = text.as_bytes().get(at + 1) != Some(&b'\n');
            is_alone.then(|| Span::new(id, at, at + 1))
        });
        let room = MOST_PROBLEMS - self.odd_spaces.len();
        self.odd_spaces.extend(alone.take(room));
    }

    /// Records a place where the text can be split, unless it is too near the previous one.
    fn add_split_point(&mut self, place: usize) {
        if self
            .split_points
            .last()
            .is_none_or(|&last| place >= last + SPLIT_SPACING_BYTES)
        {
            self.split_points.push(place);
        }
    }

    /// Returns whether the text has no unclosed comment, no value that may nest too deep, no
    /// carriage return without a line feed, and no invisible character except the white space of
    /// the language.
    pub fn is_plain(&self, text: &str) -> bool {
        self.open_comment(text).is_none() && self.deep.is_empty() && self.odd_spaces.is_empty()
    }

    /// Returns the span of the `/*` of an unclosed comment, if there is one. Such a comment extends
    /// to the end of the text, so only the last comment is tested.
    fn open_comment(&self, text: &str) -> Option<Span> {
        let last = self.comments.last()?;
        let inner = text.get(last.range())?.strip_prefix("/*")?;
        (!inner.ends_with("*/")).then(|| Span::new(last.source, last.start, last.start + 2))
    }

    /// Adds the comments and the problems of the scan to the result of parsing.
    pub fn report(self, text: &str, parsed: &mut Parsed<'_>) {
        self.report_odd_spaces(text, &mut parsed.problems);
        // In a comment, text after a carriage return may be meant as code. The comment hides this
        // code, so nothing is reported as missing.
        let hides = |place: &Span| text[place.start..].starts_with('\r');
        parsed.is_cut |= self.odd_spaces.iter().any(hides);
        if let Some(open) = self.open_comment(text) {
            // An unclosed comment hides the rest of the text. Problems that may only arise because
            // this text is hidden are dropped.
            parsed.problems.retain(|problem| {
                let first = problem.labels.first().map_or(0, |label| label.span.end);
                problem.code != "pinhole::unclosed_block" && first < open.start
            });
            parsed.is_cut = true;
            let found = say::UNCLOSED_COMMENT.at(open, &[], None);
            parsed.problems.push(found);
        }
        parsed.comments = self.comments;
    }

    /// Reports the invisible characters that are not white space of the language. Each character is
    /// reported once, at its first place.
    fn report_odd_spaces(&self, text: &str, problems: &mut Vec<Diagnostic>) {
        let mut sorts: BTreeMap<&str, Vec<Span>> = BTreeMap::new();
        for place in &self.odd_spaces {
            let sort = text.get(place.range()).unwrap_or_default();
            sorts.entry(sort).or_default().push(*place);
        }
        for (sort, places) in sorts {
            let Some(&at) = places.first() else { continue };
            let all = |title, text| {
                let edits = places.iter().map(|place| Edit::new(*place, text));
                Fix::new(title, edits)
            };
            // If a character of zero width is removed from between two words, they become one word.
            // Such a removal is not safe.
            let has_width = sort.chars().all(char::is_whitespace);
            let joins = |place: &Span| !Edit::remove_in(*place, text).text.is_empty();
            let is_safe = has_width || !places.iter().any(joins);
            let times = further_places(places.len() - 1);
            let mut found = if sort == "\r" {
                say::CARRIAGE_RETURN.at(at, &[&times], all("write line feeds", "\n"))
            } else {
                let words = [&name_of_space(sort), times.as_str()];
                let said = say::ODD_SPACE.safe_if(is_safe);
                said.at(at, &words, all("write plain spaces", " "))
            };
            // A character of zero width rarely separates words on purpose, so the fix that removes
            // it is offered before the one that writes a space.
            if !has_width {
                let applicability = Applicability::safe_if(is_safe);
                let away = all("take it away", "").with_applicability(applicability);
                found.fixes.insert(0, away);
            }
            if self.odd_spaces.len() == MOST_PROBLEMS {
                // If the maximum number of places is recorded, the text may contain more. A fix of
                // only the recorded places would be incomplete, so no fix is offered.
                found.fixes.clear();
            }
            problems.push(found);
        }
    }
}

/// Returns a noun for an invisible character in a message: its code point and its name, such as
/// `U+00A0, a no-break space,`.
fn name_of_space(text: &str) -> String {
    let character = text.chars().next().unwrap_or_default();
    let name = match character {
        '\u{A0}' => "a no-break space",
        '\u{200B}' => "a zero-width space",
        '\u{FEFF}' => "a byte order mark",
        c if c.is_whitespace() => "a space",
        _ => "a control character",
    };
    format!("U+{:04X}, {name},", u32::from(character))
}
