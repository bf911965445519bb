//! Reads items: definitions, blocks with their heads, and lines that are neither.

use super::{Recovery, foreign::CommentPosition, is_name, unquoted};
use crate::{
    diagnostic::{Edit, Fix},
    schema,
    source::Span,
    suggest,
    syntax::{
        messages::{self as say, statement},
        problem::shorten,
        tokens::TokenKind,
        tree::{Block, Definition, Item, Name, Repetition, Value, ValueKind, bad},
    },
};

/// Words that other languages use for `let`.
const OTHER_LETS: &str =
    "var const def define set val auto local int float double number vec3 vector";

/// Words before a kind that are surely not the name of an object.
const NO_NAMES: &str = "a an the my new add create draw make object";

/// Maximum number of tokens of a line that are searched.
const LINE_TOKENS: usize = 24;

/// Maximum number of preceding items that are searched for a definition of the same name. Without
/// this limit, each line of a long text would be compared with all items before it.
const ITEMS_BEFORE: usize = 64;

impl<'s> Recovery<'_, 's> {
    /// Reads one item, or whatever stands in place of one.
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

    pub(super) fn definition(&mut self) {
        let keyword = self.bump();
        let mut definition = Definition::begun(keyword);
        let problems_before = self.problems.len();
        definition.name = self.name_of_definition(keyword);
        if let Some(name) = definition.name
            && self.is(0, "=")
            && self.is_name(1)
            && self.is(2, "{")
            && !self.is_on_new_line(1)
        {
            self.bump();
            return self.named_block(keyword, name);
        }
        definition.equals = matches!(self.word(0), "=" | ":" | ":=").then(|| self.bump());
        if self.is(0, "=") && self.is_adjacent(0) {
            definition.equals = definition.equals.map(|first| first.to(self.bump()));
        }
        definition.value = self.value_of_definition(definition.name, definition.equals);
        self.clear_uncertain_fixes(problems_before);
        definition.span = keyword.to(definition.value.span);
        let is_right = self.problems.len() == problems_before;
        // The next item may start with a name; `;` and `,` may separate it.
        let is_next = self.is_name(0) || (is_right && matches!(self.word(0), ";" | ","));
        if !is_next && !self.is_boundary() {
            if is_right {
                let help = "write one value behind the `=`";
                self.unexpected("the end of the definition", help);
                definition.value = bad(definition.value.span);
            }
            self.resync();
        }
        self.items.push(Item::Definition(definition));
    }

    fn value_of_definition(&mut self, name: Option<Name<'s>>, sign: Option<Span>) -> Value<'s> {
        let (start, problems_before) = (self.here(), self.problems.len());
        let value = (!self.is_end_of_definition()).then(|| self.value());
        let Some(name) = name else {
            self.problems.truncate(problems_before);
            return bad(value.map_or(self.behind(), |value| value.span));
        };
        let text = shorten(name.text);
        let Some(value) = value else {
            let span = name.span.to(sign.unwrap_or(name.span));
            self.report(&say::LET_WITHOUT_VALUE, span, &[&text], None);
            return bad(self.behind());
        };
        let edit = match sign {
            Some(sign) if self.written(sign) == "=" => return value,
            Some(sign) => Edit::new(Span::new(self.id, name.span.end, sign.end), " ="),
            None => Edit::insert(self.id, start.start, "= "),
        };
        let title = format!("write `let {text} = {}`", self.short(value.span));
        let fix = Fix::new(title, [edit]);
        self.report(&say::MISSING_EQUALS, sign.unwrap_or(start), &[&text], fix);
        value
    }

    /// Reads the name after `let`. If several tokens stand before the `=`, all of them are reported
    /// as a bad name. Returns `None` if the name is missing.
    fn name_of_definition(&mut self, keyword: Span) -> Option<Name<'s>> {
        let is_sign = matches!(self.word(0), "=" | ":" | ":=");
        if is_sign || self.is_end_of_definition() || self.is_head(0) {
            let span = if is_sign { self.here() } else { keyword };
            self.report(&say::MISSING_NAME, span, &[], None);
            return None;
        }
        let is_end = |word: &str| matches!(word, "=" | ":" | ":=" | "{" | "}" | "let");
        let count = self.find_in_line(is_end);
        let has_equals =
            matches!(self.word(count), "=" | ":" | ":=") && !self.is_on_new_line(count);
        if self.is_name(0) && (count == 1 || !has_equals) {
            return Some(self.name());
        }
        let is_function = self.is_name(0) && self.is(1, "(") && !self.is(2, ")");
        let mut span = self.bump();
        for _ in 1..if has_equals { count } else { 1 } {
            span = span.to(self.bump());
        }
        if is_function && let Some(said) = statement("function") {
            self.report(&say::NOT_IN_LANGUAGE, span, &said, None);
        } else {
            // For a name such as `2ball`, the help moves the digits to the end.
            let written = self.short(span);
            let letters = written.trim_start_matches(|c: char| c.is_ascii_digit());
            let digits = written.len() - letters.len();
            let help = if is_name(letters) && digits > 0 {
                format!(
                    ", as in `{letters}{}`",
                    written.get(..digits).unwrap_or_default()
                )
            } else {
                String::new()
            };
            self.report(&say::BAD_NAME, span, &[&written, &help], None);
        }
        self.items.push(Item::Bad(span));
        None
    }

    /// Returns the number of tokens in the line before the first for which `is_end` holds. It is at
    /// least 1 and at most [`LINE_TOKENS`].
    pub(super) fn find_in_line(&mut self, is_end: fn(&str) -> bool) -> usize {
        let mut count = 1;
        while count < LINE_TOKENS && !self.is_on_new_line(count) && !is_end(self.word(count)) {
            count += 1;
        }
        count
    }

    /// Returns whether the definition ends here, so that no value can follow.
    fn is_end_of_definition(&mut self) -> bool {
        let word = self.word(0);
        matches!(word, "" | "let" | "{" | "}" | ";")
            || (self.is_name(0)
                && self.is_on_new_line(0)
                && !self.is_foreign_call()
                && (!self.words.is_value(word) || self.is_head(0)))
    }

    /// Reads a block whose head is a kind and perhaps a name, or is missing.
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
        // Maximum depth of nested blocks that are read, although no block may stand in another one;
        // deeper blocks are skipped.
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
    /// blocks one by one.
    fn container(&mut self, kind: Name<'s>) {
        let name = shorten(kind.text);
        let what = format!("blocks stand by themselves, not within `{name}`");
        self.report(&say::NESTED_BRACES, kind.span, &[&what], None);
        while !matches!(self.word(0), "}" | "") {
            self.any_item();
        }
        self.bump();
    }

    /// Reads a line that usually starts with a name: a block, even if its head is wrong, or another
    /// line.
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
    fn named_block(&mut self, start: Span, name: Name<'s>) {
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
    /// followed by fields. Returns whether the text is such a block.
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

    /// Reads a block from the place where its `{` is missing, and reports that.
    fn without_open(&mut self, mut block: Block<'s>, kind: Name<'s>) {
        let head = block.span.to(self.behind());
        block.span = head;
        let close = if self.is(0, "(") { ")" } else { "}" };
        // The span that ` {` replaces.
        let mut open = self.behind();
        if matches!(self.word(0), "(" | ":" | "=") {
            open = open.to(self.bump());
        }
        let mut fix = None;
        block.bad.push(open);
        if self.is_name(0) && self.words.takes(kind.text, self.word(0)).is_some() {
            self.body(&mut block, close);
            // A fix is offered only if the end of the block is certain: something closes it, and no
            // `{` in it may own that brace.
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

    // Lines that are not items.

    /// Reads a definition that lacks its `let`, as in `x = 3` or `var x = 3`. Returns whether the
    /// line is one.
    fn missing_let(&mut self) -> bool {
        let (word, start) = (self.word(0), self.here());
        let is_let = suggest::nearest(word, ["let"]).is_some()
            || OTHER_LETS.split(' ').any(|other| other == word);
        let is_plain = self.is(1, "=");
        if !(is_plain || (is_let && self.is_name(1) && self.is(2, "="))) {
            return false;
        }
        if !is_plain {
            self.bump();
        }
        let name = self.name();
        let mut definition = Definition::begun(Span::new(self.id, start.start, start.start));
        definition.name = Some(name);
        definition.equals = Some(self.bump());
        let problems_before = self.problems.len();
        let value = (!self.is_end_of_definition()).then(|| self.value());
        let value = value.unwrap_or_else(|| bad(self.behind()));
        let text = shorten(name.text);
        let written = self.written(value.span);
        if is_plain && self.is_assigned_again(word, written) {
            let what = "assignments: a name keeps its value";
            let help = "give the new value a name of its own with `let NAME = VALUE`";
            self.problems.truncate(problems_before);
            self.report(&say::NOT_IN_LANGUAGE, start, &[what, help], None);
        } else {
            let before = Span::new(self.id, start.start, name.span.start);
            let mut edits = vec![Edit::new(before, "let ")];
            // A `;` at the end belongs to the other language, so the fix removes it.
            if self.is(0, ";") {
                let sign = self.bump();
                edits.push(Edit::remove_in(sign, self.text));
            }
            let is_next = self.is_on_new_line(0) || (self.is_name(0) && self.is(1, "="));
            let is_right = self.problems.len() == problems_before && value.kind != ValueKind::Bad;
            self.problems.truncate(problems_before);
            let right = shorten(written);
            let title = format!("write `let {text} = {right}`");
            let fix = (is_right && is_next).then(|| Fix::new(title, edits));
            // The other language's word may mean more than `let`, so the fix is not safe.
            let is_foreign = !is_plain && suggest::nearest(word, ["let"]).is_none();
            let said = say::MISSING_LET.safe_if(!is_foreign);
            self.report(&said, start, &[&text, &right], fix);
            definition.span = start.to(value.span);
            definition.value = bad(value.span);
            self.items.push(Item::Definition(definition));
        }
        self.resync();
        true
    }

    /// Returns whether `name` is already defined, or occurs in `value`.
    fn is_assigned_again(&self, name: &str, value: &str) -> bool {
        let is_defined = |item: &Item<'s>| match item {
            Item::Definition(it) => it.name.is_some_and(|it| it.text == name),
            _ => false,
        };
        let mut words = value.split(|c: char| !c.is_alphanumeric());
        self.words.is_let(name)
            || words.any(|word| word == name)
            || self.items.iter().rev().take(ITEMS_BEFORE).any(is_defined)
    }

    /// Reports and skips a line outside of every block that starts no item.
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

    /// Skips to the next item that starts a line, or past a `}`.
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

    // Closing brackets and braces that were never opened.

    /// Reports a `)` or `]` that was never opened. The fix removes it if `is_needless` says that
    /// the bracket changes nothing, and if its line has no surplus opening bracket.
    pub(super) fn stray_parenthesis(&mut self, is_needless: bool) {
        let sign = self.word(0);
        let span = self.bump();
        // The opening bracket may be part of another mistake in the line.
        let line = self.line_before(span.start);
        let open = if sign == ")" { '(' } else { '[' };
        let is_opened = line.matches(open).count() > line.matches(sign).count();
        let fix =
            (is_needless && !is_opened).then(|| self.remove(format!("remove this `{sign}`"), span));
        self.report(&say::STRAY_CLOSING, span, &[sign], fix);
    }

    /// Reports a `}` that was never opened, together with any that follow it directly.
    fn stray_brace(&mut self) {
        let first = self.bump();
        let mut all = first;
        while self.is(0, "}") {
            all = all.to(self.bump());
        }
        // If no item follows, the `}` may be meant as another token.
        let is_before_item = self.is_on_new_line(0) || self.is_head(0) || self.is(0, "let");
        // The `}` may close a block that lacks its `{`.
        let mut last = self.problems.iter().rev().take(8);
        let is_sure = is_before_item && last.all(|found| found.code != "pinhole::unopened_block");
        let fix = is_sure.then(|| self.remove("remove this `}`", all));
        self.report(&say::STRAY_CLOSING, first, &["}"], fix);
    }
}
