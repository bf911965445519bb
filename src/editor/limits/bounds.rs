//! Between which numbers a field's conditions hold a number.

use crate::{
    schema::{self, Condition},
    syntax::tree::{Unit, Value, ValueKind},
};

/// Bounds of a number, in its own unit, as far as its field has conditions.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bounds {
    /// The least number.
    pub least: Option<f64>,
    /// The greatest number.
    pub most: Option<f64>,
    /// Whether the bounds themselves are excluded.
    pub is_open: bool,
    /// Whether it has no fraction.
    pub is_whole: bool,
}

impl Bounds {
    /// The bounds by the conditions of a field, in a unit.
    pub fn of_field(field: &schema::Field, unit: Option<Unit>) -> Self {
        let mut bounds = Self::default();
        for condition in field.must {
            match *condition {
                Condition::Whole => bounds.is_whole = true,
                Condition::AtLeast(bound) => bounds.least = Some(bound),
                Condition::MoreThan(bound) => {
                    (bounds.least, bounds.is_open) = (Some(bound), true);
                }
                Condition::AtMostTwoTo(power) => bounds.most = Some((1_u64 << power) as f64),
                // Only whole numbers have this one.
                Condition::LessThanTwoTo(power) => {
                    bounds.most = Some(((1_u64 << power) - 1) as f64);
                }
                Condition::EachMoreThanZero => {
                    (bounds.least, bounds.is_open) = (Some(0.0), true);
                }
                Condition::LessThanHalfTurn => {
                    let half_turn = match unit {
                        Some(Unit::Radians) => std::f64::consts::PI,
                        _ => 180.0,
                    };
                    (bounds.least, bounds.most, bounds.is_open) =
                        (Some(0.0), Some(half_turn), true);
                }
                Condition::NotZero => {}
            }
        }
        bounds
    }

    /// Those that hold a number within both.
    pub fn and(self, other: Self) -> Self {
        let both = [self, other];
        let known = |bound: fn(Self) -> Option<f64>| both.into_iter().filter_map(bound);
        Self {
            least: known(|it| it.least).reduce(f64::max),
            most: known(|it| it.most).reduce(f64::min),
            is_open: self.is_open || other.is_open,
            is_whole: self.is_whole || other.is_whole,
        }
    }

    /// The least and the greatest number by steps.
    pub fn by_steps(self, step: f64) -> [Option<f64>; 2] {
        let margin = if self.is_open { step } else { 0.0 };
        [
            self.least.map(|it| it + margin),
            self.most.map(|it| it - margin),
        ]
    }
}

/// The unit that a field's number or numbers are written in, if there is one; `None` if it is an
/// expression, whose numbers mean something else.
pub fn unit(value: &Value<'_>) -> Option<Option<Unit>> {
    match &value.kind {
        ValueKind::Number(_) => Some(None),
        ValueKind::Angle { unit, .. } => Some(Some(*unit)),
        ValueKind::Tuple(elements) => elements.iter().try_fold(None, |_, it| unit(&it.value)),
        ValueKind::Negation { operand, .. } => unit(operand),
        ValueKind::Parentheses(inner) => unit(inner),
        _ => None,
    }
}
