//! A request about a document's picture, and its answer: docs/protocol.md has the contract.

use std::cell::LazyCell;

use glam::DVec2;
use serde_json::{Value, json};

use super::{
    convert::Converter,
    params::{Answer, Refusal, at, optional},
    scene_version::SceneVersion,
};
use crate::{
    editor::{
        self, Analysis,
        viewport::{self, Along, Drag, Shown, Vanishing},
    },
    scene::{Object, Shape},
    source::Span,
};

/// What the names of our own requests begin with.
pub const NAMESPACE: &str = "pinhole/";

/// The answer to a request but that for a frame; null where the text has errors. The analysis is
/// not made where it is not asked.
pub fn answer<'s, F: FnOnce() -> Analysis<'s>>(
    about: &str,
    params: &Value,
    converter: Converter<'_>,
    analysis: &LazyCell<Analysis<'s>, F>,
    version: &mut Option<SceneVersion>,
) -> Answer {
    match about {
        "limits" => return limits(params, converter, analysis),
        "sliders" => return sliders(converter, analysis),
        "add" => return add(params, converter, analysis, version.as_ref()),
        _ => {}
    }
    let Some(version) = version else {
        return Ok(Value::Null);
    };
    match about {
        "pick" => pick(params, converter, version),
        "objects" => objects(params, converter, version),
        "overlays" => overlays(params, converter, version),
        "drag" => drag(params, converter, version),
        "samples" => samples(params, version),
        _ => Err(Refusal::unknown(&format!("{NAMESPACE}{about}"))),
    }
}

/// Between which numbers the one at a position may be; of texts with errors, too.
fn limits(params: &Value, converter: Converter<'_>, analysis: &Analysis<'_>) -> Answer {
    let offset = converter.offset(at(params, "/position")?);
    Ok(editor::limits(analysis, offset).map_or(Value::Null, written_limits))
}

fn written_limits(limits: editor::Limits) -> Value {
    json!({
        "least": limits.least,
        "most": limits.most,
        "open": limits.is_open,
        "whole": limits.is_whole,
    })
}

/// The numbers and angles that definitions are; of texts with errors, too.
fn sliders(converter: Converter<'_>, analysis: &Analysis<'_>) -> Answer {
    let sliders = editor::sliders(analysis).into_iter();
    let written = |(name, span, limits): (&str, Span, editor::Limits)| {
        let (range, step) = (converter.range(span), limits.step);
        json!({ "name": name, "range": range, "limits": written_limits(limits), "step": step })
    };
    Ok(sliders.map(written).collect())
}

/// A block that is new, or that stands there another time. In a text with errors it is put beside
/// what can be read of it.
fn add(
    params: &Value,
    converter: Converter<'_>,
    analysis: &Analysis<'_>,
    version: Option<&SceneVersion>,
) -> Answer {
    let kind: Option<String> = optional(params, "kind")?;
    let copied: Option<usize> = optional(params, "object")?;
    let scene = version.map(|version| &version.scene);
    let added = match (kind, copied, scene) {
        (Some(kind), ..) => viewport::add(analysis, scene, kind.as_str()),
        (None, Some(index), Some(scene)) => viewport::duplicate(analysis, scene, index),
        _ => None,
    };
    let added = added.ok_or_else(|| Refusal::invalid("nothing of that kind can be added"))?;
    let edits = converter.text_edits([added.edit]);
    Ok(json!({ "edits": edits, "name": added.name, "cursor": added.cursor }))
}

fn pick(params: &Value, converter: Converter<'_>, version: &mut SceneVersion) -> Answer {
    let at = point(params, "point")?;
    let (scene, world) = version.world(1);
    let (hit, color) = viewport::pick(scene, world, at).unzip();
    let hit = hit.flatten();
    Ok(json!({
        "object": hit.map(|hit| object(hit.object, converter, version)),
        "point": hit.map(|hit| hit.point.to_array()),
        "distance": hit.map(|hit| hit.t),
        "depth": hit.map(|hit| hit.depth),
        "color": color.map(|color| color.to_string()),
    }))
}

/// An object of the scene, and where it stands in the text.
fn object(index: usize, converter: Converter<'_>, version: &SceneVersion) -> Value {
    let object = &version.scene.objects[index];
    let mut facts = json!({
        "index": index,
        "kind": object.shape.kind(),
        "name": object.name,
        "range": converter.range(object.span),
        "selection": converter.range(version.selections[index]),
    });
    if !object.indices.is_empty() {
        facts["indices"] = json!(object.indices);
    }
    facts
}

