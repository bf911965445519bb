//! What must be known of a text before it is parsed.
//!
//! In: a text. Out: its comments, where it can be taken apart, the characters that cannot be seen,
//! and where it may nest too deep for pest. One walk of the lexer, without recursion.

use std::{collections::BTreeMap, sync::atomic::AtomicBool};

use super::{
    NESTING_LIMIT, Parsed, messages as say,
    problem::times,
    tokens::{Lexer, TokenKind},
};
use crate::{
    cancel,
    diagnostic::{Applicability, Diagnostic, Edit, Fix, MOST_PROBLEMS},
    source::{SourceId, Span},
};

/// Of the places where a text can be taken apart, those are kept that are so many bytes apart: a
/// small part of what is parsed at a time.
const SPACING: usize = 256;

/// What the walk finds.
#[derive(Debug, Default)]
pub struct Scan {
    /// Every comment.
    comments: Vec<Span>,
    /// Where more parentheses and minuses are open than a value may have. A minus between two
    /// values counts, too: recovery, which reads these items, counts exactly.
    pub deep: Vec<usize>,
    /// Where a right text can be taken apart: behind a `}` or before a `let`, at most one place in
    /// [`SPACING`] bytes.
    pub ends: Vec<usize>,
    /// Characters that cannot be seen and are no white space of the language, and carriage returns
    /// that end no line.
    odd_spaces: Vec<Span>,
}

impl Scan {
    /// Walks a text from an offset on. Cancelled, it stops on the way.
    pub fn of(text: &str, id: SourceId, start: usize, cancel: &AtomicBool) -> Self {
        let mut scan = Self::default();
        let mut lexer = Lexer::new(text, start);
        // The minuses since the last operand, and those before every open parenthesis.
        let (mut minuses, mut outside, mut open) = (0, 0, Vec::new());
        let mut is_told = false;
        // So many tokens are read before anybody is asked whether that is still wanted.
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
                            scan.may_end(token.end);
                        }
                    }
                    _ => {}
                },
                TokenKind::Name => {
                    if text.get(token.start..token.end) == Some("let") {
                        scan.may_end(token.start);
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

    /// Notes carriage returns that end no line, also those in comments: there they would take the
    /// lines along that other programs show below them.
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

    /// Notes where the text can be taken apart, unless it is close behind the last such place.
    fn may_end(&mut self, place: usize) {
        if self.ends.last().is_none_or(|&last| place >= last + SPACING) {
            self.ends.push(place);
        }
    }

    /// Whether the text has no comment that is never closed, no value that nests too deep and no
    /// odd white space.
    pub fn is_plain(&self, text: &str) -> bool {
        self.open_comment(text).is_none() && self.deep.is_empty() && self.odd_spaces.is_empty()
    }

    /// The `/*` of the comment that has no `*/`: it takes all of the text, and so it is the last.
    fn open_comment(&self, text: &str) -> Option<Span> {
        let last = self.comments.last()?;
        let inner = text.get(last.range())?.strip_prefix("/*")?;
        (!inner.ends_with("*/")).then(|| Span::new(last.source, last.start, last.start + 2))
    }

    /// Adds comments and problems to what was parsed.
    pub fn report(self, text: &str, parsed: &mut Parsed<'_>) {
        self.report_odd_spaces(text, &mut parsed.problems);
        // What a comment took is missing only because of that.
        let hides = |place: &Span| text[place.start..].starts_with('\r');
        parsed.is_cut |= self.odd_spaces.iter().any(hides);
        if let Some(open) = self.open_comment(text) {
            // What the comment took is no second mistake.
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

    /// One report for each sort of character, at the first one.
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
            // Words with one between them that has no width may be one or two.
            let has_width = sort.chars().all(char::is_whitespace);
            let joins = |place: &Span| !Edit::remove_in(*place, text).text.is_empty();
            let is_safe = has_width || !places.iter().any(joins);
            let times = times(places.len() - 1);
            let mut found = if sort == "\r" {
                say::CARRIAGE_RETURN.at(at, &[&times], all("write line feeds", "\n"))
            } else {
                let words = [&name_of_space(sort), times.as_str()];
                let said = say::ODD_SPACE.safe_if(is_safe);
                said.at(at, &words, all("write plain spaces", " "))
            };
            // What has no width, as a rule, is not meant to keep words apart.
            if !has_width {
                let applicability = Applicability::safe_if(is_safe);
                let away = all("take it away", "").being(applicability);
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

/// What a character that cannot be seen is called.
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
