//! Tokens and comments in their order, with what may stand before each.
//!
//! The tree says what a token is, the text says where lines end.

use crate::{
    source::{Source, Span},
    syntax::tree::{Element, Operator, Value, ValueKind},
};

/// A token or a comment.
#[derive(Clone, Copy, Debug)]
pub struct Word<'s> {
    /// Its text.
    pub text: &'s str,
    /// What stands before it.
    pub before: Before,
}

/// What stands before a word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Before {
    /// Nothing.
    Nothing,
    /// A blank.
    Space,
    /// A blank; or, where the line would be too long, its end. The less the number, the rather: it grows with the
    /// parentheses around the word, and with the tightness of the operator.
    Fold(usize),
    /// The end of a line.
    Line,
}

/// A comment before a token or an end.
#[derive(Clone, Copy, Debug)]
pub struct Comment<'s> {
    /// Its text.
    pub text: &'s str,
    /// The line ends before it; more than two count as two.
    pub breaks: usize,
}

/// Whether a line ends behind a token or a comment.
pub fn ends_line(text: &str) -> bool {
    text.starts_with("//")
}

/// What stands between two tokens.
#[derive(Debug)]
pub struct Gap<'s> {
    /// The comments.
    pub comments: Vec<Comment<'s>>,
    /// The line ends behind the last of them.
    pub breaks: usize,
}

/// Walks through a text from token to token.
pub struct Reader<'a, 's> {
    text: &'s str,
    comments: std::slice::Iter<'a, Span>,
    at: usize,
}

impl<'a, 's> Reader<'a, 's> {
    /// Starts at the beginning of a text with these comments.
    pub fn new(source: &'s Source, comments: &'a [Span]) -> Self {
        Self {
            text: source.text(),
            comments: comments.iter(),
            at: source.bom_len(),
        }
    }

    /// Goes on to an offset, over white space and comments.
    pub fn gap(&mut self, to: usize) -> Gap<'s> {
        let mut comments = Vec::new();
        while let Some(comment) = self.comments.as_slice().first()
            && comment.start < to
        {
            comments.push(Comment {
                text: self.under(*comment).trim_end_matches([' ', '\t', '\r']),
                breaks: self.breaks(comment.start),
            });
            self.at = comment.end;
            self.comments.next();
        }
        let breaks = self.breaks(to);
        self.at = to;
        Gap { comments, breaks }
    }

    /// Goes on over a token.
    pub fn skip(&mut self, token: Span) {
        self.at = token.end;
    }

    /// Whether a line ends between two offsets.
    pub fn has_line_end(&self, from: usize, to: usize) -> bool {
        self.text.get(from..to).unwrap_or_default().contains('\n')
    }

    fn breaks(&self, to: usize) -> usize {
        let between = self.text.get(self.at..to).unwrap_or_default();
        between
            .bytes()
            .filter(|&byte| byte == b'\n')
            .take(2)
            .count()
    }

    fn under(&self, span: Span) -> &'s str {
        self.text.get(span.range()).unwrap_or_default()
    }

    /// Adds the comments before a token; a comment that started a line does so still. Answers what has to stand before the
    /// token.
    pub fn comments(&mut self, to: usize, before: Before, words: &mut Vec<Word<'s>>) -> Before {
        let gap = self.gap(to);
        for comment in &gap.comments {
            let opened = words.last().is_some_and(|word| word.text == "(");
            let before = match comment.breaks {
                0 if opened => Before::Nothing,
                0 => Before::Space,
                _ => Before::Line,
            };
            words.push(Word {
                text: comment.text,
                before,
            });
        }
        match (gap.comments.last(), before) {
            (Some(last), _) if ends_line(last.text) => Before::Line,
            (Some(_), Before::Nothing) => Before::Space,
            _ => before,
        }
    }

    /// Adds a token and the comments before it.
    pub fn token(&mut self, span: Span, before: Before, words: &mut Vec<Word<'s>>) {
        let text = self.under(span);
        let mut behind = self.comments(span.start, before, words);
        if behind == Before::Space && before == Before::Nothing && matches!(text, "," | ")") {
            behind = Before::Nothing;
        }
        words.push(Word {
            text,
            before: behind,
        });
        self.skip(span);
    }

    /// Adds a value.
    pub fn value(&mut self, value: &Value<'_>, before: Before, words: &mut Vec<Word<'s>>) {
        self.nested(value, before, 0, words);
    }

    fn nested(
        &mut self,
        value: &Value<'_>,
        before: Before,
        depth: usize,
        words: &mut Vec<Word<'s>>,
    ) {
        match &value.kind {
            ValueKind::Call(call) => {
                self.token(call.function.span, before, words);
                self.list(
                    call.parentheses,
                    &call.arguments,
                    Before::Nothing,
                    depth,
                    words,
                );
            }
            ValueKind::Parentheses(inner) => {
                let (open, close) = ends(value.span);
                self.token(open, before, words);
                self.nested(inner, Before::Nothing, depth + 2, words);
                self.token(close, Before::Nothing, words);
            }
            ValueKind::Tuple(elements) => self.list(value.span, elements, before, depth, words),
            ValueKind::Negation { sign, operand } => {
                self.token(*sign, before, words);
                self.nested(operand, Before::Nothing, depth, words);
            }
            ValueKind::Chain { first, rest } => {
                self.nested(first, before, depth, words);
                for step in rest {
                    let tight = match step.operator {
                        Operator::Add | Operator::Subtract => 0,
                        Operator::Multiply | Operator::Divide => 1,
                    };
                    self.token(step.sign, Before::Fold(depth + tight), words);
                    self.nested(&step.operand, Before::Space, depth, words);
                }
            }
            _ => self.token(value.span, before, words),
        }
    }

    fn list(
        &mut self,
        parentheses: Span,
        elements: &[Element<'_>],
        before: Before,
        depth: usize,
        words: &mut Vec<Word<'s>>,
    ) {
        let (open, close) = ends(parentheses);
        self.token(open, before, words);
        let mut before = Before::Nothing;
        for element in elements {
            self.nested(&element.value, before, depth + 2, words);
            if let Some(comma) = element.comma {
                self.token(comma, Before::Nothing, words);
            }
            before = Before::Fold(depth + 2);
        }
        self.token(close, Before::Nothing, words);
    }
}

fn ends(span: Span) -> (Span, Span) {
    (
        Span::new(span.source, span.start, span.start + 1),
        Span::new(span.source, span.end - 1, span.end),
    )
}

/// How wide words are on one line; of a comment with several lines, the last one counts.
pub fn width(words: &[Word<'_>]) -> usize {
    words.iter().fold(0, |width, word| {
        let blank = usize::from(word.before != Before::Nothing);
        column_after(width + blank, word.text)
    })
}

/// Where a line stands after a text that starts in a column.
pub fn column_after(column: usize, text: &str) -> usize {
    match text.rsplit_once('\n') {
        Some((_, last)) => last.chars().count(),
        None => column + text.chars().count(),
    }
}

/// Whether words take more than one line.
pub fn has_line_end(words: &[Word<'_>]) -> bool {
    let ends = |word: &Word<'_>| word.before == Before::Line || word.text.contains('\n');
    words.iter().any(ends)
}
