//! Reads an item that does not follow the grammar.
//!
//! In: the text from the item's start. Out: nodes of what can be understood, and one problem for
//! each slip. A reader by recursive descent over the lexer's tokens: items stand in `items`, fields
//! in `fields`, indices in `repetition`, values in `values`, `joined` and `lists`, numbers in
//! `numbers`, and what other languages write in `foreign`. A right item is read as pest reads it.
//! Three rules:
//!
//! - Where something fits nowhere, reading goes on at the next field, line, item or closing brace
//!   (`resync`).
//! - A fix is offered where it is plain. A value with a slip is bad, as a rule, whether there is a
//!   fix or not, and nothing that uses it is reported.
//! - Where different slips are found in one value, none of their fixes is sure (`settle`).

mod fields;
mod foreign;
mod head;
mod items;
mod joined;
mod lists;
mod names;
mod numbers;
mod repetition;
mod values;

use std::collections::{BTreeMap, VecDeque};

use numbers::unit_of;

use super::{
    Parsed, messages as say,
    problem::{Message, replace, shorten, tell_signs_once, times},
    scan::Scan,
    tokens::{Lexer, Token, TokenKind},
    tree::{Item, Name, Tree, Value, ValueKind, bad},
    vocabulary::Vocabulary,
};
use crate::{
    diagnostic::{Edit, Fix, MOST_PROBLEMS, Problems},
    schema::Type,
    source::{Source, SourceId, Span},
};

/// The reader.
pub struct Recovery<'w, 's> {
    source: &'s Source,
    text: &'s str,
    id: SourceId,
    words: &'w Vocabulary<'s>,
    lexer: Lexer<'s>,
    /// The next tokens, as far as they were looked at, without comments and what cannot be seen.
    tokens: VecDeque<Token>,
    /// Where the token ends that was taken last.
    last_end: usize,
    /// The items so far, those that pest read among them.
    pub(super) items: Vec<Item<'s>>,
    /// What was wrong so far.
    pub(super) problems: Problems,
    /// Whether a mistake took the rest of the text.
    is_cut: bool,
    /// Whether an item was left as it was read for want of a better explanation.
    is_doubtful: bool,
    /// Where the item ended that was read here last.
    pub(super) read_to: usize,
    /// Whether the text was looked at and is no other program's.
    is_ours: bool,
    /// What the items that are read stand in.
    within: Within<'s>,
    /// Parentheses, signs and calls around what is read.
    depth: usize,
    /// Lists around what is read.
    lists: usize,
    /// Blocks around what is read.
    blocks: usize,
    /// Whether the value nests too deep, so that the rest of it was passed over.
    too_deep: bool,
}

/// The block, if it is one, that is read.
#[derive(Default)]
struct Within<'s> {
    kind: &'s str,
    is_block: bool,
    /// What closes it.
    close: &'static str,
    /// The field whose value is read.
    field: &'s str,
    /// What the value that is read should be, if that is known.
    takes: Option<Type>,
    /// Signs that are not needed, with their places: one report in a block for all of a kind.
    slips: BTreeMap<&'s str, Vec<Span>>,
    /// Whether it is not sure that none of them is needed.
    is_doubtful: bool,
}

impl<'w, 's> Recovery<'w, 's> {
    /// Reads this text.
    pub fn new(source: &'s Source, id: SourceId, words: &'w Vocabulary<'s>) -> Self {
        let text = source.text();
        Self {
            source,
            text,
            id,
            words,
            lexer: Lexer::new(text, 0),
            tokens: VecDeque::new(),
            last_end: 0,
            items: Vec::new(),
            problems: Problems::default(),
            is_cut: false,
            is_doubtful: false,
            read_to: 0,
            is_ours: false,
            within: Within::default(),
            depth: 0,
            lists: 0,
            blocks: 0,
            too_deep: false,
        }
    }

    /// Reads one item, or what stands in the place of one; answers where it ends, behind `start`.
    pub fn item(&mut self, start: usize) -> usize {
        if !self.is_ours && self.foreign_file() {
            self.read_to = self.text.len();
            return self.read_to;
        }
        self.is_ours = true;
        self.seek(start);
        self.any_item();
        self.read_to = match self.problems.is_full() {
            true => self.text.len(),
            false => self.last_end.max(start + 1),
        };
        self.read_to
    }

