//! Writes changed numbers of fields into the text.
//!
//! In a literal, only the numbers that change are replaced, so that the others keep their spelling.
//! If a name is used, the literal in its `let` is replaced. An expression gets an offset, such as
//! `+ 0.5`, at its end. If the expression already ends with a literal offset, the new amount is
//! added to this offset. A missing field is added to its block.

use glam::DVec3;

use crate::{
    diagnostic::Edit,
    editor::Analysis,
    math::Angle,
    scene::{FieldOwner, operate},
    schema::{self, BOX, Value},
    source::{SourceId, Span, sort_by_span},
    syntax::tree::{self, Block, Operator, Step, Unit, ValueKind},
};

/// A change of a field's value because a handle is dragged.
#[derive(Clone, Copy, Debug)]
pub struct FieldChange {
    /// Name of the changed field.
    pub name: &'static str,
    /// The field's old value.
    pub from: Value,
    /// Amount that is added to the old value.
    pub by: Value,
}

impl FieldChange {
    /// Returns the greatest absolute number in the amount `by`. The amount of an angle is in
    /// degrees.
    pub fn size(&self) -> f64 {
        match self.by {
            Value::Vector(vector) => vector.abs().max_element(),
            by => amount(by, Unit::Degrees).abs(),
        }
    }

    /// Returns copies of `owner`, one for each number of the field that changes, such as a
    /// coordinate of a point. In each copy, only this number is changed, by 10^−`decimals`.
    pub fn with_unit(&self, owner: FieldOwner, decimals: i32) -> Vec<FieldOwner> {
        let unit = libm::pow(10.0, f64::from(-decimals));
        let units = match self.by {
            Value::Vector(by) => {
                let axes = [0, 1, 2].into_iter().filter(|axis| by[*axis] != 0.0);
                axes.map(|axis| Value::Vector(DVec3::AXES[axis] * unit))
                    .collect()
            }
            Value::Angle(_) => vec![Value::Angle(Angle::from_degrees(unit))],
            _ => vec![Value::Number(unit)],
        };
        let changed = |by| owner.with(self.name, operate(Operator::Add, self.from, by)?);
        units.into_iter().filter_map(changed).collect()
    }
}

/// Returns the changes of the fields in which two states of an object or camera, `current` and
/// `ideal`, differ. A box can be given either by its corners or by its centre and size; only the
/// fields of the form that `block` uses are returned.
pub fn changes(block: &Block<'_>, current: FieldOwner, ideal: FieldOwner) -> Vec<FieldChange> {
    let has_min = |field: &tree::Field<'_>| field.name.text == BOX.min.name;
    let other_way = if block.fields.iter().any(has_min) {
        [BOX.center.name, BOX.size.name]
    } else {
        [BOX.min.name, BOX.max.name]
    };
    let fields = block.kind.and_then(|kind| schema::block(kind.text));
    let fields = fields.into_iter().flat_map(|row| row.fields);
    let changes = fields.filter_map(|&schema::FieldRow { name, .. }| {
        let from = current.value(name)?;
        let by = operate(Operator::Subtract, ideal.value(name)?, from)?;
        Some(FieldChange { name, from, by })
    });
    changes
        .filter(|change| change.size() != 0.0 && !other_way.contains(&change.name))
        .collect()
}

/// Ratios between the changes of two fields along the same axis. If two changes have such a ratio,
/// rounding keeps it exactly. Two vertices of a triangle move by the same amount (1). If the `size`
/// of a box changes, its `center` moves by half as much in either direction (±1/2).
const RATIOS: [f64; 3] = [1.0, 0.5, -0.5];

/// Tolerance with which the ratio of two changes is compared with [`RATIOS`], relative to the
/// larger change. It must exceed rounding errors, which are about 1e-16, and be far below the
/// smallest of these ratios, 1/2. Any value in between works.
const SAME: f64 = 1e-6;

/// The way in which the numbers that a drag changes are rounded.
#[derive(Clone, Debug, PartialEq)]
pub struct DecimalRounding {
    /// Number of decimals to which a changed number is rounded. A negative number means rounding to
    /// tens, hundreds and so on.
    decimals: i32,
    /// Absolute values of the changes that [`rounded_in_ratio`] has rounded already. A number that
    /// changes by one of these amounts is not rounded to `decimals` again, because points of the
    /// object that are not dragged would then move slightly.
    exact: Vec<f64>,
}

