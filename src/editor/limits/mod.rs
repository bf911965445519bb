//! Between which numbers a number of the text may be, for a slider.

mod bounds;
mod comment;
mod literal;
mod trials;

use self::{
    bounds::{Bounds, unit},
    comment::{Range, parse, range_behind},
    literal::{Literal, decimals, inward, rounded},
    trials::Trials,
};
use super::Analysis;
use crate::{
    schema,
    source::Span,
    syntax::tree::{Definition, Value, ValueKind},
};

/// Number of steps from a number to each end of its slider, at least.
const STEPS: f64 = 50.0;

/// The same of a count, whose steps are large.
const COUNTS: f64 = 10.0;

/// How a number is turned. All is in its own unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// The least number that is right, where there is one.
    pub least: Option<f64>,
    /// The greatest number that is right, where there is one.
    pub most: Option<f64>,
    /// The step.
    pub step: f64,
    /// Number of decimals that it is written with.
    pub decimals: usize,
    /// The ends of a slider about it.
    pub ends: [f64; 2],
}

/// A definition that has a slider, or seems to ask for one.
#[derive(Clone, Debug, PartialEq)]
pub struct Slider<'a> {
    /// The definition's name.
    pub name: &'a str,
    /// Where the number stands, without a unit, or else the value.
    pub span: Span,
    /// Between which numbers it may be; `None` if it is no number.
    pub limits: Option<Limits>,
    /// Why the comment behind it gives no range, or another one, where it looks as if it should.
    pub note: Option<String>,
}

/// Returns how the number at a place is turned; `None` if there is none.
pub fn limits(analysis: &Analysis<'_>, at: usize) -> Option<Limits> {
    let path = analysis.path(at);
    let mut values = path.values.iter().rev();
    let number = Literal::of(values.next()?)?;
    // With its sign, if it has one.
    let literal = values
        .next()
        .and_then(|it| Literal::of(it))
        .unwrap_or(number);
    let mut trials = Trials::new(analysis);
    let own = path
        .definition
        .filter(|it| Literal::of(&it.value).is_some());
    if let Some(definition) = own {
        return slider(analysis, definition, &mut trials)?.limits;
    }
    let by_field = || {
        Some(Bounds::of_field(
            path.field_row()?,
            unit(path.values.first()?)?,
        ))
    };
    Some(about(&literal, by_field().unwrap_or_default(), &mut trials))
}

/// The numbers and angles that definitions are, with their bounds: those of the line comment behind
/// one, or else those of the fields that it stands in, as far as the text has no more errors with
/// it. What is no number is there if a comment gives it a range.
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
    let bounds = by_fields(analysis, name, literal);
    let (limits, note) = match range.map(|range| parse(range, literal.unit)) {
        Some(Ok(range)) => within(range, &literal, bounds, trials),
        Some(Err(note)) => (about(&literal, bounds, trials), Some(note)),
        None => (about(&literal, bounds, trials), None),
    };
    Some(Slider {
        name,
        span: literal.span,
        limits: Some(limits),
        note,
    })
}

/// The bounds by all fields that are a name alone.
fn by_fields(analysis: &Analysis<'_>, name: &str, literal: Literal) -> Bounds {
    let is_name = |value: &Value<'_>| matches!(value.kind, ValueKind::Name(it) if it == name);
    let fields = analysis.blocks().flat_map(|block| {
        let row = block.kind.and_then(|kind| schema::block(kind.text));
        let fields = block.fields.iter().filter(move |it| is_name(&it.value));
        fields.filter_map(move |field| row?.field(field.name.text))
    });
    let bounds = fields.map(|field| Bounds::of_field(field, literal.unit));
    bounds.fold(Bounds::default(), Bounds::and)
}

/// The limits of a number that has a range of its own. A number that is whole stays so, and then a
/// note says why its step is another.
fn within(
    range: Range,
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
    let [least, most] = ends.map(Some);
    (written(literal, [least, most], step, ends), note)
}

/// The limits of a number whose slider reaches as far as the number itself, and some steps, to both
/// sides. An end is drawn in to where the text has no more errors than now.
fn about(literal: &Literal, mut bounds: Bounds, trials: &mut Trials<'_, '_>) -> Limits {
    let is_count = trials.is_count(literal);
    if is_count {
        // A formula may be right again below zero, as that of a square is.
        let least = (literal.value >= 0.0).then_some(0.0);
        (bounds.is_whole, bounds.least) = (true, bounds.least.or(least));
    }
    let (step, steps) = match bounds.is_whole {
        true => (1.0, COUNTS),
        false => (literal.step(), STEPS),
    };
    let [least, most] = bounds.by_steps(step);
    let all = [
        least.unwrap_or(f64::NEG_INFINITY),
        most.unwrap_or(f64::INFINITY),
    ];
    let [low, high] = inward(all, step);
    let bounded = |x: f64| x.max(low).min(high);
    let middle = bounded(literal.value);
    let span = middle.abs().max(steps * step);
    let ends = [middle - span, middle + span].map(|end| bounded(rounded(end, step)));
    let drawn = ends.map(|end| trials.last_right(literal, end, step, is_count));
    let (ends, [is_low, is_high]) = match drawn {
        // A number that nothing near is right for is turned as if nothing was known.
        [None, None] => (ends, [false; 2]),
        [low, high] => {
            let drawn = [low, high].map(|it| it.unwrap_or(literal.value));
            (drawn, [drawn[0] != ends[0], drawn[1] != ends[1]])
        }
    };
    let bound = |is_drawn, end, known| if is_drawn { Some(end) } else { known };
    let [least, most] = [least.map(|_| low), most.map(|_| high)];
    let [least, most] = [bound(is_low, ends[0], least), bound(is_high, ends[1], most)];
    written(literal, [least, most], step, ends)
}

fn written(
    literal: &Literal,
    [least, most]: [Option<f64>; 2],
    step: f64,
    ends: [f64; 2],
) -> Limits {
    let numbers = [literal.value, step, ends[0], ends[1]];
    Limits {
        least,
        most,
        step,
        decimals: numbers.map(decimals).into_iter().max().unwrap_or(0),
        ends,
    }
}
