//! Tokens and comments in their order, with what may stand before each.
//!
//! The tree says what a token is, the text says where lines end.

use crate::{
    source::{Source, Span},
    syntax::tree::{Value, ValueKind},
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
    /// A blank, or a line's end if the line would be too long; the lowest number breaks first. It
    /// grows with the parentheses around the word, and with the tightness of the operator.
    Fold(usize),
    /// The end of a line, which goes on here.
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

/// Whether this is a comment.
pub fn is_comment(text: &str) -> bool {
    text.starts_with("//") || text.starts_with("/*")
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

    /// Adds the comments before a token; a comment that started a line does so still. Answers what
    /// has to stand before the token.
    pub fn comments(&mut self, to: usize, before: Before, words: &mut Vec<Word<'s>>) -> Before {
        let gap = self.gap(to);
        for comment in &gap.comments {
            let opened = words.last().is_some_and(|word| word.text == "(");
            let before = match comment.breaks {
                0 if opened && !ends_line(comment.text) => Before::Nothing,
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

    /// Adds a value with so many parentheses around it.
    pub fn value(
        &mut self,
        value: &Value<'_>,
        before: Before,
        depth: usize,
        words: &mut Vec<Word<'s>>,
    ) {
        match &value.kind {
            ValueKind::Call(call) => {
                self.token(call.function.span, before, words);
                let elements = call.arguments.iter().map(|e| (&e.value, e.comma));
                self.list(call.parentheses, elements, Before::Nothing, depth, words);
            }
            ValueKind::Parentheses(inner) => {
                let element = std::iter::once((&**inner, None));
                self.list(value.span, element, before, depth, words);
            }
            ValueKind::Tuple(elements) => {
                let elements = elements.iter().map(|e| (&e.value, e.comma));
                self.list(value.span, elements, before, depth, words);
            }
            ValueKind::Negation { sign, operand } => {
                self.token(*sign, before, words);
                self.value(operand, Before::Nothing, depth, words);
            }
            ValueKind::Chain { first, rest } => {
                self.value(first, before, depth, words);
                for step in rest {
                    // A sum is broken before a product.
                    let tightness = 2 * depth + usize::from(step.operator.is_of_product());
                    self.token(step.sign, Before::Fold(tightness), words);
                    self.value(&step.operand, Before::Space, depth, words);
                }
            }
            _ => self.token(value.span, before, words),
        }
    }

    fn list<'v>(
        &mut self,
        parentheses: Span,
        elements: impl Iterator<Item = (&'v Value<'v>, Option<Span>)>,
        before: Before,
        depth: usize,
        words: &mut Vec<Word<'s>>,
    ) {
        let Span { source, start, end } = parentheses;
        self.token(Span::new(source, start, start + 1), before, words);
        let mut before = Before::Nothing;
        for (value, comma) in elements {
            self.value(value, before, depth + 1, words);
            before = Before::Fold(2 * (depth + 1));
            if let Some(comma) = comma {
                self.token(comma, Before::Nothing, words);
            }
        }
        self.token(Span::new(source, end - 1, end), Before::Nothing, words);
    }
}

/// A line gets no longer than this, as far as there are places to break it. What stands in columns
/// is measured before it is aligned, and comments at the end of a line do not count.
pub const WIDTH: usize = 100;

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
