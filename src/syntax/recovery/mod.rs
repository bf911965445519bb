//! Reads an item that does not follow the grammar.
//!
//! In: the text from the item's start. Out: nodes of what can be understood, and one problem for each slip. A reader by
//! recursive descent over the lexer's tokens: items stand in `items`, fields in `fields`, values in `values`, numbers in
//! `numbers`. Where something fits nowhere, reading goes on at the next field, line or closing brace. A right item is read
//! as pest reads it.

mod fields;
mod items;
mod numbers;
mod values;

use super::{
    Problem,
    messages::{foreign_file, foreign_statement, shorten},
    tokens::{Lexer, Token, TokenKind, line_end},
    tree::{Item, Name, Value, bad},
    words::Words,
};
use crate::{
    schema::Type,
    source::{SourceId, Span},
};

/// The reader.
pub struct Recovery<'w, 's> {
    pub(super) text: &'s str,
    pub(super) id: SourceId,
    words: &'w Words<'s>,
    lexer: Lexer<'s>,
    /// Tokens that were looked at, without comments and what cannot be seen.
    tokens: Vec<Token>,
    /// The next of them.
    next: usize,
    /// Where the token ends that was taken last.
    last_end: usize,
    /// The items so far, those that pest read among them.
    pub(super) items: Vec<Item<'s>>,
    /// What was wrong so far.
    pub(super) problems: Vec<Problem>,
    /// Comments of other languages.
    pub(super) comments: Vec<Span>,
    /// Where a mistake took the rest of the text.
    pub(super) cut: Option<usize>,
    /// Where the item ended that was read here last.
    pub(super) read_to: usize,
    /// What the items that are read stand in.
    within: Within<'s>,
    /// Where the sign stands that was read last in front of a value.
    prefix: usize,
    /// Parentheses, signs and calls around what is read.
    depth: usize,
    /// Lists around what is read.
    open: usize,
    /// Blocks around what is read.
    blocks: usize,
    /// Whether the value nests too deep, so that the rest of it was passed over.
    too_deep: bool,
    /// What separators between items were reported, by their problem.
    item_separators: Vec<(&'s str, usize)>,
}

/// How much was read.
pub struct Mark {
    items: usize,
    problems: usize,
    comments: usize,
    read_to: usize,
}

/// The block, if it is one, that is read.
#[derive(Default)]
struct Within<'s> {
    kind: &'s str,
    /// The field whose value is read; none within a list.
    field: &'s str,
    takes: Option<Type>,
    /// What slips of one kind were reported in the block, by their problem: one report stands for all.
    slips: Vec<(&'s str, usize)>,
    is_block: bool,
}

/// What may stand in a place: what starts a comment differs.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Place {
    /// An item or a field.
    Start,
    /// A value.
    Value,
    /// An operator, or what follows a value.
    Operator,
}

impl<'w, 's> Recovery<'w, 's> {
    /// Reads this text.
    pub fn new(text: &'s str, id: SourceId, words: &'w Words<'s>) -> Self {
        Self {
            text,
            id,
            words,
            lexer: Lexer::new(text, 0),
            tokens: Vec::new(),
            next: 0,
            last_end: 0,
            items: Vec::new(),
            problems: Vec::new(),
            comments: Vec::new(),
            cut: None,
            read_to: 0,
            within: Within::default(),
            prefix: usize::MAX,
            depth: 0,
            blocks: 0,
            open: 0,
            too_deep: false,
            item_separators: Vec::new(),
        }
    }

    /// Reads one item, or what stands in the place of one; answers where it ends.
    pub fn item(&mut self, start: usize) -> usize {
        if self.read_to == 0
            && let Some(what) = foreign_file(self.text)
        {
            let first = Lexer::past_comments(self.text, 0);
            self.items.clear();
            self.problems.push(Problem::ForeignFile {
                what,
                span: self.span_of(first),
            });
            self.cut = Some(0);
            self.read_to = self.text.len();
            return self.read_to;
        }
        self.seek(start);
        self.last_end = start;
        self.any_item();
        if self.last_end == start && self.comment_end() <= start {
            self.bump();
        }
        self.read_to = self.last_end.max(self.comment_end());
        self.read_to
    }

    /// What was read so far.
    pub fn mark(&self) -> Mark {
        Mark {
            items: self.items.len(),
            problems: self.problems.len(),
            comments: self.comments.len(),
            read_to: self.read_to,
        }
    }

