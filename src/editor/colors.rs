//! Finds the colours in a text, and returns the ways to write a new colour in the place of an old
//! one.
//!
//! The new text has the form of the old one: a name stays a name if the new colour has one, a code
//! such as `#ff0000` stays a code, and `rgb(…)` stays a call. A call that contains expressions or
//! comments cannot be replaced, since they would be lost.

use super::{analysis::Analysis, tokens::Role};
use crate::{
    color::Color,
    numbers,
    schema::{self, Type, Value, css},
    source::{Span, sort_by_span},
    syntax::tree::{self, Call, ValueKind},
};

/// A colour that is written in the text and can be replaced.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Swatch {
    /// Span of the colour's name, of its code, or of the call of `rgb`.
    pub span: Span,
    /// The colour itself.
    pub color: Color,
}

/// Returns the replaceable colours of the text, in order.
pub fn swatches(analysis: &Analysis<'_>) -> Vec<Swatch> {
    let mut swatches = Vec::new();
    for definition in analysis.model.definitions() {
        collect(analysis, &definition.value, &mut swatches);
    }
    for block in analysis.blocks() {
        let row = block.kind.and_then(|kind| schema::block(kind.text));
        for field in &block.fields {
            let known = row.and_then(|row| row.field(field.name.text));
            if known.is_some_and(|known| known.takes == Type::Method) {
                // The name of a sampling method is not a colour, even if a colour has this name, so
                // the field is skipped.
                continue;
            }
            collect(analysis, &field.value, &mut swatches);
        }
    }
    sort_by_span(&mut swatches, |swatch| swatch.span);
    swatches
}

fn collect<'s>(analysis: &Analysis<'s>, value: &tree::Value<'s>, swatches: &mut Vec<Swatch>) {
    let is_color = match &value.kind {
        ValueKind::ColorCode(_) => true,
        ValueKind::Name(name) => css::color(name).is_some(),
        ValueKind::Call(call) => {
            call.function.text == "rgb" && is_plain(analysis, value.span, call)
        }
        _ => false,
    };
    if is_color && let Some(Value::Color(color)) = analysis.model.value(value, None) {
        let span = value.span;
        swatches.push(Swatch { span, color });
        return;
    }
    for part in value.parts() {
        collect(analysis, part, swatches);
    }
}

/// Returns whether the arguments of a call are plain numbers without comments.
fn is_plain(analysis: &Analysis<'_>, span: Span, call: &Call<'_>) -> bool {
    let is_number = |kind: &ValueKind<'_>| matches!(kind, ValueKind::Number(_));
    let are_numbers = call
        .arguments
        .iter()
        .all(|part| is_number(&part.value.kind));
    let comments = analysis.comments();
    let next = comments.partition_point(|comment| comment.end <= span.start);
    let is_inside = |comment: &Span| comment.start < span.end;
    are_numbers && !comments.get(next).is_some_and(is_inside)
}

/// Returns the ways to write `color` in the place of the colour at `span`. The first one has the
/// same form as the old text: a name, a code or a call. Returns an empty list if the text at `span`
/// is a call that cannot be replaced.
pub fn presentations(analysis: &Analysis<'_>, span: Span, color: Color) -> Vec<String> {
    let own = match analysis.token_at(span.start).map(|token| token.role) {
        Some(Role::Function) => {
            if swatches(analysis).iter().all(|swatch| swatch.span != span) {
                return Vec::new();
            }
            rgb(color)
        }
        Some(Role::Name) => name(color).map_or_else(|| color.to_string(), str::to_owned),
        _ => color.to_string(),
    };
    let mut presentations = vec![own];
    let others = [
        name(color).map(str::to_owned),
        Some(color.to_string()),
        Some(rgb(color)),
    ];
    for other in others.into_iter().flatten() {
        if !presentations.contains(&other) {
            presentations.push(other);
        }
    }
    presentations
}

/// Returns the name of a colour, or `None` if it has no name. A colour with several names gets the
/// first in alphabetical order, such as the American `gray` rather than `grey`.
fn name(color: Color) -> Option<&'static str> {
    let bytes = color.to_bytes();
    let is_it = |name: &&str| css::color(name).is_some_and(|named| named.to_bytes() == bytes);
    css::names().find(is_it)
}

fn rgb(color: Color) -> String {
    let [r, g, b] = color.srgb.map(numbers::short);
    format!("rgb({r}, {g}, {b})")
}
