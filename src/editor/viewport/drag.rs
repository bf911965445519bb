//! A handle is moved: what has to change in the text.
//!
//! The object or the camera is moved first, in real numbers. Then the fields that differ are rounded to one decimal after another, until everything is seen within
//! half a pixel of where it would be. The text with these numbers is read once: it may tie them to others, or break a condition of the language.

use glam::{DVec2, DVec3};

use super::{
    camera,
    edits::edits,
    fields::{changes, movable},
    handles::{self, Along, TOLERANCE, handles, outline_point},
    projection::Projection,
};
use crate::{
    diagnostic::{Diagnostic, Edit, Fix, apply},
    editor::Analysis,
    scene::{self, Camera, Part, Scene, Shape},
    schema::Value,
    source::{Source, SourceId, Sources},
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
}

/// What has to change in the text, and what becomes of the fields that do; nothing at all where nobody would see it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Dragged {
    /// The changes.
    pub edits: Vec<Edit>,
    /// The fields with their new values, as `Ball.radius = 2`.
    pub values: Vec<String>,
}

/// What has to change in a text that means a scene where a handle is moved.
///
/// # Errors
///
/// Why it cannot be done, in a sentence.
pub fn drag(analysis: &Analysis<'_>, scene: &Scene, drag: &Drag<'_>) -> Result<Dragged, String> {
    if !(drag.from.is_finite() && drag.to.is_finite()) {
        return Err("the pointer is nowhere".to_owned());
    }
    let dragged = part(scene, drag).zip(block(analysis, scene, drag));
    let (current, (block, name)) = dragged.ok_or_else(|| match drag.object {
        Some(index) => format!("there is no object {index}"),
        None => "the text has no camera".to_owned(),
    })?;
    let view = Viewpoint {
        scene,
        projection: Projection::new(&scene.camera, &scene.image),
        drag,
        // An object moves without it.
        distance: drag.object.map_or_else(|| camera::distance(scene), |_| 1.0),
    };
    let ideal = view.moved(current)?;
    let fields = movable(block, current);
    let is_finite = |field: &(&str, Value)| ideal.value(field.0).is_some_and(|it| it.is_finite());
    if !fields.iter().all(is_finite) || (drag.object.is_none() && !ideal.is_possible()) {
        return Err("that is too far away".to_owned());
    }
    if !view.agree(ideal, ideal) {
        return Err("it would not be seen there".to_owned());
    }
    if view.agree(ideal, current) {
        return Ok(Dragged::default());
    }
    let changes = changes(&fields, ideal);
    let edits = |decimals| edits(analysis, block, current, &changes, decimals);
    let is_near = |(_, part): &(Vec<Edit>, Part)| part.is_possible() && view.agree(ideal, *part);
    let greatest = changes.iter().map(|change| change.size());
    let first = -1 - libm::log10(greatest.fold(0.0, f64::max)).floor() as i32;
    let tied = || "the text ties these numbers to others, or they have too few digits".to_owned();
    let (edits, _) = (first..first + DIGITS)
        .filter_map(edits)
        .find(is_near)
        .or_else(|| edits(first + DIGITS))
        .ok_or_else(tied)?;
    let found = part(&read(analysis, &edits)?, drag);
    let found = found.filter(|found| view.agree(ideal, *found));
    let found = found.ok_or_else(tied)?;
    let values = fields.into_iter().filter_map(|(field, before)| {
        let after = found.value(field).filter(|after| *after != before)?;
        Some(format!("{name}.{field} = {after}"))
    });
    Ok(Dragged {
        values: values.collect(),
        edits,
    })
}

