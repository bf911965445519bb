//! Numbers of fields, written into the text where they stand.
//!
//! A literal is replaced, number by number, so that one that does not change stays as it is written. Where a name stands, the literal of its `let` changes;
//! to an expression an offset is added, or changed where the expression ends in one. A field that is not there is added to its block.

use glam::DVec3;

use crate::{
    diagnostic::Edit,
    editor::Analysis,
    math::Angle,
    schema::Value,
    source::{SourceId, Span},
    syntax::tree::{self, Block, Operator, Step, Unit, ValueKind},
};

/// Writes numbers to so many decimals; those of angles in degrees, and radians to two more.
pub struct Writer<'a, 's> {
    analysis: &'a Analysis<'s>,
    decimals: i32,
    edits: Vec<Edit>,
}

impl<'a, 's> Writer<'a, 's> {
    pub fn new(analysis: &'a Analysis<'s>, decimals: i32) -> Self {
        Self {
            analysis,
            decimals,
            edits: Vec::new(),
        }
    }

    /// The edits in order. None if two of them want different things of one number.
    pub fn finish(self) -> Option<Vec<Edit>> {
        let mut edits = self.edits;
        edits.sort_by_key(|edit| edit.span);
        edits.dedup();
        let apart = |pair: &[Edit]| pair[0].span.end <= pair[1].span.start;
        let same = |pair: &[Edit]| pair[0].span == pair[1].span;
        let is_right = edits.windows(2).all(|pair| apart(pair) && !same(pair));
        is_right.then_some(edits)
    }

    /// Changes fields of a block by amounts, rounded; a field that is left out has the value that is given with it. Says by how much each has changed.
    pub fn change(
        &mut self,
        block: &Block<'s>,
        changes: &[(&'static str, Value, Value)],
    ) -> Vec<Value> {
        let mut added = Vec::new();
        let mut changed = Vec::new();
        for &(name, from, by) in changes {
            let given = block.fields.iter().find(|field| field.name.text == name);
            changed.push(match given {
                Some(field) => self.value(&field.value, by),
                None => {
                    let (text, by) = self.spelled(from, by);
                    added.push(format!("{name} {text}"));
                    by
                }
            });
        }
        if !added.is_empty() {
            let sources = self.analysis.model.sources();
            let edit = Edit::add_fields(block.span, sources, &added);
            self.edits.extend(edit);
        }
        changed
    }

    /// Changes a value by an amount. Says by how much it has changed.
    fn value(&mut self, tree: &tree::Value<'s>, by: Value) -> Value {
        let model = &self.analysis.model;
        match (&tree.kind, by) {
            (ValueKind::Parentheses(inner), _) => self.value(inner, by),
            (ValueKind::Name(name), _) => match model.definition_at(name, tree.span.start) {
                Some(definition) => self.value(&definition.value, by),
                None => self.offset(tree.span, by),
            },
            (ValueKind::Tuple(elements), Value::Vector(by)) if elements.len() == 3 => {
                let mut changed = DVec3::ZERO;
                for (axis, element) in elements.iter().enumerate() {
                    if by[axis] != 0.0
                        && let Value::Number(by) =
                            self.value(&element.value, Value::Number(by[axis]))
                    {
                        changed[axis] = by;
                    }
                }
                Value::Vector(changed)
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
                match self.value(&step.operand, Value::Vector(-by)) {
                    Value::Vector(by) => Value::Vector(-by),
                    by => by,
                }
            }
            (Operator::Subtract, _) => {
                self.literal(&step.operand, step.sign.to(step.operand.span), by)
            }
            _ if is_number(&step.operand) => {
                self.literal(&step.operand, step.sign.to(step.operand.span), by)
            }
            _ => self.value(&step.operand, by),
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
            let text = match operator {
                None => spelled(new, unit),
                Some(_) if (new < 0.0) == (sign < 0.0) => {
                    self.edits
                        .push(Edit::new(tree.span, spelled(new.abs(), unit)));
                    return value_of(new - old, unit);
                }
                Some(_) => format!(
                    "{} {}",
                    if new < 0.0 { '-' } else { '+' },
                    spelled(new.abs(), unit)
                ),
            };
            self.edits.push(Edit::new(place, text));
        }
        value_of(new - old, unit)
    }

    /// Adds an offset behind an expression.
    fn offset(&mut self, behind: Span, by: Value) -> Value {
        let (text, by) = match by {
            Value::Vector(_) => {
                let (text, by) = self.spelled(Value::Vector(DVec3::ZERO), by);
                (format!(" + {text}"), by)
            }
            _ => {
                let unit = matches!(by, Value::Angle(_)).then_some(Unit::Degrees);
                let new = self.rounded(0.0, amount(by, unit), unit);
                let sign = if new < 0.0 { '-' } else { '+' };
                (
                    format!(" {sign} {}", spelled(new.abs(), unit)),
                    value_of(new, unit),
                )
            }
        };
        let is_any = match by {
            Value::Vector(by) => by != DVec3::ZERO,
            by => amount(by, Some(Unit::Degrees)) != 0.0,
        };
        if is_any {
            self.edits
                .push(Edit::insert(SourceId::File, behind.end, text));
        }
        by
    }

    /// A value that has changed by an amount as it is written, and by how much it has changed then.
    fn spelled(&self, from: Value, by: Value) -> (String, Value) {
        match (from, by) {
            (Value::Vector(from), Value::Vector(by)) => {
                let new =
                    [0, 1, 2].map(|axis| self.rounded(from[axis], from[axis] + by[axis], None));
                let [x, y, z] = new.map(|new| spelled(new, None));
                (
                    format!("({x}, {y}, {z})"),
                    Value::Vector(DVec3::from(new) - from),
                )
            }
            _ => {
                let unit = matches!(from, Value::Angle(_)).then_some(Unit::Degrees);
                let old = amount(from, unit);
                let new = self.rounded(old, old + amount(by, unit), unit);
                (spelled(new, unit), value_of(new - old, unit))
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

fn value_of(amount: f64, unit: Option<Unit>) -> Value {
    match unit {
        None => Value::Number(amount),
        Some(unit) => Value::Angle(unit.of(amount)),
    }
}

/// An angle in degrees.
pub fn degrees(angle: Angle) -> f64 {
    angle.degrees + angle.radians.to_degrees()
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
    if x == 0.0 || !x.is_finite() {
        return x;
    }
    let digits = decimals + exponent(x) + 1;
    let text = match digits {
        ..0 => return 0.0,
        // The unit of the last decimal, or nothing.
        0 => {
            let unit: f64 = format!("1e{}", -decimals).parse().unwrap_or(0.0);
            return if x.abs() < unit / 2.0 {
                0.0
            } else {
                unit.copysign(x)
            };
        }
        1..18 => format!("{x:.*e}", digits as usize - 1),
        _ => return x,
    };
    text.parse().unwrap_or(x)
}

/// The exponent of ten of a number's first digit.
pub fn exponent(x: f64) -> i32 {
    let text = format!("{x:e}");
    let exponent = text.split_once('e').map(|(_, exponent)| exponent);
    exponent
        .and_then(|exponent| exponent.parse().ok())
        .unwrap_or(0)
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
