//! A first walk over the text, before it is parsed.
//!
//! In: a text. Out: its comments, the places where it can be split, its invisible characters, and
//! the places where it may nest too deep for pest. One walk of the lexer, without recursion.

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

/// Minimum distance, in bytes, between two places in [`Scan::split_points`]: a small part of what
/// is parsed at a time.
const SPLIT_SPACING_BYTES: usize = 256;

/// Result of the walk.
#[derive(Debug, Default)]
pub struct Scan {
    /// Every comment.
    comments: Vec<Span>,
    /// Places where more parentheses and minuses are open than a value may have. A minus between
    /// two values counts, too; recovery, which reads these items, counts exactly.
    pub deep: Vec<usize>,
    /// Places where a text without mistakes can be split: behind a `}` or before a `let`, at most
    /// one in [`SPLIT_SPACING_BYTES`] bytes.
    pub split_points: Vec<usize>,
    /// Invisible characters that are not white space of the language, and carriage returns that
    /// end no line.
    odd_spaces: Vec<Span>,
}

impl Scan {
    /// Walks a text from an offset on, until the end or until cancelled.
    pub fn of(text: &str, id: SourceId, start: usize, cancel: &AtomicBool) -> Self {
        let mut scan = Self::default();
        let mut lexer = Lexer::new(text, start);
        // Minuses since the last operand, the sum of those before all open parentheses, and those
        // before each of them.
        let (mut minuses, mut outside, mut open) = (0, 0, Vec::new());
        let mut is_told = false;
        // Number of tokens between two checks for cancellation.
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
            let is_deep = open.len() + outside + minuses > NESTING_LIMIT;
            if is_deep && !is_told {
                scan.deep.push(token.start);
            }
            is_told = is_deep;
        }
        scan.find_carriage_returns(text, id, start);
        scan
    }

    /// Adds carriage returns that end no line, including those in comments: other programs show
    /// what follows one as a new line, which the comment would hide.
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

    /// Adds a place where the text can be split, unless it is near the previous one.
    fn add_split_point(&mut self, place: usize) {
        if self
            .split_points
            .last()
            .is_none_or(|&last| place >= last + SPLIT_SPACING_BYTES)
        {
            self.split_points.push(place);
        }
    }

    /// Returns whether the text has no unclosed comment, no value that nests too deep and no odd
    /// white space.
    pub fn is_plain(&self, text: &str) -> bool {
        self.open_comment(text).is_none() && self.deep.is_empty() && self.odd_spaces.is_empty()
    }

    /// Returns the `/*` of an unclosed comment. It extends to the end of the text, so it is the
    /// last one.
    fn open_comment(&self, text: &str) -> Option<Span> {
        let last = self.comments.last()?;
        let inner = text.get(last.range())?.strip_prefix("/*")?;
        (!inner.ends_with("*/")).then(|| Span::new(last.source, last.start, last.start + 2))
    }

    /// Adds the comments and the problems of the scan to the result of parsing.
    pub fn report(self, text: &str, parsed: &mut Parsed<'_>) {
        self.report_odd_spaces(text, &mut parsed.problems);
        // What a comment hides is missing only because of the carriage return.
        let hides = |place: &Span| text[place.start..].starts_with('\r');
        parsed.is_cut |= self.odd_spaces.iter().any(hides);
        if let Some(open) = self.open_comment(text) {
            // What the comment hides is not a second mistake.
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

    /// Reports each kind of character once, at its first place.
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
            // Words that an invisible character without width separates may be one word or two.
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
            // Characters without width are usually not meant to separate words.
            if !has_width {
                let applicability = Applicability::safe_if(is_safe);
                let away = all("take it away", "").with_applicability(applicability);
                found.fixes.insert(0, away);
            }
            if self.odd_spaces.len() == MOST_PROBLEMS {
                // There may be others.
                found.fixes.clear();
            }
            problems.push(found);
        }
    }
}

/// Returns the name of an invisible character.
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
