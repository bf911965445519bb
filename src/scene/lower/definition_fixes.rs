//! Edits of definitions, for problems of their names.
//!
//! In: the problems that were found and the tree of the whole file. A problem is written where a name is met; what could be
//! done about it depends on what stands elsewhere, so it is added when all is read.

use super::Lowering;
use crate::{
    diagnostic::{Edit, Fix, with_comments},
    scene::{
        error::Problem,
        predefined,
        schema::{self, Type},
    },
    source::{SourceId, Span},
    syntax::{
        Parsed,
        tree::{Item, Value, ValueKind},
    },
};

impl<'s> Lowering<'s> {
    /// Says of the problems with definitions what can be done about them.
    pub(super) fn fix_definitions(&mut self, parsed: &Parsed<'s>) {
        let mut problems = std::mem::take(&mut self.problems);
        for found in problems.iter_mut() {
            found.fixes.extend(match &found.problem {
                Problem::UsedBeforeDefinition {
                    name,
                    span,
                    definition,
                    ..
                } => self.moved(name, *span, *definition, parsed),
                Problem::PredefinedName {
                    name, span, found, ..
                } => self.renamed(name, *span, *found, &parsed.tree.items),
                _ => None,
            });
        }
        self.problems = problems;
    }

    /// Moves a definition with its comments before the item that uses it first, if it can stand there.
    fn moved(&self, name: &str, used: Span, defined: Span, parsed: &Parsed<'s>) -> Option<Fix> {
        let items = &parsed.tree.items;
        let item_at = |at: usize| {
            let next = items.partition_point(|item| item.span().start <= at);
            items.get(next.checked_sub(1)?)
        };
        if used.source != SourceId::File || defined.source != SourceId::File {
            return None;
        }
        let (user, definition) = (item_at(used.start)?.span(), item_at(defined.start)?);
        let Item::Definition(definition) = definition else {
            return None;
        };
        let (whole, is_written) = (definition.span, !definition.keyword.range().is_empty());
        let is_above = |place: Span| place.source == SourceId::File && place.end <= user.start;
        let mut can_move = is_written && definition.equals.is_some() && user.end <= whole.start;
        can_move &= used.end <= user.end && !is_unfinished(&definition.value);
        for_each_name(&definition.value, &mut |used, _| {
            let is_known = self.names.place(used).is_some_and(is_above);
            can_move &=
                is_known || (self.names.place(used).is_none() && predefined(used).is_some());
        });
        if !can_move {
            return None;
        }
        let text = self.sources.file.text();
        let comments = &parsed.comments;
        let from = with_comments_above(with_comments(whole, self.sources), text, comments);
        let to = with_comments_above(user, text, comments);
        // The comment at a file's start is about all of it.
        let is_first = text
            .get(self.sources.file.bom_len()..to.start)?
            .trim()
            .is_empty();
        let to = if is_first { user.start } else { to.start };
        let moved = text.get(from.range())?;
        let before = text.get(..to)?;
        let apart = match indent_of_line(before) {
            Some(indent) => format!("{}{indent}", self.sources.file.line_end()),
            None if moved.contains("//") => self.sources.file.line_end().to_owned(),
            None => " ".to_owned(),
        };
        Some(Fix::new(
            format!("move `let {name}` before its first use"),
            [
                Edit::insert(SourceId::File, to, format!("{moved}{apart}")),
                Edit::remove(from, self.sources),
            ],
        ))
    }

