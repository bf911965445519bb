//! Reads the fields of a block.

use super::{Context, Recovery, foreign::CommentPosition};
use crate::{
    diagnostic::{Edit, Fix, Label},
    schema,
    source::Span,
    syntax::{
        messages::{self as say, statement},
        problem::{replace, shorten},
        tokens::{TokenKind, has_name, line_end, numeric_part},
        tree::{Block, Field, Item, Name, Repetition, Value, ValueKind, bad},
    },
};

impl<'s> Recovery<'_, 's> {
    /// Reads the fields of a block after its `{`. Ends after the token `close`, or where that token
    /// is missing.
    pub(super) fn body(&mut self, block: &mut Block<'s>, close: &'static str) {
        let within = Context {
            kind: block.kind.map_or("", |kind| kind.text),
            is_block: true,
            close,
            ..Context::default()
        };
        let outside = std::mem::replace(&mut self.context, within);
        let problems_before = self.problems.len();
        // After a report about braces within the block, it is uncertain which brace is missing, so
        // a missing `}` is not reported.
        let (mut braces, mut had_braces) = (0_usize, false);
        block.close = loop {
            self.comments(CommentPosition::Start);
            if self.kind(0) == TokenKind::End || self.is_after_block(block) {
                block.span.end = self.last_end.max(block.span.end);
                if !had_braces {
                    self.unclosed_block(block);
                }
                break None;
            }
            match self.word(0) {
                "}" if braces > 0 => {
                    braces -= 1;
                    self.bump();
                }
                word if word == "}" || word == close => break Some(self.bump()),
                sign @ (")" | "]") if self.is_end_of_block() => {
                    let close = self.bump();
                    let fix = Fix::write(close, "}");
                    self.report(&say::STRAY_CLOSING, close, &[sign], fix);
                    break Some(close);
                }
                "let" => self.misplaced_let(block),
                "for" if self.is_name(1) && self.is(2, "<") => self.misplaced_indices(block),
                "," | ";" => self.separator(),
                "{" => {
                    (braces, had_braces) = (braces + 1, true);
                    let span = self.bump();
                    self.report(&say::NESTED_BRACES, span, &["braces within a block"], None);
                }
                name if self.is_head(0) && !(self.is(1, "{") && self.is_field_name(name)) => {
                    // The inner block may contain fields that the outer block lacks. If a block has
                    // bad text before its `{`, its missing fields are not reported. The outer
                    // block's keyword is therefore recorded as bad text.
                    block.bad.push(block.keyword());
                    had_braces = true;
                    self.nested_block();
                }
                name if self.is_statement_in_block(name) => {
                    let (at, said) = (self.bump(), statement(name).unwrap_or_default());
                    self.report(&say::NOT_IN_LANGUAGE, at, &said, None);
                    self.resync();
                    block.bad.push(at.to(self.behind()));
                }
                _ if self.is_name(0) => self.field(block),
                _ => self.value_without_field(block),
            }
        };
        block.span = block.span.to(block.close.unwrap_or(block.span));
        self.report_signs(problems_before);
        self.context = outside;
    }

    /// Returns whether `name` starts a condition or a loop of another language rather than a field
    /// of the block.
    fn is_statement_in_block(&self, name: &str) -> bool {
        let is_one = matches!(name, "if" | "else" | "for" | "while" | "repeat");
        is_one && !self.is_field_name(name)
    }

    /// Returns whether the `}` of `block` was probably forgotten before the next token. This is
    /// assumed if the block's kind is known and the token starts an item, is the first of its line,
    /// and is indented no more than the block.
    fn is_after_block(&mut self, block: &Block<'s>) -> bool {
        let start = self.here().start;
        (self.is(0, "let") || self.starts_block() || self.starts_item())
            && self.is_on_new_line(0)
            && self.words.is_kind(self.context.kind)
            && self.indent(start) <= self.indent(block.span.start)
    }

    /// Returns whether the next token, a closing bracket, probably stands in place of the block's
    /// `}`. This is assumed if it is the last token of the text, or if the next line starts an
    /// item.
    pub(super) fn is_end_of_block(&mut self) -> bool {
        let is_item = self.is(1, "let") || self.is_head(1);
        self.kind(1) == TokenKind::End || (self.is_on_new_line(1) && is_item)
    }

    fn indent(&self, at: usize) -> usize {
        let line = self.line_before(at);
        line.len() - line.trim_start().len()
    }

    fn unclosed_block(&mut self, block: &Block<'s>) {
        let Some(open) = block.open else { return };
        let mut end = self.behind();
        let mut apart = " ";
        if self.written(open.to(end)).contains('\n') {
            apart = self.source.line_end();
            // A comment after the last field stays on the field's line, so the `}` is written after
            // the end of that line.
            let line_end = line_end(self.text, end.start);
            let rest = self.text.get(end.start..line_end).unwrap_or_default();
            if self.here().start >= line_end && !rest.contains("/*") {
                end = Span::new(self.id, line_end, line_end);
            }
        }
        let kind = shorten(block.kind.map_or("this block", |kind| kind.text));
        let edit = Edit::new(end, format!("{apart}}}"));
        let fix = Fix::new(format!("close the block of `{kind}`"), [edit]);
        let mut found = say::UNCLOSED_BLOCK.at(open, &[&kind], fix);
        if self.kind(0) != TokenKind::End {
            found.labels.push(Label {
                span: self.here(),
                message: "it should be closed before this".to_owned(),
            });
        }
        self.problems.push(found);
    }

    /// Reports a block within a block. If the inner block's kind is known, reads it as an item of
    /// its own; otherwise, skips it.
    fn nested_block(&mut self) {
        let (kind, span) = (self.word(0), self.here());
        let what = format!("the block `{}` stands within another one", shorten(kind));
        self.report(&say::NESTED_BRACES, span, &[&what], None);
        if self.words.is_kind(kind) {
            return self.block();
        }
        // Skip the part before the `{`, which may contain indices. The `{` itself may be missing.
        self.skip_head();
        if self.is(0, "{") {
            self.bump();
            self.skip_block();
        }
    }

    /// Reports definitions within `block` and reads them as if they stood before it. A definition
    /// that uses an index of the block gets a value marked as bad, since the index is unknown
    /// outside of the block.
    fn misplaced_let(&mut self, block: &Block<'s>) {
        let (keyword, before) = (self.here(), self.items.len());
        self.context.is_block = false;
        while self.is(0, "let") {
            self.definition();
        }
        self.context.is_block = true;
        let (text, mut help) = (self.text, "write it before the block");
        let has_index = |value: Span| {
            let text = text.get(value.range()).unwrap_or_default();
            let mut indices = block.repetition.iter().flat_map(|it| &it.indices);
            indices.any(|index| has_name(text, index.name.text))
        };
        for item in self.items.get_mut(before..).unwrap_or_default() {
            if let Item::Definition(definition) = item
                && has_index(definition.value.span)
            {
                definition.value = bad(definition.value.span);
                help = "write its value where it is used: an index is known within its block alone";
            }
        }
        self.report(&say::MISPLACED_LET, keyword, &[help], None);
    }

    /// Reports indices, `for i < 8`, within `block`, and reads them as if they stood before its
    /// `{`.
    fn misplaced_indices(&mut self, block: &mut Block<'s>) {
        let (keyword, mut indices) = (self.bump(), Vec::new());
        while self.is_name(0) && self.is(1, "<") {
            indices.push(self.index());
        }
        let repetition = Repetition { keyword, indices };
        self.report(&say::MISPLACED_INDICES, repetition.span(), &[], None);
        block.repetition.get_or_insert(Box::new(repetition));
    }

    fn field(&mut self, block: &mut Block<'s>) {
        if let Some(field) = self.field_without_space() {
            block.fields.push(field);
            return;
        }
        let name = self.field_name();
        let equals = matches!(self.word(0), "=" | ":" | ":=").then(|| self.bump());
        let problems_before = self.problems.len();
        self.context.takes = self.words.takes(self.context.kind, name.text);
        self.context.field = name.text;
        let value = self.value_of_field(name.span);
        let is_known = self.context.takes.take().is_some();
        if let Some(equals) = equals.filter(|_| value.kind != ValueKind::Missing) {
            self.note_sign(equals);
        }
        let is_again = || block.fields.iter().any(|f| f.name.text == name.text);
        if value.kind == ValueKind::Missing && is_known && is_again() {
            let help = "take it away: the block has this field already";
            let words = ["a field or `}`", name.text, help];
            self.report(&say::UNEXPECTED, name.span, &words, None);
            block.bad.push(name.span);
            return;
        }
        if value.kind == ValueKind::Bad {
            block.bad.push(value.span);
        }
        self.clear_uncertain_fixes(problems_before);
        let span = name.span.to(value.span);
        block.fields.push(Field { name, value, span });
    }

    /// Reads the name of a field. Two words such as `look at` or `view height` are reported and
    /// read as one name.
    fn field_name(&mut self) -> Name<'s> {
        let first = self.name();
        let second = self.word(0);
        let is_both = |name: &&str| {
            let rest = name.strip_prefix(first.text);
            rest.is_some_and(|rest| rest.strip_prefix('_').unwrap_or(rest) == second)
        };
        let found = self.words.fields(self.context.kind).find(is_both);
        let Some(text) = found.filter(|_| self.is_name(0)) else {
            return first;
        };
        let span = first.span.to(self.bump());
        let fix = replace(span, text);
        self.report(&say::TWO_WORDS, span, &[&self.short(span)], fix);
        Name { text, span }
    }

    /// Reads a field that is joined to its value, as in `radius2` and `colorred`. Returns `None` if
    /// the word is something else.
    fn field_without_space(&mut self) -> Option<Field<'s>> {
        let (word, span) = (self.word(0), self.here());
        let is_fraction = self.kind(1) == TokenKind::Number && self.is_adjacent(1);
        if self.is_field_name(word) || self.words.is_let(word) {
            return None;
        }
        let names = self.words.fields(self.context.kind);
        let field = names
            .filter(|field| word.starts_with(field))
            .max_by_key(|f| f.len())?;
        let behind = 1 + usize::from(is_fraction);
        let end = self.peek(behind - 1).end;
        let at = Span::new(self.id, span.start + field.len(), end);
        let rest = self.written(at);
        if numeric_part(rest) != rest && !self.words.is_value(rest) {
            return None;
        }
        // If a value follows, the whole word is the name, as in `radius2 3`.
        let next = self.word(behind);
        let is_value = self.words.is_value(next) && !self.is_field_name(next);
        if self.starts_value(behind) && (!self.is_name(behind) || is_value) {
            return None;
        }
        for _ in 0..behind {
            self.bump();
        }
        let edit = Edit::insert(self.id, at.start, " ");
        let fix = Fix::new(format!("write `{field} {rest}`"), [edit]);
        self.report(&say::MISSING_SPACE, span.to(at), &[field, rest], fix);
        let name = Name {
            text: field,
            span: Span::new(self.id, span.start, at.start),
        };
        let (value, span) = (bad(at), span.to(at));
        Some(Field { name, value, span })
    }

    fn value_of_field(&mut self, name: Span) -> Value<'s> {
        let after = Span::new(self.id, name.end, name.end);
        self.comments(CommentPosition::Value);
        let word = self.word(0);
        // `is_next` says that the next line starts with another field, i.e. with a name and a
        // value.
        let is_next = self.is_on_new_line(0)
            && self.starts_value(1)
            && !self.words.is_value(word)
            && !self.is_foreign_call();
        let is_field = if self.is_field_name(word) {
            !self.words.is_let(word)
        } else {
            is_next || self.starts_block() || self.starts_item()
        };
        let is_comma = word == "," && (self.is_name(1) || !self.starts_value(1));
        let is_end = matches!(word, "" | "let" | "{" | "}" | ";") && !self.is_flat_list();
        if (is_field && self.is_name(0)) || is_comma || is_end {
            return Value::new(ValueKind::Missing, after);
        }
        self.value()
    }

    /// Reports values in a block that lack a field's name. If the schema says which fields the
    /// values belong to, as in `sphere { (0, 1, 0) 2 }`, adds these fields to the block.
    fn value_without_field(&mut self, block: &mut Block<'s>) {
        let (start, problems_before) = (self.here(), self.problems.len());
        if matches!(self.word(0), ")" | "]") {
            return self.stray_parenthesis(true);
        }
        let mut values = Vec::new();
        let (mut is_listed, mut end) = (false, start);
        while self.starts_value(0) && self.kind(0) != TokenKind::Word {
            // A name after a comma is usually a further value. If a value follows the name,
            // however, the name is that of the next field, and reading stops before it.
            let has_value = !matches!(self.kind(1), TokenKind::Name | TokenKind::Sign)
                || matches!(self.word(1), "(" | "[" | "<" | "=" | ":" | ":=");
            if self.is_name(0) && (!is_listed || has_value) {
                break;
            }
            let value = self.expression();
            end = value.span;
            values.push(value);
            is_listed = self.is(0, ",");
            if is_listed {
                end = self.bump();
            }
        }
        if values.is_empty() {
            let help = "write a field's name and its value, such as `radius 2`";
            self.unexpected("a field or `}`", help);
            self.bump();
            self.resync();
            block.bad.push(start.to(self.behind()));
            return;
        }
        // The span ends with the last value, so it does not include a comment after the values.
        let span = start.to(end);
        block.bad.push(span);
        // Problems within the values are removed, since the values are reported as a whole.
        self.problems.truncate(problems_before);
        let is_vector =
            |value: &Value<'s>| matches!(&value.kind, ValueKind::Tuple(parts) if parts.len() == 3);
        let shape: Vec<bool> = values.iter().map(is_vector).collect();
        let row = schema::block(self.context.kind).filter(|_| block.fields.is_empty());
        let names = row.map_or(&[][..], |row| row.names_of_values(&shape));
        let named = names.iter().zip(&values).map(|(name, value)| {
            let written = self.written(value.span);
            let round = written.replace(['<', '['], "(").replace(['>', ']'], ")");
            format!("{name} {round}")
        });
        let named: Vec<String> = named.collect();
        let fix = (!named.is_empty()).then(|| replace(span, named.join("  ")));
        // Two vectors without field names in a `box` block are read as the box's corners. They may
        // also be its centre and its size, so the fix is not safe.
        let has_one_way = row.is_some_and(|row| row.choices.is_empty());
        let said = say::MISSING_FIELD_NAME.safe_if(has_one_way);
        self.report(&said, span, &[&self.short(span)], fix);
        let fields = names.iter().zip(values);
        block.fields.extend(fields.map(|(text, value)| {
            let name = Name { text, span };
            Field { name, value, span }
        }));
    }
}