/// The objects without what is drawn of them.
fn objects(params: &Value, converter: Converter<'_>, version: &SceneVersion) -> Answer {
    let shown = shown(params)?;
    let objects = &version.scene.objects;
    // Objects stand on the first board, wherever it stands in the text.
    let is_board = |object: &Object| matches!(object.shape, Shape::Checkerboard(_));
    let floor = match shown {
        Shown::First(_) => objects.iter().position(is_board),
        Shown::Only(_) => None,
    };
    let listed = (0..objects.len()).filter(|index| shown.has(*index) || Some(*index) == floor);
    Ok(listed
        .map(|index| object(index, converter, version))
        .collect())
}

fn shown(params: &Value) -> Result<Shown, Refusal> {
    let further: Option<usize> = optional(params, "object")?;
    let only: Option<Vec<usize>> = optional(params, "only")?;
    Ok(only.map_or(Shown::First(further), Shown::Only))
}

fn overlays(params: &Value, converter: Converter<'_>, version: &SceneVersion) -> Answer {
    let overlays = viewport::overlays(&version.scene, &shown(params)?);
    let vanishing = ["x", "y", "z"].into_iter().zip(&overlays.vanishing);
    let vanishing = vanishing.map(|(axis, Vanishing { point, lines })| {
        json!({ "axis": axis, "point": point.map(written_point), "lines": written_lines(lines) })
    });
    let objects = overlays.objects.iter().map(|outline| {
        let mut object = object(outline.object, converter, version);
        object["outline"] = written_lines(&outline.lines);
        let handles = outline.handles.iter().map(|(name, at)| {
            let label = name.replace('_', " ");
            json!({ "handle": name, "at": at.map(written_point), "label": label })
        });
        object["handles"] = handles.collect();
        object
    });
    Ok(json!({
        "size": overlays.size,
        "axis": written_point(overlays.axis),
        "horizon": overlays.horizon.map(|line| written_line(&line)),
        "vanishing": vanishing.collect::<Vec<_>>(),
        "near": written_lines(&overlays.near),
        "far": written_lines(&overlays.far),
        "objects": objects.collect::<Vec<_>>(),
    }))
}

fn drag(params: &Value, converter: Converter<'_>, version: &mut SceneVersion) -> Answer {
    let object: Option<usize> = optional(params, "object")?;
    let handle: String = at(params, "/handle")?;
    let along: Option<String> = optional(params, "along")?;
    let to = point(params, "to")?;
    let from = match object {
        Some(_) => to,
        None => point(params, "from")?,
    };
    let along = along.map(|name| {
        let message = || format!("`along` is x, y, z or floor, and not `{name}`");
        Along::named(&name).ok_or_else(|| Refusal::invalid(message()))
    });
    let drag = Drag {
        object,
        handle: &handle,
        from,
        to,
        along: along.transpose()?,
        step: optional(params, "step")?,
    };
    let sources = &converter.document.sources;
    let (scene, alone) = version.alone(sources, object);
    let dragged = viewport::drag(sources, alone, scene, &drag).map_err(Refusal::failed)?;
    let edits = converter.text_edits(dragged.edits);
    let viewport::Dragged { values, also, .. } = dragged;
    Ok(json!({ "edits": edits, "values": values, "also": also }))
}

fn samples(params: &Value, version: &mut SceneVersion) -> Answer {
    let pixel: [u32; 2] = at(params, "/pixel")?;
    let image = version.scene.image;
    if pixel[0] >= image.width || pixel[1] >= image.height {
        return Err(Refusal::invalid("`pixel` is no pixel of the picture"));
    }
    let (scene, world) = version.world(1);
    let found = viewport::samples(scene, world, pixel).map_err(Refusal::failed)?;
    let samples = found.samples.iter();
    let (points, colors): (Vec<_>, Vec<_>) = samples
        .map(|(point, color)| (point.to_array(), color.to_string()))
        .unzip();
    Ok(json!({ "points": points, "colors": colors, "color": found.color.to_string() }))
}

fn point(params: &Value, name: &str) -> Result<DVec2, Refusal> {
    let point: Option<[f64; 2]> = optional(params, name)?;
    let refusal = || Refusal::invalid(format!("`{name}` is a point of the picture, as [x, y]"));
    point.map(DVec2::from).ok_or_else(refusal)
}

/// A point to a hundredth of a pixel, which nobody sees, in a third of the bytes.
fn written_point(point: DVec2) -> Value {
    json!(((point * 100.0).round() / 100.0).to_array())
}

fn written_line(line: &[DVec2]) -> Value {
    line.iter().copied().map(written_point).collect()
}

fn written_lines(lines: &[impl AsRef<[DVec2]>]) -> Value {
    let lines = lines.iter().map(AsRef::as_ref);
    lines.map(written_line).collect()
}
