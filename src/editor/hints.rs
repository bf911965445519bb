//! What a text does not say but could: shown in grey at the ends of its lines.

use std::ops::Range;

use super::analysis::Analysis;
use crate::{
    inspect,
    math::Angle,
    numbers::{grouped, short},
    scene::Count,
    schema::{self, Method, Type, Value, css},
    source::{SourceId, Span, sort_by_span},
    syntax::tree::{self, Block, Field, ValueKind},
};

/// A remark behind a place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Hint {
    /// The place.
    pub at: usize,
    /// The remark.
    pub text: String,
}

/// What there is to say of a value.
struct Remark<'s> {
    /// Where the value ends.
    end: usize,
    /// The name of the field or definition that has the value.
    name: &'s str,
    /// What an expression comes to.
    comes_to: Option<Value>,
    /// What follows from it together with others.
    beside: Option<String>,
}

/// Returns the remarks on values that end within a range of bytes, in order: what an expression
/// comes to, the field of view that belongs to a distance, how many samples there are in all.
///
/// All of them stand at the ends of lines: within a line, they would push apart what the formatter
/// puts under one another. A value that does not stand right behind its expression has the name of
/// its field.
pub fn hints(analysis: &Analysis<'_>, within: Range<usize>) -> Vec<Hint> {
    let mut remarks: Vec<Remark<'_>> = Vec::new();
    let touches =
        |value: &tree::Value<'_>| within.contains(&value.span.end) || within.end == value.span.end;
    for definition in analysis.model.definitions() {
        if touches(&definition.value) && is_computed(&definition.value) {
            remarks.push(Remark {
                end: definition.value.span.end,
                name: definition.name.map_or("", |name| name.text),
                comes_to: analysis.model.defined(definition),
                beside: None,
            });
        }
    }
    for block in analysis.blocks() {
        for field in block.fields.iter().filter(|field| touches(&field.value)) {
            remarks.push(Remark {
                end: field.value.span.end,
                name: field.name.text,
                comes_to: computed(analysis, block, field),
                beside: beside(analysis, block, field),
            });
        }
    }
    sort_by_span(&mut remarks, |remark| {
        Span::new(SourceId::File, remark.end, remark.end)
    });
    let mut hints: Vec<Hint> = Vec::new();
    for remark in remarks {
        let rest = analysis.text().get(remark.end..).unwrap_or_default();
        let rest = rest.lines().next().unwrap_or_default().trim_end();
        let at = remark.end + rest.len();
        let shown = |value| match rest {
            "" => format!("= {value}"),
            _ => format!("{} = {value}", remark.name),
        };
        let texts = [remark.comes_to.map(shown), remark.beside];
        for text in texts.into_iter().flatten() {
            match hints.last_mut().filter(|last| last.at == at) {
                Some(last) => last.text += &format!(", {text}"),
                None => hints.push(Hint { at, text }),
            }
        }
    }
    hints
}

/// What a field's expression comes to.
fn computed<'s>(analysis: &Analysis<'s>, block: &Block<'s>, field: &Field<'s>) -> Option<Value> {
    let row = schema::block(block.kind?.text)?.field(field.name.text)?;
    // The words of methods are none of the text's names, whatever these are called.
    if row.takes == Type::Method || !is_computed(&field.value) {
        return None;
    }
    analysis.model.value(&field.value, Some(row.takes))
}

/// Whether a value is more than a literal.
fn is_computed(value: &tree::Value<'_>) -> bool {
    match &value.kind {
        ValueKind::Name(name) => css::color(name).is_none(),
        ValueKind::Call(call) if call.function.text == "rgb" => {
            value.parts().into_iter().any(is_computed)
        }
        ValueKind::Call(_) | ValueKind::Chain { .. } => true,
        _ => value.parts().into_iter().any(is_computed),
    }
}

/// What follows from a field together with others.
fn beside(analysis: &Analysis<'_>, block: &Block<'_>, field: &Field<'_>) -> Option<String> {
    let parts = &analysis.model.parts;
    let image = parts.image?;
    match (block.kind?.text, field.name.text) {
        ("camera" | "sampler", _) if is_disputed(analysis, block, field) => None,
        ("camera", "d") => {
            let (camera, _) = inspect::inspect_camera(&parts.camera?, &image);
            Some(format!(
                "fov {}",
                Value::Angle(Angle::from_degrees(camera.fov_deg))
            ))
        }
        ("camera", "fov" | "hfov") => {
            let (camera, _) = inspect::inspect_camera(&parts.camera?, &image);
            Some(format!("d {}", short(camera.d)))
        }
        ("sampler", "per_pixel" | "total") => match parts.sampler?.count {
            _ if parts.sampler?.method == Method::Exact => None,
            count @ Count::PerPixel(_) => {
                let total = inspect::total_samples(count, &image);
                Some(format!("{} in all", grouped(total)))
            }
            Count::Total(total) => {
                let pixels = f64::from(image.width) * f64::from(image.height);
                Some(format!("{} per pixel", short(total as f64 / pixels)))
            }
        },
        _ => None,
    }
}

/// Whether the field or its block stands against another one, which is reported.
fn is_disputed(analysis: &Analysis<'_>, block: &Block<'_>, field: &Field<'_>) -> bool {
    let diagnostics = analysis.diagnostics().iter();
    let mut labels = diagnostics.flat_map(|diagnostic| &diagnostic.labels);
    labels.any(|label| label.span == field.name.span || label.span == block.keyword())
}
