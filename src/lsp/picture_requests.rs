//! Answers requests about the picture of a document, as docs/protocol.md specifies.

use std::{borrow::Cow, cell::LazyCell, num::NonZeroU64};

use glam::DVec2;
use serde_json::{Value, json};

use super::{
    convert::Converter,
    frames::encoded,
    params::{Answer, Refusal, at, optional},
    scene_version::SceneVersion,
    view::{observer, written_camera, written_view},
};
use crate::{
    diagnostic::Diagnostic,
    editor::{
        self, Analysis,
        viewport::{
            self, Along, Drag, Glass, ObjectOverlay, Overlays, PointedRay, SAMPLE_COUNTS,
            ShownObjects, Vanishing,
        },
    },
    lesson::{self, Facts, Judged, value_text},
    numbers::{short, short_vector, significant},
    scene::{self, Count, Object, Scene},
    source::{Source, Sources},
};

/// Prefix of the method names of those requests that Pinhole adds to the protocol.
pub const NAMESPACE: &str = "pinhole/";

/// Answers the request whose method is [`NAMESPACE`] followed by `about`, except `pinhole/frame`,
/// which the server handles itself. `version` is `None` if the text has errors; requests that need
/// a scene are then answered with null. `analysis` is computed only if the request needs it.
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
        "glass" => glass(params, version),
        "lesson" => lesson(params, converter, version),
        _ => Err(Refusal::unknown(&format!("{NAMESPACE}{about}"))),
    }
}

/// Answers with the limits of a slider for a number in the text: its smallest and largest value,
/// its step and so on. The parameters contain a position within the number. The text may have
/// errors.
fn limits(params: &Value, converter: Converter<'_>, analysis: &Analysis<'_>) -> Answer {
    let offset = converter.offset(at(params, "/position")?);
    Ok(editor::limits(analysis, offset).map_or(Value::Null, written_limits))
}

fn written_limits(limits: editor::Limits) -> Value {
    json!({
        "least": limits.least,
        "most": limits.most,
        "step": limits.step,
        "decimals": limits.decimals,
        "ends": limits.ends,
    })
}

/// Answers with the sliders of all definitions whose values are numbers or angles. The text may
/// have errors.
fn sliders(converter: Converter<'_>, analysis: &Analysis<'_>) -> Answer {
    let sliders = editor::sliders(analysis).into_iter();
    let written = |slider: editor::Slider<'_>| {
        json!({
            "name": slider.name,
            "range": converter.range(slider.span),
            "limits": slider.limits.map(written_limits),
            "note": slider.note,
        })
    };
    Ok(sliders.map(written).collect())
}

/// Answers with the edits that add a new block or duplicate an object. The text may have errors;
/// the position of a new block then depends only on the blocks without errors.
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
    let observer = observer(params, &version.scene)?;
    let (scene, world) = version.world(observer.as_ref(), 1);
    let (hit, color) = viewport::pick(scene, world, at).unzip();
    let hit = hit.flatten();
    let image = &scene.image;
    // A point on the right or lower edge belongs to the last pixel.
    let pixel = [(at.x, image.width), (at.y, image.height)];
    let pixel = pixel.map(|(at, count)| (at as u32).min(count - 1));
    let seen = color.map(|color| {
        let on = hit.map_or("background".to_owned(), |hit| {
            let place = short_vector(hit.point.map(|it| significant(it, 4)));
            let away = short(significant(hit.t, 4));
            format!(
                "{} at {place} · {away} away ·",
                label(&scene.objects[hit.object])
            )
        });
        format!("{on} {color} · pixel {}, {}", pixel[0], pixel[1])
    });
    Ok(json!({
        "object": hit.map(|hit| object(hit.object, converter, version)),
        "point": hit.map(|hit| hit.point.to_array()),
        "distance": hit.map(|hit| hit.t),
        "depth": hit.map(|hit| hit.depth),
        "color": color.map(|color| color.to_string()),
        "pixel": color.map(|_| pixel),
        "text": seen,
    }))
}

