//! Fields that were taken for one another.
//!
//! In: a block's fields as they were parsed. Out: the fields as they were meant. The parser cannot tell the name of a field
//! from a value, as it does not know the fields; here both are known.

use std::borrow::Cow;

use super::{
    eval::{Names, predefined},
    schema::{self, Type},
};
use crate::{
    source::{Sources, Span},
    syntax::{
        self,
        tree::{self, Name, ValueKind},
    },
};

/// The fields as they were meant where a value or an operator was forgotten.
///
/// `radius color olive` is read as a radius of `color`, and a field `olive` without a value; `radius 2 pi` as a radius, and
/// a field `pi`. So the words and values of such a block are dealt out again: a field's name that is no `let` starts a
/// field, and a value right behind a value lacks its operator.
pub fn untangle<'t, 's>(
    fields: &'t [tree::Field<'s>],
    row: &schema::Block,
    names: &Names<'s>,
    sources: &'s Sources,
    problems: &mut Vec<syntax::Problem>,
) -> Cow<'t, [tree::Field<'s>]> {
    if !is_tangled(fields, row, names) {
        return Cow::Borrowed(fields);
    }
    let is_value = |name: &str| names.knows(name) || predefined(name).is_some();
    let is_field = |name: &str| row.field(name).is_some();
    let mut meant: Vec<tree::Field<'s>> = Vec::with_capacity(fields.len());
    let mut current: Option<(Name<'s>, Vec<tree::Value<'s>>)> = None;
    let mut deal = |(name, values), problems: &mut Vec<_>| {
        let values = Dealt { row, name, values };
        meant.push(values.field(sources, problems));
    };
    for piece in fields.iter().flat_map(pieces) {
        if let (Piece::Word(word), Some((name, values))) = (&piece, &mut current)
            && values.is_empty()
            && two_words(row, name.text, word.text)
        {
            // `look at`: the report says what was written, and what was meant.
            name.span = name.span.to(word.span);
            name.text = sources.text(name.span);
            continue;
        }
        let starts = match (&piece, &current) {
            (Piece::Value(_), _) => None,
            (Piece::Word(word), None) => Some(*word),
            (Piece::Word(word), Some((name, values))) => {
                let value = is_value(word.text) || goes_on(row, name, values, word);
                let field = match values.is_empty() {
                    true => is_field(word.text) && !value,
                    false => is_field(word.text) || !value,
                };
                field.then_some(*word)
            }
        };
        if let Some(name) = starts {
            if let Some(field) = current.take() {
                deal(field, problems);
            }
            current = Some((name, Vec::new()));
        } else if let Some((_, values)) = &mut current {
            values.push(match piece {
                Piece::Value(value) => value,
                Piece::Word(word) => tree::Value {
                    kind: ValueKind::Name(word.text),
                    span: word.span,
                },
            });
        }
    }
    if let Some(field) = current {
        deal(field, problems);
    }
    Cow::Owned(meant)
}

