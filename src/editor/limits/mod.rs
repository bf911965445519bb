//! Computes the limits of a slider for a number in the text.
//!
//! If the definition has a comment with a range, that range is used. Otherwise, the slider extends
//! some steps to both sides of the number, within the conditions of the fields that use it. Trial
//! analyses of the changed text find out how far the number can go without new errors.

mod comment;
mod literal;
mod trials;

use self::{
    comment::{CommentRange, parse, range_behind},
    literal::{Literal, decimals, inward, rounded},
    trials::Trials,
};
use super::Analysis;
use crate::{
    schema::{self, Condition, FieldRow},
    source::Span,
    syntax::tree::{Definition, Unit, Value, ValueKind},
};

/// Minimum number of steps from a number to each end of its slider. An end is nearer only if the
/// numbers beyond it are not valid.
const STEPS: f64 = 50.0;

/// As [`STEPS`], for numbers that must be whole, such as counts. Their step is 1, so that fewer
/// steps already span a wide range.
const STEPS_OF_COUNT: f64 = 10.0;

/// Limits of a number in the text, and its slider, in the unit in which the number is written.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Limits {
    /// Minimum of the number for which the text has no more errors than now; `None` if it is
    /// unknown.
    pub least: Option<f64>,
    /// Maximum of the number for which the text has no more errors than now; `None` if it is
    /// unknown.
    pub most: Option<f64>,
    /// Step of the slider.
    pub step: f64,
    /// Number of decimals with which the slider shows the number: enough for the number now, the
    /// step and the ends.
    pub decimals: usize,
    /// Lower and upper end of the slider.
    pub ends: [f64; 2],
}

/// The slider of a definition, or a note why the definition has none or why its comment is not used
/// as written.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Slider<'a> {
    /// The definition's name.
    pub name: &'a str,
    /// Span of the number without its unit. If the value is not a number, the span of the value.
    pub span: Span,
    /// Limits of the slider; `None` if the value is not a number.
    pub limits: Option<Limits>,
    /// Message for the author if the comment after the definition looks like a range but is none,
    /// or if the slider has another range than the comment says.
    pub note: Option<String>,
}

/// Returns the limits of the number at the offset `at`. Returns `None` if there is no number.
pub fn limits(analysis: &Analysis<'_>, at: usize) -> Option<Limits> {
    let path = analysis.path(at);
    // The literal is the innermost value, or the negation around it.
    let values = path.values.iter().rev().take(2);
    let literal = values.map_while(|it| Literal::of(it)).last()?;
    let mut trials = Trials::new(analysis);
    let is_literal = |it: &&Definition<'_>| Literal::of(&it.value).is_some();
    if let Some(definition) = path.definition.filter(is_literal) {
        return slider(analysis, definition, &mut trials)?.limits;
    }
    let unit = path.values.first().and_then(|it| unit(it));
    let bounds = path.field_row().zip(unit);
    let bounds = bounds.map(|(field, unit)| Bounds::of_field(field, unit));
    Some(tried(&literal, bounds.unwrap_or(UNBOUNDED), &mut trials))
}

/// Returns the sliders of all definitions whose values are number or angle literals. Any other
/// value with a range in a comment gets a note instead of a slider.
pub fn sliders<'a>(analysis: &'a Analysis<'_>) -> Vec<Slider<'a>> {
    let mut trials = Trials::new(analysis);
    let definitions = analysis.model.definitions();
    definitions
        .filter_map(|it| slider(analysis, it, &mut trials))
        .collect()
}

fn slider<'a>(
    analysis: &'a Analysis<'_>,
    definition: &'a Definition<'_>,
    trials: &mut Trials<'_, '_>,
) -> Option<Slider<'a>> {
    let (name, value) = (definition.name.as_ref()?.text, &definition.value);
    let behind = analysis.text()[value.span.end..].lines().next();
    let range = behind.and_then(range_behind);
    let Some(literal) = Literal::of(value) else {
        let note = "a range is for a number or an angle that stands alone".to_owned();
        return range.map(|_| Slider {
            name,
            span: value.span,
            limits: None,
            note: Some(note),
        });
    };
    let bounds = Bounds::of_name(analysis, name, literal.unit);
    let (limits, note) = match range.map(|range| parse(range, literal.unit)) {
        Some(Ok(range)) => within(range, &literal, bounds, trials),
        Some(Err(note)) => (tried(&literal, bounds, trials), Some(note)),
        None => (tried(&literal, bounds, trials), None),
    };
    Some(Slider {
        name,
        span: literal.span,
        limits: Some(limits),
        note,
    })
}

/// Returns the limits of a number whose comment gives the range `range`. If the number must be
/// whole, the step and the ends are rounded to whole numbers. If that changes the range, also
/// returns a note for the author.
fn within(
    range: CommentRange,
    literal: &Literal,
    bounds: Bounds,
    trials: &mut Trials<'_, '_>,
) -> (Limits, Option<String>) {
    let (mut step, mut ends) = range.rounded(literal.step());
    let mut note = None;
    if bounds.is_whole || trials.is_count(literal) {
        let whole = [ends[0].ceil(), ends[1].floor()];
        let is_other = range.step.is_some_and(|step| step.fract() != 0.0) || whole != ends;
        note = is_other.then(|| "the number is a count, so that its range is whole".to_owned());
        (step, ends) = (step.round().max(1.0), whole);
    }
    (Limits::new(literal, ends.map(Some), step, ends), note)
}