/// Describes an object of the scene as JSON: its index, kind, name and label, and its range in the
/// text.
fn object(index: usize, converter: Converter<'_>, version: &SceneVersion) -> Value {
    let object = &version.scene.objects[index];
    let mut facts = json!({
        "index": index,
        "kind": object.shape.kind(),
        "name": object.name,
        "label": label(object),
        "range": converter.range(object.span),
        "selection": converter.range(version.selections[index]),
    });
    if !object.indices.is_empty() {
        facts["indices"] = json!(object.indices);
    }
    facts
}

/// Returns a label for the object: its name or, if it has none, its kind. The label of a repeated
/// object without a name also contains the object's indices.
fn label(object: &Object) -> Cow<'_, str> {
    let kind = object.shape.kind();
    match (&object.name, &*object.indices) {
        (Some(name), _) => Cow::Borrowed(name),
        (None, []) => Cow::Borrowed(kind),
        (None, indices) => Cow::Owned(format!("{kind} {indices:?}")),
    }
}

/// Answers with a list of the objects that the parameters select. The list does not contain the
/// objects' outlines.
fn objects(params: &Value, converter: Converter<'_>, version: &SceneVersion) -> Answer {
    let shown = shown(params)?;
    let objects = &version.scene.objects;
    // The first checkerboard is listed even if it is not among the first objects, since other
    // objects usually stand on it. It is not added if the client names the objects to list.
    let floor = match shown {
        ShownObjects::First(_) => objects.iter().position(is_board),
        ShownObjects::Only(_) => None,
    };
    let listed = (0..objects.len()).filter(|index| shown.has(*index) || Some(*index) == floor);
    let overlays = viewport::overlays(&version.scene, &shown);
    let listed = listed.map(|index| {
        let mut object = object(index, converter, version);
        let outline = overlays.objects.iter().find(|it| it.object == index);
        // A checkerboard may be visible although it has no outline. So its place is reported as
        // unknown (null), and not as outside of the picture.
        let outline = outline.filter(|it| !(it.lines.is_empty() && is_board(&objects[index])));
        object["place"] = json!(outline.map(|outline| place(outline, overlays.size)));
        object
    });
    Ok(listed.collect())
}

fn is_board(object: &Object) -> bool {
    object.shape.checkerboard().is_some()
}

fn shown(params: &Value) -> Result<ShownObjects, Refusal> {
    let further: Option<usize> = optional(params, "object")?;
    let only: Option<Vec<usize>> = optional(params, "only")?;
    Ok(only.map_or(ShownObjects::First(further), ShownObjects::Only))
}

fn overlays(params: &Value, converter: Converter<'_>, version: &mut SceneVersion) -> Answer {
    let observer = observer(params, &version.scene)?;
    let seen = observer.map(|observer| observer.scene(&version.scene));
    let seen = seen.as_ref().unwrap_or(&version.scene);
    let mut overlays = viewport::overlays(seen, &shown(params)?);
    let objects = &version.scene.objects;
    let has_board = overlays
        .objects
        .iter()
        .any(|it| is_board(&objects[it.object]));
    if has_board {
        let (scene, world) = version.world(observer.as_ref(), 1);
        viewport::hide(&mut overlays, scene, world);
    }
    let Overlays {
        size,
        axis,
        horizon,
        vanishing,
        near,
        far,
        objects,
    } = overlays;
    let vanishing = ["x", "y", "z"].into_iter().zip(vanishing);
    let vanishing = vanishing.map(|(axis, Vanishing { point, lines })| {
        json!({ "axis": axis, "point": point.map(written_point), "lines": written_lines(&lines) })
    });
    let objects = objects.iter().map(|outline| {
        let mut object = object(outline.object, converter, version);
        object["outline"] = written_lines(&outline.lines);
        let handles = outline.handles.iter().map(|(name, at)| {
            let label = name.replace('_', " ");
            json!({ "handle": name, "at": at.map(written_point), "label": label })
        });
        object["handles"] = handles.collect();
        object
    });
    let mut answer = json!({
        "size": size,
        "axis": written_point(axis),
        "horizon": horizon.map(|line| written_line(&line)),
        "vanishing": vanishing.collect::<Vec<_>>(),
        "near": written_lines(&near),
        "far": written_lines(&far),
        "objects": objects.collect::<Vec<_>>(),
    });
    if let Some(observer) = observer {
        let pointed = pointed_ray(params, version)?;
        let Scene { camera, image, .. } = &version.scene;
        let camera = viewport::camera_overlay(camera, image, &observer.projection(), pointed);
        answer["view"] = written_view(&observer);
        answer["camera"] = written_camera(&camera, written_point, written_lines);
    }
    Ok(answer)
}