/// Whether a word goes on with the value before it: a unit, or a part of a method's name.
fn goes_on(
    row: &schema::Block,
    name: &Name<'_>,
    values: &[tree::Value<'_>],
    word: &Name<'_>,
) -> bool {
    let takes = row.field(name.text).map(|field| field.takes);
    match values {
        [only] if matches!(only.kind, ValueKind::Number(_)) => syntax::is_unit(word.text),
        [_, ..] => takes == Some(Type::Method),
        [] => false,
    }
}

/// Whether two words are the name of a field: `look at`, `view height`.
fn two_words(row: &schema::Block, first: &str, second: &str) -> bool {
    let joined = |name: &str| {
        let rest = name.strip_prefix(first);
        rest.is_some_and(|rest| rest.strip_prefix('_').unwrap_or(rest) == second)
    };
    row.field(first).is_none() && row.field_names().any(joined)
}

/// Whether a block's fields may have been taken for one another: a value is missing, a field's name stands for a value, or
/// the name of a value for a field.
fn is_tangled(fields: &[tree::Field<'_>], row: &schema::Block, names: &Names<'_>) -> bool {
    let is_value = |name: &str| names.knows(name) || predefined(name).is_some();
    let is_field = |name: &str| row.field(name).is_some();
    fields.iter().any(|field| {
        let kind = &field.value.kind;
        let name = match kind {
            ValueKind::Missing => return true,
            ValueKind::Name(name) => name,
            ValueKind::Call(call) => call.function.text,
            _ => "",
        };
        let field = field.name.text;
        let method = row
            .field(field)
            .is_some_and(|row| row.takes == Type::Method);
        let one_value = !matches!(kind, ValueKind::Chain { .. });
        two_words(row, field, name)
            || (method && !one_value)
            || (is_field(name) && !is_value(name))
            || (!is_field(field) && is_value(field))
    })
}

enum Piece<'s> {
    Word(Name<'s>),
    Value(tree::Value<'s>),
}

/// The words and values that a field was read from.
fn pieces<'s>(field: &tree::Field<'s>) -> impl Iterator<Item = Piece<'s>> + use<'s> {
    let value = &field.value;
    let (word, value) = match &value.kind {
        ValueKind::Missing => (None, None),
        ValueKind::Name(text) => {
            let span = value.span;
            (Some(Piece::Word(Name { text, span })), None)
        }
        ValueKind::Call(call) if predefined(call.function.text).is_none() => {
            let list = list(call.arguments.clone(), call.parentheses);
            (Some(Piece::Word(call.function)), Some(Piece::Value(list)))
        }
        _ => (None, Some(Piece::Value(value.clone()))),
    };
    [Some(Piece::Word(field.name)), word, value]
        .into_iter()
        .flatten()
}

/// A field's name with the values that were dealt to it.
struct Dealt<'r, 's> {
    row: &'r schema::Block,
    name: Name<'s>,
    values: Vec<tree::Value<'s>>,
}

impl<'s> Dealt<'_, 's> {
    fn field(self, sources: &'s Sources, problems: &mut Vec<syntax::Problem>) -> tree::Field<'s> {
        let name = self.name;
        let end = Span::new(name.span.source, name.span.end, name.span.end);
        let last = self.values.last().map_or(end, |last| last.span);
        let first = self.values.first().map_or(end, |first| first.span);
        let span = first.to(last);
        let kind = self.value(sources.text(span), span, sources, problems);
        tree::Field {
            name,
            span: name.span.to(span),
            value: tree::Value { kind, span },
        }
    }

    /// The values as one; a problem where they are none.
    fn value(
        self,
        text: &'s str,
        span: Span,
        sources: &Sources,
        problems: &mut Vec<syntax::Problem>,
    ) -> ValueKind<'s> {
        let takes = self.row.field(self.name.text).map(|field| field.takes);
        let is_name = |value: &tree::Value<'_>| matches!(value.kind, ValueKind::Name(_));
        let one_line = !text.contains(['\n', '/']);
        let problem = match (takes, self.values.as_slice()) {
            (_, []) => return ValueKind::Missing,
            // Something that was reported stands for nothing.
            (_, [_, rest @ ..]) if rest.iter().any(|v| v.kind == ValueKind::Bad) => {
                return ValueKind::Bad;
            }
            // `multi jittered`, `multi-jittered` and `dark red` are one name, written wrongly.
            (Some(Type::Method), [only])
                if matches!(only.kind, ValueKind::Chain { .. }) && one_line =>
            {
                return ValueKind::Name(text);
            }
            (Some(Type::Method | Type::Color), [_, _, ..])
                if self.values.iter().all(is_name) && one_line =>
            {
                return ValueKind::Name(text);
            }
            (_, [only]) => return only.kind.clone(),
            (_, [left, right]) if is_call(left, right) => return call(left, right),
            (Some(Type::Method), [_, right, ..]) => syntax::Problem::Unexpected {
                written: syntax::shorten(sources.text(right.span)),
                help:
                    "write the method's name alone; `per_pixel 16` says how many samples there are"
                        .to_owned(),
                span: right.span,
            },
            (Some(Type::Vector), [_, _, _]) | (Some(Type::Colors), [_, _]) => {
                let texts = self.values.iter().map(|value| sources.text(value.span));
                let values = texts.collect::<Vec<_>>().join(", ");
                syntax::Problem::MissingParentheses {
                    values: syntax::shorten(&values),
                    span,
                    together: format!("({values})"),
                }
            }
            (_, [left, right, ..]) => {
                if let Some(sign) = self.operator_before_field(left) {
                    problems.push(syntax::Problem::MissingOperand {
                        operator: sources.text(sign).to_owned(),
                        side: "after",
                        span: sign,
                    });
                    return ValueKind::Bad;
                }
                let texts = (sources.text(left.span), sources.text(right.span));
                match has_no_product(left) && has_no_product(right) {
                    true => syntax::missing_field(texts.0, texts.1, right.span),
                    false => syntax::missing_operator(texts.0, texts.1, right.span),
                }
            }
        };
        problems.push(problem);
        ValueKind::Bad
    }
}

impl Dealt<'_, '_> {
    /// The last operator of a value, if the name of a field follows it: `2+ color`.
    fn operator_before_field(&self, value: &tree::Value<'_>) -> Option<Span> {
        let ValueKind::Chain { rest, .. } = &value.kind else {
            return None;
        };
        let last = rest.last()?;
        match last.operand.kind {
            ValueKind::Name(name) => self.row.field(name).map(|_| last.sign),
            _ => self.operator_before_field(&last.operand),
        }
    }
}

/// Whether a value is a vector or a colour as it stands.
fn has_no_product(value: &tree::Value<'_>) -> bool {
    match value.kind {
        ValueKind::Tuple(_) | ValueKind::ColorCode(_) => true,
        ValueKind::Name(name) => predefined(name) == Some("a colour"),
        _ => false,
    }
}

/// Whether a value is a name, and the next one in parentheses.
fn is_call(left: &tree::Value<'_>, right: &tree::Value<'_>) -> bool {
    let list = matches!(right.kind, ValueKind::Tuple(_) | ValueKind::Parentheses(_));
    list && matches!(left.kind, ValueKind::Name(_))
}

fn call<'s>(left: &tree::Value<'s>, right: &tree::Value<'s>) -> ValueKind<'s> {
    let span = left.span;
    match left.kind {
        ValueKind::Name(text) => called(Name { text, span }, right.clone()),
        _ => ValueKind::Bad,
    }
}

fn called<'s>(function: Name<'s>, list: tree::Value<'s>) -> ValueKind<'s> {
    let parentheses = list.span;
    let arguments = match list.kind {
        ValueKind::Tuple(elements) => elements,
        ValueKind::Parentheses(only) => vec![tree::Element {
            value: *only,
            comma: None,
        }],
        _ => Vec::new(),
    };
    ValueKind::Call(Box::new(tree::Call {
        function,
        arguments,
        parentheses,
    }))
}

fn list<'s>(mut arguments: Vec<tree::Element<'s>>, span: Span) -> tree::Value<'s> {
    let kind = match (arguments.len(), arguments.pop()) {
        (1, Some(only)) => ValueKind::Parentheses(Box::new(only.value)),
        (_, last) => {
            arguments.extend(last);
            ValueKind::Tuple(arguments)
        }
    };
    tree::Value { kind, span }
}
