//! Between which numbers a number of the text may be, for a slider.

use super::Analysis;
use crate::{
    schema::{self, Condition},
    source::Span,
    syntax::tree::{Definition, Unit, Value, ValueKind},
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
    /// The step that a comment behind it asks for.
    pub step: Option<f64>,
}

/// Returns the bounds of the number at a place; `None` if it is no number that a field has by
/// itself.
pub fn limits(analysis: &Analysis<'_>, at: usize) -> Option<Limits> {
    let path = analysis.path(at);
    let unit = unit(path.values.first()?)?;
    Some(of_field(path.field_row()?, unit))
}

/// The numbers and angles that a `let` is, with its name and its place, and their bounds: those of
/// the line comment behind it, as `// [1:5]` or `// [1:0.1:5]`, or else those of the fields that it
/// stands in.
pub fn sliders<'a>(analysis: &'a Analysis<'_>) -> Vec<(&'a str, Span, Limits)> {
    let slider = |definition: &'a Definition<'_>| {
        let (name, value) = (definition.name.as_ref()?, &definition.value);
        let is_tuple = matches!(value.kind, ValueKind::Tuple(_));
        let unit = unit(value).filter(|_| !is_tuple)?;
        let is_name =
            |value: &Value<'_>| matches!(value.kind, ValueKind::Name(it) if it == name.text);
        let fields = analysis.blocks().flat_map(|block| {
            let row = block.kind.and_then(|kind| schema::block(kind.text));
            let fields = block.fields.iter().filter(|field| is_name(&field.value));
            fields.filter_map(move |field| row?.field(field.name.text))
        });
        let by_schema = || {
            fields
                .map(|field| of_field(field, unit))
                .fold(Limits::default(), |all, one| Limits {
                    least: [all.least, one.least]
                        .into_iter()
                        .flatten()
                        .reduce(f64::max),
                    most: [all.most, one.most].into_iter().flatten().reduce(f64::min),
                    is_open: all.is_open || one.is_open,
                    is_whole: all.is_whole || one.is_whole,
                    step: None,
                })
        };
        let behind = analysis.text()[value.span.end..].lines().next()?;
        let limits = commented(behind).unwrap_or_else(by_schema);
        Some((name.text, value.span, limits))
    };
    analysis.model.definitions().filter_map(slider).collect()
}

/// The bounds, and the step between them, of a comment that is all that stands behind a value.
fn commented(behind: &str) -> Option<Limits> {
    let comment = behind.trim_start().strip_prefix("//")?.trim_start();
    let (range, _) = comment.strip_prefix('[')?.split_once(']')?;
    let numbers: Result<Vec<f64>, _> = range.split(':').map(|it| it.trim().parse()).collect();
    let (least, step, most) = match numbers.ok()?[..] {
        [least, most] => (least, None, most),
        [least, step, most] if step > 0.0 => (least, Some(step), most),
        _ => return None,
    };
    let (least, most) = (
        Some(least),
        (least < most && most.is_finite()).then_some(most),
    );
    most.map(|_| Limits {
        least,
        most,
        step,
        ..Limits::default()
    })
}

/// The bounds by the conditions of a field, in a unit.
fn of_field(field: &schema::Field, unit: Option<Unit>) -> Limits {
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
    limits
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
