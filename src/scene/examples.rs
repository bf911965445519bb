//! Finds an example value for a field of a block. The example does not contradict the other fields
//! of the block. The schema's example might contradict another field: a corner of a box may be on
//! the wrong side of the other corner, or a camera may look at its own eye.
//!
//! In: the field, and the values of the other fields. Out: a value in the language's notation.

use glam::DVec3;

use super::eval::literal;
use crate::{
    math::predicates,
    numbers,
    schema::{BOX, CAMERA, FieldRow, TRIANGLE, Value},
};

/// Returns an example for `field` that does not contradict the values of the other fields. `given`
/// returns the value of a field by its name. If every value that is tried contradicts another
/// field, returns the schema's example.
pub fn example_beside(field: &FieldRow, given: &dyn Fn(&str) -> Option<Value>) -> String {
    // Names of the fields that contain points. If the schema's example for `field` contradicts the
    // other fields, points near the values of these fields are tried, then points near the origin.
    const POINTS: [&str; 7] = [
        BOX.max.name,
        BOX.min.name,
        CAMERA.lookat.name,
        CAMERA.eye.name,
        TRIANGLE.v0.name,
        TRIANGLE.v1.name,
        TRIANGLE.v2.name,
    ];
    const DIRECTIONS: [&str; 2] = [CAMERA.direction.name, CAMERA.up.name];
    // Differences between a given point and the examples near it, in the order in which they are
    // tried.
    const STEPS: [DVec3; 6] = [
        DVec3::NEG_Z,
        DVec3::X,
        DVec3::Y,
        DVec3::Z,
        DVec3::NEG_ONE,
        DVec3::ONE,
    ];
    let others = POINTS.iter().filter_map(|name| match given(name)? {
        // The field's own value is left out. If the field is a direction, all points are left out,
        // so only steps from the origin are tried.
        _ if DIRECTIONS.contains(&field.name) || *name == field.name => None,
        Value::Vector(point) => Some(point),
        _ => None,
    });
    // Each example that is tried is the sum of a point and a step in `STEPS`. The first step is −z,
    // the direction in which a camera usually looks, i.e. from `eye` to `lookat`. An example of
    // `eye` should lie on the opposite side of `lookat`, so the steps are then subtracted.
    let sign = if field.name == CAMERA.eye.name {
        -1.0
    } else {
        1.0
    };
    let beside = others.chain([DVec3::ZERO]);
    let beside = beside.flat_map(|point| STEPS.map(|step| point + step * sign));
    let mut all =
        std::iter::once(field.example.to_owned()).chain(beside.map(numbers::short_vector));
    let fits = |text: &String| {
        let new = literal(text, field.takes);
        new.is_some() && fits(&|name| if name == field.name { new } else { given(name) })
    };
    match given(CAMERA.near.name) {
        Some(Value::Number(near)) if field.name == CAMERA.far.name && near >= 100.0 => {
            numbers::short(near * 2.0)
        }
        _ => all.find(fits).unwrap_or_else(|| field.example.to_owned()),
    }
}

/// Returns whether the given vectors of a block do not contradict each other. Missing vectors are
/// ignored.
fn fits(given: &dyn Fn(&str) -> Option<Value>) -> bool {
    let vector = |name: &str| match given(name)? {
        Value::Vector(vector) => Some(vector),
        _ => None,
    };
    if let (Some(min), Some(max)) = (vector(BOX.min.name), vector(BOX.max.name)) {
        return min.cmplt(max).all();
    }
    let direction = vector(CAMERA.direction.name);
    let view = match (
        direction,
        vector(CAMERA.eye.name),
        vector(CAMERA.lookat.name),
    ) {
        (Some(direction), _, _) => Some((DVec3::ZERO, direction)),
        (None, Some(eye), Some(lookat)) => Some((eye, lookat)),
        _ => None,
    };
    if let Some((from, to)) = view {
        let up = vector(CAMERA.up.name).unwrap_or(DVec3::Y);
        return !predicates::cross_is_zero(up, from, to);
    }
    let vertices = [TRIANGLE.v0, TRIANGLE.v1, TRIANGLE.v2].into_iter();
    let vertices = vertices.filter_map(|vertex| vector(vertex.name));
    match vertices.collect::<Vec<DVec3>>()[..] {
        [a, b] => a != b,
        [a, b, c] => !predicates::are_on_one_line([a, b, c]),
        _ => true,
    }
}
