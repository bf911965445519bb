//! The value of a field: of the type that the field takes, and within its range.

use super::{
    Lowering,
    words::{list_for, range_words, right_type, shown},
};
use crate::{
    scene::{
        error::{Found, Problem},
        eval::{Evaluator, WithUnit},
        fix,
        schema::{self, Condition, Field, Type},
        value::Value,
    },
    source::Span,
    suggest,
    syntax::{
        shorten,
        tree::{self, ValueKind},
    },
};

impl<'s> Lowering<'s> {
    /// The value of a field, if it is of the field's type and keeps its conditions.
    pub(super) fn typed(&mut self, row: &'static Field, tree: &tree::Value<'s>) -> Option<Value> {
        let before = self.problems.len();
        let value = match row.takes {
            Type::Method => return self.method(row, tree),
            takes => match self.evaluate(tree, Some(takes)) {
                Some(value) => value,
                None => {
                    self.parts_of_list(row, tree);
                    return None;
                }
            },
        };
        if value.kind() != row.takes {
            self.wrong_type(row, tree, value);
            return None;
        }
        let broken = row.must.iter().find(|condition| !condition.holds(value));
        if let Some(&condition) = broken {
            let rounded_to_zero = matches!(
                (&tree.kind, self.problems.last()),
                (
                    ValueKind::Number(_),
                    Some(Found {
                        problem: Problem::NumberUnderflow { .. },
                        ..
                    })
                )
            ) && self.problems.len() > before;
            if rounded_to_zero {
                self.problems.truncate(before);
            }
            let found = match (&tree.kind, value) {
                (ValueKind::Name(_) | ValueKind::Call(_) | ValueKind::Chain { .. }, value) => {
                    shown(value, condition)
                }
                _ if rounded_to_zero => {
                    format!(
                        "{}, which rounds to 0",
                        shorten(self.sources.text(tree.span))
                    )
                }
                _ => shorten(self.sources.text(tree.span)),
            };
            self.out_of_range(row, condition, tree, value, &found);
            return None;
        }
        Some(value)
    }

    /// A list of numbers that is no vector: says what the field takes in place of it.
    fn parts_of_list(&mut self, row: &'static Field, tree: &tree::Value<'s>) {
        let last = self.problems.last().map(|found| &found.problem);
        let (Some(Problem::PartCount { span, .. }), ValueKind::Tuple(elements)) =
            (last, &tree.kind)
        else {
            return;
        };
        if *span != tree.span || row.takes == Type::Colors {
            return;
        }
        let texts = elements
            .iter()
            .map(|element| self.sources.text(element.value.span));
        let texts: Vec<&str> = texts.collect();
        let (help, instead) = list_for(row, &texts);
        match (row.takes, self.problems.last_mut()) {
            (
                Type::Vector,
                Some(Found {
                    problem: Problem::PartCount { help: said, .. },
                    fixes,
                }),
            ) => {
                if let Some(help) = help {
                    *said = help;
                }
                if let Some(instead) = instead {
                    *fixes = fix::instead(tree.span, instead);
                }
            }
            _ => {
                self.problems.pop();
                let problem = Problem::WrongType {
                    name: row.name.to_owned(),
                    takes: row.takes.noun(),
                    written: self.evaluator().quoted(tree.span),
                    found: "a list of numbers".to_owned(),
                    help: help.unwrap_or_else(|| {
                        format!("write {}, such as `{}`", row.takes.noun(), row.example())
                    }),
                    span: tree.span,
                    label: "a list of numbers".to_owned(),
                }
                .with(fix::instead(tree.span, instead.unwrap_or_default()));
                self.problems.push(problem);
            }
        }
    }

