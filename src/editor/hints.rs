//! What a text does not say but could: shown in grey between its words.

use super::Analysis;
use crate::{
    inspect,
    math::Angle,
    numbers::{grouped, short},
    scene::{Count, Method, Value, css, schema},
    schema::Type,
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

/// The remarks within a range of bytes, in order: what an expression comes to, the field of view that belongs to a distance, how
/// many samples there are in all.
pub fn hints(analysis: &Analysis<'_>, within: std::ops::Range<usize>) -> Vec<Hint> {
    let mut hints = Vec::new();
    let touches =
        |value: &tree::Value<'_>| within.contains(&value.span.end) || within.end == value.span.end;
    for definition in analysis.model.definitions() {
        if touches(&definition.value) && is_computed(&definition.value) {
            let value = analysis.model.defined(definition);
            hints.extend(value.map(|value| Hint {
                at: definition.value.span.end,
                text: format!("= {value}"),
            }));
        }
    }
    for block in analysis.blocks() {
        for field in block.fields.iter().filter(|field| touches(&field.value)) {
            let remarks: Vec<String> = [
                computed(analysis, block, field),
                beside(analysis, block, field),
            ]
            .into_iter()
            .flatten()
            .collect();
            if !remarks.is_empty() {
                hints.push(Hint {
                    at: field.value.span.end,
                    text: remarks.join(", "),
                });
            }
        }
    }
    hints.sort_by_key(|hint| hint.at);
    hints
}

/// What a field's expression comes to.
fn computed<'s>(analysis: &Analysis<'s>, block: &Block<'s>, field: &Field<'s>) -> Option<String> {
    let row = schema::block(block.kind?.text)?.field(field.name.text)?;
    // The words of methods are none of the text's names, whatever these are called.
    if row.takes == Type::Method || !is_computed(&field.value) {
        return None;
    }
    let value = analysis.model.value(&field.value, Some(row.takes))?;
    Some(format!("= {value}"))
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
