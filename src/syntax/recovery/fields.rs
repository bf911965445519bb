//! The fields of a block.

use super::{Place, Recovery, Within};
use crate::{
    diagnostic::Edit,
    schema::Type,
    source::Span,
    syntax::{
        Problem,
        fix::Way,
        messages::shorten,
        tokens::{TokenKind, numeric_part},
        tree::{Block, Field, Item, Name, Value, ValueKind, bad, number},
    },
};

impl<'s> Recovery<'_, 's> {
    /// Reads a block from behind its `{` up to its `}`, or to where that is missing.
    pub(super) fn body(&mut self, block: &mut Block<'s>) {
        let within = Within {
            kind: block.kind.map_or("", |kind| kind.text),
            is_block: true,
            ..Within::default()
        };
        let outside = std::mem::replace(&mut self.within, within);
        let told = self.problems.len();
        let (mut braces, mut had_braces) = (0_usize, false);
        loop {
            self.comments(Place::Start);
            if self.kind(0) == TokenKind::End || self.is_after_block(block) {
                // A `{` within the block was reported, or a comment that took the `}`.
                let told = self.problems.get(told..).unwrap_or_default();
                let is_told = told.iter().any(|problem| {
                    matches!(problem, Problem::ForeignComment { is_sure: false, .. })
                });
                block.span.end = self.last_end.max(block.span.end);
                if !had_braces && !is_told {
                    self.unclosed_block(block);
                }
                break;
            }
            match self.word(0) {
                "}" if braces > 0 => {
                    braces -= 1;
                    self.bump();
                }
                "}" => {
                    let close = self.bump();
                    block.close = Some(close);
                    block.span = block.span.to(close);
                    break;
                }
                "let" => self.misplaced_let(block),
                "," | ";" => self.separator("fields"),
                "{" => {
                    braces += 1;
                    had_braces = true;
                    let span = self.bump();
                    self.problems.push(Problem::NestedBraces {
                        what: "braces within a block".to_owned(),
                        span,
                    });
                }
                name if self.is_head(0) && !(self.is(1, "{") && self.is_field_name(name)) => {
                    // What the outer block lacks may stand in the inner one.
                    block.bad.push(block.keyword());
                    had_braces = true;
                    self.nested_block();
                }
                _ if self.is_name(0) => self.field(block),
                _ => self.no_field(block),
            }
        }
        self.within = outside;
        // Where its fields end is doubtful: what else seems to be wrong may be something else.
        let problems = self.problems.get_mut(told..).unwrap_or_default();
        if problems.len() > 1 && problems.iter().any(Problem::is_structural) {
            for problem in problems {
                let is_of_value = matches!(
                    problem,
                    Problem::NeedlessSeparator { .. }
                        | Problem::NeedlessEquals { .. }
                        | Problem::MisplacedLet { .. }
                );
                if is_of_value {
                    problem.leave();
                }
            }
        }
    }

    /// Whether something starts here that shows that the block's `}` was forgotten: an item at the start of a line that is
    /// indented no more than the block.
    fn is_after_block(&mut self, block: &Block<'s>) -> bool {
        let is_item = self.is(0, "let") || self.is_head(0);
        let known = self.word(0);
        is_item
            && self.is_on_new_line(0)
            && (known == "let" || self.words.is_kind(known))
            && self.words.is_kind(self.within.kind)
            && self.indent_here() <= self.indent(block.span.start)
    }

    fn indent_here(&mut self) -> usize {
        let start = self.here().start;
        self.indent(start)
    }

    fn indent(&self, at: usize) -> usize {
        let before = self.text.get(..at).unwrap_or_default();
        let line = before.rsplit('\n').next().unwrap_or_default();
        line.len() - line.trim_start().len()
    }

    fn unclosed_block(&mut self, block: &mut Block<'s>) {
        let Some(open) = block.open else { return };
        let again = match self.items.last() {
            Some(Item::Block(last)) => last.close.is_none() && last.fields.is_empty(),
            _ => false,
        };
        if again && block.fields.is_empty() {
            // One block after the other that is only begun is one mistake.
            return;
        }
        let before = (self.kind(0) != TokenKind::End).then(|| self.here());
        let kind = block.kind.map_or("this block", |kind| kind.text);
        self.problems.push(Problem::UnclosedBlock {
            kind: kind.to_owned(),
            open,
            end: self.end_of_text(),
            before,
        });
    }

    /// A `,` or `;` that is not needed: one report in a block for all of a kind.
    pub(super) fn separator(&mut self, between: &'static str) {
        let sign = self.word(0);
        let span = self.bump();
        let slips = match self.within.is_block {
            true => &self.within.slips,
            false => &self.item_separators,
        };
        let known = slips
            .iter()
            .find(|(slip, _)| *slip == sign)
            .map(|slip| slip.1);
        if let Some(index) = known
            && let Some(Problem::NeedlessSeparator { way, .. }) = self.problems.get_mut(index)
        {
            way.removed.push(span);
            way.help = format!("take them away; white space separates {between}");
            return;
        }
        let index = self.problems.len();
        match self.within.is_block {
            true => self.within.slips.push((sign, index)),
            false => self.item_separators.push((sign, index)),
        }
        let help = format!("take it away; white space separates {between}");
        self.problems.push(Problem::NeedlessSeparator {
            sign: sign.to_owned(),
            between,
            span,
            way: Way::remove(help, span),
        });
    }

    /// A `=` or `:` behind a field's name: one report in a block for all of a kind.
    fn needless_equals(&mut self, span: Span) {
        let sign = self.written(span);
        let known = self.within.slips.iter().find(|slip| slip.0 == sign);
        if let Some(&(_, index)) = known
            && let Some(Problem::NeedlessEquals { way, .. }) = self.problems.get_mut(index)
        {
            way.removed.push(span);
            "take them away".clone_into(&mut way.help);
            return;
        }
        self.within.slips.push((sign, self.problems.len()));
        self.problems.push(Problem::NeedlessEquals {
            sign: sign.to_owned(),
            span,
            way: Way::remove("take it away", span),
        });
    }

    /// Definitions within a block are read as if they stood before it.
    fn misplaced_let(&mut self, block: &Block<'s>) {
        let span = self.here();
        let start = span.start;
        let index = self.problems.len();
        self.within.is_block = false;
        while self.is(0, "let") {
            self.definition();
        }
        self.within.is_block = true;
        let definitions = Span::new(self.id, start, self.last_end);
        self.problems.insert(
            index,
            Problem::MisplacedLet {
                span,
                is_alone: self.problems.len() == index,
                definitions,
                block: block.span,
            },
        );
        // The problems behind it moved on.
        for (_, known) in &mut self.within.slips {
            *known += usize::from(*known >= index);
        }
    }

    /// A block within a block: an object is read by itself, anything else is passed over.
    fn nested_block(&mut self) {
        let kind = self.word(0);
        let span = self.here();
        self.problems.push(Problem::NestedBraces {
            what: format!("the block `{}` stands within another one", shorten(kind)),
            span,
        });
        let is_known = self.words.is_kind(kind);
        let items = self.items.len();
        let told = self.problems.len();
        self.block();
        if !is_known {
            self.items.truncate(items);
            self.problems.truncate(told);
        }
    }

    /// Whether a name is that of a field of the block.
    pub(super) fn is_field_name(&self, name: &str) -> bool {
        self.words.takes(self.within.kind, name).is_some()
    }

    fn field(&mut self, block: &mut Block<'s>) {
        let mut name = self.name();
        if let Some(field) = self.glued(&name) {
            block.fields.push(field);
            return;
        }
        let is_known = self.is_field_name(name.text);
        if !is_known && self.is_name(0) && self.are_two_words(name.text) {
            let second = self.bump();
            let span = name.span.to(second);
            name = Name {
                text: self.written(span),
                span,
            };
        }
        let has_equals = self.is(0, "=") || self.is(0, ":");
        let equals = has_equals.then(|| self.bump());
        self.within.takes = self.words.takes(self.within.kind, name.text);
        self.within.field = name.text;
        let index = self.problems.len();
        let value = self.value_of_field(&name);
        if let Some(equals) = equals.filter(|_| value.kind != ValueKind::Missing) {
            self.needless_equals(equals);
        }
        self.within.takes = None;
        self.within.field = "";
        let is_again = block
            .fields
            .iter()
            .any(|field| field.name.text == name.text);
        if value.kind == ValueKind::Missing && is_again && is_known && self.problems.len() == index
        {
            self.problems.push(Problem::Unexpected {
                expected: "a field or `}`",
                written: name.text.to_owned(),
                help: "take it away: the block has this field already",
                span: name.span,
            });
            block.bad.push(name.span);
            return;
        }
        if value.kind == ValueKind::Bad {
            block.bad.push(value.span);
        }
        self.leave_doubtful(index);
        block.fields.push(Field {
            name,
            span: name.span.to(value.span),
            value,
        });
    }

    /// Whether a word and the next one are the name of a field: `look at`, `view height`.
    fn are_two_words(&mut self, first: &str) -> bool {
        let second = self.word(0);
        let mut names = self.words.fields(self.within.kind);
        names.any(|name| {
            let rest = name.strip_prefix(first);
            rest.is_some_and(|rest| rest.strip_prefix('_').unwrap_or(rest) == second)
        })
    }

    /// `radius2` and `colorred`: a field with its value, and no space between them.
    fn glued(&mut self, name: &Name<'s>) -> Option<Field<'s>> {
        let is_known = self.is_field_name(name.text) || self.words.is_let(name.text);
        let is_fraction = self.kind(0) == TokenKind::Number && self.is_adjacent(0);
        if is_known || (!is_fraction && self.starts_value(0) && !self.starts_field(true)) {
            return None;
        }
        let names = self.words.fields(self.within.kind);
        let field = names
            .filter(|field| name.text.starts_with(field))
            .max_by_key(|field| field.len())?;
        let at = name.span.start + field.len();
        let end = if is_fraction {
            self.peek(0).end
        } else {
            name.span.end
        };
        let span = Span::new(self.id, at, end);
        let rest = self.written(span);
        let kind = match numeric_part(rest) == rest {
            true => number(rest),
            false if self.words.is_value(rest) => ValueKind::Name(rest),
            false => return None,
        };
        if is_fraction {
            self.bump();
        }
        self.problems.push(Problem::MissingSpace {
            left: (*field).to_owned(),
            right: rest.to_owned(),
            span: name.span.to(span),
            way: Way::write(
                format!("write `{field} {rest}`"),
                [Edit::insert(self.id, at, " ")],
            ),
        });
        let text = name.text.get(..field.len())?;
        let name = Name {
            text,
            span: Span::new(self.id, name.span.start, at),
        };
        Some(Field {
            name,
            span: name.span.to(span),
            value: Value { kind, span },
        })
    }

    /// Whether the next token is the name of a field, rather than a value or a part of one.
    fn starts_field(&mut self, has_value: bool) -> bool {
        if !self.is_name(0) {
            return false;
        }
        let word = self.word(0);
        let is_value = self.words.is_value(word);
        if self.is_field_name(word) {
            return has_value || !self.words.is_let(word);
        }
        if !has_value {
            return self.is_on_new_line(0) && !is_value && self.starts_value(1);
        }
        !is_value || self.is_on_new_line(0)
    }

    fn value_of_field(&mut self, name: &Name<'s>) -> Value<'s> {
        let takes = self.within.takes;
        let mut values: Vec<Value<'s>> = Vec::new();
        let mut commas = Vec::new();
        let mut stray = false;
        self.too_deep = false;
        loop {
            let place = if values.is_empty() {
                Place::Value
            } else {
                Place::Operator
            };
            self.comments(place);
            let word = self.word(0);
            if matches!(word, ")" | "]") || (word == ">" && !values.is_empty()) {
                self.stray_in_value(&values, commas.len(), stray);
                stray = true;
                continue;
            }
            if word == "," && self.goes_on_behind_comma(&values) {
                let comma = self.bump();
                commas.push(comma);
                continue;
            }
            if word == "." && self.is_adjacent(0) && !values.is_empty() {
                self.unexpected("a field or `}`", "take it away");
                self.bump();
                stray = true;
                continue;
            }
            let is_first = values.is_empty();
            let starts = match self.kind(0) {
                TokenKind::Name => {
                    let kind = self.word(1);
                    // The kind of a block behind it stands in the head, not this.
                    let is_head = self.is_head(0) && !(self.is_name(1) && self.words.is_kind(kind));
                    !self.is(0, "let") && !is_head && self.is_value_name(&values)
                }
                TokenKind::Sign => match word {
                    "{" => is_first && self.is_flat_list(),
                    "-" | "+" | "−" | "*" | "/" | "^" | "**" | "%" | "×" | "·" | "÷" => {
                        is_first || stray
                    }
                    "(" | "[" | "<" => true,
                    "#" => is_first,
                    _ => false,
                },
                TokenKind::End => false,
                TokenKind::Color => is_first || takes == Some(Type::Color),
                _ => true,
            };
            if !starts {
                break;
            }
            let next = self.next;
            let value = match takes {
                Some(Type::Method) if is_first => self.method(),
                _ => self.expression(),
            };
            if self.too_deep {
                stray = true;
            }
            values.push(value);
            if self.next == next {
                break;
            }
        }
        let after = Span::new(self.id, name.span.end, name.span.end);
        match values.first() {
            None if stray => bad(after),
            None => {
                if self.is(0, ",") && self.starts_value(1) && !self.is_name(1) {
                    self.unexpected("a value", "take the comma away, or write a value before it");
                    while self.is(0, ",") || (self.starts_value(0) && !self.is_name(0)) {
                        self.bump();
                    }
                    return bad(after.to(self.end_of_text()));
                }
                if self.kind(0) == TokenKind::Sign
                    && !matches!(self.word(0), "}" | "," | ";" | "{" | "#" | "-")
                {
                    self.unexpected(
                        "a value",
                        "write a value, such as `2`, `30deg`, `(0, 1, 0)` or `olive`",
                    );
                    let span = self.bump();
                    return bad(after.to(span));
                }
                Value {
                    kind: ValueKind::Missing,
                    span: after,
                }
            }
            Some(first) if stray => bad(first.span.to(self.end_of_text())),
            Some(_) => self.joined(values, &commas),
        }
    }

    /// Whether a name belongs to the values before it: the first one, or one that is known for a value.
    fn is_value_name(&mut self, values: &[Value<'s>]) -> bool {
        let word = self.word(0);
        let Some(last) = values.last() else {
            return !self.starts_field(false);
        };
        let is_words = matches!(self.within.takes, Some(Type::Color | Type::Method))
            && matches!(last.kind, ValueKind::Name(_))
            && !self.is_field_name(word)
            && !self.is_on_new_line(0)
            && !self.starts_value(1);
        let is_call = self.words.is_function(word) && !matches!(last.kind, ValueKind::Number(_));
        is_words || (!self.starts_field(true) && !is_call)
    }

    /// Whether a comma stands between values, rather than between two fields.
    fn goes_on_behind_comma(&mut self, values: &[Value<'s>]) -> bool {
        if values.is_empty() || self.is(1, ",") {
            return false;
        }
        match self.kind(1) {
            TokenKind::Number => true,
            TokenKind::Name => {
                let word = self.word(1);
                self.words.is_value(word) && !self.is_field_name(word)
            }
            TokenKind::Sign => self.is(1, "-") || (self.is(1, "(") && !self.is_on_new_line(1)),
            _ => false,
        }
    }

    /// The word of a method, or several that are one, written wrongly: `multi jittered`, `multi-jittered`.
    fn method(&mut self) -> Value<'s> {
        if !self.is_name(0) || self.is(1, "(") {
            return self.expression();
        }
        let mut span = self.bump();
        while (self.is(0, "-") && self.is_name(1))
            || (self.is_name(0)
                && !self.is_field_name(self.word_seen(0))
                && !self.is_on_new_line(0))
        {
            if self.is(0, "-") {
                self.bump();
            }
            span = span.to(self.bump());
        }
        Value {
            kind: ValueKind::Name(self.written(span)),
            span,
        }
    }

    /// `)` behind the value of a field: that of a list without its `(`, or one too many.
    fn stray_in_value(&mut self, values: &[Value<'s>], commas: usize, stray: bool) {
        let index = self.problems.len();
        let is_vector = self.within.takes == Some(Type::Vector);
        let first = values.first().map(|first| first.span.start);
        let is_plain = |value: &Value<'s>| {
            !matches!(value.kind, ValueKind::Chain { .. }) && self.is_number(value)
        };
        let is_whole = values.len() == 3 && commas == 2 && !stray && values.iter().all(is_plain);
        let is_known = values.first().is_some_and(|value| self.is_known(value));
        self.stray_parenthesis();
        let word = self.word(0);
        let is_end =
            (self.is_name(0) && self.is_field_name(word)) || matches!(word, "}" | "," | ";" | "");
        let alone = values.len() == 1 && commas == 0 && !stray && is_end && is_known;
        let Some(Problem::StrayClosing { way, .. }) = self.problems.get_mut(index) else {
            return;
        };
        match first {
            Some(first) if is_vector && is_whole && is_end => {
                let edit = Edit::insert(self.id, first, "(");
                *way = Way::write("write `(` before the first number", [edit]);
            }
            _ if !alone => *way = Way::told("write the parenthesis that opens it, or take it away"),
            _ => {}
        }
    }

    /// Where several things seem to be wrong with one value, none of them is sure.
    pub(super) fn leave_doubtful(&mut self, index: usize) {
        let problems = self.problems.get_mut(index..).unwrap_or_default();
        let is_same = |other: &Problem| {
            let first = problems.first().map(std::mem::discriminant);
            first == Some(std::mem::discriminant(other))
        };
        if !problems.iter().all(is_same) {
            problems.iter_mut().for_each(Problem::leave);
        }
    }

    /// `)` or `]` that was never opened.
    pub(super) fn stray_parenthesis(&mut self) {
        let sign = self.word(0);
        let span = self.bump();
        self.problems.push(Problem::StrayClosing {
            sign: sign.to_owned(),
            span,
            way: Way::remove(format!("remove this `{sign}`"), span),
        });
    }

    /// What stands in place of a field and has no name.
    fn no_field(&mut self, block: &mut Block<'s>) {
        let start = self.here();
        let index = self.problems.len();
        if matches!(self.word(0), ")" | "]") {
            self.stray_parenthesis();
            return;
        }
        if matches!(self.kind(0), TokenKind::Word | TokenKind::Quoted) || !self.starts_value(0) {
            self.unexpected(
                "a field or `}`",
                "write a field's name and its value, such as `radius 2`",
            );
            self.bump();
            // What stands behind it up to the next field belongs to it.
            let mut open = 0_usize;
            while (open > 0 || !(self.is_name(0) || matches!(self.word(0), "," | ";")))
                && !matches!(self.word(0), "" | "{" | "}" | "let")
            {
                match self.word(0) {
                    "(" => open += 1,
                    ")" => open = open.saturating_sub(1),
                    _ => {}
                }
                self.bump();
            }
            block
                .bad
                .push(Span::new(self.id, start.start, self.last_end));
            return;
        }
        let mut values = Vec::new();
        while self.starts_value(0) && !self.is_name(0) {
            let next = self.next;
            values.push(self.expression());
            if self.next == next {
                self.bump();
            }
            if self.is(0, ",") {
                self.bump();
            }
        }
        let problems = self.problems.get_mut(index..).unwrap_or_default();
        problems.iter_mut().for_each(Problem::leave);
        let span = Span::new(self.id, start.start, self.last_end);
        block.bad.push(span);
        let is_vector = |value: &Value<'s>| match &value.kind {
            ValueKind::Tuple(parts) => parts.len() == 3,
            _ => self.written(value.span).starts_with(['<', '[']),
        };
        let shape: Vec<bool> = values.iter().map(is_vector).collect();
        let texts: Vec<String> = values
            .iter()
            .map(|value| {
                let written = self.written(value.span);
                written.replace(['<', '['], "(").replace(['>', ']'], ")")
            })
            .collect();
        let right = match (self.within.kind, shape.as_slice(), texts.as_slice()) {
            ("sphere", [true, false], [center, radius]) => {
                Some(format!("center {center}  radius {radius}"))
            }
            ("sphere", [true], [center]) => Some(format!("center {center}")),
            ("box", [true, true], [min, max]) => Some(format!("min {min}  max {max}")),
            _ => None,
        };
        // What is wrong within the values goes with the whole.
        if right.is_some() && block.fields.is_empty() {
            self.problems.truncate(index);
        } else if self.problems.len() > index {
            return;
        }
        let way = match right.filter(|_| block.fields.is_empty()) {
            Some(right) => {
                let given = self.words.fields(self.within.kind);
                let given = given.filter(|name| right.split(' ').any(|word| word == *name));
                block.fields.extend(given.map(|text| Field {
                    name: Name { text, span },
                    value: bad(span),
                    span,
                }));
                Way::replace(span, right)
            }
            None => Way::told("write the name of its field before it, such as `radius 2`"),
        };
        self.problems.push(Problem::MissingFieldName { span, way });
    }
}
