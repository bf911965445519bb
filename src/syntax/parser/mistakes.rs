//! What the rules for slips and junk ate: each becomes a problem, and what can be understood of it is kept.

use super::{Pairs, Parser, bad};
use crate::{
    source::Span,
    syntax::{
        Problem,
        grammar::Rule,
        junk,
        tree::{Block, Definition, Field, Item, Name, Value, ValueKind},
    },
};

impl<'s> Parser<'s> {
    pub(super) fn bad_definition(&mut self, pair: Pairs<'_>) {
        let whole = self.span(&pair);
        let span = self.trimmed(whole.start, whole.end);
        let keyword = self.word_at(span.start);
        let (name, problem) = junk::definition(self.clean(), span);
        let name = name.map(|name| self.own(name));
        if let Problem::BadName { span, .. } = &problem {
            self.parts_of_bad_name(*span);
        }
        let again = match self.items.last() {
            Some(Item::Definition(last)) => {
                last.value.span.range().is_empty() && !last.keyword.range().is_empty()
            }
            _ => false,
        };
        // One definition after the other that is only begun is one mistake, on one line.
        if !(again && self.is_on_line_of_last(span.start)) {
            self.problems.push(problem);
        }
        let value = bad(Span::new(self.id, span.end, span.end));
        self.items.push(Item::Definition(Definition {
            keyword,
            name,
            equals: None,
            value,
            span,
        }));
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
            let letters = |c: char| c.is_ascii_alphanumeric() || c == '_';
            if word.starts_with(|c: char| c.is_ascii_alphabetic()) && word.chars().all(letters) {
                self.items.push(Item::Definition(Definition {
                    keyword: Span::new(self.id, span.start, span.start),
                    name: Some(Name {
                        text: word,
                        span: place,
                    }),
                    equals: None,
                    value: bad(Span::new(self.id, span.end, span.end)),
                    span: place,
                }));
            }
        }
    }

    pub(super) fn bad_field(&mut self, pair: Pairs<'_>, block: &mut Block<'s>) {
        let whole = self.span(&pair);
        let span = self.trimmed(whole.start, whole.end);
        let (name, problem) = junk::field(self.clean(), span);
        match (name.map(|name| self.own(name)), problem) {
            (
                Some(name),
                Some(Problem::MissingOperand {
                    side: "before",
                    span: operator,
                    ..
                }),
            ) if self
                .trimmed(name.span.end, operator.start)
                .range()
                .is_empty()
                && !block.fields.is_empty() =>
            {
                // `center middle ring * 2`: no field's name stands before an operator.
                let before = block.fields.last().map_or(span, |field| field.value.span);
                let problem = junk::missing_operator(self.written(before), name.text, name.span);
                self.problems.push(problem);
                block.bad.push(span);
            }
            (Some(name), problem) => {
                let after = self
                    .clean()
                    .get(name.span.end..span.end)
                    .unwrap_or_default();
                let kind = match matches!(after.trim(), "" | "=" | ":") {
                    true => ValueKind::Missing,
                    false => ValueKind::Bad,
                };
                let rest = self.clean().get(whole.end..).unwrap_or_default();
                // Braces that follow are reported themselves.
                let braces = problem.is_none() && rest.trim_start().starts_with('{');
                if kind == ValueKind::Bad && !braces {
                    let unexpected = || junk::unexpected_value(self.clean(), span);
                    let problem = problem.unwrap_or_else(unexpected);
                    self.problems.push(problem);
                    block.bad.push(span);
                }
                let value = Value {
                    kind,
                    span: Span::new(self.id, name.span.end, span.end),
                };
                block.fields.push(Field { name, value, span });
            }
            (None, problem) => {
                let again = block
                    .bad
                    .last()
                    .is_some_and(|last| self.trimmed(last.end, span.start).range().is_empty());
                // What follows junk without a field between is the same mistake.
                if !again {
                    self.problems.extend(problem);
                }
                block.bad.push(span);
            }
        }
    }

    pub(super) fn stray_close(&mut self, pair: Pairs<'_>) {
        let whole = self.span(&pair);
        let start = whole.start;
        let span = Span::new(self.id, start, start + 1);
        let braces = self.written(whole).matches('}').count();
        let closed = (0..braces).take_while(|_| self.nested()).count();
        if closed == braces {
            self.items.push(Item::Bad(span));
            return;
        }
        self.problems.push(Problem::StrayClosing {
            sign: "}".to_owned(),
            span,
            all: self.trimmed(start, whole.end),
            help: "take it away, or write the `{` that it is to close".to_owned(),
        });
        self.items.push(Item::Bad(span));
    }

    /// Whether a `}` closes a block that other blocks stand in: these are the mistake, and the block is closed.
    fn nested(&mut self) -> bool {
        if self.nesting == 0 {
            return false;
        }
        self.nesting -= 1;
        let unclosed = self
            .problems
            .iter_mut()
            .rfind(|problem| matches!(problem, Problem::UnclosedBlock { .. }));
        if let Some(problem) = unclosed
            && let Problem::UnclosedBlock {
                before: Some(before),
                ..
            } = problem
        {
            let rest = self.text.get(before.start..).unwrap_or_default();
            let brace = before.start + rest.find('{').unwrap_or(0);
            let span = Span::new(self.id, brace, brace + 1);
            *problem = Problem::NestedBraces { span };
        }
        true
    }

    pub(super) fn bad_item(&mut self, pair: Pairs<'_>) {
        let whole = self.span(&pair);
        let mut block = Block::empty(whole);
        let mut odd = Span::new(self.id, whole.start, whole.start);
        let at = self.problems.len();
        for part in pair.into_inner() {
            let span = self.span(&part);
            match part.as_rule() {
                Rule::odd_lines => odd = self.trimmed(span.start, span.end),
                _ => self.body(part, span, &mut block),
            }
        }
        let previous = self.items.last().and_then(|item| match item {
            Item::Definition(definition) => Some(definition.value.span),
            Item::Block(_) | Item::Bad(_) => None,
        });
        if let Some(open) = block.open {
            self.close_block(&mut block);
            let (kind, name, problem) = junk::head(self.clean(), odd, open);
            let [kind, name] = [kind, name].map(|name| name.map(|name| self.own(name)));
            block.kind = kind;
            block.name = name;
            let again = match self.items.last() {
                Some(Item::Block(last)) => last.kind.is_none(),
                _ => false,
            };
            if !(again && kind.is_none() && self.is_on_line_of_last(whole.start)) {
                self.problems.insert(at, problem);
            }
            block.bad.push(odd);
            self.items.push(Item::Block(block));
        } else {
            if block.close.is_some() && self.nested() {
                self.items.push(Item::Bad(odd));
                return;
            }
            let problem = junk::lines(self.clean(), odd, block.close, previous);
            // Lines without meaning, one after the other, are one mistake.
            let vague = matches!(
                problem,
                Problem::OutsideBlock { .. } | Problem::Unexpected { .. }
            );
            // A name that was to be defined is known from here on.
            let item = match &problem {
                Problem::MissingLet { place, .. } => Item::Definition(Definition {
                    keyword: Span::new(self.id, odd.start, odd.start),
                    name: Some(Name {
                        text: self.written(*place),
                        span: *place,
                    }),
                    equals: None,
                    value: bad(Span::new(self.id, odd.end, odd.end)),
                    span: odd,
                }),
                _ => Item::Bad(odd),
            };
            if !(vague && self.in_odd_lines) {
                self.problems.insert(at, problem);
            }
            self.in_odd_lines = vague && block.close.is_none();
            self.items.push(item);
        }
    }
}
