//! Changes the text when a handle in the picture is dragged.
//!
//! First, the object or the camera is moved with unrounded numbers; this is the ideal result. Then
//! the changed fields are written with more and more decimals, until the scene of the new text
//! agrees with the ideal one within half a pixel. This fails if fields share a number of the text,
//! or if the result would violate a condition of the language.

use std::{iter, sync::Arc};

use glam::{DVec2, DVec3};

use super::{
    camera,
    edits::{FieldChange, changes, edits, rounded, rounded_in_ratio},
    handles::{self, Along, TOLERANCE, TOO_FAR, handles, side_held},
    observer::Observer,
    outside::{camera_handles, moved_camera},
};
use crate::{
    diagnostic::{Diagnostic, Edit, Fix, apply},
    editor::Analysis,
    inspect,
    numbers::short,
    projection::Projection,
    scene::{self, FieldOwner, Image, Scene, Shape},
    schema::CAMERA,
    source::{Source, SourceId, Sources, Span},
    syntax::tree::Block,
};

/// Number of significant digits that identify every `f64`. More digits would not change the number,
/// so none are tried.
const DIGITS: i32 = 17;

/// A movement of a handle by the pointer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drag<'a> {
    /// Index of the dragged object in the scene; `None` if the camera is dragged.
    pub object: Option<usize>,
    /// Name of the handle, such as `center` or `orbit`.
    pub handle: &'a str,
    /// Position of the pointer at the previous step of the drag, in pixels. Only movements of the
    /// camera use it.
    pub from: DVec2,
    /// Current position of the pointer, in pixels.
    pub to: DVec2,
    /// Axis or plane along which the handle moves; `None` if it follows the pointer freely.
    pub along: Option<Along>,
    /// Maximum number of the picture's pixels by which the handle moves from one point of the grid
    /// to the next. The changed numbers are rounded to multiples of a power of ten: the largest one
    /// that moves the handle by at most this distance. `None` if the drag does not snap to a grid.
    pub step: Option<f64>,
    /// Second camera that looks at the scene from outside, if the pointer is in its picture; `None`
    /// if the pointer is in the picture of the scene's own camera.
    pub observer: Option<Observer>,
}

/// Changes of a text that a dragged handle causes. All lists are empty if the picture would not
/// change visibly.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Dragged {
    /// Edits of the text.
    pub edits: Vec<Edit>,
    /// New values of the changed fields of the dragged object or camera, such as `Ball.radius = 2`.
    pub values: Vec<String>,
    /// Names of other fields that change, too, because their values use the same numbers of the
    /// text. They are fields of other blocks, such as `camera.lookat`, or of other objects of the
    /// same repeated block.
    pub also: Vec<String>,
}

/// Returns the text of a scene in which the blocks of all objects except `object` are replaced by
/// blanks. `object` is `None` if the camera is dragged; the blocks of all objects are then
/// replaced. All offsets stay the same, but the text is analyzed faster.
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

/// Returns the spans of the blocks of all objects, except the block of `object`.
fn other_blocks(scene: &Scene, object: Option<usize>) -> impl Iterator<Item = Span> {
    let own = object
        .and_then(|index| scene.objects.get(index))
        .map(|it| it.span);
    let blocks = scene.objects.chunk_by(|one, next| one.span == next.span);
    let blocks = blocks.filter_map(|block| block.first()).map(|it| it.span);
    blocks.filter(move |span| Some(*span) != own)
}

