//! Computes hints about values, such as the result of an expression. Editors show hints in grey at
//! the ends of lines.

use std::ops::Range;

use super::analysis::Analysis;
use crate::{
    inspect,
    math::Angle,
    numbers::{grouped, short},
    scene::Count,
    schema::{self, BlockKind, CAMERA, Method, SAMPLER, Type, Value, css},
    source::{SourceId, Span, sort_by_span},
    syntax::tree::{self, Block, Field, ValueKind},
};

/// A hint at the end of a line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Hint {
    /// Byte offset of the end of the line at which the hint is shown.
    pub at: usize,
    /// The shown text, such as `= 2.5`.
    pub text: String,
}

/// The hints about one value, before they are put at the end of a line.
struct Remark<'s> {
    /// Byte offset of the end of the value.
    end: usize,
    /// Name of the value's field or definition.
    name: &'s str,
    /// Result of the value, if it is an expression.
    result: Option<Value>,
    /// A fact that follows from the value together with other fields of the block. For example, the
    /// field of view follows from the camera's field `d`, the distance of the view plane.
    beside: Option<String>,
}

/// Returns the hints about the values that end in the byte range `within`, in order. A hint shows
/// the result of an expression, the field of view for the camera's `d`, or the total number of
/// samples for the sampler's `per_pixel`.
///
/// Hints stand at the ends of lines, because within a line they would shift the columns in which
/// the formatter aligns values. If other text stands between an expression and the end of its line,
/// the name of the field or definition precedes the result.
pub fn hints(analysis: &Analysis<'_>, within: Range<usize>) -> Vec<Hint> {
    let mut remarks: Vec<Remark<'_>> = Vec::new();
    let touches =
        |value: &tree::Value<'_>| within.contains(&value.span.end) || within.end == value.span.end;
    for definition in analysis.model.definitions() {
        if touches(&definition.value) && is_computed(&definition.value) {
            remarks.push(Remark {
                end: definition.value.span.end,
                name: definition.name.map_or("", |name| name.text),
                result: analysis.model.defined(definition),
                beside: None,
            });
        }
    }
    for block in analysis.blocks() {
        for field in block.fields.iter().filter(|field| touches(&field.value)) {
            remarks.push(Remark {
                end: field.value.span.end,
                name: field.name.text,
                result: computed(analysis, block, field),
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
        let texts = [remark.result.map(shown), remark.beside];
        for text in texts.into_iter().flatten() {
            match hints.last_mut().filter(|last| last.at == at) {
                Some(last) => last.text += &format!(", {text}"),
                None => hints.push(Hint { at, text }),
            }
        }
    }
    hints
}

/// Returns the result of a field's value if it is an expression rather than a literal.
fn computed<'s>(analysis: &Analysis<'s>, block: &Block<'s>, field: &Field<'s>) -> Option<Value> {
    let row = schema::block(block.kind?.text)?.field(field.name.text)?;
    // The name of a method is not a reference, even if a `let` has the same name. So it gets no
    // hint.
    if row.takes == Type::Method || !is_computed(&field.value) {
        return None;
    }
    analysis.model.value(&field.value, Some(row.takes))
}

/// Returns whether a value is an expression rather than a literal.
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

/// Returns a fact that follows from a field of the camera or the sampler together with other
/// fields, such as `fov 53deg` for the field `d`. Returns `None` for all other fields, and if a
/// problem is reported at the field.
fn beside(analysis: &Analysis<'_>, block: &Block<'_>, field: &Field<'_>) -> Option<String> {
    let parts = &analysis.model.parts;
    let image = parts.image?;
    let (kind, name) = (schema::block(block.kind?.text)?.kind, field.name.text);
    match kind {
        BlockKind::Camera | BlockKind::Sampler if is_disputed(analysis, block, field) => None,
        BlockKind::Camera if name == CAMERA.d.name => {
            let (camera, _) = inspect::inspect_camera(&parts.camera?, &image);
            let fov = Value::Angle(Angle::from_degrees(camera.fov_deg));
            Some(format!("fov {fov}"))
        }
        BlockKind::Camera if [CAMERA.fov.name, CAMERA.hfov.name].contains(&name) => {
            let (camera, _) = inspect::inspect_camera(&parts.camera?, &image);
            Some(format!("d {}", short(camera.d)))
        }
        BlockKind::Sampler if [SAMPLER.per_pixel.name, SAMPLER.total.name].contains(&name) => {
            match parts.sampler?.count {
                _ if parts.sampler?.method == Method::Exact => None,
                count @ Count::PerPixel(_) => {
                    let total = inspect::total_samples(count, &image);
                    Some(format!("{} in all", grouped(total)))
                }
                Count::Total(total) => {
                    let pixels = f64::from(image.width) * f64::from(image.height);
                    Some(format!("{} per pixel", short(total as f64 / pixels)))
                }
            }
        }
        _ => None,
    }
}

/// Returns whether a reported problem has a label at the field's name or at the block's keyword.
/// Problems about conflicting fields have such labels.
fn is_disputed(analysis: &Analysis<'_>, block: &Block<'_>, field: &Field<'_>) -> bool {
    let diagnostics = analysis.diagnostics().iter();
    let mut labels = diagnostics.flat_map(|diagnostic| &diagnostic.labels);
    labels.any(|label| label.span == field.name.span || label.span == block.keyword())
}
