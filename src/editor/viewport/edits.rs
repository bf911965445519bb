//! Numbers of fields, written into the text where they stand.
//!
//! A literal is replaced, number by number, so that one that does not change stays as it is written. Where a name stands, the literal of its `let` changes;
//! to an expression an offset is added, or changed where the expression ends in one. A field that is not there is added to its block.

use super::fields::{Change, degrees, difference};
use crate::{
    diagnostic::Edit,
    editor::Analysis,
    schema::Value,
    source::{SourceId, Span},
    syntax::tree::{self, Block, Operator, Step, Unit, ValueKind},
};

/// The edits that change fields of a block, in order, with numbers written to so many decimals: those of angles in degrees, and radians to two more.
/// None if two of them want different things of one number.
pub fn edits<'s>(
    analysis: &Analysis<'s>,
    block: &Block<'s>,
    changes: &[Change],
    decimals: i32,
) -> Option<Vec<Edit>> {
    let mut writer = Writer {
        analysis,
        decimals,
        edits: Vec::new(),
    };
    let mut added = Vec::new();
    for &Change { name, from, by } in changes {
        match block.fields.iter().find(|field| field.name.text == name) {
            Some(field) => writer.value(&field.value, by),
            None => added.push(format!("{name} {}", writer.sum(from, by))),
        }
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
    is_right.then_some(edits)
}

struct Writer<'a, 's> {
    analysis: &'a Analysis<'s>,
    decimals: i32,
    edits: Vec<Edit>,
}

impl<'s> Writer<'_, 's> {
    /// Changes a value by an amount.
    fn value(&mut self, tree: &tree::Value<'s>, by: Value) {
        let model = &self.analysis.model;
        match (&tree.kind, by) {
            (ValueKind::Parentheses(inner), _) => self.value(inner, by),
            (ValueKind::Name(name), _) => match model.definition_at(name, tree.span.start) {
                Some(definition) => self.value(&definition.value, by),
                None => self.offset(tree.span, by),
            },
            (ValueKind::Tuple(elements), Value::Vector(by)) if elements.len() == 3 => {
                for (axis, element) in elements.iter().enumerate() {
                    if by[axis] != 0.0 {
                        self.value(&element.value, Value::Number(by[axis]));
                    }
                }
            }
            (_, Value::Number(_) | Value::Angle(_)) if is_number(tree) => {
                self.literal(tree, tree.span, by);
            }
            (ValueKind::Chain { rest, .. }, _) => match rest.last() {
                Some(step) if !step.operator.is_of_product() && is_literal(&step.operand) => {
                    self.last(step, by);
                }
                _ => self.offset(tree.span, by),
            },
            _ => self.offset(tree.span, by),
        }
    }

    /// Changes the literal that a sum ends in.
    fn last(&mut self, step: &Step<'s>, by: Value) {
        match (step.operator, by) {
            (Operator::Subtract, Value::Vector(by)) => {
                self.value(&step.operand, Value::Vector(-by));
            }
            (_, Value::Vector(_)) => self.value(&step.operand, by),
            _ => self.literal(&step.operand, step.sign.to(step.operand.span), by),
        }
    }

    /// Changes a number or an angle; the place may begin with the operator before it, of a sum.
    fn literal(&mut self, tree: &tree::Value<'s>, place: Span, by: Value) {
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
        if new == old {
            return;
        }
        let digits = spelled(new.abs(), unit);
        self.edits.push(match operator {
            None => Edit::new(place, spelled(new, unit)),
            Some(_) if (new < 0.0) == (sign < 0.0) => Edit::new(tree.span, digits),
            Some(_) if new < 0.0 => Edit::new(place, format!("- {digits}")),
            Some(_) => Edit::new(place, format!("+ {digits}")),
        });
    }

    /// Adds an offset behind an expression.
    fn offset(&mut self, behind: Span, by: Value) {
        let zero = difference(by, by);
        let text = self.sum(zero, by);
        if text == self.sum(zero, zero) {
            return;
        }
        let text = match text.strip_prefix('-') {
            Some(digits) => format!(" - {digits}"),
            None => format!(" + {text}"),
        };
        self.edits
            .push(Edit::insert(SourceId::File, behind.end, text));
    }

    /// A value that has changed by an amount, as it is written.
    fn sum(&self, from: Value, by: Value) -> String {
        match (from, by) {
            (Value::Vector(from), Value::Vector(by)) => {
                let [x, y, z] = [0, 1, 2].map(|axis| {
                    spelled(self.rounded(from[axis], from[axis] + by[axis], None), None)
                });
                format!("({x}, {y}, {z})")
            }
            _ => {
                let unit = matches!(from, Value::Angle(_)).then_some(Unit::Degrees);
                let old = amount(from, unit);
                spelled(self.rounded(old, old + amount(by, unit), unit), unit)
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
        (Value::Angle(angle), Some(Unit::Radians)) => angle.radians + angle.degrees.to_radians(),
        (Value::Angle(angle), _) => degrees(angle),
        _ => 0.0,
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