/// Returns the ray of the scene's camera through the point of the picture that the parameter
/// `point` names. Returns `None` if there is no such parameter, or if the point is outside of the
/// picture.
fn pointed_ray(params: &Value, version: &mut SceneVersion) -> Result<Option<PointedRay>, Refusal> {
    let Some(pixel) = optional::<[f64; 2]>(params, "point")?.map(DVec2::from) else {
        return Ok(None);
    };
    let (scene, world) = version.world(None, 1);
    let found = viewport::pick(scene, world, pixel);
    Ok(found.map(|(hit, _)| PointedRay {
        pixel,
        end: hit.map(|hit| hit.point),
    }))
}

/// Describes where an object is in the picture, such as "top left". The place is that of the
/// object's first handle, i.e. the first point by which a user can drag it. If this point is
/// outside of the picture, returns a phrase that says so.
fn place(outline: &ObjectOverlay, size: [u32; 2]) -> String {
    let at = outline.handles.first().and_then(|(_, at)| *at);
    let size = DVec2::from(size.map(f64::from));
    let part = at.map(|at| (3.0 * at / size).floor());
    let third = |part: f64, words: [&'static str; 3]| {
        let found = (0..3).zip(words).find(|(at, _)| f64::from(*at) == part);
        found.map(|(_, word)| word)
    };
    let down = part.and_then(|part| third(part.y, ["top", "middle", "bottom"]));
    let across = part.and_then(|part| third(part.x, ["left", "centre", "right"]));
    let points = outline.lines.iter().flatten();
    let none = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    let (low, high) = points.fold(none, |(low, high), &it| (low.min(it), high.max(it)));
    match down.zip(across) {
        Some((down, across)) => format!("{down} {across}"),
        None if high.cmpge(DVec2::ZERO).all() && low.cmple(size).all() => {
            "middle beside the picture".to_owned()
        }
        None => "not in the picture".to_owned(),
    }
}

fn drag(params: &Value, converter: Converter<'_>, version: &mut SceneVersion) -> Answer {
    let object: Option<usize> = optional(params, "object")?;
    let handle: String = at(params, "/handle")?;
    let along: Option<String> = optional(params, "along")?;
    let to = point(params, "to")?;
    let observer = observer(params, &version.scene)?;
    // The earlier position of the pointer is needed only if the camera is dragged in its own
    // picture. In an observer's picture, the camera has handles, as objects have.
    let from = match object {
        None if observer.is_none() => point(params, "from")?,
        _ => to,
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
        observer,
    };
    let sources = &converter.document.sources;
    let (scene, alone) = version.alone(sources, object);
    let dragged = viewport::drag(sources, alone, scene, &drag).map_err(Refusal::failed)?;
    let edits = converter.text_edits(dragged.edits);
    let viewport::Dragged { values, also, .. } = dragged;
    Ok(json!({ "edits": edits, "values": values, "also": also }))
}

fn samples(params: &Value, version: &mut SceneVersion) -> Answer {
    let pixel = pixel(params, version)?;
    let (scene, world) = version.world(None, 1);
    let mut sampler = scene.sampler;
    if let Some(method) = optional::<String>(params, "method")? {
        let unknown = || Refusal::invalid(format!("`{method}` is no method"));
        sampler.method = method.parse().map_err(|_| unknown())?;
    }
    if let Some(count) = optional::<u64>(params, "count")? {
        let positive = NonZeroU64::new(count);
        let refusal = || Refusal::invalid("`count` is a number of samples, at least 1");
        sampler.count = Count::PerPixel(positive.ok_or_else(refusal)?.get());
    }
    let found = viewport::samples(&sampler, world, pixel).map_err(Refusal::failed)?;
    let samples = found.samples.iter();
    let (points, colors): (Vec<_>, Vec<_>) = samples
        .map(|(point, color)| (point.to_array(), color.to_string()))
        .unzip();
    let color = found.color.to_string();
    Ok(json!({ "points": points, "colors": colors, "color": color, "mean": found.mean }))
}