    /// Forgets what was read since.
    pub fn go_back(&mut self, mark: Mark) {
        self.items.truncate(mark.items);
        self.problems.truncate(mark.problems);
        self.comments.truncate(mark.comments);
        self.read_to = mark.read_to;
    }

    /// Whether what was read since explains a text that follows the grammar better: by fields that the block has, or by a
    /// comment or a function of another language.
    pub fn is_better(&self, mark: &Mark) -> bool {
        let items = self.items.get(mark.items..).unwrap_or_default();
        let problems = self.problems.get(mark.problems..).unwrap_or_default();
        let is_foreign = |problem: &Problem| {
            matches!(
                problem,
                Problem::ForeignComment { .. } | Problem::ForeignFunction { .. }
            )
        };
        match items {
            [Item::Block(block)] => block.fields.iter().all(|field| {
                let kind = block.kind.map_or("", |kind| kind.text);
                let name = field.name.text;
                self.words.takes(kind, name).is_some() || name.contains(char::is_whitespace)
            }),
            [Item::Definition(_)] => !problems.is_empty() && problems.iter().all(is_foreign),
            _ => false,
        }
    }

    /// Reads the text from an offset on as one value.
    pub fn whole_value(&mut self, start: usize) -> Value<'s> {
        self.seek(start);
        self.last_end = start;
        if self.peek(0).kind == TokenKind::End {
            let span = Span::new(self.id, start.saturating_sub(1), start);
            self.problems.push(Problem::SetWithoutValue { span });
            return bad(Span::new(self.id, start, start));
        }
        let value = self.value_of_definition();
        if self.peek(0).kind != TokenKind::End && value.kind != super::tree::ValueKind::Bad {
            self.unexpected("the end of the value", "write one value behind the `=`");
            return bad(value.span);
        }
        value
    }

    // Tokens.

    /// The token that is so many behind the next one.
    fn peek(&mut self, ahead: usize) -> Token {
        while self.tokens.len() <= self.next + ahead {
            let token = self.lexer.token();
            let is_seen = !matches!(
                token.kind,
                TokenKind::Comment | TokenKind::OpenComment | TokenKind::OddSpace
            );
            if is_seen {
                self.tokens.push(token);
            }
        }
        self.tokens
            .get(self.next + ahead)
            .copied()
            .unwrap_or(Token {
                kind: TokenKind::End,
                start: self.text.len(),
                end: self.text.len(),
            })
    }

    fn kind(&mut self, ahead: usize) -> TokenKind {
        self.peek(ahead).kind
    }

    /// The text of a token ahead.
    fn word(&mut self, ahead: usize) -> &'s str {
        let token = self.peek(ahead);
        self.text.get(token.start..token.end).unwrap_or_default()
    }

    /// The same of a token that was looked at already.
    fn word_seen(&self, ahead: usize) -> &'s str {
        let token = self.tokens.get(self.next + ahead);
        let range = token.map_or(0..0, |token| token.start..token.end);
        self.text.get(range).unwrap_or_default()
    }

    fn is(&mut self, ahead: usize, word: &str) -> bool {
        self.word(ahead) == word && self.kind(ahead) != TokenKind::End
    }

    fn is_name(&mut self, ahead: usize) -> bool {
        self.kind(ahead) == TokenKind::Name && !self.is(ahead, "let")
    }

    /// Whether a line ends before a token ahead.
    fn is_on_new_line(&mut self, ahead: usize) -> bool {
        let token = self.peek(ahead);
        let before = match ahead {
            0 => self.last_end,
            _ => self.peek(ahead - 1).end,
        };
        let between = self.text.get(before..token.start).unwrap_or_default();
        token.kind == TokenKind::End || between.contains('\n')
    }

    /// Whether a token ahead stands right behind the one before it.
    fn is_adjacent(&mut self, ahead: usize) -> bool {
        let before = match ahead {
            0 => self.last_end,
            _ => self.peek(ahead - 1).end,
        };
        self.peek(ahead).start == before
    }

    /// Takes the next token.
    fn bump(&mut self) -> Span {
        let token = self.peek(0);
        if token.kind != TokenKind::End {
            self.next += 1;
            self.last_end = token.end;
        }
        self.span_of(token)
    }

    /// Goes on reading at an offset.
    fn seek(&mut self, at: usize) {
        self.tokens.clear();
        self.next = 0;
        self.lexer = Lexer::new(self.text, at);
    }

    fn span_of(&self, token: Token) -> Span {
        Span::new(self.id, token.start, token.end)
    }

    fn here(&mut self) -> Span {
        let token = self.peek(0);
        self.span_of(token)
    }

    fn written(&self, span: Span) -> &'s str {
        self.text.get(span.range()).unwrap_or_default()
    }

    fn short(&self, span: Span) -> String {
        shorten(self.written(span))
    }

    fn name(&mut self) -> Name<'s> {
        let text = self.word(0);
        let span = self.bump();
        Name { text, span }
    }

    fn end_of_text(&self) -> Span {
        Span::new(self.id, self.last_end, self.last_end)
    }

    /// Passes over the rest of the line, but not over a brace.
    fn skip_line(&mut self) {
        loop {
            if self.is_on_new_line(0) || self.is(0, "{") || self.is(0, "}") {
                return;
            }
            self.bump();
        }
    }

    /// Whether a block starts at a token ahead: `sphere {` or `sphere Ball {`.
    fn is_head(&mut self, ahead: usize) -> bool {
        self.is_name(ahead)
            && (self.is(ahead + 1, "{") || (self.is_name(ahead + 1) && self.is(ahead + 2, "{")))
    }

    fn unexpected(&mut self, expected: &'static str, help: &'static str) {
        let span = self.here();
        let written = match self.written(span) {
            "" => "the end of the file".to_owned(),
            written => shorten(written),
        };
        self.problems.push(Problem::Unexpected {
            expected,
            written,
            help,
            span,
        });
    }

    // Comments of other languages.

    /// Passes over comments of other languages.
    fn comments(&mut self, place: Place) {
        while self.starts_comment(place) {
            self.foreign_comment();
        }
    }

    fn starts_comment(&mut self, place: Place) -> bool {
        let word = self.word(0);
        let is_blank_behind = !self.is_adjacent(1);
        if word.starts_with('#') {
            let digits = word.trim_start_matches('#');
            let is_color = matches!(digits.len(), 3 | 6)
                && digits.bytes().all(|digit| digit.is_ascii_hexdigit());
            return match place {
                Place::Start => foreign_statement(word).is_none(),
                Place::Operator => !(is_color && self.open > 0),
                Place::Value => word == "#" && !self.is_on_new_line(1) && self.is_remark(),
            };
        }
        let is_dashed = word == "-" && self.is(1, "-") && !is_blank_behind;
        is_dashed
            && match place {
                Place::Start => true,
                Place::Operator => {
                    let name = self.word(2);
                    self.is_name(2)
                        && !self.is_adjacent(2)
                        && !self.is_on_new_line(2)
                        && !self.is(3, "(")
                        && !self.words.is_value(name)
                }
                Place::Value => false,
            }
    }

    /// Whether words follow a `#` that stands in place of a value, rather than the digits or the name of a colour.
    fn is_remark(&mut self) -> bool {
        if self.is(1, "#") {
            return true;
        }
        let word = self.word(1);
        let is_digits =
            matches!(word.len(), 3 | 6) && word.bytes().all(|digit| digit.is_ascii_hexdigit());
        let is_name = self.is_name(1);
        let is_lone_color = is_name && self.words.is_color(word) && !self.is_on_new_line(2);
        is_name && !is_digits && !is_lone_color
    }

    /// One report for comments in lines that follow each other without anything between.
    fn foreign_comment(&mut self) {
        let token = self.peek(0);
        let first = self.word(0).chars().next().unwrap_or('#');
        let rest = self.text.get(token.start..).unwrap_or_default();
        let length = rest.len() - rest.trim_start_matches(first).len();
        let sign = Span::new(self.id, token.start, token.start + length);
        let end = line_end(self.text, token.start);
        let before = self.comment_end();
        let gap = self.text.get(before..token.start).unwrap_or("-");
        match self.problems.last_mut() {
            Some(Problem::ForeignComment { places, .. }) if gap.trim().is_empty() => {
                places.push(sign);
            }
            _ => {
                let words = self.text.get(sign.end..end).unwrap_or_default();
                // The comment may have taken the block's end.
                let is_sure = !(self.within.is_block && words.contains('}'));
                self.problems.push(Problem::ForeignComment {
                    is_sure,
                    sign: self.short(sign),
                    right: shorten(&format!("//{words}")),
                    span: sign,
                    places: vec![sign],
                });
            }
        }
        self.comments.push(Span::new(self.id, token.start, end));
        self.seek(end);
    }

    fn comment_end(&self) -> usize {
        self.comments.last().map_or(0, |comment| comment.end)
    }
}
