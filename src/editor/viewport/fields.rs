//! By how much the fields of an object or of the camera have to change.

use crate::{
    scene::{Part, Shape, operate},
    schema::Value,
    syntax::tree::{Block, Operator},
};

/// The fields that a drag may change.
const MOVABLE: [&str; 19] = [
    "eye",
    "lookat",
    "direction",
    "roll",
    "d",
    "fov",
    "hfov",
    "min",
    "max",
    "center",
    "radius",
    "size",
    "centroid",
    "normal",
    "spin",
    "v0",
    "v1",
    "v2",
    "y",
];

/// Those fields of a block that a drag may change, with their values.
pub fn movable(block: &Block<'_>, part: Part) -> Vec<(&'static str, Value)> {
    let by_corners = block.fields.iter().any(|field| field.name.text == "min");
    let is_other = |name| match (part, name) {
        (Part::Shape(Shape::Box(_)), "min" | "max") => !by_corners,
        (Part::Shape(Shape::Box(_)), "center" | "size") => by_corners,
        _ => false,
    };
    let names = MOVABLE.into_iter().filter(|name| !is_other(*name));
    names
        .filter_map(|name| Some((name, part.value(name)?)))
        .collect()
}

/// A field that has to change.
#[derive(Clone, Copy, Debug)]
pub struct Change {
    /// The field.
    pub name: &'static str,
    /// The value that it has.
    pub from: Value,
    /// The amount that is to be added to it.
    pub by: Value,
}

/// The fields in which another one differs from these.
pub fn changes(current: &[(&'static str, Value)], ideal: Part) -> Vec<Change> {
    let changes = current.iter().filter_map(|&(name, from)| {
        let by = operate(Operator::Subtract, ideal.value(name)?, from)?;
        Some(Change { name, from, by })
    });
    changes.filter(|change| change.size() != 0.0).collect()
}

impl Change {
    /// The greatest number in the amount; of an angle, in degrees.
    pub fn size(&self) -> f64 {
        match self.by {
            Value::Number(number) => number.abs(),
            Value::Vector(vector) => vector.abs().max_element(),
            Value::Angle(angle) => angle.in_degrees().abs(),
            _ => 0.0,
        }
    }
}
