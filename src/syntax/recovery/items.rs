//! Items: definitions, blocks with their heads, and lines that are neither.

use super::{Recovery, foreign, foreign::Place, is_name, unquoted};
use crate::{
    diagnostic::{Diagnostic, Edit, Fix},
    source::Span,
    suggest,
    syntax::{
        problem::{problem, shorten},
        tokens::TokenKind,
        tree::{Block, Definition, Item, Name, bad},
    },
};

/// What other languages write for `let`.
const OTHER_LETS: &[&str] = &[
    "var", "const", "def", "define", "set", "val", "auto", "local", "int", "float", "double",
    "number", "vec3", "vector",
];

/// As far as this a line is searched for what tells what it is.
const FAR: usize = 24;

impl<'s> Recovery<'_, 's> {
    /// Reads one item, or what stands in the place of one.
    pub(super) fn any_item(&mut self) {
        self.comments(Place::Start);
        match self.word(0) {
            "" => {}
            "let" => self.definition(),
            "}" => self.stray_brace(),
            "," | ";" => {
                let sign = self.bump();
                self.needless(sign);
            }
            ")" | "]" => self.stray_parenthesis(),
            "{" => {
                let span = self.here();
                let help = "write what it is before the `{`, such as `sphere {`";
                self.problems.push(
                    problem(
                        "missing_kind",
                        "a block lacks its kind",
                        span,
                        "what is this?",
                    )
                    .with_help(help),
                );
                self.block();
            }
            word => {
                if let Some((what, help)) = foreign::statement(word) {
                    self.foreign_statement(what, help);
                } else if !self.nested_comment() {
                    self.block_or_line();
                }
            }
        }
    }

    // Definitions.

    pub(super) fn definition(&mut self) {
        let keyword = self.bump();
        let mut definition = Definition::begun(keyword);
        let told = self.problems.len();
        definition.name = self.name_of_definition(keyword);
        if let Some(name) = definition.name
            && self.is(0, "=")
            && self.is_name(1)
            && self.is(2, "{")
            && !self.is_on_new_line(1)
        {
            self.bump();
            self.named_block(keyword, name);
            return;
        }
        let mut sign = None;
        if !self.is_end_of_definition() && matches!(self.word(0), "=" | ":") {
            sign = Some(self.bump());
            definition.equals = sign;
        }
        definition.value = match (definition.name, self.is_end_of_definition()) {
            (None, true) => bad(self.behind()),
            (Some(name), true) => {
                let message = format!("`let {}` has no value", shorten(name.text));
                let help = format!("write `let {} = ` and a value", shorten(name.text));
                let span = name.span.to(sign.unwrap_or(name.span));
                self.problems.push(
                    problem("missing_value", message, span, "a value should follow")
                        .with_help(help),
                );
                bad(self.behind())
            }
            (None, false) => {
                let before = self.problems.len();
                let value = self.value();
                self.problems.truncate(before);
                bad(value.span)
            }
            (Some(name), false) => {
                let start = self.here();
                let value = self.value();
                if sign.is_none_or(|sign| self.written(sign) == ":") {
                    let found = self.missing_equals(name, sign, start, value.span);
                    self.problems.push(found);
                }
                value
            }
        };
        self.settle(told);
        definition.span = keyword.to(definition.value.span);
        while self.problems.len() == told && matches!(self.word(0), ";" | ",") {
            let sign = self.bump();
            self.needless(sign);
        }
        // A word is for the next item to tell.
        if !self.is_boundary() && !self.is_name(0) && !self.word(0).starts_with('#') {
            if self.problems.len() == told {
                self.unexpected(
                    "the end of the definition",
                    "write one value behind the `=`",
                );
                definition.value = bad(definition.value.span);
            }
            self.resync();
        }
        self.items.push(Item::Definition(definition));
    }

    /// Reads the name behind `let`: up to the `=`, and what is no name in it is the mistake.
    fn name_of_definition(&mut self, keyword: Span) -> Option<Name<'s>> {
        let is_sign = matches!(self.word(0), "=" | ":");
        if is_sign || self.is_end_of_definition() || self.is_head(0) {
            let span = if is_sign { self.here() } else { keyword };
            let help = "write a name of letters, digits and `_`, such as `let height = 2`";
            self.problems.push(
                problem(
                    "missing_name",
                    "a `let` lacks its name",
                    span,
                    "a name should stand here",
                )
                .with_help(help),
            );
            return None;
        }
        let mut count = 1;
        while count < FAR
            && !self.is_on_new_line(count)
            && !matches!(self.word(count), "=" | ":" | "{" | "}" | "let")
        {
            count += 1;
        }
        let has_equals = matches!(self.word(count), "=" | ":") && !self.is_on_new_line(count);
        if self.is_name(0) && (count == 1 || !has_equals) {
            return Some(self.name());
        }
        let is_function = self.is_name(0) && self.is(1, "(") && !self.is(2, ")");
        let mut span = self.bump();
        for _ in 1..if has_equals { count } else { 1 } {
            span = span.to(self.bump());
        }
        if is_function {
            let help = "give each result a name with `let NAME = VALUE`";
            self.not_in_language("functions of one's own", help, span);
        } else {
            let help = "a name is made of the letters a to z, digits and `_`, and does not start with a digit";
            let message = format!("`{}` cannot be a name", self.short(span));
            self.problems.push(
                problem("bad_name", message, span, "a name should stand here").with_help(help),
            );
        }
        self.parts_of_bad_name(span);
        None
    }

    /// `let my-x = 5`, `let mut x = 5`: where `my-x` or `x` is used, `my`, `mut` and `x` are names that are known.
    fn parts_of_bad_name(&mut self, span: Span) {
        const ENOUGH: usize = 8;
        let is_between = |c: char| !c.is_alphanumeric() && c != '_';
        let (mut at, end) = (span.start, Span::new(self.id, span.end, span.end));
        for word in self.written(span).split_inclusive(is_between).take(ENOUGH) {
            let text = word.trim_end_matches(is_between);
            let span = Span::new(self.id, at, at + text.len());
            at += word.len();
            if is_name(text) {
                self.items.push(Item::Definition(Definition {
                    name: Some(Name { text, span }),
                    value: bad(end),
                    span,
                    ..Definition::begun(Span::new(self.id, span.start, span.start))
                }));
            }
        }
    }

    fn missing_equals(
        &self,
        name: Name<'s>,
        sign: Option<Span>,
        start: Span,
        value: Span,
    ) -> Diagnostic {
        let edit = match sign {
            Some(sign) => Edit::new(Span::new(self.id, name.span.end, sign.end), " ="),
            None => Edit::insert(self.id, start.start, "= "),
        };
        let text = shorten(name.text);
        problem(
            "missing_equals",
            format!("`let {text}` lacks its `=`"),
            sign.unwrap_or(start),
            "`=` should stand here",
        )
        .with_fix(Fix::new(
            format!("write `let {text} = {}`", self.short(value)),
            [edit],
        ))
    }

    /// Whether no value can follow any more.
    fn is_end_of_definition(&mut self) -> bool {
        let word = self.word(0);
        matches!(word, "" | "let" | "{" | "}" | ";")
            || (self.is_name(0)
                && self.is_on_new_line(0)
                && (!self.words.is_value(word) || self.is_head(0)))
    }

    // Blocks.

    /// Reads a block whose head is right, or missing.
    pub(super) fn block(&mut self) {
        let mut block = Block::empty(self.here());
        if self.is_name(0) {
            block.kind = Some(self.name());
            block.name = self.is_name(0).then(|| self.name());
        }
        self.open_block(block);
    }

    /// Reads a block from its `{` on.
    fn open_block(&mut self, mut block: Block<'s>) {
        // No block stands in another one; deeper than this they are passed over.
        const DEEPEST: usize = 3;
        block.open = Some(self.bump());
        if self.blocks == DEEPEST {
            self.skip_block();
            return;
        }
        self.blocks += 1;
        match block.kind {
            Some(kind)
                if !self.words.is_kind(kind.text) && (self.is(0, "let") || self.is_head(0)) =>
            {
                self.container(kind);
            }
            _ => {
                self.body(&mut block, "}");
                self.items.push(Item::Block(block));
            }
        }
        self.blocks -= 1;
    }

    /// `scene { sphere { … } }`: the blocks within are read by themselves.
    fn container(&mut self, kind: Name<'s>) {
        let what = format!(
            "blocks stand by themselves, not within `{}`",
            shorten(kind.text)
        );
        self.nested_braces(what, kind.span);
        while !matches!(self.word(0), "}" | "") {
            let next = (self.next, self.last_end);
            self.any_item();
            if (self.next, self.last_end) == next {
                self.bump();
            }
        }
        if self.is(0, "}") {
            self.bump();
        }
    }

    /// A line that starts with a name, as a rule: a block, whatever stands in its head, or something else.
    fn block_or_line(&mut self) {
        if self.is_head(0) {
            return self.block();
        }
        let mut count = 1;
        while count < FAR
            && !self.is_on_new_line(count)
            && !matches!(self.word(count), "{" | "}" | ";")
            && (!self.is(count, "let") || self.is(count + 1, "{"))
        {
            count += 1;
        }
        if self.is_name(0) && self.is(count, "{") && !self.is_on_new_line(count) {
            return self.odd_head(count);
        }
        if !(self.is_name(0) && (self.missing_let() || self.unopened_block())) {
            self.line();
        }
    }

    /// A `{` with more than a kind and a name before it.
    fn odd_head(&mut self, count: usize) {
        let mut block = Block::empty(self.here());
        let first = self.name();
        if self.is(0, "=") && self.is_name(1) && count == 3 {
            self.bump();
            return self.named_block(first.span, first);
        }
        let mut rest = self.here();
        let is_quoted = self.kind(0) == TokenKind::Quoted && count == 2;
        while !self.is(0, "{") {
            rest = rest.to(self.bump());
        }
        let (kind, written) = (shorten(first.text), self.written(rest));
        let words: Vec<&str> = unquoted(written)
            .split([' ', '-', '.', '\t'])
            .filter(|word| !word.is_empty())
            .collect();
        let name = words.join("_");
        let fix = if is_name(&name) {
            let edit = Edit::new(rest, name.as_str());
            Some(Fix::new(
                format!("write `{kind} {} {{`", shorten(&name)),
                [edit],
            ))
        } else if matches!(written, "=" | ":") {
            let edit = Edit::remove_in(rest, self.text);
            Some(Fix::new(format!("write `{kind} {{`"), [edit]))
        } else {
            None
        };
        let (code, message, label) = match is_quoted {
            true => (
                "quoted",
                "a name is written without quotation marks",
                "without the quotation marks",
            ),
            false => (
                "bad_head",
                "only a kind and a name stand before a `{`",
                "this does not belong here",
            ),
        };
        let help = format!("write `{kind} {{`, and then its fields");
        self.problems
            .push(problem(code, message, rest, label).with_fix_or(fix, help));
        block.kind = Some(first);
        block.bad = vec![first.span.to(rest)];
        self.open_block(block);
    }

    /// `let Ball = sphere {` and `Ball = sphere {`, from the kind on.
    fn named_block(&mut self, start: Span, name: Name<'s>) {
        let kind = self.name();
        let whole = start.to(kind.span);
        let message = "only a kind and a name stand before a `{`";
        let right = format!("{} {}", kind.text, name.text);
        let title = format!("write `{} {{`", shorten(&right));
        self.problems.push(
            problem(
                "bad_head",
                message,
                whole,
                "a block gets its name behind its kind",
            )
            .with_fix(Fix::new(title, [Edit::new(whole, right)])),
        );
        let mut block = Block::empty(kind.span);
        (block.kind, block.name) = (Some(kind), Some(name));
        self.open_block(block);
    }

    /// A kind without the `{` that should follow: `camera:`, `image 640 480`, `sphere (…)`, `sphere Ball` and then fields.
    fn unopened_block(&mut self) -> bool {
        if !self.words.is_kind(self.word(0)) {
            return false;
        }
        let kind = self.name();
        let is_field = |this: &mut Self, ahead| {
            let word = this.word(ahead);
            this.is_name(ahead) && this.words.takes(kind.text, word).is_some()
        };
        let has_name = self.is_name(0) && !self.is_on_new_line(0) && !is_field(self, 0);
        let name = has_name.then(|| self.name());
        let head = kind.span.to(self.behind());
        let mut block = Block::empty(head);
        (block.kind, block.name) = (Some(kind), name);
        let sign = matches!(self.word(0), "(" | ":" | "=").then(|| self.bump());
        let mut fix = None;
        let from = self.here();
        if is_field(self, 0) {
            let close = if sign.is_some_and(|sign| self.written(sign) == "(") {
                ")"
            } else {
                "}"
            };
            self.body(&mut block, close);
            // Where nothing closes it, it is not known where it ends.
            fix = block.close.map(|close| {
                let apart = if self.written(head.to(from)).contains(" (") {
                    ""
                } else {
                    " "
                };
                let open = match sign {
                    Some(sign) => Edit::new(sign, format!("{apart}{{")),
                    None => Edit::insert(self.id, head.end, " {"),
                };
                let title = format!("write `{} {{`", self.short(head));
                Fix::new(title, [open, Edit::new(close, "}")])
            });
        } else {
            while !self.is_on_new_line(0) && !matches!(self.word(0), "{" | "}" | "let") {
                self.bump();
            }
            block.bad.push(from.to(self.behind()));
        }
        let head = self.short(head);
        let help = "write its fields between braces, such as `sphere { center (0, 1, 0) }`";
        self.problems.push(
            problem(
                "unopened_block",
                format!("the block `{head}` lacks its braces"),
                block.span,
                "the block's fields stand between `{` and `}`",
            )
            .with_fix_or(fix, help),
        );
        self.items.push(Item::Block(block));
        true
    }

    // Lines that are no items.

    /// `x = 3`, and what may have been `let x = 3`.
    fn missing_let(&mut self) -> bool {
        let (word, start) = (self.word(0), self.here());
        let is_let = suggest::nearest(word, ["let"]).is_some() || OTHER_LETS.contains(&word);
        let is_plain = self.is(1, "=");
        if !(is_plain || (is_let && self.is_name(1) && self.is(2, "="))) {
            return false;
        }
        let mut ahead = 2;
        while ahead < FAR && !self.is_on_new_line(ahead) && !self.is(ahead, word) {
            ahead += 1;
        }
        let is_used = self.is(ahead, word) && !self.is_on_new_line(ahead);
        if is_plain && (self.words.is_let(word) || is_used) {
            let what = "assignments: a name keeps its value";
            let help = "give the new value a name of its own with `let NAME = VALUE`";
            self.not_in_language(what, help, start);
            self.bump();
            while !self.is_on_new_line(0) {
                self.bump();
            }
            return true;
        }
        if !is_plain {
            self.bump();
        }
        let name = self.name();
        let equals = self.bump();
        let told = self.problems.len();
        let value = match self.is_end_of_definition() {
            true => bad(self.behind()),
            false => self.value(),
        };
        let text = shorten(name.text);
        let help = format!("write `let {text} = {}`", self.short(value.span));
        let before = Span::new(self.id, start.start, name.span.start);
        let mut edits = vec![Edit::new(before, "let ")];
        // A `;` goes with the words of the other language.
        if self.is(0, ";") {
            let sign = self.bump();
            edits.push(Edit::remove_in(sign, self.text));
        }
        let is_sure = self.problems.len() == told && !value.span.range().is_empty();
        let is_sure = is_sure && self.is_on_new_line(0);
        self.problems.truncate(told);
        let message = format!("a value is given to `{text}` without `let`");
        let label = format!("`let {text}` should stand here");
        let fix = is_sure.then(|| Fix::new(&help, edits));
        self.problems
            .push(problem("missing_let", message, start, label).with_fix_or(fix, &help));
        self.items.push(Item::Definition(Definition {
            name: Some(name),
            equals: Some(equals),
            span: start.to(value.span),
            value: bad(value.span),
            ..Definition::begun(Span::new(self.id, start.start, start.start))
        }));
        if !self.is_boundary() {
            self.resync();
        }
        true
    }

    /// Something outside of blocks that starts no block.
    fn line(&mut self) {
        let start = self.here();
        if self.is_name(0) {
            let message = format!("`{}` stands outside of every block", shorten(self.word(0)));
            let help = "a file holds `let NAME = VALUE` and blocks such as `sphere { … }`; fields stand between a block's braces";
            self.problems.push(
                problem("outside_block", message, start, "this belongs to no block")
                    .with_help(help),
            );
        } else {
            let help =
                "a file holds `let NAME = VALUE` and blocks such as `sphere { center (0, 1, 0) }`";
            self.unexpected("`let` or a block", help);
        }
        self.bump();
        self.skip_lines();
        self.items.push(Item::Bad(start.to(self.behind())));
    }

    /// Goes on to the next item that starts a line, or behind a `}`.
    fn skip_lines(&mut self) {
        while self.kind(0) != TokenKind::End {
            if self.is_on_new_line(0) {
                self.comments(Place::Start);
                let word = self.word(0);
                if self.is(0, "let")
                    || self.is_head(0)
                    || (self.is_name(0) && self.is(1, "="))
                    || foreign::statement(word).is_some()
                {
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

    // What closes nothing.

    fn stray_closing(&mut self, sign: &str, first: Span, all: Span) {
        let fix = Fix::new(
            format!("remove this `{sign}`"),
            [Edit::remove_in(all, self.text)],
        );
        let message = format!("this `{sign}` closes nothing");
        self.problems
            .push(problem("stray_closing", message, first, "nothing is open here").with_fix(fix));
    }

    /// `)` or `]` that was never opened.
    pub(super) fn stray_parenthesis(&mut self) {
        let sign = self.word(0);
        let span = self.bump();
        self.stray_closing(sign, span, span);
    }

    /// `}` that was never opened, and others right behind it.
    fn stray_brace(&mut self) {
        let first = self.bump();
        let mut all = first;
        while self.is(0, "}") {
            all = all.to(self.bump());
        }
        self.stray_closing("}", first, all);
    }
}