/// What is dragged: the camera or an object; none if there is no such object.
fn part(scene: &Scene, drag: &Drag<'_>) -> Option<Part> {
    Some(match drag.object {
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

/// The scene that a text means after some edits.
fn read(analysis: &Analysis<'_>, edits: &[Edit]) -> Result<Scene, String> {
    let source = analysis.source();
    let text = apply(
        &Fix::new("", edits.iter().cloned()),
        SourceId::File,
        source.text(),
    );
    let reading = scene::read(&Sources::new(Source::from_text(source.name(), text)));
    let mut diagnostics = reading.diagnostics.iter();
    reading.scene.ok_or_else(|| {
        let error = diagnostics.find(|diagnostic| Diagnostic::is_error(diagnostic));
        let why = error.map_or("", |error| error.message.as_str());
        format!("the scene would not be right any more: {why}")
    })
}

/// From where a drag is seen.
struct Viewpoint<'a> {
    scene: &'a Scene,
    projection: Projection,
    drag: &'a Drag<'a>,
    /// How far away that is which the camera is moved about.
    distance: f64,
}

impl Viewpoint<'_> {
    /// The object or the camera as it is moved, in real numbers.
    fn moved(&self, current: Part) -> Result<Part, String> {
        let Drag {
            handle,
            from,
            to,
            along,
            ..
        } = *self.drag;
        let projection = &self.projection;
        Ok(match current {
            Part::Shape(shape) => {
                Part::Shape(handles::moved(&shape, handle, to, along, projection)?)
            }
            Part::Camera(camera) => {
                let points = [from, to];
                let moved = camera::moved(&camera, projection, handle, points, self.distance)?;
                Part::Camera(moved)
            }
            Part::Image(_) => current,
        })
    }

    /// Whether everything is seen within half a pixel of where it should be.
    fn agree(&self, ideal: Part, found: Part) -> bool {
        match (ideal, found) {
            (Part::Camera(ideal), Part::Camera(found)) => self.cameras_agree(&ideal, &found),
            (Part::Shape(ideal), Part::Shape(found)) => {
                let marks = self.marks(&ideal).into_iter().zip(self.marks(&found));
                marks.into_iter().all(|((name, ideal), (_, found))| {
                    let is_seen = |at: &DVec2| self.is_near(*at) || name == self.drag.handle;
                    match (ideal.filter(is_seen), found) {
                        (None, _) => name != self.drag.handle,
                        (Some(ideal), Some(found)) => ideal.distance(found) <= TOLERANCE,
                        (Some(_), None) => false,
                    }
                })
            }
            _ => false,
        }
    }

    /// Where the handles of an object are seen; that of a radius on the side where it is moved to.
    fn marks(&self, shape: &Shape) -> Vec<(&'static str, Option<DVec2>)> {
        let mut handles = handles(shape, &self.projection);
        if let (Shape::Sphere(sphere), "radius", [_, radius]) =
            (shape, self.drag.handle, &mut handles[..])
        {
            let towards = self.projection.ray(self.drag.to);
            radius.at = outline_point(sphere, self.projection.eye, towards);
        }
        // The handle of a board stays where the view axis meets it: what moves is the point that it holds now.
        if let (Shape::Checkerboard(board), [y]) = (shape, &mut handles[..]) {
            y.at = self.held().map(|at| at.with_y(board.y));
        }
        let seen = |at: Option<DVec3>| at.and_then(|at| self.projection.point(at));
        handles
            .into_iter()
            .map(|it| (it.name, seen(it.at)))
            .collect()
    }

    /// Where the first handle of the dragged object is before the drag.
    fn held(&self) -> Option<DVec3> {
        let object = self.scene.objects.get(self.drag.object?)?;
        handles(&object.shape, &self.projection).first()?.at
    }

    /// Whether a point lies in the picture, or so near to it that it may come to be seen.
    fn is_near(&self, at: DVec2) -> bool {
        let size = self.projection.size;
        (at.cmpge(-size) & at.cmple(2.0 * size)).all()
    }

    /// Whether what one camera sees in the middle and in the corners, before and behind what it is moved about, is seen by the other at the same points.
    fn cameras_agree(&self, ideal: &Camera, found: &Camera) -> bool {
        let [ideal, found] =
            [ideal, found].map(|camera| Projection::new(camera, &self.scene.image));
        let size = ideal.size;
        let points = [
            size / 2.0,
            DVec2::ZERO,
            size,
            DVec2::new(size.x, 0.0),
            DVec2::new(0.0, size.y),
        ];
        let mut depths = [0.5, 1.0, 2.0].map(|part| part * self.distance).into_iter();
        depths.all(|depth| {
            points.into_iter().all(|point| {
                let seen = found.point(ideal.at_depth(point, depth));
                seen.is_some_and(|seen| seen.distance(point) <= TOLERANCE)
            })
        })
    }
}
