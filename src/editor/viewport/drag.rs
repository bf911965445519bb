//! A handle is moved: what has to change in the text.
//!
//! The object or the camera is moved first, in real numbers. Then the fields that differ are
//! written to one decimal after another, until the text means something that is seen within half a
//! pixel of where it would be. It may not come to that: a text ties numbers to others, or breaks a
//! condition of the language.

use std::{iter, sync::Arc};

use glam::{DVec2, DVec3};

use super::{
    camera,
    edits::{Change, changes, edits, rounded, together},
    handles::{self, Along, TOLERANCE, TOO_FAR, handles},
};
use crate::{
    diagnostic::{Diagnostic, Edit, Fix, apply},
    editor::Analysis,
    inspect,
    numbers::short,
    projection::Projection,
    scene::{self, Image, Part, Scene, Shape},
    source::{Source, SourceId, Sources, Span},
    syntax::tree::Block,
};

/// A number of an `f64` has no more digits than this.
const DIGITS: i32 = 17;

/// A handle is moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drag<'a> {
    /// The object's index in the file; none for the camera.
    pub object: Option<usize>,
    /// Which handle.
    pub handle: &'a str,
    /// Where the pointer was: it counts for the camera alone.
    pub from: DVec2,
    /// Where the pointer is.
    pub to: DVec2,
    /// What a point moves along.
    pub along: Option<Along>,
    /// So many pixels a handle may go at once: its numbers are multiples of the greatest power of
    /// ten that moves it no farther.
    pub step: Option<f64>,
}

/// What has to change in the text, and what becomes of the fields that do; nothing at all where
/// nobody would see it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Dragged {
    /// The changes.
    pub edits: Vec<Edit>,
    /// The fields with their new values, as `Ball.radius = 2`.
    pub values: Vec<String>,
    /// Fields of other blocks that change with them, as `camera.lookat`, and of other objects of
    /// the same block.
    pub also: Vec<String>,
}

/// The text of a scene with spaces in the place of all blocks of objects but that of one, so that
/// what is left stands where it stood and is read quickly.
pub fn alone(sources: &Sources, scene: &Scene, object: Option<usize>) -> Sources {
    let source = &sources.file;
    let mut text = String::with_capacity(source.text().len());
    for other in other_blocks(scene, object) {
        text.push_str(source.slice(text.len()..other.start));
        for letter in source.slice(other.range()).chars() {
            match letter {
                '\n' => text.push('\n'),
                _ => text.extend(iter::repeat_n(' ', letter.len_utf8())),
            }
        }
    }
    text.push_str(source.slice(text.len()..source.text().len()));
    Sources::new(Source::from_text(source.name(), text))
}

/// The blocks of all objects but one.
fn other_blocks(scene: &Scene, object: Option<usize>) -> impl Iterator<Item = Span> {
    let own = object
        .and_then(|index| scene.objects.get(index))
        .map(|it| it.span);
    let blocks = scene.objects.chunk_by(|one, next| one.span == next.span);
    let blocks = blocks.filter_map(|block| block.first()).map(|it| it.span);
    blocks.filter(move |span| Some(*span) != own)
}