/// Returns the limits of a number whose comment gives no range. The slider extends to both sides by
/// the number's absolute value, or by [`STEPS`] or [`STEPS_OF_COUNT`] steps if that is farther, but
/// not beyond `bounds`. If the text would have more errors than now with the number at an end, that
/// end is moved towards the number.
fn tried(literal: &Literal, mut bounds: Bounds, trials: &mut Trials<'_, '_>) -> Limits {
    let is_count = trials.is_count(literal);
    if is_count {
        bounds.is_whole = true;
        // A negative count may be valid in a formula such as a square, so trials would not exclude
        // it.
        if literal.value >= 0.0 && bounds.least == f64::NEG_INFINITY {
            bounds.least = 0.0;
        }
    }
    let (step, steps) = if bounds.is_whole {
        (1.0, STEPS_OF_COUNT)
    } else {
        (literal.step(), STEPS)
    };
    let margin = if bounds.is_open { step } else { 0.0 };
    let [least, most] = inward([bounds.least + margin, bounds.most - margin], step);
    let bounded = |x: f64| x.max(least).min(most);
    let middle = bounded(literal.value);
    let reach = middle.abs().max(steps * step);
    let ends = [middle - reach, middle + reach].map(|end| bounded(rounded(end, step)));
    let valid = ends.map(|end| trials.last_right(literal, end, step, is_count));
    // If even the next numbers on both sides are not valid, the ends stay where they are.
    let valid = if valid == [None, None] {
        ends
    } else {
        valid.map(|end| end.unwrap_or(literal.value))
    };
    let known = |end: usize, bound: f64| {
        if valid[end] != ends[end] {
            Some(valid[end])
        } else {
            bound.is_finite().then_some(bound)
        }
    };
    Limits::new(literal, [known(0, least), known(1, most)], step, valid)
}

impl Limits {
    fn new(literal: &Literal, [least, most]: [Option<f64>; 2], step: f64, ends: [f64; 2]) -> Self {
        let numbers = [literal.value, step, ends[0], ends[1]];
        Self {
            least,
            most,
            step,
            decimals: numbers.map(decimals).into_iter().max().unwrap_or(0),
            ends,
        }
    }
}

/// Range of a number that the schema's conditions ([`Condition`]) on its fields allow, in the unit
/// in which the number is written: degrees or radians for an angle.
#[derive(Clone, Copy, Debug)]
struct Bounds {
    least: f64,
    most: f64,
    /// Whether the two ends of the range are excluded from it.
    is_open: bool,
    /// Whether only whole numbers are allowed.
    is_whole: bool,
}

/// Bounds of a number on which no condition is known.
const UNBOUNDED: Bounds = Bounds {
    least: f64::NEG_INFINITY,
    most: f64::INFINITY,
    is_open: false,
    is_whole: false,
};

impl Bounds {
    /// Returns the bounds that the conditions on a field impose on a number in its value, which is
    /// written in the unit `unit`.
    fn of_field(field: &FieldRow, unit: Option<Unit>) -> Self {
        let two_to = |power: u32| (1_u64 << power) as f64;
        let mut bounds = UNBOUNDED;
        for condition in field.must {
            match *condition {
                Condition::Whole => bounds.is_whole = true,
                Condition::AtLeast(bound) => bounds.least = bound,
                Condition::MoreThan(bound) => (bounds.least, bounds.is_open) = (bound, true),
                Condition::AtMostTwoTo(power) => bounds.most = two_to(power),
                // Only fields for whole numbers have this condition, so the greatest number is
                // 2^power − 1.
                Condition::LessThanTwoTo(power) => bounds.most = two_to(power) - 1.0,
                Condition::EachMoreThanZero => (bounds.least, bounds.is_open) = (0.0, true),
                Condition::LessThanHalfTurn => {
                    let is_in_radians = unit == Some(Unit::Radians);
                    let half = if is_in_radians {
                        std::f64::consts::PI
                    } else {
                        180.0
                    };
                    (bounds.least, bounds.most, bounds.is_open) = (0.0, half, true);
                }
                Condition::NotZero => {}
            }
        }
        bounds
    }

    /// Returns the bounds of the number that is defined as `name`: the intersection of those that
    /// are imposed by the fields whose value is this name alone.
    fn of_name(analysis: &Analysis<'_>, name: &str, unit: Option<Unit>) -> Self {
        let is_name = |value: &Value<'_>| matches!(value.kind, ValueKind::Name(it) if it == name);
        let fields = analysis.blocks().flat_map(|block| {
            let row = block.kind.and_then(|kind| schema::block(kind.text));
            let fields = block.fields.iter().filter(move |it| is_name(&it.value));
            fields.filter_map(move |field| row?.field(field.name.text))
        });
        fields.fold(UNBOUNDED, |bounds, field| {
            let other = Self::of_field(field, unit);
            Self {
                least: bounds.least.max(other.least),
                most: bounds.most.min(other.most),
                is_open: bounds.is_open || other.is_open,
                is_whole: bounds.is_whole || other.is_whole,
            }
        })
    }
}

/// Returns the unit in which the numbers of a field's value are written; the inner `None` stands
/// for numbers without a unit. Returns the outer `None` for an expression, whose numbers need not
/// meet the field's conditions.
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