    /// Reads an item that follows the grammar, but may have been meant otherwise; answers where it
    /// ends, if that is a better explanation: by fields that the block has, or by a comment or a
    /// function of another language.
    pub fn item_as_meant(&mut self, start: usize) -> Option<usize> {
        let (items, problems, read_to) = (self.items.len(), self.problems.len(), self.read_to);
        let slips = |this: &Self| this.within.slips.values().map(Vec::len).sum::<usize>();
        let slips_before = slips(self);
        let end = self.item(start);
        let is_better = match self.items.get(items..) {
            Some([Item::Block(block)]) => {
                let kind = block.kind.map_or("", |kind| kind.text);
                let is_known = |name| self.words.takes(kind, name).is_some();
                block.fields.iter().all(|field| is_known(field.name.text))
            }
            Some([Item::Definition(_)]) => {
                let mut new = self.problems.iter().skip(problems);
                // What is right already is not read once more.
                let is_new = slips(self) > slips_before || self.problems.len() > problems;
                is_new && new.all(|problem| problem.code == "pinhole::foreign_function")
            }
            _ => false,
        };
        if is_better {
            return Some(end);
        }
        self.is_doubtful = true;
        self.items.truncate(items);
        self.problems.truncate(problems);
        for places in self.within.slips.values_mut() {
            places.retain(|place| place.start < start);
        }
        self.read_to = read_to;
        None
    }

