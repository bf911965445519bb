//! Numbers of fields, written into the text where they stand.
//!
//! A literal is replaced, number by number, so that one that does not change stays as it is written. Where a name stands, the literal of its `let` changes;
//! to an expression an offset is added, or changed where the expression ends in one. A field that is not there is added to its block.

use glam::DVec3;

use super::fields::Change;
use crate::{
    diagnostic::Edit,
    editor::Analysis,
    scene::{Part, operate},
    schema::Value,
    source::{SourceId, Span},
    syntax::tree::{self, Block, Operator, Step, Unit, ValueKind},
};

/// The edits that change fields of a part's block, in order, with numbers written to so many decimals: those of angles in degrees, and radians to two more. And
/// what becomes of the part, unless a number that changes stands behind several of its fields. None if two of them want different things of one number.
pub fn edits<'s>(
    analysis: &Analysis<'s>,
    block: &Block<'s>,
    mut part: Part,
    changes: &[Change],
    decimals: i32,
) -> Option<(Vec<Edit>, Part)> {
    let mut writer = Writer {
        analysis,
        decimals,
        edits: Vec::new(),
    };
    let mut added = Vec::new();
    for &Change { name, from, by } in changes {
        let value = match block.fields.iter().find(|field| field.name.text == name) {
            Some(field) => operate(Operator::Add, from, writer.change(&field.value, by))?,
            None => {
                let value = writer.sum(from, by);
                added.push(format!("{name} {}", spelled_sum(value)));
                value
            }
        };
        part = part.with(name, value)?;
    }
    let mut edits = writer.edits;
    if !added.is_empty() {
        edits.extend(Edit::add_fields(
            block.span,
            analysis.model.sources(),
            &added,
        ));
    }
    edits.sort_by_key(|edit| edit.span);
    edits.dedup();
    let apart = |pair: &[Edit]| pair[0].span.end <= pair[1].span.start;
    let same = |pair: &[Edit]| pair[0].span == pair[1].span;
    let is_right = edits.windows(2).all(|pair| apart(pair) && !same(pair));
    is_right.then_some((edits, part))
}

struct Writer<'a, 's> {
    analysis: &'a Analysis<'s>,
    decimals: i32,
    edits: Vec<Edit>,
}

impl<'s> Writer<'_, 's> {
    /// Changes a value by an amount. Returns by how much it has changed, which is rounded.
    fn change(&mut self, tree: &tree::Value<'s>, by: Value) -> Value {
        let model = &self.analysis.model;
        match (&tree.kind, by) {
            (ValueKind::Parentheses(inner), _) => self.change(inner, by),
            (ValueKind::Name(name), _) => match model.definition_at(name, tree.span.start) {
                Some(definition) => self.change(&definition.value, by),
                None => self.offset(tree.span, by),
            },
            (ValueKind::Tuple(elements), Value::Vector(mut by)) if elements.len() == 3 => {
                for (axis, element) in elements.iter().enumerate() {
                    if by[axis] != 0.0 {
                        by[axis] =
                            amount(self.change(&element.value, Value::Number(by[axis])), None);
                    }
                }
                Value::Vector(by)
            }
            (_, Value::Number(_) | Value::Angle(_)) if is_number(tree) => {
                self.literal(tree, tree.span, by)
            }
            (ValueKind::Chain { rest, .. }, _) => match rest.last() {
                Some(step) if !step.operator.is_of_product() && is_literal(&step.operand) => {
                    self.last(step, by)
                }
                _ => self.offset(tree.span, by),
            },
            _ => self.offset(tree.span, by),
        }
    }

    /// Changes the literal that a sum ends in.
    fn last(&mut self, step: &Step<'s>, by: Value) -> Value {
        match (step.operator, by) {
            (Operator::Subtract, Value::Vector(by)) => {
                match self.change(&step.operand, Value::Vector(-by)) {
                    Value::Vector(by) => Value::Vector(-by),
                    other => other,
                }
            }
            (_, Value::Vector(_)) => self.change(&step.operand, by),
            _ => self.literal(&step.operand, step.sign.to(step.operand.span), by),
        }
    }

    /// Changes a number or an angle; the place may begin with the operator before it, of a sum.
    fn literal(&mut self, tree: &tree::Value<'s>, place: Span, by: Value) -> Value {
        let written = self.analysis.slice(place);
        let operator = match place == tree.span {
            true => None,
            false => written.chars().next(),
        };
        let sign = match operator {
            Some('-') => -1.0,
            _ => 1.0,
        };
        let unit = unit(tree);
        let value = self.analysis.model.value(tree, None);
        let old = sign * value.map_or(0.0, |value| amount(value, unit));
        let new = self.rounded(old, old + amount(by, unit), unit);
        if new != old {
            let digits = spelled(new.abs(), unit);
            self.edits.push(match operator {
                None => Edit::new(place, spelled(new, unit)),
                Some(_) if (new < 0.0) == (sign < 0.0) => Edit::new(tree.span, digits),
                Some(_) if new < 0.0 => Edit::new(place, format!("- {digits}")),
                Some(_) => Edit::new(place, format!("+ {digits}")),
            });
        }
        value_of(new - old, unit)
    }

    /// Adds an offset behind an expression.
    fn offset(&mut self, behind: Span, by: Value) -> Value {
        let zero = match by {
            Value::Vector(_) => Value::Vector(DVec3::ZERO),
            Value::Angle(_) => value_of(0.0, Some(Unit::Degrees)),
            _ => Value::Number(0.0),
        };
        let by = self.sum(zero, by);
        if by != zero {
            let text = spelled_sum(by);
            let text = match text.strip_prefix('-') {
                Some(digits) => format!(" - {digits}"),
                None => format!(" + {text}"),
            };
            self.edits
                .push(Edit::insert(SourceId::File, behind.end, text));
        }
        by
    }

    /// A value that has changed by an amount; an angle in degrees.
    fn sum(&self, from: Value, by: Value) -> Value {
        match (from, by) {
            (Value::Vector(mut from), Value::Vector(by)) => {
                for axis in 0..3 {
                    from[axis] = self.rounded(from[axis], from[axis] + by[axis], None);
                }
                Value::Vector(from)
            }
            _ => {
                let unit = matches!(from, Value::Angle(_)).then_some(Unit::Degrees);
                let old = amount(from, unit);
                value_of(self.rounded(old, old + amount(by, unit), unit), unit)
            }
        }
    }

    /// The new number with as many decimals as there are to be; the old one where the difference has none of them.
    fn rounded(&self, old: f64, new: f64, unit: Option<Unit>) -> f64 {
        let decimals = match unit {
            Some(Unit::Radians) => self.decimals + 2,
            _ => self.decimals,
        };
        match round(new - old, decimals) == 0.0 {
            true => old,
            false => round(new, decimals),
        }
    }
}

