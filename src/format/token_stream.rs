//! Reads tokens and comments in order, with the white space that may precede each of them.
//!
//! The places of the tokens come from the syntax tree, and the line ends from the text.

use crate::{
    source::{Source, Span},
    syntax::tree::{Value, ValueKind},
};

/// A token or a comment.
#[derive(Clone, Copy, Debug)]
pub struct Word<'s> {
    /// The text of the token or comment.
    pub text: &'s str,
    /// The white space before the token or comment.
    pub before: Before,
}

/// White space before a token or a comment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Before {
    /// No white space.
    Nothing,
    /// One blank.
    Space,
    /// A blank, or a line end if the line would be too long. A line that is too long is broken
    /// before a token with the lowest number. The number is twice the depth of parentheses around
    /// the token. For the operator of a product, it is greater by 1, so that a line is broken at
    /// the operator of a sum first.
    Fold(usize),
    /// A line end.
    Line,
}

/// A comment in a gap between two tokens.
#[derive(Clone, Copy, Debug)]
pub struct Comment<'s> {
    /// The text of the comment.
    pub text: &'s str,
    /// Number of line ends before the comment, at most 2.
    pub breaks: usize,
}

/// Returns whether `text` is a `//` comment, after which the line must end.
pub fn ends_line(text: &str) -> bool {
    text.starts_with("//")
}

/// Returns whether a text is a comment.
pub fn is_comment(text: &str) -> bool {
    text.starts_with("//") || text.starts_with("/*")
}

/// The comments and line ends between two tokens.
#[derive(Debug)]
pub struct Gap<'s> {
    /// The comments.
    pub comments: Vec<Comment<'s>>,
    /// Number of line ends after the last comment, at most 2.
    pub breaks: usize,
}

/// Reader of a text's tokens and the comments between them.
pub struct TokenReader<'a, 's> {
    text: &'s str,
    comments: std::slice::Iter<'a, Span>,
    at: usize,
}

impl<'a, 's> TokenReader<'a, 's> {
    /// Makes a reader that starts at the beginning of a text, after its byte order mark.
    pub fn new(source: &'s Source, comments: &'a [Span]) -> Self {
        Self {
            text: source.text(),
            comments: comments.iter(),
            at: source.bom_len(),
        }
    }

    /// Moves to the offset `to`. Returns the comments and line ends between the old offset and
    /// `to`.
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

    /// Moves to the end of `token`.
    pub fn skip(&mut self, token: Span) {
        self.at = token.end;
    }

    /// Returns whether there is a line end between two offsets.
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

    /// Adds the comments before the token at the offset `to` to `words`. A comment that started a
    /// line also starts a line in the layout. Returns the white space that must precede the token.
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

    /// Adds the comments before the token `span`, and the token itself, to `words`.
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

    /// Adds the tokens and comments of a value to `words`. The value is inside of `depth`
    /// parentheses.
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
                    // A line is broken at the operator with the lowest number. The operator of a
                    // product gets a greater number, so a line is broken in a sum first.
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

/// Maximum width of a line, in characters, as the language's reference states it. Longer lines are
/// broken if there are tokens before which they can be broken. The width is measured before
/// alignment and without the comments at the line's end.
pub const WIDTH: usize = 100;

/// Returns the width, in characters, of the tokens and comments `words` on one line. If one of them
/// is a comment of several lines, the width is that of the last line.
pub fn width(words: &[Word<'_>]) -> usize {
    words.iter().fold(0, |width, word| {
        let blank = usize::from(word.before != Before::Nothing);
        column_after(width + blank, word.text)
    })
}

/// Returns the column after a text that starts at `column`; columns count characters from 0.
pub fn column_after(column: usize, text: &str) -> usize {
    match text.rsplit_once('\n') {
        Some((_, last)) => last.chars().count(),
        None => column + text.chars().count(),
    }
}

/// Returns whether the tokens and comments `words` need several lines: one of them contains a line
/// end or must start a new line.
pub fn has_line_end(words: &[Word<'_>]) -> bool {
    let ends = |word: &Word<'_>| word.before == Before::Line || word.text.contains('\n');
    words.iter().any(ends)
}