    /// Reads the text from an offset on as one value.
    pub fn whole_value(&mut self, start: usize) -> Value<'s> {
        self.seek(start);
        let told = self.problems.len();
        let value = self.value();
        if self.kind(0) != TokenKind::End && self.problems.len() == told {
            self.unexpected("the end of the value", "write one value behind the `=`");
            return bad(value.span);
        }
        self.settle(told);
        value
    }

    /// All that was read, with what the scan found.
    pub fn finish(mut self, scan: Scan) -> Parsed<'s> {
        self.report_slips(self.problems.len());
        let mut parsed = Parsed {
            tree: Tree { items: self.items },
            is_cut: self.is_cut || self.problems.is_full(),
            is_doubtful: self.is_doubtful,
            problems: self.problems.into(),
            ..Parsed::default()
        };
        tell_signs_once(&mut parsed.problems);
        scan.report(self.text, &mut parsed);
        parsed
    }

    // Tokens.

    /// The token that is so many behind the next one.
    fn peek(&mut self, ahead: usize) -> Token {
        while self.tokens.len() <= ahead {
            self.tokens.push_back(self.lexer.seen_token());
        }
        // With more mistakes than are kept, the text ends.
        let token = self.tokens.get(ahead).filter(|_| !self.problems.is_full());
        let end = || Lexer::new(self.text, self.text.len()).token();
        token.copied().unwrap_or_else(end)
    }

    fn kind(&mut self, ahead: usize) -> TokenKind {
        self.peek(ahead).kind
    }

    /// The text of a token ahead; nothing at the end.
    fn word(&mut self, ahead: usize) -> &'s str {
        let token = self.peek(ahead);
        self.text.get(token.start..token.end).unwrap_or_default()
    }

    fn is(&mut self, ahead: usize, word: &str) -> bool {
        self.word(ahead) == word
    }

    /// The text of what lies before a place, in the line of the place.
    fn line_before(&self, at: usize) -> &'s str {
        let before = self.text.get(..at).unwrap_or_default();
        before.rsplit('\n').next().unwrap_or_default()
    }

    fn is_name(&mut self, ahead: usize) -> bool {
        self.kind(ahead) == TokenKind::Name && !self.is(ahead, "let")
    }

    /// What lies between a token ahead and the one before it.
    fn space_before(&mut self, ahead: usize) -> &'s str {
        let end = match ahead {
            0 => self.last_end,
            _ => self.peek(ahead - 1).end,
        };
        let start = self.peek(ahead).start;
        self.text.get(end..start).unwrap_or_default()
    }

    /// Whether a line ends before a token ahead.
    fn is_on_new_line(&mut self, ahead: usize) -> bool {
        self.kind(ahead) == TokenKind::End || self.space_before(ahead).contains('\n')
    }

    /// Whether a token ahead stands right behind the one before it.
    fn is_adjacent(&mut self, ahead: usize) -> bool {
        self.space_before(ahead).is_empty()
    }

    /// Takes the next token.
    fn bump(&mut self) -> Span {
        let span = self.here();
        if self.kind(0) != TokenKind::End {
            self.tokens.pop_front();
            self.last_end = span.end;
        }
        span
    }

    /// Goes on reading at an offset.
    fn seek(&mut self, at: usize) {
        self.tokens.clear();
        self.last_end = at;
        self.lexer = Lexer::new(self.text, at);
    }

    fn name(&mut self) -> Name<'s> {
        let text = self.word(0);
        let span = self.bump();
        Name { text, span }
    }

    fn here(&mut self) -> Span {
        let token = self.peek(0);
        Span::new(self.id, token.start, token.end)
    }

    /// The place behind the token that was taken last.
    fn behind(&self) -> Span {
        Span::new(self.id, self.last_end, self.last_end)
    }

    fn written(&self, span: Span) -> &'s str {
        self.text.get(span.range()).unwrap_or_default()
    }

    fn short(&self, span: Span) -> String {
        shorten(self.written(span))
    }

    /// Whether a block starts at a token ahead: `sphere {`, `sphere Ball {` or `sphere for i`.
    /// Behind any other word than a kind, a kind on a new line starts a block of its own.
    fn is_head(&mut self, ahead: usize) -> bool {
        let name = ahead + 1;
        let ends = |this: &mut Self, at| this.is(at, "{") || this.is_repetition(at);
        if !self.is_name(ahead) || ends(self, name) {
            return self.is_name(ahead);
        }
        let is_kind = self.words.is_kind(self.word(name)) && !self.words.is_kind(self.word(ahead));
        self.is_name(name) && ends(self, name + 1) && !(is_kind && self.is_on_new_line(name))
    }

    /// Whether a block of a known kind starts here.
    fn starts_block(&mut self) -> bool {
        self.is_head(0) && self.is_kind(0)
    }

    /// Whether a token ahead is a kind of block.
    fn is_kind(&mut self, ahead: usize) -> bool {
        self.words.is_kind(self.word(ahead))
    }

    /// Whether a name is that of a field of the block.
    fn is_field_name(&self, name: &str) -> bool {
        self.within.is_block && self.words.takes(self.within.kind, name).is_some()
    }

    /// Whether a line starts here that is the head of a block of a known kind, right or wrong.
    fn starts_item(&mut self) -> bool {
        let word = self.word(0);
        self.is_on_new_line(0) && self.words.is_kind(word) && !self.is_field_name(word) && {
            let count = self.find_in_line(|word| matches!(word, "{" | "}"));
            self.is(count, "{") && !self.is_on_new_line(count)
        }
    }

    // Going on.

    /// Whether what stood before must have ended: at a brace, `let`, the name of a field, or a
    /// line.
    fn is_boundary(&mut self) -> bool {
        let word = self.word(0);
        matches!(word, "" | "let" | "{" | "}")
            || (self.is_on_new_line(0) && (!self.within.is_block || self.is_name(0)))
            || (self.is_name(0) && self.is_field_name(word))
            || self.starts_block()
            || self.starts_item()
    }

    /// Passes over what stands before the next field, line, item or closing brace.
    fn resync(&mut self) {
        while !self.is_boundary() {
            self.bump();
        }
    }

    /// Passes over what stands before the next `{`, if there is one.
    fn skip_head(&mut self) {
        while !self.is(0, "{") && self.kind(0) != TokenKind::End {
            self.bump();
        }
    }

    /// Passes over what follows a `{`, up to the `}` that closes it.
    fn skip_block(&mut self) {
        let mut braces = 1_usize;
        while braces > 0 && self.kind(0) != TokenKind::End {
            match self.word(0) {
                "{" => braces += 1,
                "}" => braces -= 1,
                _ => {}
            }
            self.bump();
        }
    }

    // Problems.

    fn report(&mut self, said: &Message, at: Span, words: &[&str], fix: impl Into<Option<Fix>>) {
        self.problems.push(said.at(at, words, fix));
    }

    fn unexpected(&mut self, expected: &str, help: &str) {
        let span = self.here();
        let written = match self.written(span) {
            "" => "the end of the file".to_owned(),
            written => shorten(written),
        };
        let before = self.line_before(span.start).trim_end();
        let is_behind_part =
            self.lists > 0 && before.ends_with(|c: char| c.is_alphanumeric() || c == ')');
        let of_books = foreign::of_books(&written, expected != "a value" || is_behind_part);
        let help = of_books.unwrap_or(help);
        // `½` and `π` by themselves.
        let text = of_books.filter(|_| expected == "a value" && written.chars().count() == 1);
        let text = text.and_then(|help| help.strip_prefix("write `")?.strip_suffix('`'));
        let fix = text
            .filter(|it| !it.contains('`'))
            .map(|text| replace(span, text));
        self.report(&say::UNEXPECTED, span, &[expected, &written, help], fix);
    }

    fn remove(&self, title: impl Into<String>, span: Span) -> Fix {
        Fix::new(title, [Edit::remove_in(span, self.text)])
    }

    /// Where different slips are found since so many, none of their fixes is sure.
    fn settle(&mut self, told: usize) {
        let problems = self.problems.get_mut(told..).unwrap_or_default();
        if problems.chunk_by(|a, b| a.code == b.code).count() > 1 {
            let fixes = problems.iter_mut().map(|problem| &mut problem.fixes);
            fixes.for_each(Vec::clear);
        }
    }

    // Signs that are not needed, and those of comments in other languages: one report in a block
    // for all of a kind.

    /// Takes a `,` or `;` between fields or items. Before a value it may stand for something else.
    fn separator(&mut self) {
        let sign = self.bump();
        self.slip(sign);
        let word = self.word(0);
        let is_value = self.starts_value(0)
            && (!self.is_name(0) || self.words.is_value(word) || unit_of(word).is_some());
        self.within.is_doubtful |= is_value && !self.is_boundary();
    }

    fn slip(&mut self, sign: Span) {
        let word = self.written(sign);
        let places = self.within.slips.entry(word).or_default();
        match places.len() < MOST_PROBLEMS {
            true => places.push(sign),
            false => self.problems.leave_out(sign),
        }
    }

    /// Where a problem since so many has no fix, it is doubtful what the signs belong to.
    fn report_slips(&mut self, told: usize) {
        let since = self.problems.get(told..).unwrap_or_default();
        let is_doubtful = since.iter().any(|problem| problem.fixes.is_empty())
            || std::mem::take(&mut self.within.is_doubtful);
        let between = match self.within.is_block {
            true => "fields",
            false => "items",
        };
        for (sign, places) in std::mem::take(&mut self.within.slips) {
            let Some(&at) = places.first() else { continue };
            let it = if places.len() > 1 { "them" } else { "it" };
            let (message, title) = match sign {
                "=" | ":" | ":=" => (&say::NEEDLESS_EQUALS, format!("take {it} away")),
                "," | ";" => {
                    let title = format!("take {it} away; white space separates {between}");
                    (&say::NEEDLESS_SEPARATOR, title)
                }
                _ => (&say::COMMENT_SIGN, "write `//`".to_owned()),
            };
            let edits = places.iter().map(|&place| {
                if message.is_needless() {
                    return Edit::remove_in(place, self.text);
                }
                let rest = self.text.get(place.start..).unwrap_or_default();
                let signs = rest.len() - rest.trim_start_matches(['#', '-', ';', '%']).len();
                Edit::new(Span::new(self.id, place.start, place.start + signs), "//")
            });
            let words = [sign.trim(), &times(places.len() - 1), between];
            let mut found = message.at(at, &words, Fix::new(title, edits));
            if is_doubtful && found.is_needless {
                found.fixes.clear();
            }
            self.problems.push_earlier(found);
        }
    }
}

/// Whether a text is a name.
fn is_name(text: &str) -> bool {
    text.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
        && text.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
        && text != "let"
}

/// What stands between quotation marks.
fn unquoted(written: &str) -> &str {
    let marks = ['"', '\'', '“', '”', '„', '‘', '’', '«', '»'];
    written.trim_matches(marks).trim()
}

/// A value of some type, for a help.
fn example(takes: Option<Type>) -> &'static str {
    let any = "write a value, such as `2`, `30deg`, `(0, 1, 0)` or `olive`";
    takes.map_or(any, Type::such_as)
}

/// Whether a value is a plain number, perhaps with a sign.
fn is_plain_number(value: &Value<'_>) -> bool {
    match &value.kind {
        ValueKind::Number(_) => true,
        ValueKind::Negation { operand, .. } => matches!(operand.kind, ValueKind::Number(_)),
        _ => false,
    }
}
