//! Converts shapes to JSON: the values of their fields and, for a triangle, its vertices.

use glam::DVec3;
use serde_json::{Value as Json, json};

use super::{Shape, Triangle};
use crate::schema::{self, TRIANGLE, Value};

impl Shape {
    /// Returns the members that describe the shape in the JSON output of `pinhole inspect`.
    /// `vertices` computes the vertices of a triangle.
    #[doc(hidden)]
    pub fn facts(
        &self,
        vertices: impl FnOnce(&Triangle) -> [DVec3; 3],
    ) -> Vec<(&'static str, Json)> {
        match *self {
            Self::Triangle(triangle) => vec![
                ("vertices", json!(vertices(&triangle).map(|v| v.to_array()))),
                (TRIANGLE.color.name, json(Value::Color(triangle.color))),
            ],
            mut shape @ (Self::Sphere(_) | Self::Box(_) | Self::Checkerboard(_)) => {
                let names = schema::of_kind(self.block_kind()).field_names();
                let facts = names.filter_map(|name| {
                    let field = shape.field_mut(name)?;
                    Some((name, json(field.value())))
                });
                facts.collect()
            }
        }
    }
}

/// Returns the value of a field as JSON.
fn json(value: Value) -> Json {
    match value {
        Value::Number(number) => json!(number),
        Value::Vector(vector) => json!(vector.to_array()),
        Value::Colors(colors) => json!(colors.map(|color| color.to_string())),
        Value::FaceColors(colors) => json!(colors.map(|color| color.to_string())),
        Value::Color(_) | Value::Angle(_) | Value::Method(_) => json!(value.to_string()),
    }
}
