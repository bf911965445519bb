//! Reads an item that does not follow the grammar.
//!
//! In: the text from the item's start. Out: nodes for the parts that can be read, and one problem
//! for each mistake. This is a recursive-descent parser over the lexer's tokens. It reads items in
//! `items`, fields in `fields`, indices in `repetition`, values in `values`, `adjacent` and
//! `lists`, names in `names`, numbers in `numbers`, needless separators in `signs`, and constructs
//! of other languages in `foreign`. From an item without mistakes, this parser makes the same tree
//! as pest, the generated parser. Three rules apply:
//!
//! - After a token that fits nowhere, reading continues at the next field, line, item or brace
//!   (`resync`).
//! - Only an obvious fix is offered. A value with a mistake usually becomes `Bad`, whether it has a
//!   fix or not, so that uses of the value cause no further reports.
//! - If one value has several different mistakes, their fixes are uncertain and are removed
//!   (`clear_uncertain_fixes`).

mod adjacent;
mod definitions;
mod fields;
mod foreign;
mod head;
mod items;
mod lists;
mod names;
mod numbers;
mod repetition;
mod signs;
mod values;

use std::collections::{BTreeMap, VecDeque};

use super::{
    NESTING_LIMIT, Parsed, messages as say,
    problem::{Message, merge_sign_reports, replace, shorten},
    scan::Scan,
    tokens::{Lexer, Token, TokenKind},
    tree::{Item, Name, Tree, Value, ValueKind, bad},
    vocabulary::Vocabulary,
};
use crate::{
    diagnostic::{Edit, Fix, Problems},
    schema::Type,
    source::{Source, SourceId, Span},
};

/// Parser of items that do not follow the grammar. It recovers from errors.
pub struct Recovery<'w, 's> {
    source: &'s Source,
    text: &'s str,
    id: SourceId,
    words: &'w Vocabulary<'s>,
    lexer: Lexer<'s>,
    /// Tokens read ahead from the lexer, without comments and invisible characters.
    tokens: VecDeque<Token>,
    /// Offset after the last token that was consumed.
    last_end: usize,
    /// The items read so far, including those that pest read.
    pub(super) items: Vec<Item<'s>>,
    /// The problems reported so far.
    pub(super) problems: Problems,
    /// Whether a mistake, such as an unclosed comment, hides the rest of the text.
    is_cut: bool,
    /// Whether the text contains an item that follows the grammar but looks wrong, and for which
    /// error recovery found no better reading. Such an item keeps the node that pest, the generated
    /// parser, made of it.
    is_doubtful: bool,
    /// Offset after the last item that error recovery read.
    pub(super) read_to: usize,
    /// Whether [`Self::foreign_file`] has already tested if the text is a file of another program.
    /// The test is done only once.
    is_checked: bool,
    /// The block and the field that are being read.
    context: Context<'s>,
    /// Number of parentheses, signs and calls around the value that is read.
    depth: usize,
    /// Number of lists around the value that is read.
    lists: usize,
    /// Number of blocks around the item that is read.
    blocks: usize,
    /// Whether the value that is read nests deeper than `limit`, so that the rest was skipped.
    too_deep: bool,
    /// Maximum depth of nested parentheses, signs and calls in a value.
    pub(super) limit: usize,
    /// Whether any value so far nests deeper than `limit`.
    pub(super) has_passed_over: bool,
}

/// What the parser is reading: the block, if any, and the field of that block.
#[derive(Default)]
struct Context<'s> {
    kind: &'s str,
    is_block: bool,
    /// The token that closes the block.
    close: &'static str,
    /// Name of the field whose value is read.
    field: &'s str,
    /// Type that the value should have, if that is known.
    takes: Option<Type>,
    /// Needless separators, such as `;`, and the characters that start comments in other languages,
    /// such as `#`. Each is mapped to its places.
    signs: BTreeMap<&'s str, Vec<Span>>,
    /// Whether a separator in `signs` may be needed after all, for example to continue a list. If
    /// so, the reports of needless separators get no fix.
    is_doubtful: bool,
}

