//! Reads items: definitions, blocks with their heads, and lines that are neither.

use super::{Recovery, foreign::CommentPosition, is_name, unquoted};
use crate::{
    diagnostic::{Edit, Fix},
    schema,
    source::Span,
    syntax::{
        messages::{self as say, statement},
        problem::shorten,
        tokens::TokenKind,
        tree::{Block, Item, Name, Repetition},
    },
};

/// Words that are surely not meant as an object's name before a kind, as in `a sphere {`.
const NO_NAMES: &str = "a an the my new add create draw make object";

/// Maximum number of tokens, counted from the start of a line, that are searched for the `{` after
/// the head of a block. A `{` further on is not found. Heads are shorter than this; the limit
/// bounds the time for a very long line.
const LINE_TOKENS: usize = 24;

impl<'s> Recovery<'_, 's> {
    /// Reads one item, or reports the text that stands in its place.
    pub(super) fn any_item(&mut self) {
        self.comments(CommentPosition::Start);
        match self.word(0) {
            "" => {}
            "let" => self.definition(),
            "}" => self.stray_brace(),
            "," | ";" => self.separator(),
            ")" | "]" => self.stray_parenthesis(true),
            "{" => {
                let span = self.here();
                self.report(&say::MISSING_KIND, span, &[], None);
                self.block();
            }
            word => {
                if let Some(said) = statement(word) {
                    self.foreign_statement(said);
                } else if !self.nested_comment() {
                    self.block_or_line();
                }
            }
        }
    }

    /// Counts the tokens from the next one up to the first for which `is_end` holds, which is not
    /// counted. Stops at the end of the line if `is_end` holds for no token of the line. The next
    /// token itself is not tested. The result is at most [`LINE_TOKENS`].
    pub(super) fn find_in_line(&mut self, is_end: fn(&str) -> bool) -> usize {
        let mut count = 1;
        while count < LINE_TOKENS && !self.is_on_new_line(count) && !is_end(self.word(count)) {
            count += 1;
        }
        count
    }

    /// Reads a block whose head, the part before the `{`, is a kind, a kind and a name, or missing.
    pub(super) fn block(&mut self) {
        let span = self.here();
        let kind = self.is_name(0).then(|| self.name());
        let has_name = self.is_name(0) && !self.is_repetition(0);
        let name = has_name.then(|| self.name());
        let block = Block::new(span, kind, name);
        self.with_indices(block);
    }

    /// Reads the rest of a block after its kind and name: indices, if any, and the fields.
    fn with_indices(&mut self, mut block: Block<'s>) {
        let goes_on = self.indices(&mut block);
        match block.kind {
            _ if !goes_on => self.items.push(Item::Bad(block.span.to(self.behind()))),
            Some(kind) if !self.is(0, "{") => self.without_open(block, kind),
            _ => self.open_block(block),
        }
    }

    /// Reads a block from its `{` on.
    fn open_block(&mut self, mut block: Block<'s>) {
        // Maximum nesting depth of blocks that are read; deeper blocks are skipped. The language
        // has no nested blocks, but reading them allows reports about mistakes in the inner blocks.
        // A limit is needed because each level of nesting uses stack. Somewhat larger values work
        // as well.
        const DEEPEST: usize = 3;
        block.open = Some(self.bump());
        if self.blocks == DEEPEST {
            return self.skip_block();
        }
        self.blocks += 1;
        let is_known = block.kind.is_none_or(|kind| self.words.is_kind(kind.text));
        match block.kind {
            Some(kind) if !is_known && (self.is(0, "let") || self.is_head(0)) => {
                self.container(kind);
            }
            _ => {
                self.body(&mut block, "}");
                self.items.push(Item::Block(block));
            }
        }
        self.blocks -= 1;
    }

    /// Reports a block that contains blocks, as in `scene { sphere { … } }`, and reads the inner
    /// blocks as items.
    fn container(&mut self, kind: Name<'s>) {
        let name = shorten(kind.text);
        let what = format!("blocks stand by themselves, not within `{name}`");
        self.report(&say::NESTED_BRACES, kind.span, &[&what], None);
        while !matches!(self.word(0), "}" | "") {
            self.any_item();
        }
        self.bump();
    }

    /// Reads a block, even if its head is wrong, or a definition without its `let`. Reports and
    /// skips any other line.
    fn block_or_line(&mut self) {
        let has_other_kind = self.is_name(0) && self.is_kind(1) && !self.is_kind(0);
        if self.is_head(0) && !has_other_kind {
            return self.block();
        }
        let count = self.find_in_line(|word| matches!(word, "{" | "}" | ";"));
        if self.is_name(0) && self.is(count, "{") && !self.is_on_new_line(count) {
            return self.block_with_bad_head(count);
        }
        if !(self.is_name(0) && (self.missing_let() || self.unopened_block())) {
            self.line();
        }
    }

    /// Reports a block with more than a kind and a name before its `{`, and reads the block. The
    /// `{` is `count` tokens after the first one.
    fn block_with_bad_head(&mut self, count: usize) {
        let first = self.name();
        if matches!(self.word(0), "=" | ":" | ":=") && self.is_name(1) && count == 3 {
            self.bump();
            return self.named_block(first.span, first);
        }
        if !self.words.is_kind(first.text) && self.starts_block() {
            let kind = self.word(0);
            let is_object = schema::block(kind).is_some_and(|row| row.is_object);
            let is_noise = NO_NAMES.split(' ').any(|word| word == first.text);
            if is_object && self.is(1, "{") && !is_noise {
                return self.named_block(first.span, first);
            }
            let before = Span::new(self.id, first.span.start, self.here().start);
            let title = format!("take `{}` away", shorten(first.text));
            let fix = Fix::new(title, [Edit::new(before, "")]);
            self.report(&say::BAD_HEAD.safe_if(false), first.span, &[kind], fix);
            return self.block();
        }
        let rest = self.here();
        while !self.is(0, "{") && !self.is_repetition(0) && self.kind(0) != TokenKind::End {
            self.bump();
        }
        let rest = rest.to(self.behind());
        let (kind, written) = (shorten(first.text), self.written(rest));
        let name = written.trim_end_matches([':', '=', ',', ' ', '\t']);
        let words = unquoted(name).split([' ', '-', '.', '\t']);
        let words: Vec<&str> = words.filter(|word| !word.is_empty()).collect();
        let name = words.join("_");
        let fix = if is_name(&name) {
            let title = format!("write `{kind} {} {{`", shorten(&name));
            let is_apart = rest.start > first.span.end;
            is_apart.then(|| Fix::new(title, [Edit::new(rest, name)]))
        } else {
            let title = format!("write `{kind} {{`");
            matches!(written, "=" | ":").then(|| self.remove(title, rest))
        };
        let is_object = schema::block(first.text).is_some_and(|row| row.is_object);
        let mut block = Block::new(first.span, Some(first), None);
        block.bad = vec![first.span.to(rest)];
        if is_object && self.counted_name(&kind, rest) {
            let (keyword, indices) = (rest, Vec::new());
            block.repetition = Some(Box::new(Repetition { keyword, indices }));
        } else {
            let said = say::BAD_HEAD.safe_if(words.len() == 1);
            self.report(&said, rest, &[&kind], fix);
        }
        self.with_indices(block);
    }

    /// Reports and reads a block whose name stands before its kind, as in `let Ball = sphere {`,
    /// `Ball: sphere {`, `Ball sphere {` and `sphere = Ball {`. The next token is the one after the
    /// `=`, the `:` or the first name.
    pub(super) fn named_block(&mut self, start: Span, name: Name<'s>) {
        let (mut name, mut kind) = (name, self.name());
        let whole = start.to(kind.span);
        if self.words.is_kind(name.text) && !self.words.is_kind(kind.text) {
            std::mem::swap(&mut name, &mut kind);
        }
        let right = format!("{} {}", kind.text, name.text);
        let title = format!("write `{} {{`", shorten(&right));
        let fix = Fix::new(title, [Edit::new(whole, right)]);
        // In `red sphere {`, the first word is a colour rather than a name, so there is no fix.
        let fix = Some(fix).filter(|_| !self.words.is_color(name.text));
        let said = say::BAD_HEAD.safe_if(self.written(whole).contains(['=', ':']));
        self.report(&said, whole, &[kind.text], fix);
        self.open_block(Block::new(whole, Some(kind), Some(name)));
    }

    /// Reads a block that lacks its `{`: `camera:`, `image 640 480`, `sphere (…)`, or `sphere Ball`
    /// followed by fields. Returns `false` and reads nothing if the text is not such a block.
    fn unopened_block(&mut self) -> bool {
        let Some(row) = schema::block(self.word(0)) else {
            return false;
        };
        let kind = self.name();
        let is_field = |this: &mut Self| {
            this.is_name(0) && this.words.takes(kind.text, this.word(0)).is_some()
        };
        let has_name =
            row.is_object && self.is_name(0) && !self.is_on_new_line(0) && !is_field(self);
        let name = has_name.then(|| self.name());
        let block = Block::new(kind.span, Some(kind), name);
        self.without_open(block, kind);
        true
    }

    /// Reports that a block lacks its `{`, and reads the fields that follow the head.
    fn without_open(&mut self, mut block: Block<'s>, kind: Name<'s>) {
        let head = block.span.to(self.behind());
        block.span = head;
        let close = if self.is(0, "(") { ")" } else { "}" };
        // The span that the fix replaces by ` {`.
        let mut open = self.behind();
        if matches!(self.word(0), "(" | ":" | "=") {
            open = open.to(self.bump());
        }
        let mut fix = None;
        block.bad.push(open);
        if self.is_name(0) && self.words.takes(kind.text, self.word(0)).is_some() {
            self.body(&mut block, close);
            // There is a fix only if the end of the block is certain: a token closes the block, and
            // the block contains no `{` that this token could belong to.
            let is_flat = !self.written(block.span).contains('{');
            fix = block.close.filter(|_| is_flat).map(|close| {
                let title = format!("write `{} {{`", self.short(head));
                Fix::new(title, [Edit::new(open, " {"), Edit::new(close, "}")])
            });
        } else {
            let from = self.here();
            self.resync();
            if self.is(0, "}") && !self.is_on_new_line(0) {
                self.bump();
            }
            block.bad.push(from.to(self.behind()));
        }
        self.report(&say::UNOPENED_BLOCK, head, &[&self.short(head)], fix);
        self.items.push(Item::Block(block));
    }

    /// Reports and skips a line that stands outside of all blocks and starts no item.
    fn line(&mut self) {
        let start = self.here();
        if self.is_name(0) {
            let name = self.short(start);
            self.report(&say::OUTSIDE_BLOCK, start, &[&name], None);
        } else {
            let blocks = "blocks such as `sphere { center (0, 1, 0) }`";
            let help = format!("a file holds `let NAME = VALUE` and {blocks}");
            self.unexpected("`let` or a block", &help);
        }
        self.bump();
        self.skip_lines();
        self.items.push(Item::Bad(start.to(self.behind())));
    }

    /// Skips to the next line that starts an item or a statement of another language. If a `{`
    /// comes before that line, skips to the end of the block that it opens. If a `}` comes first,
    /// skips to the end of this `}`.
    fn skip_lines(&mut self) {
        while self.kind(0) != TokenKind::End {
            if self.is_on_new_line(0) {
                self.comments(CommentPosition::Start);
                let word = self.word(0);
                let is_item = word == "let" || statement(word).is_some();
                if is_item || self.is_head(0) || (self.is_name(0) && self.is(1, "=")) {
                    return;
                }
            }
            let brace = self.word(0);
            self.bump();
            match brace {
                "{" => return self.skip_block(),
                "}" => return,
                _ => {}
            }
        }
    }

    // The methods below report closing brackets and braces that were never opened.

    /// Reports a `)` or `]` that was never opened. The fix removes the bracket. There is a fix only
    /// if the caller knows that the bracket changes nothing (`is_needless`) and the line has no
    /// surplus opening bracket.
    pub(super) fn stray_parenthesis(&mut self, is_needless: bool) {
        let sign = self.word(0);
        let span = self.bump();
        // There is no fix if the line has a surplus opening bracket, which may be part of another
        // mistake.
        let line = self.line_before(span.start);
        let open = if sign == ")" { '(' } else { '[' };
        let is_opened = line.matches(open).count() > line.matches(sign).count();
        let fix =
            (is_needless && !is_opened).then(|| self.remove(format!("remove this `{sign}`"), span));
        self.report(&say::STRAY_CLOSING, span, &[sign], fix);
    }

    /// Reports a `}` that was never opened, together with further `}` directly after it.
    fn stray_brace(&mut self) {
        let first = self.bump();
        let mut all = first;
        while self.is(0, "}") {
            all = all.to(self.bump());
        }
        // The fix is certain only if the next token starts a line or an item. Otherwise, the `}`
        // may be a typing error for another character.
        let is_before_item = self.is_on_new_line(0) || self.is_head(0) || self.is(0, "let");
        // If a block without its `{` was reported shortly before, the `}` may close that block, so
        // there is no fix.
        let mut last = self.problems.iter().rev().take(8);
        let is_sure = is_before_item && last.all(|found| found.code != "pinhole::unopened_block");
        let fix = is_sure.then(|| self.remove("remove this `}`", all));
        self.report(&say::STRAY_CLOSING, first, &["}"], fix);
    }
}
