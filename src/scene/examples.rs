//! Values that a field can have beside what else its block is given.
//!
//! A field's own example can be an error there: a corner of a box on the wrong side of the other
//! one, a camera that looks at its own eye. In: the field, and the values of the others. Out: a
//! value that fits them, as it is written.

use glam::DVec3;

use super::eval::literal;
use crate::{
    math::predicates,
    numbers,
    schema::{Field, Value},
};

/// A value that a field can have, given the values of the others in its block. Where none that is
/// tried fits, it is the field's own example.
pub fn example_beside(field: &Field, given: &dyn Fn(&str) -> Option<Value>) -> String {
    const POINTS: [&str; 7] = ["max", "min", "lookat", "eye", "v0", "v1", "v2"];
    const STEPS: [DVec3; 6] = [
        DVec3::NEG_Z,
        DVec3::X,
        DVec3::Y,
        DVec3::Z,
        DVec3::NEG_ONE,
        DVec3::ONE,
    ];
    let others = POINTS.iter().filter_map(|name| match given(name)? {
        // A direction is none from a point.
        _ if matches!(field.name, "direction" | "up") || *name == field.name => None,
        Value::Vector(point) => Some(point),
        _ => None,
    });
    // An eye looks along −z, and stands before what it looks at.
    let sign = if field.name == "eye" { -1.0 } else { 1.0 };
    let beside = others.chain([DVec3::ZERO]);
    let beside = beside.flat_map(|point| STEPS.map(|step| point + step * sign));
    let mut all =
        std::iter::once(field.example.to_owned()).chain(beside.map(numbers::short_vector));
    let fits = |text: &String| {
        let new = literal(text, field.takes);
        new.is_some() && fits(&|name| if name == field.name { new } else { given(name) })
    };
    match (field.name, given("near")) {
        ("far", Some(Value::Number(near))) if near >= 100.0 => numbers::short(near * 2.0),
        _ => all.find(fits).unwrap_or_else(|| field.example.to_owned()),
    }
}

/// Whether vectors of a block do not contradict each other, as far as they are known.
fn fits(given: &dyn Fn(&str) -> Option<Value>) -> bool {
    let vector = |name: &str| match given(name)? {
        Value::Vector(vector) => Some(vector),
        _ => None,
    };
    if let (Some(min), Some(max)) = (vector("min"), vector("max")) {
        return min.cmplt(max).all();
    }
    let view = match (vector("direction"), vector("eye"), vector("lookat")) {
        (Some(direction), _, _) => Some((DVec3::ZERO, direction)),
        (None, Some(eye), Some(lookat)) => Some((eye, lookat)),
        _ => None,
    };
    if let Some((from, to)) = view {
        let up = vector("up").unwrap_or(DVec3::Y);
        return !predicates::cross_is_zero(up, from, to);
    }
    let vertices = ["v0", "v1", "v2"].into_iter().filter_map(vector);
    match vertices.collect::<Vec<DVec3>>()[..] {
        [a, b] => a != b,
        [a, b, c] => !predicates::are_on_one_line([a, b, c]),
        _ => true,
    }
}