    fn method(&mut self, row: &'static Field, tree: &tree::Value<'s>) -> Option<Value> {
        let list = suggest::list(schema::method_names());
        let ValueKind::Name(written) = tree.kind else {
            if !matches!(tree.kind, ValueKind::Bad | ValueKind::Missing) {
                let found = self.evaluate(tree, None)?.kind();
                let problem = Problem::WrongType {
                    name: row.name.to_owned(),
                    takes: row.takes.noun(),
                    written: self.evaluator().quoted(tree.span),
                    found: found.noun().to_owned(),
                    help: format!("the methods are {list}"),
                    span: tree.span,
                    label: found.noun().to_owned(),
                };
                self.problems.push(problem);
            }
            return None;
        };
        if let Some(method) = schema::method(written) {
            return Some(Value::Method(method));
        }
        let near = schema::nearest_method(written);
        let help = match near {
            Some(near) => format!("did you mean `{near}`? The methods are {list}."),
            None => format!("the methods are {list}"),
        };
        self.problems.push(
            Problem::UnknownMethod {
                written: written.to_owned(),
                help,
                span: tree.span,
            }
            .with(fix::written(tree.span, near)),
        );
        None
    }

    fn wrong_type(&mut self, row: &Field, tree: &tree::Value<'s>, value: Value) {
        let evaluator = self.evaluator();
        let label = evaluator.described(tree, value.kind());
        let written = evaluator.quoted(tree.span);
        let whole = evaluator.sources.text(tree.span);
        let problem = if let (Type::Angle, Value::Number(number)) = (row.takes, value) {
            let units = evaluator.units(tree);
            // A unit that cannot be meant is not offered: `fov 45rad` would be the next mistake.
            let fits = |unit: &&WithUnit| row.allows(Value::Angle(unit.unit.of(number)));
            let fitting: Vec<&WithUnit> = units.iter().filter(fits).collect();
            let [first, second] = &units;
            Problem::BareAngle {
                what: format!("`{}`", row.name),
                written,
                help: match fitting.as_slice() {
                    [only] => format!("write `{}`", only.shown),
                    _ => format!("write `{}` (or `{}`)", first.shown, second.shown),
                },
                span: tree.span,
                label,
            }
            .with(fix::instead(
                tree.span,
                fitting.iter().map(|unit| unit.text.clone()),
            ))
        } else {
            let (help, instead) = right_type(row, tree, value, whole);
            Problem::WrongType {
                name: row.name.to_owned(),
                takes: row.takes.noun(),
                written,
                found: value.kind().noun().to_owned(),
                help,
                span: tree.span,
                label,
            }
            .with(fix::instead(tree.span, instead))
        };
        self.problems.push(problem);
    }

    fn out_of_range(
        &mut self,
        row: &Field,
        condition: Condition,
        tree: &tree::Value<'s>,
        value: Value,
        found: &str,
    ) {
        let (label, help, instead) = range_words(row, condition, value);
        let message = match condition {
            Condition::NotZero => format!("`{}` must not be zero", row.name),
            _ => format!("`{}` must be {condition}, and it is {found}", row.name),
        };
        let (span, label) = match part_not_above_zero(condition, tree, value) {
            Some(part) => (part, "not above 0"),
            None => (tree.span, label),
        };
        self.problems.push(
            Problem::OutOfRange {
                message,
                help,
                span,
                label: label.to_owned(),
            }
            .with(fix::instead(tree.span, instead)),
        );
    }

    pub(super) fn evaluate(
        &mut self,
        value: &tree::Value<'s>,
        wanted: Option<Type>,
    ) -> Option<Value> {
        self.evaluator().value(value, wanted)
    }

    fn evaluator(&mut self) -> Evaluator<'_, 's> {
        Evaluator {
            sources: self.sources,
            names: &self.names,
            problems: &mut self.problems,
        }
    }
}

/// The first part of a written vector that is not above 0, if all were to be.
fn part_not_above_zero(condition: Condition, tree: &tree::Value<'_>, value: Value) -> Option<Span> {
    let (Condition::EachMoreThanZero, ValueKind::Tuple(parts), Value::Vector(v)) =
        (condition, &tree.kind, value)
    else {
        return None;
    };
    let mut parts = parts.iter().zip(v.to_array());
    parts.find_map(|(part, x)| (x <= 0.0).then_some(part.value.span))
}
