//! A handle is moved: what has to change in the text.
//!
//! The object or the camera is moved first, in real numbers. Then the fields that differ are written to one decimal after another, until the text means
//! something that is seen within half a pixel of where it would be. It may not come to that: a text ties numbers to others, or breaks a condition of the language.

use glam::{DVec2, DVec3};

use super::{
    camera,
    edits::{Change, changes, edits},
    handles::{self, Along, TOLERANCE, handles},
    projection::Projection,
};
use crate::{
    diagnostic::{Diagnostic, Edit, Fix, apply},
    editor::Analysis,
    scene::{self, Camera, Part, Scene, Shape},
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
    let dragged = part(scene, drag.object).zip(block(analysis, scene, drag));
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
    let changes = changes(block, current, ideal);
    let greatest = changes.iter().map(Change::size).fold(0.0, f64::max);
    if !greatest.is_finite() || (drag.object.is_none() && !ideal.is_possible()) {
        return Err("that is too far away".to_owned());
    }
    if !view.agree(ideal, ideal) {
        return Err("it would not be seen there".to_owned());
    }
    if view.agree(ideal, current) {
        return Ok(Dragged::default());
    }
    // A text is read quickly without the other objects.
    let objects = scene.objects.iter().enumerate();
    let others = objects.filter(|(index, _)| Some(*index) != drag.object);
    let without_others: Vec<Edit> = others.map(|(_, it)| Edit::new(it.span, "")).collect();
    let tied = || "the text ties these numbers to others, or they have too few digits".to_owned();
    let mut refusal = tied();
    let first = -1 - libm::log10(greatest).floor() as i32;
    for decimals in first..=first + DIGITS {
        let edits = edits(analysis, block, &changes, decimals);
        let Some(edits) = edits.filter(|edits| !edits.is_empty()) else {
            continue;
        };
        let alone = read(analysis, [&edits, &without_others]);
        match alone.map(|scene| part(&scene, drag.object.map(|_| 0))) {
            Ok(Some(found)) if view.agree(ideal, found) => {
                // The others may depend on the same numbers.
                read(analysis, [&edits, &[]])?;
                let value = |change: &Change| {
                    let after = found.value(change.name)?;
                    let is_new = after != change.from;
                    is_new.then(|| format!("{name}.{} = {after}", change.name))
                };
                let values = changes.iter().filter_map(value).collect();
                return Ok(Dragged { edits, values });
            }
            Ok(_) => refusal = tied(),
            Err(why) => refusal = why,
        }
    }
    Err(refusal)
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

/// The scene that a text means after some edits.
fn read(analysis: &Analysis<'_>, edits: [&[Edit]; 2]) -> Result<Scene, String> {
    let source = analysis.source();
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
                    let is_held = name == self.drag.handle;
                    match ideal {
                        Some(ideal) if is_held || self.is_near(ideal) => are_near(ideal, found),
                        _ => !is_held,
                    }
                })
            }
            _ => false,
        }
    }

    /// Where the handles of an object are seen; that of a radius on the side where it is moved to.
    fn marks(&self, shape: &Shape) -> Vec<(&'static str, Option<DVec2>)> {
        let towards = match self.drag.handle {
            "radius" => self.projection.ray(self.drag.to),
            _ => self.projection.right,
        };
        let mut handles = handles(shape, &self.projection, towards);
        // The handle of a board stays where the view axis meets it: what moves is the point that it holds now.
        if let (Shape::Checkerboard(board), [(_, at)]) = (shape, &mut handles[..]) {
            *at = self.held().map(|at| at.with_y(board.y));
        }
        let seen = |at: DVec3| self.projection.point(at);
        handles
            .into_iter()
            .map(|(name, at)| (name, at.and_then(seen)))
            .collect()
    }

    /// Where the first handle of the dragged object is before the drag.
    fn held(&self) -> Option<DVec3> {
        let object = self.scene.objects.get(self.drag.object?)?;
        handles(&object.shape, &self.projection, DVec3::ZERO)
            .first()?
            .1
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
            points
                .into_iter()
                .all(|point| are_near(point, found.point(ideal.at_depth(point, depth))))
        })
    }
}

/// Whether something is seen within half a pixel of where it should be.
fn are_near(ideal: DVec2, found: Option<DVec2>) -> bool {
    found.is_some_and(|found| found.distance(ideal) <= TOLERANCE)
}
