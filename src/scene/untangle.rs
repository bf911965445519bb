//! Fields that were taken for one another.
//!
//! In: a block's fields as they were parsed. Out: the fields as they were meant. The parser cannot tell the name of a field
//! from a value, as it does not know the fields; here both are known.

use std::borrow::Cow;

use super::{
    eval::{Names, predefined},
    schema,
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
    sources: &Sources,
    problems: &mut Vec<syntax::Problem>,
) -> Cow<'t, [tree::Field<'s>]> {
    if !is_tangled(fields, row, names) {
        return Cow::Borrowed(fields);
    }
    let is_value = |name: &str| names.knows(name) || predefined(name).is_some();
    let is_field = |name: &str| row.field(name).is_some();
    let mut meant: Vec<tree::Field<'s>> = Vec::with_capacity(fields.len());
    let mut current: Option<(Name<'s>, Vec<tree::Value<'s>>)> = None;
    for piece in fields.iter().flat_map(pieces) {
        let starts = match (&piece, &current) {
            (Piece::Value(_), _) => None,
            (Piece::Word(word), None) => Some(*word),
            (Piece::Word(word), Some((_, values))) => {
                let value = is_value(word.text);
                let field = match values.is_empty() {
                    true => is_field(word.text) && !value,
                    false => is_field(word.text) || !value,
                };
                field.then_some(*word)
            }
        };
        if let Some(name) = starts {
            meant.extend(current.take().map(|field| dealt(field, sources, problems)));
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
    meant.extend(current.map(|field| dealt(field, sources, problems)));
    Cow::Owned(meant)
}

/// Whether a block's fields may have been taken for one another: a value is missing, a field's name stands for a value, or
/// the name of a value for a field.
fn is_tangled(fields: &[tree::Field<'_>], row: &schema::Block, names: &Names<'_>) -> bool {
    let is_value = |name: &str| names.knows(name) || predefined(name).is_some();
    let is_field = |name: &str| row.field(name).is_some();
    fields.iter().any(|field| {
        let name = match &field.value.kind {
            ValueKind::Missing => return true,
            ValueKind::Name(name) => name,
            ValueKind::Call { function, .. } => function.text,
            _ => "",
        };
        let field = field.name.text;
        (is_field(name) && !is_value(name)) || (is_value(field) && !is_field(field))
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
        ValueKind::Call {
            function,
            arguments,
            parentheses,
        } if predefined(function.text).is_none() => {
            let list = list(arguments.clone(), *parentheses);
            (Some(Piece::Word(*function)), Some(Piece::Value(list)))
        }
        _ => (None, Some(Piece::Value(value.clone()))),
    };
    [Some(Piece::Word(field.name)), word, value]
        .into_iter()
        .flatten()
}

/// A field from its name and the values that were dealt to it.
fn dealt<'s>(
    (name, values): (Name<'s>, Vec<tree::Value<'s>>),
    sources: &Sources,
    problems: &mut Vec<syntax::Problem>,
) -> tree::Field<'s> {
    let end = Span::new(name.span.source, name.span.end, name.span.end);
    let mut values = values.into_iter();
    let mut value = values.next().unwrap_or(tree::Value {
        kind: ValueKind::Missing,
        span: end,
    });
    let left = value.clone();
    if let Some(right) = values.next() {
        let call = match (&left.kind, &right.kind) {
            (ValueKind::Name(text), ValueKind::Tuple(_) | ValueKind::Parentheses(_)) => Some(*text),
            _ => None,
        };
        value.span = left.span.to(right.span);
        value.kind = match call {
            Some(text) => called(
                Name {
                    text,
                    span: left.span,
                },
                right,
            ),
            None => {
                problems.push(syntax::missing_operator(
                    sources.text(left.span),
                    sources.text(right.span),
                    right.span,
                ));
                ValueKind::Bad
            }
        };
    }
    tree::Field {
        span: name.span.to(value.span),
        name,
        value,
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
    ValueKind::Call {
        function,
        arguments,
        parentheses,
    }
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