/// What has to change in a text that means a scene where a handle is moved; `alone` is that text
/// with the moved object [`alone`].
///
/// # Errors
///
/// Why it cannot be done, in a sentence.
pub fn drag(
    sources: &Sources,
    alone: &Sources,
    scene: &Scene,
    drag: &Drag<'_>,
) -> Result<Dragged, String> {
    let analysis = &Analysis::new(alone);
    if !(drag.from.is_finite() && drag.to.is_finite()) {
        return Err("the pointer is nowhere".to_owned());
    }
    let dragged = part(scene, drag.object).zip(block(analysis, scene, drag));
    let (current, (block, name)) = dragged.ok_or_else(|| match drag.object {
        Some(index) => format!("there is no object {index}"),
        None => "the text has no camera".to_owned(),
    })?;
    let image = &scene.image;
    let projection = Projection::new(&scene.camera, image);
    let (ideal, points) = match current {
        Part::Shape(shape) => {
            let held = handles(&shape, &projection, DVec3::ZERO)[0].1;
            let ideal = handles::moved(shape, drag.handle, drag.to, drag.along, &projection)?;
            (ideal, Some(Vec::from_iter(held)))
        }
        _ => {
            let distance = camera::distance(scene);
            let (handle, by) = (drag.handle, [drag.from, drag.to]);
            let moved = camera::moved(&scene.camera, &projection, handle, by, distance)?;
            let seen = landmarks(&Projection::new(&moved, image), distance);
            (Part::Camera(moved), seen)
        }
    };
    let changes = changes(block, current, ideal);
    if !changes.iter().all(|change| change.by.is_finite()) {
        return Err(TOO_FAR.to_owned());
    }
    let not_seen = "it would not be seen there";
    let view = View {
        image,
        projection,
        drag,
        points: points.ok_or(not_seen)?,
    };
    if !view.agree(ideal, ideal, TOLERANCE) {
        return Err(not_seen.to_owned());
    }
    if view.agree(ideal, current, TOLERANCE) {
        return Ok(Dragged::default());
    }
    let others = other_blocks(scene, drag.object);
    let without_others: Vec<Edit> = others.map(|span| Edit::new(span, "")).collect();
    let of_block = scene.objects.iter().filter(|it| it.span == block.span);
    let scene_alone = Scene {
        objects: Arc::new(of_block.cloned().collect()),
        ..scene.clone()
    };
    // Where it stands among the objects of its block.
    let place = drag.object.map(|index| {
        let before = scene.objects.iter().take(index);
        before.filter(|it| it.span == block.span).count()
    });
    let tied = || tied(analysis, block, &name, &changes);
    let mut refusal = tied();
    let greatest = changes.iter().map(Change::size).fold(0.0, f64::max);
    let first = -1 - libm::log10(greatest).floor() as i32;
    let snapped = drag
        .step
        .and_then(|step| view.snapped(current, &changes, step));
    let tolerance = snapped.map_or(TOLERANCE, |(_, step)| step);
    let first = snapped.map_or(first, |(decimals, _)| decimals);
    // Within a step nobody would see that a number is shared with another field.
    let keeps_others = |found: Part| {
        let mut fields = block.fields.iter().map(|field| field.name.text);
        let is_meant = |field: &str| changes.iter().any(|change| change.name == field);
        snapped.is_none()
            || fields.all(|field| is_meant(field) || found.value(field) == current.value(field))
    };
    for decimals in first..=first + DIGITS {
        let (changes, rounding) = together(&changes, decimals);
        let changes = &changes;
        let edits = edits(analysis, block, changes, &rounding);
        // The place of the press is one of those that it snaps to.
        let is_back = snapped.is_some() && rounded(current, changes, &rounding) == Some(current);
        if is_back || (snapped.is_some() && edits.as_ref().is_some_and(Vec::is_empty)) {
            return Ok(Dragged::default());
        }
        let Some(edits) = edits.filter(|edits| !edits.is_empty()) else {
            continue;
        };
        let read_alone = read(analysis.source(), [&edits, &without_others]);
        match read_alone.map(|scene| (part(&scene, place), scene)) {
            Ok((Some(found), after))
                if view.agree(ideal, found, tolerance) && keeps_others(found) =>
            {
                // What stands in the block itself concerns no other one, which saves reading a long
                // text.
                let is_own = |edit: &Edit| {
                    block.span.start <= edit.span.start && edit.span.end <= block.span.end
                };
                let also = match edits.iter().all(is_own) {
                    true => others_changed(analysis, place, changes, [&scene_alone, &after]),
                    false => {
                        let after = read(&sources.file, [&edits, &[]])?;
                        others_changed(
                            &Analysis::new(sources),
                            drag.object,
                            changes,
                            [scene, &after],
                        )
                    }
                };
                let value = |change: &Change| {
                    let after = found.value(change.name)?;
                    let is_new = after != change.from;
                    is_new.then(|| format!("{name}.{} = {after}", change.name))
                };
                let values = changes.iter().filter_map(value);
                let values = values.chain(lens(image, changes, found)).collect();
                return Ok(Dragged {
                    edits,
                    values,
                    also,
                });
            }
            Ok(_) => refusal = tied(),
            // More digits might slip by what the language forbids, and nobody would see the
            // difference.
            Err(why) => match rounded(current, changes, &rounding) {
                Some(rounded) if view.agree(ideal, rounded, tolerance) => return Err(why),
                _ => refusal = why,
            },
        }
    }
    Err(refusal)
}

