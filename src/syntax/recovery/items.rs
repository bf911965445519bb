//! Items: definitions, blocks with their heads, and lines that are neither.

use super::{Place, Recovery};
use crate::{
    diagnostic::Edit,
    source::Span,
    suggest,
    syntax::{
        Problem,
        fix::{Way, written_length},
        messages::{foreign_statement, shorten},
        tokens::TokenKind,
        tree::{Block, Definition, Item, Name, Value, ValueKind, bad},
    },
};

use super::values::{is_name, unquoted};

/// What other languages write for `let`.
const OTHER_LETS: &[&str] = &[
    "var", "const", "def", "define", "set", "val", "auto", "local", "int", "float", "double",
    "number", "vec3", "vector",
];

impl<'s> Recovery<'_, 's> {
    /// Reads one item, or what stands in the place of one.
    pub(super) fn any_item(&mut self) {
        self.comments(Place::Start);
        match self.word(0) {
            "" => {}
            "let" => self.definition(),
            "}" => self.stray_brace(),
            "," | ";" => self.separator("items"),
            ")" | "]" => self.stray_parenthesis(),
            "{" => {
                let span = self.here();
                self.problems.push(Problem::MissingKind { span });
                self.block();
            }
            word => {
                if let Some((what, help)) = foreign_statement(word) {
                    self.foreign_statement(what, help);
                } else if !self.nested_comment() {
                    match self.kind(0) {
                        TokenKind::Name => self.block_or_line(),
                        _ => self.line("`let` or a block"),
                    }
                }
            }
        }
    }

    // Definitions.

    pub(super) fn definition(&mut self) {
        let keyword = self.bump();
        let mut definition = Definition {
            keyword,
            name: None,
            equals: None,
            value: bad(keyword),
            span: keyword,
        };
        let told = self.problems.len();
        if !self.name_of_definition(&mut definition) {
            let end = Span::new(self.id, self.last_end, self.last_end);
            definition.value = bad(end);
            definition.span = keyword.to(end);
            self.push_definition(definition, told);
            return;
        }
        let is_end = self.is_end_of_definition();
        match self.word(0) {
            "=" | ":" if !is_end => {
                let sign = self.bump();
                definition.equals = Some(sign);
                if self.written(sign) == ":" {
                    self.missing_equals(&definition, sign);
                }
            }
            _ if !is_end && self.starts_value(0) => {
                let here = self.here();
                self.missing_equals(&definition, Span::new(self.id, here.start, here.start));
            }
            _ => {}
        }
        if self.is_end_of_definition() {
            if let (Some(name), true) = (definition.name, self.problems.len() == told) {
                self.problems.push(Problem::MissingValue {
                    name: name.text.to_owned(),
                    span: name.span.to(definition.equals.unwrap_or(name.span)),
                });
            }
            definition.value = bad(self.end_of_text());
        } else if self.is_head(0) && self.is(1, "{") && !self.is_on_new_line(0) {
            self.defined_block(&definition);
            return;
        } else {
            definition.value = self.value_of_definition();
            self.leave_doubtful(told);
            if definition.equals.is_none() {
                let problems = self.problems.get_mut(told..).unwrap_or_default();
                problems.iter_mut().skip(1).for_each(Problem::leave);
            }
            if self.problems.len() == told || matches!(self.word(0), ")" | "]") {
                self.end_of_definition(&mut definition.value);
            } else if !self.is_on_new_line(0) && definition.value.kind == ValueKind::Bad {
                self.skip_to_item();
            }
        }
        self.leave_doubtful(told);
        definition.span = keyword.to(definition.value.span);
        self.push_definition(definition, told);
    }

    /// Of definitions that are only begun, on one line, the first is reported.
    fn push_definition(&mut self, definition: Definition<'s>, told: usize) {
        let is_begun = |definition: &Definition<'s>| {
            definition.value.span.range().is_empty() && !definition.keyword.range().is_empty()
        };
        if let Some(Item::Definition(last)) = self.items.last()
            && is_begun(last)
            && is_begun(&definition)
        {
            let between = self.text.get(last.span.end..definition.span.start);
            if between.is_some_and(|between| !between.contains('\n')) {
                self.problems.truncate(told);
            }
        }
        self.items.push(Item::Definition(definition));
    }

    /// Reads the name behind `let`; answers whether there is one.
    fn name_of_definition(&mut self, definition: &mut Definition<'s>) -> bool {
        if self.is_end_of_definition() || self.is_head(0) {
            let span = definition.keyword;
            self.problems.push(Problem::MissingName { span });
            return false;
        }
        if matches!(self.word(0), "=" | ":") {
            let span = self.bump();
            self.problems.push(Problem::MissingName { span });
            if !self.is_end_of_definition() {
                let told = self.problems.len();
                self.value_of_definition();
                self.problems.truncate(told);
            }
            return false;
        }
        // A name goes on up to the `=`: what is no name in it is the mistake.
        let mut count = 0;
        while !matches!(self.word(count), "=" | ":" | "" | "{" | "}" | "let")
            && (count == 0 || !self.is_on_new_line(count))
        {
            count += 1;
        }
        let has_equals =
            matches!(self.word(count), "=" | ":") && (count == 0 || !self.is_on_new_line(count));
        if self.is_name(0) && (count == 1 || !has_equals) {
            definition.name = Some(self.name());
            return true;
        }
        let first = self.here();
        let last = match has_equals {
            true => self.peek(count.saturating_sub(1)),
            false => self.peek(0),
        };
        let span = first.to(self.span_of(last));
        if self.is_name(0) && self.is(1, "(") && !self.is(2, ")") {
            self.problems.push(Problem::NotInLanguage {
                what: "functions of one's own",
                help: "give each result a name with `let NAME = VALUE`",
                span,
            });
        } else {
            let written = self.short(span);
            self.problems.push(Problem::BadName { written, span });
        }
        self.parts_of_bad_name(span);
        while self.here().start < span.end && self.kind(0) != TokenKind::End {
            self.bump();
        }
        if matches!(self.word(0), "=" | ":") {
            self.bump();
        }
        if !self.is_end_of_definition() {
            let told = self.problems.len();
            self.value_of_definition();
            self.problems.truncate(told);
        }
        false
    }

    /// `let my-x = 5`, `let mut x = 5`: where `my-x` or `x` is used, `my`, `mut` and `x` are names that are known.
    fn parts_of_bad_name(&mut self, span: Span) {
        const ENOUGH: usize = 8;
        let is_between = |c: char| !c.is_alphanumeric() && c != '_';
        let mut at = span.start;
        for word in self.written(span).split_inclusive(is_between).take(ENOUGH) {
            let start = at;
            at += word.len();
            let word = word.trim_end_matches(is_between);
            let place = Span::new(self.id, start, start + word.len());
            if is_name(word) {
                let end = Span::new(self.id, span.end, span.end);
                self.items.push(Item::Definition(Definition {
                    keyword: Span::new(self.id, span.start, span.start),
                    name: Some(Name {
                        text: word,
                        span: place,
                    }),
                    equals: None,
                    value: bad(end),
                    span: place,
                }));
            }
        }
    }

    fn missing_equals(&mut self, definition: &Definition<'s>, span: Span) {
        let Some(name) = definition.name else { return };
        const LONGEST: usize = 100;
        let start = self.here().start;
        let rest = self.text.get(start..).unwrap_or_default();
        let end = (0..=LONGEST.min(rest.len()))
            .rev()
            .find(|&end| rest.is_char_boundary(end));
        let rest = rest.get(..end.unwrap_or(0)).unwrap_or_default();
        let value = rest.split(['\n', ';', '}']).next().unwrap_or_default();
        let value = value.get(..written_length(value)).unwrap_or_default();
        let (span, edit) = match self.written(span) {
            ":" => {
                let gap = Span::new(self.id, name.span.end, span.end);
                (span, Edit::new(gap, " ="))
            }
            _ => {
                let here = self.here();
                (here, Edit::insert(self.id, here.start, "= "))
            }
        };
        self.problems.push(Problem::MissingEquals {
            name: name.text.to_owned(),
            span,
            way: Way::write(
                format!("write `let {} = {}`", name.text, shorten(value)),
                [edit],
            ),
        });
    }

    /// Whether no value can follow any more.
    fn is_end_of_definition(&mut self) -> bool {
        let is_new = self.is_on_new_line(0);
        match self.kind(0) {
            TokenKind::End => true,
            TokenKind::Name => {
                self.is(0, "let")
                    || (is_new && !self.words.is_value(self.word_seen(0)))
                    || (is_new && self.is_head(0))
            }
            TokenKind::Sign => matches!(self.word(0), "}" | "{" | ";"),
            _ => false,
        }
    }

    /// The value of a definition, or of a `--set`: what is written on a line.
    pub(super) fn value_of_definition(&mut self) -> Value<'s> {
        let mut values = Vec::new();
        let mut commas = Vec::new();
        self.too_deep = false;
        loop {
            let next = self.next;
            values.push(self.expression());
            if self.next == next || self.too_deep {
                break;
            }
            self.comments(Place::Operator);
            if self.is(0, ",") && self.kind(1) == TokenKind::Number && !self.is_on_new_line(1) {
                let comma = self.bump();
                commas.push(comma);
            }
            let is_operator = self.kind(0) == TokenKind::Sign && !matches!(self.word(0), "(" | "[");
            let word = self.word(0);
            let is_field =
                self.is_name(0) && self.is_field_name(word) && !self.words.is_value(word);
            let is_item = is_field || (self.is_head(0) && !self.goes_on_as_value());
            if self.is_on_new_line(0) || is_operator || is_item || !self.starts_value(0) {
                break;
            }
        }
        if self.too_deep {
            let span = values
                .first()
                .map_or(self.end_of_text(), |first| first.span);
            return bad(span.to(self.end_of_text()));
        }
        self.joined(values, &commas)
    }

    /// `2 pi`, with `sphere {` in the next line: a name that is no kind, before one that is.
    fn goes_on_as_value(&mut self) -> bool {
        let (first, second) = (self.word(0), self.word(1));
        self.is_name(1)
            && !self.words.is_kind(first)
            && self.words.is_kind(second)
            && self.is_on_new_line(1)
    }

    /// What stands behind a definition on its line.
    fn end_of_definition(&mut self, value: &mut Value<'s>) {
        while matches!(self.word(0), ")" | "]") {
            let told = self.problems.len();
            let is_sure = self.is_known(value);
            self.stray_parenthesis();
            let is_end = self.is_on_new_line(0) || matches!(self.word(0), ")" | "+" | "-");
            if let Some(problem) = self.problems.last_mut()
                && !(is_end && (is_sure || value.kind == ValueKind::Bad))
            {
                problem.leave();
            }
            while matches!(self.word(0), "+" | "-" | "*" | "/") && !self.is_on_new_line(0) {
                self.bump();
                self.expression();
            }
            if self.problems.len() > told + 1 {
                self.problems.truncate(told + 1);
            }
            *value = bad(value.span.to(self.end_of_text()));
        }
        while matches!(self.word(0), ";" | ",") {
            self.separator("items");
        }
        let is_item = matches!(self.word(0), "let" | "" | "}" | "{" | "#") || self.is_head(0);
        if is_item || self.is_on_new_line(0) || value.kind == ValueKind::Bad {
            return;
        }
        if self.is_name(0) {
            return;
        }
        self.unexpected(
            "the end of the definition",
            "write one value behind the `=`",
        );
        *value = bad(value.span);
        self.skip_to_item();
    }

    /// Passes over the rest of a line, up to what starts an item.
    fn skip_to_item(&mut self) {
        while !self.is_on_new_line(0)
            && !matches!(self.word(0), "let" | "{" | "}" | "#")
            && !self.is_head(0)
        {
            self.bump();
        }
    }

    /// `let Ball = sphere {`: what was meant is a block with a name.
    fn defined_block(&mut self, definition: &Definition<'s>) {
        let kind = self.here();
        let Some(name) = definition.name else { return };
        let place = definition.keyword.to(kind);
        let right = format!("{} {}", self.written(kind), name.text);
        self.problems.push(Problem::BadHead {
            span: definition
                .keyword
                .to(definition.equals.unwrap_or(name.span)),
            way: Way::write(format!("write `{right} {{`"), [Edit::new(place, right)]),
        });
        let items = self.items.len();
        self.block();
        if let Some(Item::Block(block)) = self.items.get_mut(items) {
            block.name = Some(name);
        }
    }

    // Blocks.

    /// Reads a block whose head is right, or missing.
    pub(super) fn block(&mut self) {
        let mut block = Block::empty(self.here());
        if self.is_name(0) {
            block.kind = Some(self.name());
            if self.is_name(0) {
                block.name = Some(self.name());
            }
        }
        self.open_block(block);
    }

    /// Reads a block from its `{` on.
    fn open_block(&mut self, mut block: Block<'s>) {
        // No block stands in another one; so deep, nobody means one.
        const DEEPEST: usize = 8;
        block.open = Some(self.bump());
        if self.blocks == DEEPEST {
            self.skip_block();
            return;
        }
        self.blocks += 1;
        let kind = block.kind.map_or("", |kind| kind.text);
        let is_container = !self.words.is_kind(kind)
            && (self.is(0, "let") || self.is_head(0))
            && block.kind.is_some();
        if is_container {
            self.container(&block);
        } else {
            self.body(&mut block);
            self.items.push(Item::Block(block));
        }
        self.blocks -= 1;
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

    /// `scene { sphere { … } }`: the blocks within are read by themselves.
    fn container(&mut self, block: &Block<'s>) {
        let kind = block.kind.map_or("", |kind| kind.text);
        self.problems.push(Problem::NestedBraces {
            what: format!("blocks stand by themselves, not within `{}`", shorten(kind)),
            span: block.keyword(),
        });
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

    /// A name at the start of an item: a block, whatever stands in its head, or a line.
    fn block_or_line(&mut self) {
        if self.is_head(0) {
            self.block();
            return;
        }
        const LONGEST: usize = 24;
        let mut count = 1;
        let mut is_open = false;
        while count < LONGEST {
            match self.word(count) {
                "{" => {
                    is_open = true;
                    break;
                }
                "let" if self.is(count + 1, "{") => count += 1,
                "}" | "let" | ";" | "" => break,
                _ if self.is_on_new_line(count) => break,
                _ => count += 1,
            }
        }
        match is_open {
            true => self.head(count),
            false => self.line("`let` or a block"),
        }
    }

    /// What stands before a `{`: a kind and a name, or more than these.
    fn head(&mut self, count: usize) {
        let mut block = Block::empty(self.here());
        let first = self.here();
        let last = self.peek(count - 1);
        let whole = first.to(self.span_of(last));
        if self.is(1, "let") {
            let span = self.peek(1);
            let span = self.span_of(span);
            let written = "let".to_owned();
            self.problems.push(Problem::BadName { written, span });
        } else if self.is(1, "=") && self.is_name(2) && count == 3 {
            let name = self.name();
            let equals = self.bump();
            let kind = self.name();
            let right = format!("{} {}", kind.text, name.text);
            self.problems.push(Problem::BadHead {
                span: first.to(equals),
                way: Way::write(format!("write `{right} {{`"), [Edit::new(whole, right)]),
            });
            block.kind = Some(kind);
            block.name = Some(name);
            self.open_block(block);
            return;
        } else {
            self.odd_head(count, whole);
        }
        block.kind = Some(self.name());
        if self.is_name(0) {
            block.name = Some(self.name());
        }
        while !self.is(0, "{") {
            block.bad = vec![whole];
            self.bump();
        }
        self.open_block(block);
    }

    fn odd_head(&mut self, count: usize, whole: Span) {
        let second = self.peek(1);
        let rest = Span::new(self.id, second.start, whole.end);
        let kind = self.word(0);
        let written = self.written(rest);
        if count == 2 && self.kind(1) == TokenKind::Quoted {
            let inner = unquoted(written).replace([' ', '-'], "_");
            let way = match is_name(&inner) {
                true => Way::replace(rest, inner),
                false => Way::told("write a name of letters, digits and `_`"),
            };
            let what = "a name";
            self.problems.push(Problem::Quoted {
                what,
                span: rest,
                way,
            });
            return;
        }
        let is_words = (1..count).all(|ahead| {
            matches!(self.kind(ahead), TokenKind::Name | TokenKind::Number)
                || matches!(self.word(ahead), "-" | ".")
        });
        let joined: Vec<&str> = written
            .split([' ', '-', '.', '\t'])
            .filter(|word| !word.is_empty())
            .collect();
        let joined = joined.join("_");
        let way = match is_words && is_name(&joined) {
            true => {
                let mut way = Way::replace(rest, &joined);
                way.help = format!("write `{kind} {} {{`", shorten(&joined));
                way
            }
            // A name and then something else, or something else at once.
            false if self.is_name(1) && count > 2 => {
                let third = self.peek(2);
                let name = self.word(1);
                Way::remove(
                    format!("write `{kind} {} {{`", shorten(name)),
                    Span::new(self.id, third.start, whole.end),
                )
            }
            false if matches!(written, "=" | ":") => {
                Way::remove(format!("write `{} {{`", shorten(kind)), rest)
            }
            false => Way::told(format!("write `{} {{`, and then its fields", shorten(kind))),
        };
        let span = match is_words && self.is_name(1) && count > 2 && written.contains(' ') {
            true => Span::new(self.id, self.peek(2).start, whole.end),
            false => rest,
        };
        self.problems.push(Problem::BadHead { span, way });
    }

    // Lines that are no items.

    /// A line outside of blocks that starts no block.
    fn line(&mut self, expected: &'static str) {
        let start = self.here();
        if self.is_name(0) && self.missing_let() {
            return;
        }
        if self.is_name(0) && self.unopened_block() {
            return;
        }
        match self.kind(0) {
            TokenKind::Name => {
                let name = shorten(self.word(0));
                self.problems
                    .push(Problem::OutsideBlock { name, span: start });
            }
            _ => self.unexpected(
                expected,
                "a file holds `let NAME = VALUE` and blocks such as `sphere { center (0, 1, 0) }`",
            ),
        }
        self.bump();
        self.skip_lines();
        self.items
            .push(Item::Bad(Span::new(self.id, start.start, self.last_end)));
    }

    /// Goes on to the next item that starts a line, or behind a `}`.
    fn skip_lines(&mut self) {
        let mut braces = 0_usize;
        loop {
            if self.kind(0) == TokenKind::End {
                return;
            }
            if self.is_on_new_line(0) && braces == 0 {
                self.comments(Place::Start);
                let is_assignment = self.is_name(0) && self.is(1, "=");
                if self.is(0, "let")
                    || is_assignment
                    || self.is_head(0)
                    || foreign_statement(self.word_seen(0)).is_some()
                {
                    return;
                }
            }
            match self.word(0) {
                "{" => braces += 1,
                "}" if braces <= 1 => {
                    self.bump();
                    return;
                }
                "}" => braces -= 1,
                _ => {}
            }
            self.bump();
        }
    }

    /// `x = 3`, and what may have been `let x = 3`.
    fn missing_let(&mut self) -> bool {
        let start = self.here();
        let word = self.word(0);
        let is_let = suggest::nearest(word, ["let"]).is_some() || OTHER_LETS.contains(&word);
        let ahead = match (self.is(1, "="), self.is_name(1) && self.is(2, "=")) {
            (true, _) => 0,
            (_, true) if is_let => 1,
            _ => return false,
        };
        let glued = word
            .strip_prefix("let")
            .filter(|rest| ahead == 0 && is_name(rest));
        let name = self.peek(ahead);
        let name = self.span_of(name);
        let name = match glued {
            Some(rest) => Span::new(self.id, name.end - rest.len(), name.end),
            None => name,
        };
        let text = self.written(name);
        let is_again = self.words.is_let(text) || self.is_in_line(text, 2);
        if ahead == 0 && glued.is_none() && is_again {
            self.problems.push(Problem::NotInLanguage {
                what: "assignments: a name keeps its value",
                help: "give the new value a name of its own with `let NAME = VALUE`",
                span: start,
            });
            self.bump();
            self.skip_rest_of_line();
            return true;
        }
        for _ in 0..=ahead {
            self.bump();
        }
        let equals = self.bump();
        let told = self.problems.len();
        let value = match self.is_end_of_definition() {
            true => bad(self.end_of_text()),
            false => self.value_of_definition(),
        };
        let mut way = Way::write(
            format!("write `let {text} = {}`", self.short(value.span)),
            [Edit::new(
                Span::new(self.id, start.start, name.start),
                "let ",
            )],
        );
        // A `;` goes with the words of the other language.
        if self.is(0, ";") && (ahead == 1 || glued.is_none()) {
            way.removed.push(self.bump());
        }
        if self.problems.len() > told || value.span.range().is_empty() {
            way.leave();
            self.problems.truncate(told);
        }
        self.problems.push(Problem::MissingLet {
            name: text.to_owned(),
            span: start,
            way,
        });
        let keyword = Span::new(self.id, start.start, start.start);
        self.items.push(Item::Definition(Definition {
            keyword,
            name: Some(Name { text, span: name }),
            equals: Some(equals),
            span: start.to(value.span),
            value: bad(value.span),
        }));
        if !self.is_on_new_line(0) && self.problems.len() > told {
            self.skip_to_item();
        }
        true
    }

    /// Whether a word stands in the rest of the line, behind so many tokens.
    fn is_in_line(&mut self, word: &str, behind: usize) -> bool {
        let mut ahead = behind;
        while !self.is_on_new_line(ahead) && self.kind(ahead) != TokenKind::End {
            if self.is(ahead, word) {
                return true;
            }
            ahead += 1;
        }
        false
    }

    fn skip_rest_of_line(&mut self) {
        while !self.is_on_new_line(0) {
            self.bump();
        }
    }

    /// A kind without the `{` that should follow: `camera:`, `image 640 480`, `sphere (…)`, `sphere Ball` and then fields.
    fn unopened_block(&mut self) -> bool {
        let kind = self.word(0);
        if !self.words.is_kind(kind) {
            return false;
        }
        let start = self.here();
        let has_name = self.is_name(1)
            && !self.is_on_new_line(1)
            && self.words.takes(kind, self.word_seen(1)).is_none();
        let behind = 1 + usize::from(has_name);
        let last = self.peek(behind - 1);
        let head = start.to(self.span_of(last));
        let mut block = Block::empty(head);
        let told = "write its fields between braces, such as `sphere { center (0, 1, 0) }`";
        let mut way = Way::told(told);
        let is_list = self.is(behind, "(");
        if is_list
            && self.is_name(behind + 1)
            && !self.is(behind + 2, ",")
            && !self.is(behind + 2, ")")
        {
            // The parentheses stand for braces.
            let open = self.peek(behind);
            let close = self.closing(behind);
            if let Some(close) = close {
                let braces = [(self.span_of(open), " {"), (close, "}")];
                way = Way::write(
                    format!("write `{} {{`", self.short(head)),
                    braces.map(|(span, brace)| Edit::new(span, brace)),
                );
                if self.text.get(open.start.saturating_sub(1)..open.start) == Some(" ") {
                    way.edits = braces
                        .map(|(span, brace)| Edit::new(span, brace.trim()))
                        .to_vec();
                }
            }
        }
        // On the lines below stand fields, and a `}` closes them.
        let fields_below =
            self.is_on_new_line(behind) && self.is_name(behind) && !self.is_head(behind);
        let on_line = !self.is_on_new_line(behind) && self.is_name(behind);
        let field = self.word_seen(behind);
        let is_field = self.words.takes(kind, field).is_some()
            && self.starts_value(behind + 1)
            && self.words.takes(kind, self.word_seen(behind + 1)).is_none();
        if (fields_below || on_line) && is_field && self.closes_before_item(behind) {
            way = Way::write(
                format!("write `{} {{`", self.short(head)),
                [Edit::insert(self.id, head.end, " {")],
            );
        }
        block.kind = Some(self.name());
        if has_name {
            block.name = Some(self.name());
        }
        self.problems.push(Problem::UnopenedBlock {
            head: self.short(head),
            span: head,
            way,
        });
        let from = self.here().start;
        self.skip_fields();
        let bad = Span::new(self.id, from.min(self.last_end), self.last_end);
        block.bad.push(bad);
        block.span = head.to(bad);
        self.items.push(Item::Block(block));
        true
    }

    /// The `)` that closes the `(` at a token ahead, if nothing but fields stands between.
    fn closing(&mut self, open: usize) -> Option<Span> {
        let mut depth = 0_usize;
        const ENOUGH: usize = 500;
        for ahead in open..open + ENOUGH {
            match self.word(ahead) {
                "(" => depth += 1,
                ")" if depth == 1 => {
                    let token = self.peek(ahead);
                    return Some(self.span_of(token));
                }
                ")" => depth -= 1,
                "{" | "}" | "let" | "" => return None,
                _ => {}
            }
        }
        None
    }

    /// Whether a `}` follows before the next block or definition.
    fn closes_before_item(&mut self, from: usize) -> bool {
        const ENOUGH: usize = 500;
        for ahead in from..from + ENOUGH {
            match self.word(ahead) {
                "}" => return true,
                "{" | "let" | "" => return false,
                _ => {}
            }
        }
        false
    }

    /// Passes over the fields of a block without its `{`: its own line, and indented ones or those up to a `}` below.
    fn skip_fields(&mut self) {
        let closes = self.closes_before_item(0);
        loop {
            if self.kind(0) == TokenKind::End || self.is(0, "let") {
                return;
            }
            if self.is_on_new_line(0) && !closes {
                let is_field =
                    self.is_name(0) && !self.is_head(0) && !self.words.is_kind(self.word_seen(0));
                let line = self
                    .text
                    .get(self.last_end..self.here().start)
                    .unwrap_or_default();
                if !is_field || !line.ends_with([' ', '\t']) {
                    return;
                }
            }
            let is_close = self.is(0, "}");
            if self.is(0, "{") {
                return;
            }
            self.bump();
            if is_close {
                return;
            }
        }
    }

    /// `if (a > 0) {`, `for i in 0..10 {`, `import "x"`, `print(r)`: passed over, with what stands in braces behind it.
    fn foreign_statement(&mut self, what: &'static str, help: &'static str) {
        let span = self.here();
        self.problems
            .push(Problem::NotInLanguage { what, help, span });
        self.bump();
        self.skip_line();
        let mut braces = 0_usize;
        while self.kind(0) != TokenKind::End {
            match self.word(0) {
                "{" => braces += 1,
                "}" if braces > 0 => braces -= 1,
                _ if braces == 0 => return,
                _ => {}
            }
            let is_last = braces == 0;
            self.bump();
            if is_last {
                return;
            }
        }
    }

    /// `/* /* */ c */`: the first `*/` ended the comment.
    fn nested_comment(&mut self) -> bool {
        const ENOUGH: usize = 64;
        let start = self.here().start;
        let Some(close) = (0..ENOUGH).find(|&ahead| {
            self.is(ahead, "*") && self.is(ahead + 1, "/") && self.is_adjacent(ahead + 1)
        }) else {
            return false;
        };
        let before = self.text.get(..start).unwrap_or_default();
        let Some(comment) = before.trim_end().strip_suffix("*/") else {
            return false;
        };
        let Some(second) = comment.rfind("/*") else {
            return false;
        };
        if !comment
            .get(..second)
            .is_some_and(|first| first.contains("/*"))
        {
            return false;
        }
        let close = self.peek(close);
        let close = Span::new(self.id, close.start, close.start + 2);
        let first = Span::new(self.id, comment.len(), comment.len() + 2);
        self.problems.push(Problem::NestedComment {
            span: Span::new(self.id, second, second + 2),
            close,
            way: Way::write(
                "take the inner `/*` and `*/` away",
                [
                    Edit::new(Span::new(self.id, second, second + 2), ""),
                    Edit::new(first, ""),
                ],
            ),
        });
        while self.here().start < close.end {
            self.bump();
        }
        true
    }

    /// `}` that was never opened, and others right behind it.
    fn stray_brace(&mut self) {
        let first = self.bump();
        let mut all = first;
        while self.is(0, "}") {
            all = all.to(self.bump());
        }
        self.problems.push(Problem::StrayClosing {
            sign: "}".to_owned(),
            span: first,
            way: Way::remove("remove this `}`", all),
        });
    }
}
