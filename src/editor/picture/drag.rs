//! A handle is moved: what has to change in the text.
//!
//! The object or the camera is moved first, in real numbers. Then the fields that differ are written with one decimal after another, until everything is seen
//! within half a pixel of where it would be. What comes of that is read as a scene before it is proposed, since the text may tie numbers together.

use glam::{DVec2, DVec3};

use super::{
    edits::{Writer, degrees, exponent},
    fields::Subject,
    handles::{self, Along, TOLERANCE, handles, outline_point, unit},
    motions,
    projection::Projection,
};
use crate::{
    diagnostic::{Diagnostic, Edit, Fix, apply},
    editor::Analysis,
    math::Angle,
    probe::probe,
    scene::{self, Camera, Scene, Shape, View},
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

/// What has to change in the text, and what becomes of the fields that do.
#[derive(Clone, Debug, PartialEq)]
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
    let projection = Projection::new(&scene.camera, &scene.image);
    let (block, name) = block(analysis, scene, drag)?;
    let by_corners = block.fields.iter().any(|field| field.name.text == "min");
    let current = subject(scene, drag, by_corners)?;
    let view = Sight {
        scene,
        projection,
        drag,
        distance: distance(scene, drag),
    };
    let ideal = view.moved(&current)?;
    let changes = changes(&current, &ideal);
    if !(ideal.is_possible() && changes.iter().all(|(.., by)| by.is_finite())) {
        return Err("that is too far away".to_owned());
    }
    if !view.agree(&ideal, &ideal) {
        return Err("it would not be seen there".to_owned());
    }
    let written = |decimals| {
        let mut writer = Writer::new(analysis, decimals);
        let changed = writer.change(block, &changes);
        let fields = changes.iter().zip(changed);
        let fields = fields.map(|(&(name, from, _), by)| (name, sum(from, by)));
        let fields: Vec<(&'static str, Value)> = fields.collect();
        (writer.finish(), fields)
    };
    // Where the change is so small that nobody sees it, it has no digit at all.
    let first = -2 - exponent(changes.iter().map(|(.., by)| size(*by)).fold(0.0, f64::max));
    let mut decimals = first..=first + DIGITS + 2;
    let good = |decimals: &i32| {
        let (_, fields) = written(*decimals);
        view.agree(&ideal, &current.with(&fields))
    };
    let decimals = decimals.find(good).unwrap_or(first + DIGITS + 2);
    let (edits, fields) = written(decimals);
    let tied = || "the text ties these numbers to others, and they cannot change alone".to_owned();
    let edits = edits.ok_or_else(tied)?;
    let found = subject(&read(analysis, &edits)?, drag, by_corners)?;
    if !view.agree(&ideal, &found) {
        return Err(match view.agree(&ideal, &current.with(&fields)) {
            true => tied(),
            false => "numbers have too few digits to show it there".to_owned(),
        });
    }
    let before = current.fields();
    let fields = fields.into_iter().filter(|field| !before.contains(field));
    let values = fields.map(|(field, value)| format!("{name}.{field} = {value}"));
    Ok(Dragged {
        values: values.collect(),
        edits,
    })
}

/// The block of the text that is to change, and what it is called.
fn block<'a, 's>(
    analysis: &'a Analysis<'s>,
    scene: &Scene,
    drag: &Drag<'_>,
) -> Result<(&'a Block<'s>, String), String> {
    let mut blocks = analysis.blocks();
    let (block, name) = match drag.object {
        None => {
            let is_camera = |block: &&Block<'_>| block.kind.is_some_and(|it| it.text == "camera");
            (blocks.find(is_camera), "camera".to_owned())
        }
        Some(index) => {
            let object = scene.objects.get(index);
            let object = object.ok_or_else(|| format!("there is no object {index}"))?;
            let name = object.name.clone();
            let name = name.unwrap_or_else(|| object.shape.kind().to_owned());
            (blocks.find(|block| block.span == object.span), name)
        }
    };
    let block = block.ok_or_else(|| format!("the text has no block for the {name}"))?;
    Ok((block, name))
}

fn subject(scene: &Scene, drag: &Drag<'_>, by_corners: bool) -> Result<Subject, String> {
    let Some(index) = drag.object else {
        return Ok(Subject::Camera(scene.camera));
    };
    let object = scene.objects.get(index);
    let object = object.ok_or_else(|| format!("there is no object {index}"))?;
    let shape = object.shape;
    Ok(Subject::Object { shape, by_corners })
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

/// How far away that is which the camera is moved about: `lookat`, or else what is seen in the middle of the picture, or the nearest object.
fn distance(scene: &Scene, drag: &Drag<'_>) -> f64 {
    let eye = scene.camera.eye;
    match (scene.camera.view, drag.object) {
        (View::Lookat(point), _) => unit(point - eye).1,
        (View::Direction(_), None) => {
            let (width, height) = (scene.image.width, scene.image.height);
            let middle = DVec2::new(f64::from(width), f64::from(height)) / 2.0;
            let seen = probe(scene, middle).hits.into_iter();
            let seen = seen.map(|(hit, ..)| hit).find(|hit| hit.visible);
            let nearest = || {
                let distances = scene
                    .objects
                    .iter()
                    .map(|object| unit(center(&object.shape, eye) - eye).1);
                distances
                    .filter(|distance| *distance > 0.0)
                    .reduce(f64::min)
            };
            seen.map(|hit| hit.t).or_else(nearest).unwrap_or(1.0)
        }
        // An object moves without it.
        (View::Direction(_), Some(_)) => 1.0,
    }
}

fn center(shape: &Shape, eye: DVec3) -> DVec3 {
    match shape {
        Shape::Sphere(sphere) => sphere.center,
        Shape::Triangle(triangle) => triangle.outline.centroid(),
        Shape::Box(cuboid) => cuboid.min.midpoint(cuboid.max),
        Shape::Checkerboard(board) => eye.with_y(board.y),
    }
}

/// The fields that differ: what they are, and by how much they have to change.
fn changes(current: &Subject, ideal: &Subject) -> Vec<(&'static str, Value, Value)> {
    let pairs = current.fields().into_iter().zip(ideal.fields());
    let changes = pairs.map(|((name, from), (_, to))| (name, from, difference(to, from)));
    changes.filter(|(.., by)| size(*by) != 0.0).collect()
}

fn difference(to: Value, from: Value) -> Value {
    match (to, from) {
        (Value::Number(to), Value::Number(from)) => Value::Number(to - from),
        (Value::Vector(to), Value::Vector(from)) => Value::Vector(to - from),
        (Value::Angle(to), Value::Angle(from)) => {
            Value::Angle(Angle::from_degrees(degrees(to) - degrees(from)))
        }
        (to, _) => to,
    }
}

fn sum(from: Value, by: Value) -> Value {
    match (from, by) {
        (Value::Number(from), Value::Number(by)) => Value::Number(from + by),
        (Value::Vector(from), Value::Vector(by)) => Value::Vector(from + by),
        (Value::Angle(from), Value::Angle(by)) => Value::Angle(from + by),
        (from, _) => from,
    }
}

/// The greatest number in a value; of an angle, in degrees.
fn size(value: Value) -> f64 {
    match value {
        Value::Number(number) => number.abs(),
        // A part that is not a number makes the whole not one.
        Value::Vector(v) => v
            .to_array()
            .into_iter()
            .map(f64::abs)
            .fold(0.0, |a, b| if a > b { a } else { b }),
        Value::Angle(angle) => degrees(angle).abs(),
        _ => 0.0,
    }
}

/// How a drag is seen.
struct Sight<'a> {
    scene: &'a Scene,
    projection: Projection,
    drag: &'a Drag<'a>,
    distance: f64,
}

impl Sight<'_> {
    /// The object or the camera as it is moved, in real numbers.
    fn moved(&self, current: &Subject) -> Result<Subject, String> {
        let Drag {
            handle,
            from,
            to,
            along,
            ..
        } = *self.drag;
        let projection = &self.projection;
        Ok(match current {
            Subject::Camera(camera) => {
                let points = [from, to];
                let moved = motions::moved(camera, projection, handle, points, self.distance)?;
                Subject::Camera(moved)
            }
            Subject::Object { shape, by_corners } => Subject::Object {
                shape: handles::moved(shape, handle, to, along, projection)?,
                by_corners: *by_corners,
            },
        })
    }

    /// Whether everything is seen within half a pixel of where it should be.
    fn agree(&self, ideal: &Subject, found: &Subject) -> bool {
        match (ideal, found) {
            _ if !found.is_possible() => false,
            (Subject::Camera(ideal), Subject::Camera(found)) => self.cameras_agree(ideal, found),
            (Subject::Object { shape: ideal, .. }, Subject::Object { shape: found, .. }) => {
                let marks = self.marks(ideal).into_iter().zip(self.marks(found));
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