/// How much a camera sees, in all of the ways that the language has, where one of them has changed.
fn lens(image: &Image, changes: &[Change], found: Part) -> Option<String> {
    let is_lens = |change: &Change| matches!(change.name, "d" | "fov" | "hfov" | "view_height");
    let (Part::Camera(camera), true) = (found, changes.iter().any(is_lens)) else {
        return None;
    };
    let (seen, _) = inspect::inspect_camera(&camera, image);
    let (d, fov, high) = (short(seen.d), seen.fov_deg, short(camera.view_height));
    Some(format!("d {d} = fov {fov:.1}° of a window {high} high"))
}

/// Why fields cannot take the values that they should have, where the text could be changed so that
/// they can, and how.
fn tied(analysis: &Analysis<'_>, block: &Block<'_>, name: &str, changes: &[Change]) -> String {
    let Some(change) = changes.first() else {
        return TOO_FAR.to_owned();
    };
    let field = change.name;
    let mut written = block.fields.iter();
    let written = written.find(|it| it.name.text == field);
    let line = analysis.line(written.map_or(block.span, |field| field.span));
    let value = change.from;
    format!(
        "`{name}.{field}` in line {line} cannot take that value, because it shares numbers with other fields: write its own numbers there, as in `{field} {value}`"
    )
}

/// An object or the camera; none if there is no such object.
fn part(scene: &Scene, object: Option<usize>) -> Option<Part> {
    Some(match object {
        None => Part::Camera(scene.camera),
        Some(index) => Part::Shape(scene.objects.get(index)?.shape),
    })
}

/// The block of the text that is to change, and what it is called.
fn block<'a, 's>(
    analysis: &'a Analysis<'s>,
    scene: &Scene,
    drag: &Drag<'_>,
) -> Option<(&'a Block<'s>, String)> {
    let mut blocks = analysis.blocks();
    let Some(index) = drag.object else {
        let is_camera = |block: &&Block<'_>| block.kind.is_some_and(|it| it.text == "camera");
        return Some((blocks.find(is_camera)?, "camera".to_owned()));
    };
    let object = scene.objects.get(index)?;
    let name = object.name.as_deref().unwrap_or(object.shape.kind());
    let block = blocks.find(|block| block.span == object.span)?;
    Some((block, name.to_owned()))
}

/// The fields of the camera and of other objects, by the names of their blocks, in which two scenes
/// differ that have the same blocks.
fn others_changed(
    analysis: &Analysis<'_>,
    dragged: Option<usize>,
    changes: &[Change],
    scenes: [&Scene; 2],
) -> Vec<String> {
    let mut next = 0;
    let mut changed = Vec::new();
    for block in analysis.blocks() {
        let Some(kind) = block.kind else { continue };
        let first = next;
        let objects = scenes[0].objects.get(first..).unwrap_or_default();
        next += objects
            .iter()
            .take_while(|it| it.span == block.span)
            .count();
        let of_block: Vec<_> = match kind.text {
            "camera" => vec![None],
            _ => (first..next).map(Some).collect(),
        };
        let others = of_block.into_iter().filter(|index| *index != dragged);
        let parts = others.map(|index| scenes.map(|scene| part(scene, index)));
        let parts: Vec<_> = parts.collect();
        let name = block.name.map_or(kind.text, |name| name.text);
        let fields: Vec<&str> = match dragged.is_some_and(|index| (first..next).contains(&index)) {
            true => changes.iter().map(|change| change.name).collect(),
            false => block.fields.iter().map(|it| it.name.text).collect(),
        };
        let differ = fields.into_iter().filter(|field| {
            let differs = |[before, after]: &[Option<Part>; 2]| match (before, after) {
                (Some(before), Some(after)) => before.value(field) != after.value(field),
                _ => false,
            };
            parts.iter().any(differs)
        });
        changed.extend(differ.map(|field| format!("{name}.{field}")));
    }
    changed
}

/// The scene that a text means after some edits.
fn read(source: &Source, edits: [&[Edit]; 2]) -> Result<Scene, String> {
    let fix = Fix::new("", edits.concat());
    let text = apply(&fix, SourceId::File, source.text());
    let reading = scene::read(&Sources::new(Source::from_text(source.name(), text)));
    let mut diagnostics = reading.diagnostics.iter();
    reading.scene.ok_or_else(|| {
        let error = diagnostics.find(|diagnostic| Diagnostic::is_error(diagnostic));
        let why = error.map_or("", |error| error.message.as_str());
        format!("the scene would not be right any more: {why}")
    })
}

