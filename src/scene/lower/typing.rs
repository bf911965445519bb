//! The value of a field: of the type that the field takes, and within its range.

use glam::DVec3;

use super::{
    Lowering,
    words::{of_right_type, range_words, shown, type_help},
};
use crate::{
    math::{Angle, compare_half_turns},
    scene::{
        error::Problem,
        eval::Evaluator,
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
            takes => self.evaluate(tree, Some(takes))?,
        };
        if value.kind() != row.takes {
            self.wrong_type(row, tree, value);
            return None;
        }
        let broken = row.must.iter().find(|condition| !holds(**condition, value));
        if let Some(&condition) = broken {
            let rounded_to_zero = matches!(
                (&tree.kind, self.problems.last()),
                (ValueKind::Number(_), Some(Problem::NumberUnderflow { .. }))
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
                    instead: Vec::new(),
                };
                self.problems.push(problem);
            }
            return None;
        };
        if let Some(method) = schema::method(written) {
            return Some(Value::Method(method));
        }
        let near = suggest::nearest(written, schema::method_names());
        let help = match near {
            Some(near) => format!("did you mean `{near}`? The methods are {list}."),
            None => format!("the methods are {list}"),
        };
        self.problems.push(Problem::UnknownMethod {
            written: written.to_owned(),
            help,
            span: tree.span,
            near: near.map(str::to_owned),
        });
        None
    }

    fn wrong_type(&mut self, row: &Field, tree: &tree::Value<'s>, value: Value) {
        let evaluator = self.evaluator();
        let label = evaluator.described(tree, value.kind());
        let written = evaluator.quoted(tree.span);
        let whole = evaluator.sources.text(tree.span);
        let text = shorten(whole);
        let problem = if let (Type::Angle, Value::Number(number)) = (row.takes, value) {
            let [degrees, radians] = evaluator.with_units(tree);
            // A unit that cannot be meant is not offered: `fov 45rad` would be the next mistake.
            let angles = [Angle::from_degrees(number), Angle::from_radians(number)];
            let fits = angles.map(|angle| {
                let mut must = row.must.iter();
                must.all(|condition| holds(*condition, Value::Angle(angle)))
            });
            let instead = evaluator.as_angle(tree).into_iter().zip(fits);
            Problem::BareAngle {
                what: format!("`{}`", row.name),
                written,
                help: match fits {
                    [true, false] => format!("write `{degrees}`"),
                    [false, true] => format!("write `{radians}`"),
                    _ => format!("write `{degrees}` (or `{radians}`)"),
                },
                span: tree.span,
                label,
                instead: instead
                    .filter_map(|(text, fits)| fits.then_some(text))
                    .collect(),
            }
        } else {
            Problem::WrongType {
                name: row.name.to_owned(),
                takes: row.takes.noun(),
                written,
                found: value.kind().noun().to_owned(),
                help: type_help(row, tree, value.kind(), &text),
                span: tree.span,
                label,
                instead: of_right_type(row, tree, value.kind(), whole),
            }
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
        self.problems.push(Problem::OutOfRange {
            message,
            help,
            span,
            label: label.to_owned(),
            whole: tree.span,
            instead,
        });
    }

    pub(super) fn evaluate(
        &mut self,
        value: &tree::Value<'s>,
        wanted: Option<Type>,
    ) -> Option<Value> {
        self.evaluator().value(value, wanted)
    }

    /// Looks for mistakes in the value of something unknown.
    pub(super) fn evaluate_loosely(&mut self, value: &tree::Value<'s>) {
        if !matches!(value.kind, ValueKind::Name(_)) {
            let before = self.problems.len();
            self.evaluate(value, None);
            // What type was meant is not known; only a name is wrong in any.
            let found = self.problems.split_off(before);
            self.problems
                .extend(found.into_iter().filter(Problem::is_of_name));
        }
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

/// Whether a value keeps a condition; one of another type has no say in it.
fn holds(condition: Condition, value: Value) -> bool {
    let two_to = |power: u32| (1_u64 << power) as f64;
    match (condition, value) {
        (Condition::Whole, Value::Number(x)) => x.fract() == 0.0,
        (Condition::MoreThan(bound), Value::Number(x)) => x > bound,
        (Condition::AtLeast(bound), Value::Number(x)) => x >= bound,
        (Condition::AtMostTwoTo(power), Value::Number(x)) => x <= two_to(power),
        (Condition::LessThanTwoTo(power), Value::Number(x)) => x < two_to(power),
        (Condition::LessThanHalfTurn, Value::Angle(angle)) => {
            compare_half_turns(angle, 0.0).is_gt() && compare_half_turns(angle, 1.0).is_lt()
        }
        (Condition::NotZero, Value::Vector(v)) => v != DVec3::ZERO,
        (Condition::EachMoreThanZero, Value::Vector(v)) => v.min_element() > 0.0,
        _ => true,
    }
}
