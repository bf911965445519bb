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
    /// The end of a line, which goes on here.
    Line,
    /// The end of a line; an element of a list, or a comment beside it, starts here. The number counts the lists around that
    /// have an element a line.
    Element(usize),
    /// The end of a line; the `)` of a list that has an element a line stands here. The number counts as for its elements.
    Close(usize),
}

impl Before {
    /// Whether a line has to end before the word.
    pub fn is_line_end(self) -> bool {
        matches!(self, Self::Line | Self::Element(_) | Self::Close(_))
    }
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
    /// Where the comments start that end a line or start one.
    breaking: Vec<usize>,
    at: usize,
}

impl<'a, 's> Reader<'a, 's> {
    /// Starts at the beginning of a text with these comments.
    pub fn new(source: &'s Source, comments: &'a [Span]) -> Self {
        Self {
            text: source.text(),
            comments: comments.iter(),
            breaking: breaking(source.text(), comments),
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
        self.nested(value, before, Depth::default(), words);
    }

    fn nested(
        &mut self,
        value: &Value<'_>,
        before: Before,
        depth: Depth,
        words: &mut Vec<Word<'s>>,
    ) {
        match &value.kind {
            ValueKind::Call(call) => {
                self.token(call.function.span, before, words);
                let elements = call.arguments.iter().map(of_list);
                self.list(call.parentheses, elements, Before::Nothing, depth, words);
            }
            ValueKind::Parentheses(inner) => {
                let element = std::iter::once((&**inner, None));
                self.list(value.span, element, before, depth, words);
            }
            ValueKind::Tuple(elements) => {
                let elements = elements.iter().map(of_list);
                self.list(value.span, elements, before, depth, words);
            }
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
                    self.token(step.sign, Before::Fold(depth.parentheses + tight), words);
                    self.nested(&step.operand, Before::Space, depth, words);
                }
            }
            _ => self.token(value.span, before, words),
        }
    }

    /// Adds a list in its parentheses, with an element a line if there is a comment in it that ends a line or starts one.
    fn list<'v>(
        &mut self,
        parentheses: Span,
        elements: impl Iterator<Item = (&'v Value<'v>, Option<Span>)>,
        before: Before,
        mut depth: Depth,
        words: &mut Vec<Word<'s>>,
    ) {
        let (open, close) = ends(parentheses);
        self.token(open, before, words);
        let is_open = self.is_broken(parentheses);
        depth.parentheses += 2;
        depth.open += usize::from(is_open);
        let mut before = Before::Nothing;
        for (value, comma) in elements {
            // Behind a comma on a new line its element follows.
            if is_open && (before != Before::Space || self.has_comment(value.span.start)) {
                before = self.beside_elements(value.span.start, depth.open, words);
            }
            self.nested(value, before, depth, words);
            before = Before::Fold(depth.parentheses);
            if let Some(comma) = comma {
                self.token(comma, Before::Nothing, words);
            }
            // A comment to the end of the line put the comma on the next one.
            if let Some(comma) = words.last_mut()
                && comma.before == Before::Line
                && comma.text == ","
            {
                comma.before = Before::Element(depth.open);
                before = Before::Space;
            }
        }
        match is_open {
            true => {
                self.beside_elements(close.start, depth.open, words);
                self.token(close, Before::Close(depth.open), words);
            }
            false => self.token(close, Before::Nothing, words),
        }
    }

    /// Adds the comments between two elements of a list that has an element a line, or beside its parentheses: those on the
    /// line of what came before to its end, the others on lines of their own. Answers what has to stand before what follows,
    /// which may be on the line of the last one.
    fn beside_elements(&mut self, to: usize, open: usize, words: &mut Vec<Word<'s>>) -> Before {
        let gap = self.gap(to);
        let closes = self
            .text
            .get(to..)
            .is_some_and(|text| text.starts_with(')'));
        let is_broken = gap.breaks > 0 || gap.comments.iter().any(|comment| comment.breaks > 0);
        let mut joins = closes || is_broken;
        let mut before = Before::Element(open);
        for comment in &gap.comments {
            joins &= comment.breaks == 0;
            if comment.breaks > 0 {
                before = Before::Element(open);
            }
            words.push(Word {
                text: comment.text,
                before: if joins { Before::Space } else { before },
            });
            if !joins {
                before = Before::Space;
            }
        }
        match gap.breaks {
            0 => before,
            _ => Before::Element(open),
        }
    }

    /// Whether the next comment stands before an offset.
    fn has_comment(&self, to: usize) -> bool {
        let next = self.comments.as_slice().first();
        next.is_some_and(|comment| comment.start < to)
    }

    /// Whether there is a comment between parentheses that ends a line or starts one.
    fn is_broken(&self, parentheses: Span) -> bool {
        let next = self.breaking.partition_point(|&at| at < parentheses.start);
        let next = self.breaking.get(next);
        next.is_some_and(|&at| at < parentheses.end)
    }
}

/// How deep a value lies.
#[derive(Clone, Copy, Debug, Default)]
struct Depth {
    /// Twice the parentheses around it.
    parentheses: usize,
    /// The lists around it that have an element a line.
    open: usize,
}

fn of_list<'v>(element: &'v Element<'v>) -> (&'v Value<'v>, Option<Span>) {
    (&element.value, element.comma)
}

/// Where the comments start that end a line or start one.
fn breaking(text: &str, comments: &[Span]) -> Vec<usize> {
    let breaks = |comment: &&Span| {
        let before = text.get(..comment.start).unwrap_or_default();
        let gap = before.len() - before.trim_end().len();
        let starts = before.get(before.len() - gap..).unwrap_or_default();
        starts.contains('\n') || text.get(comment.range()).is_some_and(ends_line)
    };
    comments.iter().filter(breaks).map(|c| c.start).collect()
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
    let ends = |word: &Word<'_>| word.before.is_line_end() || word.text.contains('\n');
    words.iter().any(ends)
}