/// Points that a camera sees in the middle and in the corners of its picture, before and behind
/// what it is moved about; none where numbers have too few digits for them.
fn landmarks(projection: &Projection, distance: f64) -> Option<Vec<DVec3>> {
    let corners = [(0.5, 0.5), (0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0)];
    let depths = [0.5, 1.0, 2.0].into_iter();
    let places = depths.flat_map(|depth| corners.map(|corner| (depth, corner)));
    let point = |(depth, corner): (f64, (f64, f64))| {
        let corner = projection.size * DVec2::from(corner);
        let at = projection.at_depth(corner, depth * distance);
        let seen = projection.point(at)?;
        (seen.distance(corner) <= TOLERANCE).then_some(at)
    };
    places.map(point).collect()
}

/// How the scene before a drag is seen.
struct View<'a> {
    image: &'a Image,
    projection: Projection,
    drag: &'a Drag<'a>,
    /// The points of the world by which cameras, and boards, are compared.
    points: Vec<DVec3>,
}

impl View<'_> {
    /// The number of decimals of the greatest power of ten that moves what is held by no more than
    /// `step` pixels, and that `step`; none of what is not a handle's. Beyond the digits that
    /// numbers have, nothing snaps.
    fn snapped(&self, part: Part, changes: &[Change], step: f64) -> Option<(i32, f64)> {
        let held = |part: Part| {
            let mut marks = self.marks(part).into_iter();
            marks.find_map(|(is_held, at)| at.filter(|_| is_held))
        };
        let here = held(part).filter(|_| self.drag.object.is_some())?;
        let is_small = |decimals: &i32| {
            let parts = changes
                .iter()
                .flat_map(|change| change.with_unit(part, *decimals));
            let ways: Vec<f64> = parts
                .filter_map(|it| Some(held(it)?.distance(here)))
                .collect();
            !ways.is_empty() && ways.iter().all(|way| *way <= step)
        };
        Some(((-9..=12).find(is_small)?, step))
    }

    /// Whether everything in the picture or near to it, and what is held, is seen no farther than
    /// this from where it should be.
    fn agree(&self, ideal: Part, found: Part, tolerance: f64) -> bool {
        // With few digits a distance may have become 0.
        if ideal.is_possible() && !found.is_possible() {
            return false;
        }
        let size = self.projection.size;
        let mut marks = self.marks(ideal).into_iter().zip(self.marks(found));
        marks.all(|((is_held, ideal), (_, found))| {
            let Some(ideal) = ideal else {
                return !is_held;
            };
            let is_near = (ideal.cmpge(-size) & ideal.cmple(2.0 * size)).all();
            let agrees = found.is_some_and(|found| found.distance(ideal) <= tolerance);
            agrees || !(is_held || is_near)
        })
    }

    /// Where that is seen which tells a camera or an object from others, and whether it is what is
    /// held.
    fn marks(&self, part: Part) -> Vec<(bool, Option<DVec2>)> {
        let points = self.points.iter();
        match part {
            Part::Camera(camera) => {
                let projection = Projection::new(&camera, self.image);
                points.map(|at| (true, projection.point(*at))).collect()
            }
            // The handle of a board stays where the view axis meets it: what moves is the point
            // that it holds now.
            Part::Shape(Shape::Checkerboard(board)) => {
                let seen = |at: &DVec3| self.projection.point(at.with_y(board.y));
                points.map(|at| (true, seen(at))).collect()
            }
            Part::Shape(shape) => {
                let Drag { handle, to, .. } = *self.drag;
                // That of a radius is on the side where it is moved to.
                let towards = match handle {
                    "radius" => self.projection.ray(to),
                    _ => self.projection.right,
                };
                let seen = |at: Option<DVec3>| self.projection.point(at?);
                let handles = handles(&shape, &self.projection, towards).into_iter();
                handles
                    .map(|(name, at)| (name == handle, seen(at)))
                    .collect()
            }
            Part::Image(_) => Vec::new(),
        }
    }
}