/// Rounds the changes of several fields to `decimals` decimals, and keeps their ratios. On each
/// axis, the largest change is rounded, and the others are computed from it by the same ratios as
/// before. So the points of the object that are not dragged stay exactly in place. An axis on which
/// a ratio is not one of [`RATIOS`] is left out.
pub fn rounded_in_ratio(
    changes: &[FieldChange],
    decimals: i32,
) -> (Vec<FieldChange>, DecimalRounding) {
    let mut changes = changes.to_vec();
    let mut exact = Vec::new();
    for axis in 0..3 {
        let mut amounts: Vec<&mut f64> = changes
            .iter_mut()
            .filter_map(|change| along(change, axis))
            .collect();
        let larger = |by: &f64, than: f64| by.abs() > than.abs() * (1.0 + SAME);
        let greatest = amounts
            .iter()
            .fold(0.0, |than, by| if larger(by, than) { **by } else { than });
        let is_ratio = |by: f64, ratio: f64| (by - ratio * greatest).abs() <= SAME * greatest.abs();
        let ratio = |by: f64| RATIOS.into_iter().find(|ratio| is_ratio(by, *ratio));
        let ratios: Option<Vec<f64>> = amounts.iter().map(|by| ratio(**by)).collect();
        if let Some(ratios) = ratios.filter(|ratios| ratios.len() > 1) {
            for (by, ratio) in amounts.iter_mut().zip(ratios) {
                **by = ratio * round(greatest, decimals);
                exact.push(by.abs());
            }
        }
    }
    (changes, DecimalRounding { decimals, exact })
}

/// Returns the amount by which a vector changes along an axis. Returns `None` if the amount is 0 or
/// if the value is not a vector.
fn along(change: &mut FieldChange, axis: usize) -> Option<&mut f64> {
    match &mut change.by {
        Value::Vector(by) => Some(&mut by[axis]).filter(|by| **by != 0.0),
        _ => None,
    }
}

impl DecimalRounding {
    /// Returns the rounded sum of a value and an amount. An angle is rounded in the unit `unit`.
    fn sum(&self, from: Value, by: Value, unit: Unit) -> Value {
        match (from, by) {
            (Value::Vector(from), Value::Vector(by)) => {
                let number = |axis| self.number(from[axis], by[axis]);
                Value::Vector([0, 1, 2].map(number).into())
            }
            (Value::Angle(_), _) => {
                Value::Angle(unit.of(self.number(amount(from, unit), amount(by, unit))))
            }
            _ => Value::Number(self.number(amount(from, unit), amount(by, unit))),
        }
    }

    /// Returns the rounded sum of a number and an amount. Returns the number itself if the amount
    /// is rounded to 0.
    fn number(&self, from: f64, by: f64) -> f64 {
        let decimals = self.decimals;
        if self.exact.contains(&by.abs()) {
            // The amount was rounded to `decimals` already. If it was computed as half of another
            // rounded amount, it has one decimal more. So the sum keeps `decimals` + 1 decimals,
            // and all decimals of `from`.
            let [own, more] = [decimals_of(from), decimals.saturating_add(1)];
            return round(from + by, own.max(more));
        }
        if round(by, decimals) == 0.0 {
            from
        } else {
            round(from + by, decimals)
        }
    }
}

/// Returns the number of decimals in the shortest decimal form of a number.
fn decimals_of(number: f64) -> i32 {
    let text = format!("{number}");
    text.split_once('.')
        .map_or(0, |(_, digits)| digits.len() as i32)
}

/// Returns a copy of the object or camera `owner` in which the fields of `changes` have their new,
/// rounded values. Returns `None` if `owner` lacks one of these fields.
pub fn rounded(
    owner: FieldOwner,
    changes: &[FieldChange],
    rounding: &DecimalRounding,
) -> Option<FieldOwner> {
    changes.iter().try_fold(owner, |owner, change| {
        let value = rounding.sum(change.from, change.by, Unit::Degrees);
        owner.with(change.name, value)
    })
}

/// Returns the edits of the text that change the fields of `block`, in the order of the text.
/// Returns `None` if two changes would write different numbers in one place.
pub fn edits<'s>(
    analysis: &Analysis<'s>,
    block: &Block<'s>,
    changes: &[FieldChange],
    rounding: &DecimalRounding,
) -> Option<Vec<Edit>> {
    let mut writer = NumberWriter {
        analysis,
        rounding,
        edits: Vec::new(),
    };
    let mut added = Vec::new();
    for &FieldChange { name, from, by } in changes {
        match block.fields.iter().find(|field| field.name.text == name) {
            Some(field) => writer.change(&field.value, by)?,
            None => added.push(format!("{name} {}", writer.sum(from, by, Unit::Degrees))),
        }
    }
    let mut edits = writer.edits;
    if !added.is_empty() {
        let sources = analysis.model.sources();
        edits.extend(Edit::add_fields(block.span, sources, &added));
    }
    sort_by_span(&mut edits, |edit| edit.span);
    edits.dedup();
    let apart = |pair: &[Edit]| {
        let [a, b] = [0, 1].map(|index| pair[index].span);
        a.end <= b.start && a != b
    };
    edits.windows(2).all(apart).then_some(edits)
}

/// Collects the edits that change numbers in the text.
struct NumberWriter<'a, 's> {
    analysis: &'a Analysis<'s>,
    rounding: &'a DecimalRounding,
    edits: Vec<Edit>,
}

