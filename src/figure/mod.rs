//! Draws figures of scenes for teaching material, as SVG files that are the same on every machine.
//!
//! A figure shows one idea with few marks, and the label of each mark is beside the mark. The
//! figures use results of other modules: samples come from [`sampling`](crate::sampling), visible
//! objects from the tracer, outlines from the editor, and axes and angles from
//! [`inspect`](crate::inspect).
//!
//! Each kind of figure has a file. In addition, `canvas` writes the SVG and places labels, and
//! `outside` shows a scene from a point beside its camera.

mod camera;
mod canvas;
mod methods;
mod outside;
mod pixel;
mod roll;
mod triangle;

use crate::{
    scene::{Image, Scene, Shape, Triangle},
    suggest,
};

/// Kind of figure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Kind {
    /// The camera's eye, its window and one ray, seen from outside.
    Camera,
    /// A pixel with its samples and colours.
    Pixel,
    /// A triangle with its sides, centroid, normal and spin, i.e. its rotation in its plane.
    Triangle,
    /// The edge of the picture before and after the camera's roll.
    Roll,
    /// The sample points of all sampling methods in a pixel.
    Methods,
}

/// All kinds of figures with their names.
pub const KINDS: [(&str, Kind); 5] = [
    ("camera", Kind::Camera),
    ("pixel", Kind::Pixel),
    ("triangle", Kind::Triangle),
    ("roll", Kind::Roll),
    ("methods", Kind::Methods),
];

/// The pixel and the triangle that a figure shows. A field that is `None` is chosen automatically.
#[derive(Clone, Copy, Debug, Default)]
pub struct Choice<'a> {
    /// Column and row of the pixel, for the figures `camera`, `pixel` and `methods`. If it is
    /// `None`, the figure chooses a suitable pixel. The figure `methods` chooses the pixel (0, 0).
    pub pixel: Option<[u32; 2]>,
    /// Name of the triangle, for the figure `triangle`. If it is `None`, the scene's first triangle
    /// is drawn.
    pub object: Option<&'a str>,
}

/// Draws a figure of a scene. Returns the text of an SVG file.
///
/// # Errors
///
/// Returns a sentence for the user that says why this figure cannot be drawn.
///
/// # Panics
///
/// Panics if the scene breaks a condition of the language. Only a scene that was made in code can
/// do so. [`Scene::check`] finds such scenes.
pub fn figure(scene: &Scene, kind: Kind, choice: Choice<'_>) -> Result<String, String> {
    let Image { width, height, .. } = scene.image;
    match (choice.pixel, kind, choice.object) {
        (Some(_), Kind::Triangle | Kind::Roll, _) => {
            return Err("`--pixel` is for the figures camera, pixel and methods".to_owned());
        }
        (_, kind, Some(_)) if kind != Kind::Triangle => {
            return Err("`--object` is for the figure triangle".to_owned());
        }
        (Some([x, y]), ..) if x >= width || y >= height => {
            return Err(format!(
                "pixel {x},{y} lies outside of the picture: X goes from 0 to {}, Y from 0 to {}",
                width - 1,
                height - 1
            ));
        }
        _ => {}
    }
    match kind {
        Kind::Camera => Ok(camera::draw(scene, choice.pixel)),
        Kind::Pixel => pixel::draw(scene, choice.pixel),
        Kind::Triangle => Ok(triangle::draw(triangle_of(scene, choice.object)?)),
        Kind::Roll => Ok(roll::draw(scene)),
        Kind::Methods => methods::draw(scene, choice.pixel.unwrap_or_default()),
    }
}

/// Returns the triangle with the name `wanted`, or the scene's first triangle if `wanted` is
/// `None`.
fn triangle_of<'s>(scene: &'s Scene, wanted: Option<&str>) -> Result<&'s Triangle, String> {
    let objects = scene.objects.iter();
    let triangles = objects.filter_map(|object| match &object.shape {
        Shape::Triangle(triangle) => Some((object.name.as_deref().unwrap_or_default(), triangle)),
        _ => None,
    });
    let triangles: Vec<_> = triangles.collect();
    let Some(&(_, first)) = triangles.first() else {
        return Err("the scene has no triangle: draw camera, pixel, roll or methods, or add one, such as `triangle { centroid (0, 1, 0) normal (0, 0, 1) }`".to_owned());
    };
    let Some(wanted) = wanted else {
        return Ok(first);
    };
    let found = triangles.iter().find(|(name, _)| *name == wanted);
    found.map(|&(_, triangle)| triangle).ok_or_else(|| {
        let names = triangles.iter().map(|&(name, _)| name);
        match suggest::nearest(wanted, names) {
            Some(near) => format!("no triangle is named `{wanted}`: did you mean `{near}`?"),
            None => format!(
                "no triangle is named `{wanted}`: without `--object`, the first one is drawn"
            ),
        }
    })
}