/// Whether a value is a number or an angle, with a sign or without.
fn is_number(tree: &tree::Value<'_>) -> bool {
    match &tree.kind {
        ValueKind::Number(_) | ValueKind::Angle { .. } => true,
        ValueKind::Negation { operand, .. } => {
            matches!(operand.kind, ValueKind::Number(_) | ValueKind::Angle { .. })
        }
        _ => false,
    }
}

/// Whether a value is written in numbers, at least in part, so that it can take up any change.
fn is_literal(tree: &tree::Value<'_>) -> bool {
    is_number(tree) || matches!(&tree.kind, ValueKind::Tuple(elements) if elements.len() == 3)
}

/// The unit of a number.
fn unit(tree: &tree::Value<'_>) -> Option<Unit> {
    match &tree.kind {
        ValueKind::Angle { unit, .. } => Some(*unit),
        ValueKind::Negation { operand, .. } => unit(operand),
        _ => None,
    }
}

/// A number, or how many of its unit an angle is.
fn amount(value: Value, unit: Option<Unit>) -> f64 {
    match (value, unit) {
        (Value::Number(number), _) => number,
        (Value::Angle(angle), Some(Unit::Radians)) => angle.in_radians(),
        (Value::Angle(angle), _) => angle.in_degrees(),
        _ => 0.0,
    }
}

/// A number, or an angle of so many of its unit.
fn value_of(amount: f64, unit: Option<Unit>) -> Value {
    unit.map_or(Value::Number(amount), |unit| Value::Angle(unit.of(amount)))
}

/// A sum with all its digits.
fn spelled_sum(value: Value) -> String {
    match value {
        Value::Vector(vector) => {
            let [x, y, z] = vector.to_array().map(|number| spelled(number, None));
            format!("({x}, {y}, {z})")
        }
        Value::Angle(angle) => spelled(angle.in_degrees(), Some(Unit::Degrees)),
        number => spelled(amount(number, None), None),
    }
}

/// A number with all its digits.
fn spelled(number: f64, unit: Option<Unit>) -> String {
    let number = number + 0.0;
    let text = match number == 0.0 || (1e-4..1e9).contains(&number.abs()) {
        true => format!("{number}"),
        false => format!("{number:e}"),
    };
    text + unit.map_or("", Unit::name)
}

/// A number rounded to so many decimals, which may be fewer than none.
fn round(x: f64, decimals: i32) -> f64 {
    let text = match usize::try_from(decimals) {
        Ok(decimals) => format!("{x:.decimals$}"),
        Err(_) => {
            let power = decimals.unsigned_abs();
            let unit: f64 = format!("1e{power}").parse().unwrap_or(f64::INFINITY);
            format!("{}e{power}", (x / unit).round())
        }
    };
    text.parse().unwrap_or(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_rounded_to_decimals() {
        for (x, decimals, rounded) in [
            (1.2345, 2, 1.23),
            (-1.2355, 3, -1.236),
            (1234.5, -2, 1200.0),
            (1234.5, -3, 1000.0),
            (1234.5, -4, 0.0),
            (6234.5, -4, 10000.0),
            (6234.5, -5, 0.0),
            (0.05, 1, 0.1),
            (0.04, 1, 0.0),
            (1e300, -299, 1e300),
            (1e-300, 300, 1e-300),
            (0.1 + 0.2, 20, 0.1 + 0.2),
            (0.0, 3, 0.0),
        ] {
            assert_eq!(round(x, decimals), rounded, "{x} {decimals}");
        }
    }

    #[test]
    fn numbers_are_spelled_as_people_do() {
        for (x, text) in [
            (-0.0, "0"),
            (1.25, "1.25"),
            (1000.0, "1000"),
            (0.001, "0.001"),
            (1.5e-7, "1.5e-7"),
            (-1e300, "-1e300"),
        ] {
            assert_eq!(spelled(x, None), text);
        }
    }
}
