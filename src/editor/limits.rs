//! Between which numbers a number of the text may be, for a slider.

use super::Analysis;
use crate::{
    schema::Condition,
    syntax::tree::{Unit, Value, ValueKind},
};

/// Bounds of a number, in its own unit, as far as its field has conditions.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Limits {
    /// The least number.
    pub least: Option<f64>,
    /// The greatest number.
    pub most: Option<f64>,
    /// Whether the bounds themselves are excluded.
    pub is_open: bool,
    /// Whether it has no fraction.
    pub is_whole: bool,
}

/// Returns the bounds of the number at a place; `None` if it is no number that a field has by
/// itself.
pub fn limits(analysis: &Analysis<'_>, at: usize) -> Option<Limits> {
    let path = analysis.path(at);
    let field = path.field_row()?;
    let unit = unit(path.values.first()?)?;
    let mut limits = Limits::default();
    for condition in field.must {
        match *condition {
            Condition::Whole => limits.is_whole = true,
            Condition::AtLeast(bound) => limits.least = Some(bound),
            Condition::MoreThan(bound) => {
                (limits.least, limits.is_open) = (Some(bound), true);
            }
            Condition::AtMostTwoTo(power) | Condition::LessThanTwoTo(power) => {
                limits.most = Some((1_u64 << power) as f64);
            }
            Condition::EachMoreThanZero => {
                (limits.least, limits.is_open) = (Some(0.0), true);
            }
            Condition::LessThanHalfTurn => {
                let half_turn = match unit {
                    Some(Unit::Radians) => std::f64::consts::PI,
                    _ => 180.0,
                };
                (limits.least, limits.most, limits.is_open) = (Some(0.0), Some(half_turn), true);
            }
            Condition::NotZero => {}
        }
    }
    Some(limits)
}

/// The unit that a field's number or numbers are written in, if there is one; `None` if it is an
/// expression, whose numbers mean something else.
fn unit(value: &Value<'_>) -> Option<Option<Unit>> {
    match &value.kind {
        ValueKind::Number(_) => Some(None),
        ValueKind::Angle { unit, .. } => Some(Some(*unit)),
        ValueKind::Tuple(elements) => elements.iter().try_fold(None, |_, it| unit(&it.value)),
        ValueKind::Negation { operand, .. } => unit(operand),
        ValueKind::Parentheses(inner) => unit(inner),
        _ => None,
    }
}
