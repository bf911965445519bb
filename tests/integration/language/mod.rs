//! What scenes mean, and the language's reference, held against the program.

mod conditions;
mod reference;
mod reports;
mod seen;
mod text;
mod values;

use pinhole::scene::{Object, Shape, Sphere};

use crate::{diagnostics, scenes::read, table::lines};

const CAMERA: &str = "camera { eye (0, 2, 8) lookat (0, 1, 0) }\n";

/// The codes of what is wrong with a scene, apart by blanks.
fn codes(text: &str) -> String {
    diagnostics::codes(text, &[]).join(" ")
}

/// Rows of a text, maybe what is set, and the codes of what is wrong. A camera, if the text has none, and a ball `S` stand below.
#[track_caller]
fn assert_codes(table: &'static str) {
    for row in lines(table) {
        let [text, sets @ .., expected] = &row[..] else {
            panic!("{row:?}");
        };
        let camera = if text.contains("camera {") {
            ""
        } else {
            CAMERA
        };
        let text = format!("{text}\n{camera}sphere S {{ center (0, 1, 0) }}");
        let sets = sets.iter().flat_map(|sets| sets.split("; "));
        let found = diagnostics::codes(&text, &sets.collect::<Vec<_>>());
        assert_eq!(found.join(" "), *expected, "{row:?}");
    }
}

/// The first object of a scene with a camera.
fn object(text: &str) -> Object {
    read(&format!("{CAMERA}{text}")).objects[0].clone()
}

fn sphere(fields: &str) -> Sphere {
    match object(&format!("sphere {{ {fields} }}")).shape {
        Shape::Sphere(sphere) => sphere,
        _ => unreachable!(),
    }
}

/// The x of a sphere's center: what an expression is.
fn number(expression: &str) -> f64 {
    sphere(&format!("center ({expression}, 0, 0)")).center.x
}
