//! Values that a field can have beside what else its block is given.
//!
//! A field's own example can be an error there: a corner of a box on the wrong side of the other one, a camera that looks at its own
//! eye. In: the field, and the values of the others. Out: a value that fits them, as it is written.

use glam::DVec3;

use super::{schema::Field, value::Value};
use crate::{math::predicates, numbers};

/// A value that a field can have, given the values of the others in its block. Where none that is tried fits, it is the field's own
/// example.
pub fn example_beside(field: &Field, given: &dyn Fn(&str) -> Option<Value>) -> String {
    let example = field.example();
    let vector = |name: &str| match given(name)? {
        Value::Vector(vector) => Some(vector),
        _ => None,
    };
    let first_of = |names: &[&str]| names.iter().find_map(|name| vector(name));
    // Beside what it can lie, and where.
    let (from, offsets) = match field.name {
        "far" => {
            return match given("near") {
                Some(Value::Number(near)) if near >= 100.0 => numbers::short(near * 2.0),
                _ => example,
            };
        }
        "min" => (vector("max"), [DVec3::NEG_ONE; 2]),
        "max" => (vector("min"), [DVec3::ONE; 2]),
        "eye" => (vector("lookat"), [DVec3::Z, DVec3::X]),
        "lookat" => (vector("eye"), [DVec3::NEG_Z, DVec3::X]),
        "direction" | "up" => (Some(DVec3::ZERO), [DVec3::NEG_Z, DVec3::X]),
        "v0" => (first_of(&["v1", "v2"]), [DVec3::Z, DVec3::X]),
        "v1" => (first_of(&["v0", "v2"]), [DVec3::X, DVec3::Y]),
        "v2" => (first_of(&["v0", "v1"]), [DVec3::Y, DVec3::Z]),
        _ => return example,
    };
    let Some(from) = from else { return example };
    let others = offsets.map(|offset| numbers::short_vector(from + offset));
    let fits = |text: &&String| {
        let with = |new| {
            move |name: &str| {
                if name == field.name {
                    Some(new)
                } else {
                    vector(name)
                }
            }
        };
        parsed(text).is_some_and(|new| fits(&with(new)))
    };
    let mut all = std::iter::once(&example).chain(&others);
    all.find(fits).unwrap_or(&example).clone()
}

/// Whether vectors of a block do not contradict each other, as far as they are known.
fn fits(vector: &dyn Fn(&str) -> Option<DVec3>) -> bool {
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

/// A vector of three numbers, as examples are written.
fn parsed(text: &str) -> Option<DVec3> {
    let inner = text.strip_prefix('(')?.strip_suffix(')')?;
    let mut parts = inner.split(", ").map(|part| part.parse().ok());
    let vector = DVec3::new(parts.next()??, parts.next()??, parts.next()??);
    vector.is_finite().then_some(vector)
}