/// Answers with what a pixel shows, its exact colour, and the errors of all sampling methods in
/// this pixel.
fn glass(params: &Value, version: &mut SceneVersion) -> Answer {
    let pixel = pixel(params, version)?;
    let (scene, world) = version.world(None, 1);
    let Glass {
        seen,
        enlarged,
        exact,
        errors,
    } = viewport::glass(scene, world, pixel);
    let seen = seen.iter().map(|seen| {
        let on = match (seen.at, seen.object) {
            (None, _) => Value::Null,
            (_, None) => json!("background"),
            (_, Some(object)) => json!(label(&scene.objects[object])),
        };
        let color = seen.color.to_string();
        json!({ "color": color, "share": seen.share, "label": on, "object": seen.object })
    });
    let errors = errors.iter().map(|errors| {
        let method = errors.method.name();
        json!({ "method": method, "typical": errors.typical, "own": errors.own })
    });
    Ok(json!({
        "png": encoded(&enlarged)?,
        "seen": seen.collect::<Vec<_>>(),
        "color": viewport::color_of(exact.mean).to_string(),
        "mean": exact.mean,
        "bound": exact.bound,
        "method": scene.sampler.method.name(),
        "counts": SAMPLE_COUNTS,
        "errors": errors.collect::<Vec<_>>(),
    }))
}

fn pixel(params: &Value, version: &SceneVersion) -> Result<[u32; 2], Refusal> {
    let pixel: [u32; 2] = at(params, "/pixel")?;
    let image = version.scene.image;
    if pixel[0] >= image.width || pixel[1] >= image.height {
        return Err(Refusal::invalid("`pixel` is no pixel of the picture"));
    }
    Ok(pixel)
}

/// Judges the scene by the conditions of a lesson. The client sends the text of the lesson and that
/// of its start scene.
fn lesson(params: &Value, converter: Converter<'_>, version: &SceneVersion) -> Answer {
    let [text, start]: [Source; 2] = [
        Source::from_text("lesson", at::<String>(params, "/lesson")?),
        Source::from_text("start.scn", at::<String>(params, "/start")?),
    ];
    let lesson = lesson::parse(&text).map_err(|problems| {
        let place = |it: &Diagnostic| it.labels.first().map_or(0, |it| text.line(it.span.start));
        let first = problems.first().map(|it| (place(it), &*it.message));
        let (line, message) = first.unwrap_or_default();
        Refusal::invalid(format!("line {line} of the lesson: {message}"))
    })?;
    let sources = Sources::new(start);
    let start = scene::read(&sources).scene;
    let start = start.ok_or_else(|| Refusal::invalid("the scene of the lesson has errors"))?;
    let scene = Facts::new(&version.scene, &converter.document.sources.file);
    let judged = lesson.judge(&scene, &Facts::new(&start, &sources.file));
    let written = |it: &Judged<'_>| {
        json!({
            "condition": it.condition.text,
            "words": it.condition.words,
            "found": value_text(it.found.as_ref()),
            "start": it.at_start.as_ref().map(|value| value_text(Some(value))),
            "holds": it.holds,
        })
    };
    let blocks = judged.iter();
    let blocks: Vec<Value> = blocks.map(|it| it.iter().map(written).collect()).collect();
    let holds = judged.iter().flatten().all(|it| it.holds);
    Ok(json!({ "holds": holds, "checks": blocks }))
}

fn point(params: &Value, name: &str) -> Result<DVec2, Refusal> {
    let point: Option<[f64; 2]> = optional(params, name)?;
    let refusal = || Refusal::invalid(format!("`{name}` is a point of the picture, as [x, y]"));
    point.map(DVec2::from).ok_or_else(refusal)
}

/// Rounds a point to a hundredth of a pixel. The difference is invisible, and the JSON has only a
/// third of the bytes.
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