/// Returns the edits of the text that move a handle as `drag` says. `alone` is the text without the
/// blocks of other objects; the function [`alone`] returns it.
///
/// # Errors
///
/// Returns a sentence that says why the handle cannot be moved in this way.
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
    let dragged = owner(scene, drag.object).zip(block(analysis, scene, drag));
    let (current, (block, name)) = dragged.ok_or_else(|| match drag.object {
        Some(index) => format!("there is no object {index}"),
        None => "the text has no camera".to_owned(),
    })?;
    let image = &scene.image;
    let projection = match drag.observer {
        Some(observer) => observer.projection(),
        None => Projection::new(&scene.camera, image),
    };
    let (ideal, points) = match current {
        FieldOwner::Shape(shape) => {
            let held = handles(&shape, &projection, DVec3::ZERO)[0].1;
            let ideal = handles::moved(shape, drag.handle, drag.to, drag.along, &projection)?;
            (ideal, Some(Vec::from_iter(held)))
        }
        FieldOwner::Camera(own) if drag.observer.is_some() => {
            let Drag {
                handle, to, along, ..
            } = *drag;
            let moved = moved_camera(&own, image, handle, to, along, &projection)?;
            (FieldOwner::Camera(moved), Some(Vec::new()))
        }
        _ => {
            let distance = camera::distance(scene);
            let (handle, by) = (drag.handle, [drag.from, drag.to]);
            let moved = camera::moved(&scene.camera, &projection, handle, by, distance)?;
            let seen = landmarks(&Projection::new(&moved, image), distance);
            (FieldOwner::Camera(moved), seen)
        }
    };
    let changes = changes(block, current, ideal);
    if !changes.iter().all(|change| change.by.is_finite()) {
        return Err(TOO_FAR.to_owned());
    }
    let not_seen = "it would not be seen there";
    let view = DragView {
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
    // Index of the dragged object among the objects of its block.
    let place = drag.object.map(|index| {
        let before = scene.objects.iter().take(index);
        before.filter(|it| it.span == block.span).count()
    });
    let refused = || shared_numbers(analysis, block, &name, &changes);
    let mut refusal = refused();
    let greatest = changes.iter().map(FieldChange::size).fold(0.0, f64::max);
    let first = -1 - libm::log10(greatest).floor() as i32;
    let snapped = drag
        .step
        .and_then(|step| view.snapped(current, &changes, step));
    let tolerance = snapped.map_or(TOLERANCE, |(_, step)| step);
    let first = snapped.map_or(first, |(decimals, _)| decimals);
    // Returns whether all fields that the drag should not change keep their exact values. This is
    // checked only for a drag on a grid. The tolerance of such a drag is a whole step of the grid.
    // A small change of another field, which may use the same number of the text, would be within
    // this tolerance.
    let keeps_others = |found: FieldOwner| {
        let mut fields = block.fields.iter().map(|field| field.name.text);
        let is_meant = |field: &str| changes.iter().any(|change| change.name == field);
        snapped.is_none()
            || fields.all(|field| is_meant(field) || found.value(field) == current.value(field))
    };
    for decimals in first..=first + DIGITS {
        let (changes, rounding) = rounded_in_ratio(&changes, decimals);
        let changes = &changes;
        let edits = edits(analysis, block, changes, &rounding);
        // If the drag snaps back to the old position, no edit is needed. An empty list of edits
        // does not always prove this. If a number of the text has another unit than the grid,
        // `decimals` may be too small to show its change. The old position is then compared with
        // the ideal one.
        let is_back = snapped.is_some() && rounded(current, changes, &rounding) == Some(current);
        let is_unchanged = snapped.is_some() && edits.as_ref().is_some_and(Vec::is_empty);
        if is_back || (is_unchanged && view.agree(ideal, current, tolerance)) {
            return Ok(Dragged::default());
        }
        let Some(edits) = edits.filter(|edits| !edits.is_empty()) else {
            continue;
        };
        let read_alone = read(analysis.source(), [&edits, &without_others]);
        match read_alone.map(|scene| (owner(&scene, place), scene)) {
            Ok((Some(found), after))
                if view.agree(ideal, found, tolerance) && keeps_others(found) =>
            {
                // If all edits are within the block, no other block changes. The whole text, which
                // may be long, then need not be read.
                let is_own = |edit: &Edit| {
                    block.span.start <= edit.span.start && edit.span.end <= block.span.end
                };
                let also = if edits.iter().all(is_own) {
                    others_changed(analysis, place, changes, [&scene_alone, &after])
                } else {
                    let after = read(&sources.file, [&edits, &[]])?;
                    others_changed(
                        &Analysis::new(sources),
                        drag.object,
                        changes,
                        [scene, &after],
                    )
                };
                let value = |change: &FieldChange| {
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
            Ok(_) => refusal = refused(),
            // If the rounded numbers are already within the tolerance, but the text has errors, the
            // search ends: more digits would not change the picture visibly.
            Err(why) => match rounded(current, changes, &rounding) {
                Some(rounded) if view.agree(ideal, rounded, tolerance) => return Err(why),
                _ => refusal = why,
            },
        }
    }
    Err(refusal)
}

/// Describes the field of view of a camera in several forms, such as degrees. Returns `None` if no
/// field that determines the field of view has changed.
fn lens(image: &Image, changes: &[FieldChange], found: FieldOwner) -> Option<String> {
    // Names of the fields that determine the field of view.
    const LENS: [&str; 4] = [
        CAMERA.d.name,
        CAMERA.fov.name,
        CAMERA.hfov.name,
        CAMERA.view_height.name,
    ];
    let is_lens = |change: &FieldChange| LENS.contains(&change.name);
    let (FieldOwner::Camera(camera), true) = (found, changes.iter().any(is_lens)) else {
        return None;
    };
    let (seen, _) = inspect::inspect_camera(&camera, image);
    let (d, fov, high) = (short(seen.d), seen.fov_deg, short(camera.view_height));
    Some(format!("d {d} = fov {fov:.1}° of a window {high} high"))
}

/// Returns the message that a field cannot be changed because it shares numbers with other fields.
/// The message says how the author can change the text first.
fn shared_numbers(
    analysis: &Analysis<'_>,
    block: &Block<'_>,
    name: &str,
    changes: &[FieldChange],
) -> String {
    let Some(change) = changes.first() else {
        return TOO_FAR.to_owned();
    };
    let field = change.name;
    let written = block.fields.iter().find(|it| it.name.text == field);
    let line = analysis.line(written.map_or(block.span, |field| field.span));
    let value = change.from;
    format!(
        "`{name}.{field}` in line {line} cannot take that value, because it shares numbers with other fields: write its own numbers there, as in `{field} {value}`"
    )
}

/// Returns the shape of the object with the index `object`, or the camera if `object` is `None`.
/// Returns `None` if there is no such object.
fn owner(scene: &Scene, object: Option<usize>) -> Option<FieldOwner> {
    Some(match object {
        None => FieldOwner::Camera(scene.camera),
        Some(index) => FieldOwner::Shape(scene.objects.get(index)?.shape),
    })
}

/// Returns the block of the dragged object or camera, and its name for messages. Returns `None` if
/// the text has no such block.
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

/// Compares two scenes with the same blocks. Returns the names of the fields, such as
/// `camera.lookat`, whose values differ. Leaves out the dragged object itself. For other objects of
/// its block, compares only the fields in `changes`.
fn others_changed(
    analysis: &Analysis<'_>,
    dragged: Option<usize>,
    changes: &[FieldChange],
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
        let of_block: Vec<_> = if kind.text == "camera" {
            vec![None]
        } else {
            (first..next).map(Some).collect()
        };
        let others = of_block.into_iter().filter(|index| *index != dragged);
        let parts = others.map(|index| scenes.map(|scene| owner(scene, index)));
        let parts: Vec<_> = parts.collect();
        let name = block.name.map_or(kind.text, |name| name.text);
        let is_dragged = dragged.is_some_and(|index| (first..next).contains(&index));
        let fields: Vec<&str> = if is_dragged {
            changes.iter().map(|change| change.name).collect()
        } else {
            block.fields.iter().map(|it| it.name.text).collect()
        };
        let differ = fields.into_iter().filter(|field| {
            let differs = |[before, after]: &[Option<FieldOwner>; 2]| match (before, after) {
                (Some(before), Some(after)) => before.value(field) != after.value(field),
                _ => false,
            };
            parts.iter().any(differs)
        });
        changed.extend(differ.map(|field| format!("{name}.{field}")));
    }
    changed
}

/// Applies two lists of edits to the text of `source`, and returns the scene of the result. Returns
/// a message if the changed text has errors.
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

/// Returns 15 points in space that the camera sees in the middle and in the corners of its picture.
/// In each of these five directions, the points have 0.5, 1 and 2 times the depth `distance`.
/// Returns `None` if an `f64` has too few digits to place a point within [`TOLERANCE`].
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

/// Compares possible results of a drag by their appearance in the picture.
struct DragView<'a> {
    image: &'a Image,
    projection: Projection,
    drag: &'a Drag<'a>,
    /// Points in space by which two results of the drag are compared: for a checkerboard, and for
    /// the camera if it is dragged in its own picture. Two results agree if these points appear at
    /// nearly equal places of the picture.
    points: Vec<DVec3>,
}