impl<'s> NumberWriter<'_, 's> {
    /// Adds edits by which the value of the expression `tree` changes by the amount `by`. Returns
    /// `None` if no edits can achieve this, for example because the amount would have to be negated
    /// and its type does not allow that.
    fn change(&mut self, tree: &tree::Value<'s>, by: Value) -> Option<()> {
        let model = &self.analysis.model;
        if let Some(unit) = literal_unit(tree) {
            let old = model.value(tree, None)?;
            let text = self.sum(old, by, unit);
            if text != written(old, unit) {
                self.edits.push(Edit::new(tree.span, text));
            }
            return Some(());
        }
        match (&tree.kind, by) {
            (ValueKind::Parentheses(inner), _) => return self.change(inner, by),
            (ValueKind::Name(name), _) => {
                if let Some(definition) = model.definition_at(name, tree.span.start) {
                    return self.change(&definition.value, by);
                }
            }
            (ValueKind::Tuple(elements), Value::Vector(by)) => {
                let mut numbers = elements.iter().zip(by.to_array());
                return numbers.try_for_each(|(it, by)| self.change(&it.value, Value::Number(by)));
            }
            (ValueKind::Chain { rest, .. }, _) => {
                if let Some(step) = rest.last()
                    && !step.operator.is_of_product()
                    && is_literal(&step.operand)
                {
                    return self.change_last(step, by);
                }
            }
            _ => {}
        }
        self.offset(tree.span, by)
    }

    /// Changes the literal at the end of a sum or difference. If the literal would become negative,
    /// the operator before it changes instead: `+ 1` becomes `- 1` rather than `+ -1`. Returns
    /// `None` if no edits can achieve the change.
    fn change_last(&mut self, step: &Step<'s>, by: Value) -> Option<()> {
        let (sign, other) = match step.operator {
            Operator::Subtract => (-1.0, '+'),
            _ => (1.0, '-'),
        };
        let by = operate(Operator::Multiply, Value::Number(sign), by)?;
        self.change(&step.operand, by)?;
        if let Some(edit) = self.edits.last_mut()
            && edit.span == step.operand.span
            && let Some(digits) = edit.text.strip_prefix('-')
        {
            *edit = Edit::new(step.sign.to(edit.span), format!("{other} {digits}"));
        }
        Some(())
    }

    /// Adds an edit that appends an offset, such as `+ 0.5`, to an expression. Returns `None` if
    /// values of the type of `by`, such as colours, have no negatives or multiples.
    fn offset(&mut self, behind: Span, by: Value) -> Option<()> {
        let zero = operate(Operator::Multiply, Value::Number(0.0), by)?;
        let text = self.sum(zero, by, Unit::Degrees);
        if text != self.sum(zero, zero, Unit::Degrees) {
            let text = match text.strip_prefix('-') {
                Some(digits) => format!(" - {digits}"),
                None => format!(" + {text}"),
            };
            let edit = Edit::insert(SourceId::File, behind.end, text);
            self.edits.push(edit);
        }
        Some(())
    }

    /// Formats the sum of `from` and `by`, rounded by `self.rounding`. If the amount `by` is
    /// rounded to 0, formats `from`. An angle is written in `unit`.
    fn sum(&self, from: Value, by: Value, unit: Unit) -> String {
        written(self.rounding.sum(from, by, unit), unit)
    }
}

/// Returns the unit of an angle literal, and degrees for a number literal. Returns `None` for any
/// other value.
fn literal_unit(tree: &tree::Value<'_>) -> Option<Unit> {
    match &tree.kind {
        ValueKind::Number(_) => Some(Unit::Degrees),
        ValueKind::Angle { unit, .. } => Some(*unit),
        ValueKind::Negation { operand, .. } => literal_unit(operand),
        _ => None,
    }
}

/// Returns whether a value is a literal or a list, so that a change can be written into it.
fn is_literal(tree: &tree::Value<'_>) -> bool {
    literal_unit(tree).is_some() || matches!(tree.kind, ValueKind::Tuple(_))
}

/// Converts a value to a plain number. An angle is measured in `unit`. A value that is neither a
/// number nor an angle becomes 0.
fn amount(value: Value, unit: Unit) -> f64 {
    match (value, unit) {
        (Value::Number(number), _) => number,
        (Value::Angle(angle), Unit::Radians) => angle.in_radians(),
        (Value::Angle(angle), Unit::Degrees) => angle.in_degrees(),
        _ => 0.0,
    }
}

/// Formats a number, an angle or a vector with all digits, as in a scene. An angle is written in
/// `unit`.
fn written(value: Value, unit: Unit) -> String {
    match value {
        Value::Vector(vector) => {
            let [x, y, z] = vector.to_array().map(spelled);
            format!("({x}, {y}, {z})")
        }
        Value::Angle(_) => spelled(amount(value, unit)) + unit.name(),
        _ => spelled(amount(value, unit)),
    }
}

/// Formats a number with all its digits. Very small and very large numbers get an exponent.
fn spelled(number: f64) -> String {
    let number = number + 0.0;
    if number == 0.0 || (1e-4..1e9).contains(&number.abs()) {
        format!("{number}")
    } else {
        format!("{number:e}")
    }
}

/// Rounds a number to `decimals` decimals. A negative number of decimals means rounding to tens,
/// hundreds and so on.
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
            assert_eq!(spelled(x), text);
        }
    }
}
