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

/// A number or an angle that a `let` is.
#[derive(Clone, Debug, PartialEq)]
pub struct Slider<'a> {
    /// The definition's name.
    pub name: &'a str,
    /// Where the value stands.
    pub span: Span,
    /// Between which numbers it may be.
    pub limits: Limits,
    /// Why the comment behind it gives no range, where it looks as if it should.
    pub note: Option<String>,
}

/// The numbers and angles that definitions are, with their bounds: those of the line comment behind
/// one, as `// [1:5]`, `// [1:0.1:5]` or `// [0deg:5deg:90deg]`, or else those of the fields
/// that it stands in.
pub fn sliders<'a>(analysis: &'a Analysis<'_>) -> Vec<Slider<'a>> {
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
        let (limits, note) = match range_behind(behind).map(|range| commented(range, unit)) {
            // A number that is whole stays so.
            Some(Ok(limits)) => {
                let is_whole = by_schema().is_whole;
                (Limits { is_whole, ..limits }, None)
            }
            Some(Err(note)) => (by_schema(), Some(note)),
            None => (by_schema(), None),
        };
        Some(Slider {
            name: name.text,
            span: value.span,
            limits,
            note,
        })
    };
    analysis.model.definitions().filter_map(slider).collect()
}

/// What stands in the brackets of a comment that is all that stands behind a value, if one of its
/// parts begins as a number does: others are remarks.
fn range_behind(behind: &str) -> Option<&str> {
    let comment = behind.trim_start().strip_prefix("//")?.trim_start();
    let (range, _) = comment.strip_prefix('[')?.split_once(']')?;
    let is_number = |part: &str| {
        part.trim_start()
            .trim_start_matches(['+', '-', '.'])
            .starts_with(|it: char| it.is_ascii_digit())
    };
    (range.contains(':') && range.split(':').any(is_number)).then_some(range)
}

/// Parses a range into bounds in the unit of a value; its ends may come in either order.
///
/// # Errors
///
/// Why it is no range, in a sentence.
fn commented(range: &str, unit: Option<Unit>) -> Result<Limits, String> {
    let numbers: Result<Vec<f64>, _> = range
        .split(':')
        .map(|it| in_unit(it.trim(), unit))
        .collect();
    let (one, step, other) = match numbers?[..] {
        [one, other] => (one, None, other),
        [one, step, other] => (one, Some(step.abs()), other),
        _ => return Err("a range has two ends, and at most a step between them".to_owned()),
    };
    if one == other {
        return Err("both ends of the range are the same".to_owned());
    }
    if step == Some(0.0) {
        return Err("the step of the range is 0".to_owned());
    }
    Ok(Limits {
        least: Some(one.min(other)),
        most: Some(one.max(other)),
        step,
        ..Limits::default()
    })
}

/// A number of a range; one without a unit is in that of the value.
fn in_unit(written: &str, unit: Option<Unit>) -> Result<f64, String> {
    let units = [Unit::Degrees, Unit::Radians].into_iter();
    let mut own = units.filter_map(|unit| Some((written.strip_suffix(unit.name())?, unit)));
    let (number, own) = own
        .next()
        .map_or((written, None), |(it, unit)| (it, Some(unit)));
    let number = number.trim_end().replace('_', "").parse().ok();
    let number: f64 = number
        .filter(|it: &f64| it.is_finite())
        .ok_or_else(|| format!("`{written}` in the range is no number"))?;
    match (own, unit) {
        (Some(own), None) => {
            let name = own.name();
            Err(format!(
                "the range is in {name}, and the number has no unit"
            ))
        }
        (Some(Unit::Degrees), Some(Unit::Radians)) => Ok(Unit::Degrees.of(number).in_radians()),
        (Some(Unit::Radians), Some(Unit::Degrees)) => Ok(Unit::Radians.of(number).in_degrees()),
        _ => Ok(number),
    }
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
            Condition::AtMostTwoTo(power) => limits.most = Some((1_u64 << power) as f64),
            // Only whole numbers have this one.
            Condition::LessThanTwoTo(power) => {
                limits.most = Some(((1_u64 << power) - 1) as f64);
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