impl DragView<'_> {
    /// Returns the number of decimals to which the drag rounds numbers, and the tolerance of the
    /// drag in pixels, which is `step`. The number of decimals is the smallest with which a change
    /// of the last decimal by one moves the handle by at most `step` pixels. Returns `None` if 12
    /// decimals do not suffice, or if the camera is dragged in its own picture, where it has no
    /// handles.
    fn snapped(&self, owner: FieldOwner, changes: &[FieldChange], step: f64) -> Option<(i32, f64)> {
        let held = |owner: FieldOwner| {
            let mut marks = self.marks(owner).into_iter();
            marks.find_map(|(is_held, at)| at.filter(|_| is_held))
        };
        let has_handles = self.drag.object.is_some() || self.drag.observer.is_some();
        let here = held(owner).filter(|_| has_handles)?;
        let is_small = |decimals: &i32| {
            let parts = changes
                .iter()
                .flat_map(|change| change.with_unit(owner, *decimals));
            let ways: Vec<f64> = parts
                .filter_map(|it| Some(held(it)?.distance(here)))
                .collect();
            !ways.is_empty() && ways.iter().all(|way| *way <= step)
        };
        Some(((-9..=12).find(is_small)?, step))
    }

    /// Returns whether the states `ideal` and `found` of the dragged object or camera look alike,
    /// i.e. whether all points that [`Self::marks`] returns for them are at the same places within
    /// `tolerance` pixels. Points far outside of the picture are ignored unless the pointer drags
    /// them. Returns `false` if `found`, unlike `ideal`, breaks a condition of the language.
    fn agree(&self, ideal: FieldOwner, found: FieldOwner, tolerance: f64) -> bool {
        // A length that was rounded to few digits may have become 0, which the language forbids.
        // Such a result is rejected even if it looks alike.
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

    /// Returns the points of the picture by which two states of the dragged object or camera are
    /// compared. They depend on what is dragged:
    ///
    /// - the camera in its own picture: the images of `self.points`;
    /// - a checkerboard: the images of the board's points above or below `self.points`;
    /// - anything else: its handles.
    ///
    /// The flag is true for a point that the pointer drags: the dragged handle, or every point of a
    /// camera in its own picture or of a checkerboard. The position is `None` if the point is not
    /// visible, for example because it is behind the eye.
    fn marks(&self, owner: FieldOwner) -> Vec<(bool, Option<DVec2>)> {
        let points = self.points.iter();
        match owner {
            FieldOwner::Camera(camera) if self.drag.observer.is_some() => {
                let handles = camera_handles(&camera, self.image).into_iter();
                let seen = |(name, at)| (name == self.drag.handle, self.projection.point(at));
                handles.map(seen).collect()
            }
            FieldOwner::Camera(camera) => {
                let projection = Projection::new(&camera, self.image);
                points.map(|at| (true, projection.point(*at))).collect()
            }
            // The handle of a checkerboard always appears in the middle of the picture, so it does
            // not show the board's height. Fixed points of the board are compared instead.
            FieldOwner::Shape(Shape::Checkerboard(board)) => {
                let seen = |at: &DVec3| self.projection.point(at.with_y(board.y));
                points.map(|at| (true, seen(at))).collect()
            }
            FieldOwner::Shape(shape) => {
                let Drag { handle, to, .. } = *self.drag;
                let towards = side_held(&shape, handle, to, &self.projection);
                let seen = |at: Option<DVec3>| self.projection.point(at?);
                let handles = handles(&shape, &self.projection, towards).into_iter();
                handles
                    .map(|(name, at)| (name == handle, seen(at)))
                    .collect()
            }
            FieldOwner::Image(_) => Vec::new(),
        }
    }
}
