//! Computes the limits of a slider for a number in the text.
//!
//! If a comment after the definition gives a range, that range is used. Otherwise, the slider
//! extends some steps to both sides of the number. It does not extend beyond the values that are
//! allowed for a field, if the number is the value of that field. If an end of the slider would
//! cause a new error in the text, the end is moved towards the number.

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

/// Minimum distance from a number to each end of its slider, in steps of the slider. An end is
/// nearer only if the numbers beyond it are not valid. With far fewer steps, the slider's range
/// would be narrow. With far more, a slider on a small screen could not reach every step.
const STEPS: f64 = 50.0;

/// Minimum distance from a whole number, such as a count, to each end of its slider, in steps of 1.
/// An end is nearer only if the numbers beyond it are not valid. The distance is shorter than for
/// other numbers ([`STEPS`]), because 10 more or fewer objects already change a picture much.
const STEPS_OF_COUNT: f64 = 10.0;

/// Limits of a number in the text, and the range and step of its slider. All are given in the unit
/// in which the number is written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Smallest value that the number can have without a new error in the text. `None` if this
    /// value is not known.
    pub least: Option<f64>,
    /// Largest value that the number can have without a new error in the text. `None` if this value
    /// is not known.
    pub most: Option<f64>,
    /// Distance between neighbouring values of the slider.
    pub step: f64,
    /// Number of decimals that the slider shows. They suffice for the current number, the step and
    /// both ends of the slider.
    pub decimals: usize,
    /// Lower and upper end of the slider.
    pub ends: [f64; 2],
}

/// The slider for the value of a definition. If the definition's comment asks for a slider or a
/// range that is not possible, a note says why.
#[derive(Clone, Debug, PartialEq)]
pub struct Slider<'a> {
    /// Name of the definition.
    pub name: &'a str,
    /// Span of the number without its unit. If the value is not a number, the span of the whole
    /// value.
    pub span: Span,
    /// Limits of the slider; `None` if there is no slider, because the value is not a number.
    pub limits: Option<Limits>,
    /// Message for the author, if the comment after the definition looks like a range but is not
    /// one, or if the slider's range differs from the range in the comment.
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

/// Returns the sliders of all definitions whose values are number or angle literals. If another
/// value has a comment with a range, returns a note for it instead of a slider.
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
/// whole, the step and the ends are rounded to whole numbers. If this rounding changes the range,
/// also returns a note for the author.
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
/// the greater of the number's absolute value and [`STEPS`] steps ([`STEPS_OF_COUNT`] for whole
/// numbers). It does not extend beyond `bounds`. If an end would cause a new error in the text, it
/// is moved towards the current number.
fn tried(literal: &Literal, mut bounds: Bounds, trials: &mut Trials<'_, '_>) -> Limits {
    let is_count = trials.is_count(literal);
    if is_count {
        bounds.is_whole = true;
        // A negative count need not cause an error, e.g. if a formula squares the count. So the
        // lower bound 0 is set explicitly, unless the count is negative now.
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
    // If the first step causes an error in both directions, the search finds no ends other than the
    // current number, and the slider could not move. It then keeps the ends that it had before the
    // search.
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

/// Range of the values that the language allows for a number in the fields that use it. For an
/// angle, the range is in degrees or in radians, as the number is written.
#[derive(Clone, Copy, Debug)]
struct Bounds {
    least: f64,
    most: f64,
    /// Whether both ends are excluded from the range.
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
    /// Returns the bounds of the numbers in the field's value, by the conditions on the field.
    /// `unit` is the unit in which the numbers are written.
    fn of_field(field: &FieldRow, unit: Option<Unit>) -> Self {
        let two_to = |power: u32| (1_u64 << power) as f64;
        let mut bounds = UNBOUNDED;
        for condition in field.must {
            match *condition {
                Condition::Whole => bounds.is_whole = true,
                Condition::AtLeast(bound) => bounds.least = bound,
                Condition::MoreThan(bound) => (bounds.least, bounds.is_open) = (bound, true),
                Condition::AtMostTwoTo(power) => bounds.most = two_to(power),
                // Only fields for whole numbers have this condition, so the greatest valid number
                // is 2^power − 1.
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

    /// Returns the bounds of the number that is defined as `name`. They are the intersection of the
    /// bounds of all fields whose value is exactly this name.
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

/// Returns the unit in which the numbers of a field's value are written. Returns `Some(None)` for
/// numbers without a unit, and `None` for an expression, since the numbers in an expression need
/// not meet the field's conditions.
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