    /// Gives a definition, and what uses it below, the name that the help suggests. Where a colour is wanted, a colour's name means that.
    fn renamed(
        &self,
        name: &str,
        span: Span,
        found: Option<Type>,
        items: &[Item<'s>],
    ) -> Option<Fix> {
        let new = format!("my_{name}");
        // What is typed on the command line is not renamed with the file.
        let is_set = self.targets.contains_key(&(None, name))
            || self
                .overrides
                .iter()
                .any(|set| holds_name(&set.value, name));
        if self.names.knows(&new) || is_set {
            return None;
        }
        let kind = match predefined(name)? {
            "a colour" => Some(Type::Color),
            "a number" => Some(Type::Number),
            "a unit" => Some(Type::Angle),
            _ => None,
        };
        let mut places = vec![span];
        let mut is_clear = true;
        for item in items.iter().filter(|item| item.span().start > span.start) {
            match item {
                Item::Definition(definition) => {
                    is_clear &= definition.name.is_none_or(|other| other.text != name);
                    let value = &definition.value;
                    let is_all = matches!(value.kind, ValueKind::Name(_));
                    // What a name by itself means does not show where both could be meant, nor which of two numbers.
                    is_clear &= !holds_name(value, name)
                        || kind == found
                        || kind.is_none()
                        || (kind == Some(Type::Color) && !is_all && found.is_some());
                    push_uses(value, name, &mut places);
                }
                Item::Block(block) => {
                    let row = block.kind.and_then(|kind| schema::block(kind.text));
                    for field in &block.fields {
                        let takes = row
                            .and_then(|row| row.field(field.name.text))
                            .map(|row| row.takes);
                        let is_color = matches!(takes, Some(Type::Color | Type::Colors));
                        let is_other = is_color && kind == Some(Type::Color) && kind != found;
                        is_clear &= kind.is_none()
                            || kind == found
                            || (kind == Some(Type::Color) && found.is_some())
                            || !holds_name(&field.value, name);
                        if takes != Some(Type::Method) && !is_other {
                            push_uses(&field.value, name, &mut places);
                        }
                    }
                }
                Item::Bad(_) => {}
            }
        }
        let edits = places.into_iter().map(|place| Edit::new(place, &new));
        is_clear.then(|| Fix::new(format!("call it `{new}`"), edits))
    }
}

fn push_uses(value: &Value<'_>, name: &str, places: &mut Vec<Span>) {
    for_each_name(value, &mut |used, span| {
        if used == name {
            places.push(span);
        }
    });
}

fn is_unfinished(value: &Value<'_>) -> bool {
    matches!(value.kind, ValueKind::Missing | ValueKind::Bad)
}

fn holds_name(value: &Value<'_>, name: &str) -> bool {
    let mut found = false;
    for_each_name(value, &mut |used, _| found |= used == name);
    found
}

/// Calls a function with every name that stands for a value, in order.
fn for_each_name<'s>(value: &Value<'s>, call: &mut impl FnMut(&'s str, Span)) {
    match &value.kind {
        ValueKind::Name(name) => call(name, value.span),
        ValueKind::Call(made) => {
            for argument in &made.arguments {
                for_each_name(&argument.value, call);
            }
        }
        ValueKind::Parentheses(inner) => for_each_name(inner, call),
        ValueKind::Tuple(elements) => {
            for element in elements {
                for_each_name(&element.value, call);
            }
        }
        ValueKind::Negation { operand, .. } => for_each_name(operand, call),
        ValueKind::Chain { first, rest } => {
            for_each_name(first, call);
            for step in rest {
                for_each_name(&step.operand, call);
            }
        }
        _ => {}
    }
}

/// The blanks at the end of a text, if they start a line.
fn indent_of_line(before: &str) -> Option<&str> {
    let outer = before.trim_end_matches([' ', '\t']);
    let starts = outer.is_empty() || outer.ends_with(['\n', '\u{feff}']);
    before.get(outer.len()..).filter(|_| starts)
}

/// An item with the lines of comments right above it.
fn with_comments_above(item: Span, text: &str, comments: &[Span]) -> Span {
    let mut start = item.start;
    let starts_line = |at: usize| text.get(..at).and_then(indent_of_line).is_some();
    while starts_line(start) {
        let above = comments.partition_point(|comment| comment.start < start);
        let Some(comment) = above.checked_sub(1).and_then(|above| comments.get(above)) else {
            break;
        };
        let between = text.get(comment.end..start).unwrap_or_default();
        let is_above = between.trim().is_empty() && between.matches('\n').count() == 1;
        if !is_above || !starts_line(comment.start) {
            break;
        }
        start = comment.start;
    }
    Span::new(item.source, start, item.end)
}
