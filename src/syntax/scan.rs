//! What must be known of a text before it is parsed.
//!
//! In: a text. Out: its comments, where it can be taken apart, the characters that cannot be seen, and where it may nest too deep for pest.
//! One walk of the lexer, without recursion.

use std::{collections::BTreeMap, ops::Range, sync::atomic::AtomicBool};

use miette::Diagnostic as _;

use super::{
    NESTING_LIMIT, Parsed, Problem,
    messages::name_of_space,
    tokens::{Lexer, TokenKind},
};
use crate::{
    cancel,
    source::{SourceId, Span},
};

/// What the walk finds.
#[derive(Debug, Default)]
pub struct Scan {
    /// Every comment.
    comments: Vec<Range<usize>>,
    /// Where the comment starts that has no `*/`.
    open_comment: Option<usize>,
    /// Where more parentheses and minuses are open than a value may have. A minus between two values counts, too: recovery,
    /// which reads these items, counts exactly.
    pub deep: Vec<usize>,
    /// Where a right text can be taken apart: behind every `}`, and before every `let`.
    pub ends: Vec<usize>,
    /// Characters that cannot be seen and are no white space of the language.
    odd_spaces: Vec<Range<usize>>,
}

impl Scan {
    /// Walks a text from an offset on. Cancelled, it stops on the way.
    pub fn of(text: &str, start: usize, cancel: &AtomicBool) -> Self {
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
            match token.kind {
                TokenKind::Comment => scan.comments.push(token.start..token.end),
                TokenKind::OpenComment => {
                    scan.comments.push(token.start..token.end);
                    scan.open_comment = Some(token.start);
                }
                TokenKind::OddSpace => scan.odd_spaces.push(token.start..token.end),
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
                            scan.ends.push(token.end);
                        }
                    }
                    _ => {}
                },
                TokenKind::Name => {
                    if text.get(token.start..token.end) == Some("let") {
                        scan.ends.push(token.start);
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
        scan
    }

    /// Whether nothing was found that is a mistake or hides one.
    pub fn is_plain(&self) -> bool {
        self.open_comment.is_none() && self.deep.is_empty() && self.odd_spaces.is_empty()
    }

    /// Adds comments and problems to what was parsed.
    pub fn report(self, text: &str, id: SourceId, parsed: &mut Parsed<'_>) {
        self.report_odd_spaces(text, id, &mut parsed.problems);
        let lone = self.comments.iter().find_map(|comment| {
            let written = text.get(comment.clone())?;
            let line = written
                .starts_with("//")
                .then(|| written.trim_end_matches('\r'))?;
            Some((comment.start, comment.start + line.find('\r')?, comment.end))
        });
        // Where lines end at carriage returns alone, a comment of one line takes all that follows.
        if let Some((start, at, end)) = lone {
            let span = Span::new(id, at, at + 1);
            parsed.problems.push(Problem::LoneReturn { span });
            if end == text.len() {
                parsed.cut = parsed.cut.or(Some(start));
            }
        }
        if let Some(start) = self.open_comment {
            // What the comment took is no second mistake.
            parsed.problems.retain(|problem| {
                !matches!(problem, Problem::UnclosedBlock { .. })
                    && first_label(problem).is_none_or(|end| end < id.start() + start)
            });
            parsed.cut = Some(start);
            let span = Span::new(id, start, start + 2);
            parsed.problems.push(Problem::UnclosedComment { span });
        }
        let comments = self.comments.into_iter();
        let comments = comments.map(|comment| Span::new(id, comment.start, comment.end));
        let foreign = std::mem::take(&mut parsed.comments);
        parsed.comments = comments
            .filter(|comment| !is_within(*comment, &foreign))
            .collect();
        if !foreign.is_empty() {
            parsed.comments.extend(foreign);
            parsed.comments.sort_unstable();
        }
    }

    /// One report for each sort of character, at the first one.
    fn report_odd_spaces(&self, text: &str, id: SourceId, problems: &mut Vec<Problem>) {
        let mut sorts: BTreeMap<&str, Vec<Span>> = BTreeMap::new();
        for place in &self.odd_spaces {
            let sort = text.get(place.clone()).unwrap_or_default();
            let span = Span::new(id, place.start, place.end);
            sorts.entry(sort).or_default().push(span);
        }
        for (sort, places) in sorts {
            if let Some(&span) = places.first() {
                problems.push(Problem::OddSpace {
                    what: name_of_space(sort),
                    more: places.len() - 1,
                    span,
                    places,
                });
            }
        }
    }
}

fn is_within(span: Span, places: &[Span]) -> bool {
    let next = places.partition_point(|place| place.end <= span.start);
    places
        .get(next)
        .is_some_and(|place| place.start <= span.start)
}

/// Where the first label of a problem ends.
fn first_label(problem: &Problem) -> Option<usize> {
    let label = problem.labels()?.next()?;
    Some(label.offset() + label.len())
}
