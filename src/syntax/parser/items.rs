//! Items: definitions, blocks and their fields.

use super::{Pairs, Parser, bad};
use crate::{
    source::Span,
    syntax::{
        Problem,
        grammar::Rule,
        junk,
        tree::{Block, Definition, Field, Item, Name},
    },
};

impl<'s> Parser<'s> {
    pub(super) fn definition(&mut self, pair: Pairs<'_>) -> Definition<'s> {
        let mut definition = Definition {
            keyword: self.span(&pair),
            name: None,
            equals: None,
            value: bad(self.span(&pair)),
            span: self.span(&pair),
        };
        let mut separator = None;
        for part in pair.into_inner() {
            let span = self.span(&part);
            match part.as_rule() {
                Rule::let_word => definition.keyword = span,
                Rule::name => definition.name = Some(self.name(&part)),
                Rule::equals => definition.equals = Some(span),
                Rule::value => definition.value = self.value(part),
                Rule::separator => separator = Some(self.tight(span)),
                _ => {}
            }
        }
        definition.span = definition.keyword.to(definition.value.span);
        let wrong = match definition.equals {
            None => Some(definition.value.span),
            Some(equals) if self.written(equals) == ":" => Some(equals),
            Some(_) => None,
        };
        if let (Some(span), Some(name)) = (wrong, definition.name) {
            self.problems.push(Problem::MissingEquals {
                name: name.text.to_owned(),
                value: self.short(definition.value.span),
                span,
            });
        }
        self.needless_separator(separator, "items");
        definition
    }

    pub(super) fn block(&mut self, pair: Pairs<'_>) -> Block<'s> {
        let whole = self.span(&pair);
        let mut block = Block::empty(whole);
        self.defined_block(&mut block);
        let parts = pair.into_inner();
        // All parts but the kind and the two braces, as a rule.
        block.fields.reserve_exact(parts.len().saturating_sub(3));
        for part in parts {
            let span = self.span(&part);
            match part.as_rule() {
                Rule::let_word => self.problems.push(Problem::BadName {
                    written: "let".to_owned(),
                    span,
                }),
                Rule::name if block.kind.is_none() => block.kind = Some(self.name(&part)),
                Rule::name => block.name = Some(self.name(&part)),
                _ => self.body(part, span, &mut block),
            }
        }
        self.close_block(&mut block);
        self.kind_of_the_next_line(&mut block);
        block
    }

    /// `let Ball = sphere {`: what was meant is a block with a name.
    fn defined_block(&mut self, block: &mut Block<'s>) {
        let (Some(Item::Definition(before)), Some(Problem::MissingValue { span, .. })) =
            (self.items.last(), self.problems.last())
        else {
            return;
        };
        let between = self.text.get(span.end..block.span.start);
        let same_line = between.is_some_and(|text| !text.contains('\n'));
        if let Some(name) = before.name
            && same_line
            && self.written(*span).ends_with('=')
        {
            let kind = self.word_at(block.span.start);
            let problem = Problem::BadHead {
                help: format!("write `{} {} {{`", self.short(kind), self.short(name.span)),
                span: before.keyword.to(*span),
                instead: Some((
                    before.keyword.to(kind),
                    format!("{} {}", self.written(kind), name.text),
                )),
            };
            self.problems.pop();
            self.problems.push(problem);
            block.name = Some(name);
        }
    }

    /// `let a = 2 pi`, and `sphere {` in the next line: the kind is the rest of the value, and the name the kind.
    ///
    /// That is so only where the text is wrong as it stands, and right but for one slip if it is read like this: the first
    /// word is no kind, and the second one is. What is right, such as `let a = 2 sphere` and `B {`, means the same however
    /// its lines end.
    fn kind_of_the_next_line(&mut self, block: &mut Block<'s>) {
        let (Some(Item::Definition(before)), Some(kind), Some(name)) =
            (self.items.last(), block.kind, block.name)
        else {
            return;
        };
        if junk::is_kind(kind.text) || !junk::is_kind(name.text) {
            return;
        }
        let value = before.value.span;
        let apart = |from, to| self.text.get(from..to).unwrap_or_default().contains('\n');
        if !apart(value.end, kind.span.start) && apart(kind.span.end, name.span.start) {
            let problem = junk::missing_operator(self.written(value), kind.text, kind.span);
            self.problems.push(problem);
            block.kind = Some(name);
            block.name = None;
            block.span.start = name.span.start;
        }
    }

    /// One part of a body.
    pub(super) fn body(&mut self, part: Pairs<'_>, span: Span, block: &mut Block<'s>) {
        match part.as_rule() {
            Rule::open => block.open = Some(span),
            Rule::close => block.close = Some(span),
            Rule::field => {
                let field = self.field(part);
                block.fields.push(field);
            }
            Rule::lets_in_block => self.lets_in_block(part, block.span),
            Rule::bad_field => self.bad_field(part, block),
            _ => {}
        }
    }

    pub(super) fn close_block(&mut self, block: &mut Block<'s>) {
        let (Some(open), None) = (block.open, block.close) else {
            if let Some(close) = block.close {
                block.span = block.span.to(close);
            }
            return;
        };
        let next = block.span.end;
        let before = (next < self.end).then(|| self.word_at(next));
        block.span = self.trimmed(block.span.start, next);
        let again = match self.items.last() {
            Some(Item::Block(last)) => last.close.is_none() && last.fields.is_empty(),
            _ => false,
        };
        if again && block.fields.is_empty() {
            // One block after the other that is only begun is one mistake.
            return;
        }
        let followed = before.is_some_and(|before| !matches!(self.written(before), "let" | "}"));
        self.nesting += usize::from(followed);
        let kind = block.kind.map_or("this block", |kind| kind.text);
        self.problems.push(Problem::UnclosedBlock {
            kind: kind.to_owned(),
            open,
            end: Span::new(self.id, block.span.end, block.span.end),
            before,
        });
    }

    fn field(&mut self, pair: Pairs<'_>) -> Field<'s> {
        let whole = self.span(&pair);
        let (mut name, mut value) = (None, bad(whole));
        let (mut equals, mut separator) = (None, None);
        for part in pair.into_inner() {
            let span = self.span(&part);
            match part.as_rule() {
                Rule::name => name = Some(self.name(&part)),
                Rule::equals => equals = Some(span),
                Rule::value => value = self.value(part),
                Rule::separator => separator = Some(self.tight(span)),
                _ => {}
            }
        }
        let name = name.unwrap_or(Name {
            text: "",
            span: whole,
        });
        if let Some(span) = equals {
            self.problems.push(Problem::NeedlessEquals {
                sign: self.written(span).to_owned(),
                name: name.text.to_owned(),
                value: self.short(value.span),
                span,
            });
        }
        self.needless_separator(separator, "fields");
        Field {
            name,
            span: name.span.to(value.span),
            value,
        }
    }

    fn lets_in_block(&mut self, pair: Pairs<'_>, block: Span) {
        let mut first = true;
        let whole = self.span(&pair);
        let definitions = self.trimmed(whole.start, whole.end);
        for part in pair.into_inner() {
            if first {
                let span = self.word_at(self.span(&part).start);
                self.problems.push(Problem::MisplacedLet {
                    span,
                    definitions,
                    block,
                });
                first = false;
            }
            match part.as_rule() {
                Rule::definition => {
                    let definition = self.definition(part);
                    self.items.push(Item::Definition(definition));
                }
                Rule::bad_definition => self.bad_definition(part),
                _ => {}
            }
        }
    }

    /// Whether no line ends between the last item and an offset.
    pub(super) fn is_on_line_of_last(&self, start: usize) -> bool {
        let end = self.items.last().map_or(start, |item| item.span().end);
        let between = self.text.get(end..start).unwrap_or_default();
        !between.contains('\n')
    }

    fn needless_separator(&mut self, separator: Option<Span>, between: &'static str) {
        if let Some(span) = separator {
            self.problems.push(Problem::NeedlessSeparator {
                sign: self.short(span),
                between,
                span,
            });
        }
    }
}
