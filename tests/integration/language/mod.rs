//! What scenes mean, and the language's reference, held against the program.

mod conditions;
mod consequences;
mod reference;
mod reports;
mod seen;
mod text;
mod values;

use pinhole::{
    color::Color,
    scene::{self, Camera, Shape, Sphere},
};

use crate::scenes::{read, sources};

const CAMERA: &str = "camera { eye (0, 2, 8) lookat (0, 1, 0) }\n";

/// The codes of a scene's diagnostics, without `pinhole::`.
fn codes(text: &str) -> Vec<String> {
    let found = scene::read(&sources(text)).diagnostics;
    let code = |code: String| code.replace("pinhole::", "");
    found
        .into_iter()
        .map(|diagnostic| code(diagnostic.code))
        .collect()
}

/// The camera of a scene with one sphere.
fn camera(fields: &str) -> Camera {
    read(&format!(
        "camera {{ {fields} }} sphere {{ center (0, 0, 0) }}"
    ))
    .camera
}

/// The x of a sphere's center: what an expression is.
fn number(expression: &str) -> f64 {
    let scene = read(&format!(
        "{CAMERA} sphere {{ center ({expression}, 0, 0) }}"
    ));
    match scene.objects[0].shape {
        Shape::Sphere(Sphere { center, .. }) => center.x,
        _ => unreachable!(),
    }
}

fn color(expression: &str) -> Color {
    let scene = read(&format!(
        "{CAMERA} sphere {{ center (0, 0, 0) color {expression} }}"
    ));
    match scene.objects[0].shape {
        Shape::Sphere(Sphere { color, .. }) => color,
        _ => unreachable!(),
    }
}