impl<'w, 's> Recovery<'w, 's> {
    /// Makes an error-recovering parser that starts at the beginning of a text.
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
            is_checked: false,
            context: Context::default(),
            depth: 0,
            lists: 0,
            blocks: 0,
            too_deep: false,
            limit: NESTING_LIMIT,
            has_passed_over: false,
        }
    }

    /// Reads one item, or reports the text in its place. Returns the item's end, which is after
    /// `start`. Returns the end of the text if the text is a file of another program, or if the
    /// maximum number of problems is reached.
    pub fn item(&mut self, start: usize) -> usize {
        if !self.is_checked && self.foreign_file() {
            self.read_to = self.text.len();
            return self.read_to;
        }
        self.is_checked = true;
        self.seek(start);
        self.any_item();
        self.read_to = if self.problems.is_full() {
            self.text.len()
        } else {
            self.last_end.max(start + 1)
        };
        self.read_to
    }

    /// Reads the item at `start` again, which follows the grammar but may have been meant
    /// otherwise. Returns the item's end if the new reading is better. A new reading of a block is
    /// better if all fields are known. A new reading of a definition is better if it finds at least
    /// one mistake, and every mistake is a comment or a function of another language. If the new
    /// reading is not better, restores the items and problems and returns `None`.
    pub fn item_as_meant(&mut self, start: usize) -> Option<usize> {
        let (items, problems, read_to) = (self.items.len(), self.problems.len(), self.read_to);
        let slips = |this: &Self| this.context.signs.values().map(Vec::len).sum::<usize>();
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
                // If the new reading finds no mistake, it explains nothing, and the node that the
                // generated parser made is kept.
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
        for places in self.context.signs.values_mut() {
            places.retain(|place| place.start < start);
        }
        self.read_to = read_to;
        None
    }

    /// Reads the text from the offset `start` to its end as one value, and reports any text after
    /// the value.
    pub fn whole_value(&mut self, start: usize) -> Value<'s> {
        self.seek(start);
        let problems_before = self.problems.len();
        let value = self.value();
        if self.kind(0) != TokenKind::End && self.problems.len() == problems_before {
            self.unexpected("the end of the value", "write one value behind the `=`");
            return bad(value.span);
        }
        self.clear_uncertain_fixes(problems_before);
        value
    }

    /// Returns the tree of all items that were read, their problems, and the comments and problems
    /// of `scan`.
    pub fn finish(mut self, scan: Scan) -> Parsed<'s> {
        self.report_signs(self.problems.len());
        let mut parsed = Parsed {
            tree: Tree { items: self.items },
            is_cut: self.is_cut || self.problems.is_full(),
            is_doubtful: self.is_doubtful,
            problems: self.problems.into(),
            ..Parsed::default()
        };
        merge_sign_reports(&mut parsed.problems);
        scan.report(self.text, &mut parsed);
        parsed
    }

    // The methods below look at the next tokens or consume them.

    /// Returns the token `ahead` tokens after the next one, without consuming it. At the end of the
    /// text, this is an end token.
    fn peek(&mut self, ahead: usize) -> Token {
        while self.tokens.len() <= ahead {
            self.tokens.push_back(self.lexer.seen_token());
        }
        // Once the maximum number of problems is reached, error recovery behaves as if the text
        // ended.
        let token = self.tokens.get(ahead).filter(|_| !self.problems.is_full());
        let end = || Lexer::new(self.text, self.text.len()).token();
        token.copied().unwrap_or_else(end)
    }

    fn kind(&mut self, ahead: usize) -> TokenKind {
        self.peek(ahead).kind
    }

    /// Returns the text of the token `ahead` tokens after the next one; empty at the end of the
    /// text.
    fn word(&mut self, ahead: usize) -> &'s str {
        let token = self.peek(ahead);
        self.text.get(token.start..token.end).unwrap_or_default()
    }

    fn is(&mut self, ahead: usize, word: &str) -> bool {
        self.word(ahead) == word
    }

    /// Returns the part of the line before the offset `at`.
    fn line_before(&self, at: usize) -> &'s str {
        let before = self.text.get(..at).unwrap_or_default();
        before.rsplit('\n').next().unwrap_or_default()
    }

    fn is_name(&mut self, ahead: usize) -> bool {
        self.kind(ahead) == TokenKind::Name && !self.is(ahead, "let")
    }

    /// Returns the text directly before the token `ahead` tokens after the next one. The text
    /// starts at the end of the previous token.
    fn space_before(&mut self, ahead: usize) -> &'s str {
        let end = match ahead {
            0 => self.last_end,
            _ => self.peek(ahead - 1).end,
        };
        let start = self.peek(ahead).start;
        self.text.get(end..start).unwrap_or_default()
    }

    /// Returns whether the token `ahead` tokens after the next one is the first of its line, or the
    /// end of the text.
    fn is_on_new_line(&mut self, ahead: usize) -> bool {
        self.kind(ahead) == TokenKind::End || self.space_before(ahead).contains('\n')
    }

    /// Returns whether nothing separates the token `ahead` tokens after the next one from its
    /// predecessor.
    fn is_adjacent(&mut self, ahead: usize) -> bool {
        self.space_before(ahead).is_empty()
    }

    /// Consumes the next token and returns its span.
    fn bump(&mut self) -> Span {
        let span = self.here();
        if self.kind(0) != TokenKind::End {
            self.tokens.pop_front();
            self.last_end = span.end;
        }
        span
    }

    /// Continues reading at the offset `at`, and discards the tokens that were read ahead.
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

    /// Returns the empty span after the token that was consumed last.
    fn behind(&self) -> Span {
        Span::new(self.id, self.last_end, self.last_end)
    }

    fn written(&self, span: Span) -> &'s str {
        self.text.get(span.range()).unwrap_or_default()
    }

    fn short(&self, span: Span) -> String {
        shorten(self.written(span))
    }

    /// Returns whether a block starts at the token `ahead` tokens after the next one, as in `sphere
    /// {`, `sphere Ball {` or `sphere for i`. If `Ball` ends a line and `sphere {` follows on the
    /// next line, the block starts at `sphere`, not at `Ball`.
    fn is_head(&mut self, ahead: usize) -> bool {
        let name = ahead + 1;
        let ends = |this: &mut Self, at| this.is(at, "{") || this.is_repetition(at);
        if !self.is_name(ahead) || ends(self, name) {
            return self.is_name(ahead);
        }
        let is_kind = self.words.is_kind(self.word(name)) && !self.words.is_kind(self.word(ahead));
        self.is_name(name) && ends(self, name + 1) && !(is_kind && self.is_on_new_line(name))
    }

    /// Returns whether the next token starts a block of a known kind, such as `sphere Ball {`.
    fn starts_block(&mut self) -> bool {
        self.is_head(0) && self.is_kind(0)
    }

    /// Returns whether the token `ahead` tokens after the next one is a kind of block.
    fn is_kind(&mut self, ahead: usize) -> bool {
        self.words.is_kind(self.word(ahead))
    }

    /// Returns whether `name` is a field of the current block.
    fn is_field_name(&self, name: &str) -> bool {
        self.context.is_block && self.words.takes(self.context.kind, name).is_some()
    }

    /// Returns whether the next token starts a line that opens a block of a known kind. The text
    /// before the `{` may have mistakes.
    fn starts_item(&mut self) -> bool {
        let word = self.word(0);
        self.is_on_new_line(0) && self.words.is_kind(word) && !self.is_field_name(word) && {
            let count = self.find_in_line(|word| matches!(word, "{" | "}"));
            self.is(count, "{") && !self.is_on_new_line(count)
        }
    }

    // The methods below skip text after a mistake.

    /// Returns whether the next token ends every unfinished construct before it. This holds for a
    /// brace, `let`, the name of a field, the start of a block, and the first token of a line.
    /// Within a block, the first token of a line must also be a name.
    fn is_boundary(&mut self) -> bool {
        let word = self.word(0);
        matches!(word, "" | "let" | "{" | "}")
            || (self.is_on_new_line(0) && (!self.context.is_block || self.is_name(0)))
            || (self.is_name(0) && self.is_field_name(word))
            || self.starts_block()
            || self.starts_item()
    }

    /// Skips to the next field, line, item or brace.
    fn resync(&mut self) {
        while !self.is_boundary() {
            self.bump();
        }
    }

    /// Skips to the next `{`, or to the end of the text.
    fn skip_head(&mut self) {
        while !self.is(0, "{") && self.kind(0) != TokenKind::End {
            self.bump();
        }
    }

    /// Skips the contents of a block and its `}`. The `{` must have been consumed already.
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

    // The methods below report problems.

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
        let help_for_notation =
            foreign::help_for_notation(&written, expected != "a value" || is_behind_part);
        let help = help_for_notation.unwrap_or(help);
        // If the token is a single character such as `½` or `π`, the help names its replacement,
        // which becomes the fix.
        let text =
            help_for_notation.filter(|_| expected == "a value" && written.chars().count() == 1);
        let text = text.and_then(|help| help.strip_prefix("write `")?.strip_suffix('`'));
        let fix = text
            .filter(|it| !it.contains('`'))
            .map(|text| replace(span, text));
        self.report(&say::UNEXPECTED, span, &[expected, &written, help], fix);
    }

    fn remove(&self, title: impl Into<String>, span: Span) -> Fix {
        Fix::new(title, [Edit::remove_in(span, self.text)])
    }

    /// Removes the fixes of all problems from the index `first` on if these problems have different
    /// codes, because none of the fixes is certain in this case.
    fn clear_uncertain_fixes(&mut self, first: usize) {
        let problems = self.problems.get_mut(first..).unwrap_or_default();
        if problems.chunk_by(|a, b| a.code == b.code).count() > 1 {
            let fixes = problems.iter_mut().map(|problem| &mut problem.fixes);
            fixes.for_each(Vec::clear);
        }
    }
}

/// Returns whether a text is a name.
fn is_name(text: &str) -> bool {
    text.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
        && text.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
        && text != "let"
}

/// Returns a text without the quotation marks and white space around it.
fn unquoted(written: &str) -> &str {
    let marks = ['"', '\'', '“', '”', '„', '‘', '’', '«', '»'];
    written.trim_matches(marks).trim()
}

/// Returns a help text with an example value of the type `takes`. If the type is unknown, the text
/// contains examples of several types.
fn example(takes: Option<Type>) -> &'static str {
    let any = "write a value, such as `2`, `30deg`, `(0, 1, 0)` or `olive`";
    takes.map_or(any, Type::such_as)
}

/// Returns whether a value is a number literal, perhaps with a minus.
fn is_plain_number(value: &Value<'_>) -> bool {
    match &value.kind {
        ValueKind::Number(_) => true,
        ValueKind::Negation { operand, .. } => matches!(operand.kind, ValueKind::Number(_)),
        _ => false,
    }
}
