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
    let fitting = match field.name {
        "min" => vector("max").and_then(|max| corner(max, -1.0)),
        "max" => vector("min").and_then(|min| corner(min, 1.0)),
        "far" => match given("near") {
            Some(Value::Number(near)) => beyond(&example, near),
            _ => None,
        },
        "eye" | "lookat" | "direction" | "up" => looking(field, &example, &vector),
        "v0" | "v1" | "v2" => vertex(field.name, &vector),
        _ => None,
    };
    fitting.unwrap_or(example)
}

/// A corner of a box 1 away from the other one on every axis; none so far from the origin that 1 is lost in rounding.
fn corner(other: DVec3, away: f64) -> Option<String> {
    let text = numbers::short_vector(other + away);
    let offset = (parsed(&text)? - other) * away;
    offset.cmpgt(DVec3::ZERO).all().then_some(text)
}

/// A number beyond another one.
fn beyond(example: &str, near: f64) -> Option<String> {
    let texts = [example.to_owned(), numbers::short(near * 2.0)];
    let is_beyond = |text: &String| {
        let far: Option<f64> = text.parse().ok();
        far.is_some_and(|far| far.is_finite() && far > near)
    };
    texts.into_iter().find(is_beyond)
}

/// A vector of the camera with which it looks somewhere, and not along up.
fn looking(field: &Field, example: &str, given: &dyn Fn(&str) -> Option<DVec3>) -> Option<String> {
    let eye = given("eye");
    let lookat = given("lookat");
    let others = match (field.name, eye, lookat) {
        ("eye", _, Some(lookat)) => [lookat + DVec3::Z, lookat + DVec3::X],
        ("lookat", Some(eye), _) => [eye - DVec3::Z, eye + DVec3::X],
        ("direction" | "up", _, _) => [DVec3::NEG_Z, DVec3::X],
        _ => return None,
    };
    let fits = |text: &String| {
        let Some(new) = parsed(text) else {
            return false;
        };
        let value = |name: &str| match name == field.name {
            true => Some(new),
            false => given(name),
        };
        let view = match (value("direction"), value("eye"), value("lookat")) {
            (Some(direction), _, _) => (DVec3::ZERO, direction),
            (None, Some(eye), Some(lookat)) => (eye, lookat),
            // Nothing is known that it could contradict.
            _ => return true,
        };
        !predicates::cross_is_zero(value("up").unwrap_or(DVec3::Y), view.0, view.1)
    };
    let mut texts = vec![example.to_owned()];
    texts.extend(others.map(numbers::short_vector));
    texts.into_iter().find(fits)
}

/// A vertex of a triangle beside those that are given, away from them along an axis of its own.
fn vertex(name: &str, given: &dyn Fn(&str) -> Option<DVec3>) -> Option<String> {
    let others = ["v0", "v1", "v2"]
        .into_iter()
        .filter(|other| *other != name);
    let others: Vec<DVec3> = others.filter_map(given).collect();
    let from = *others.first()?;
    let axes = match name {
        "v0" => [DVec3::Z, DVec3::X, DVec3::Y],
        "v1" => [DVec3::X, DVec3::Y, DVec3::Z],
        _ => [DVec3::Y, DVec3::Z, DVec3::X],
    };
    let fits = |text: &String| match (parsed(text), others.as_slice()) {
        (Some(new), &[one, other]) => !predicates::are_on_one_line([one, other, new]),
        (Some(new), _) => new != from,
        (None, _) => false,
    };
    let mut texts = axes
        .map(|axis| numbers::short_vector(from + axis))
        .into_iter();
    texts.find(fits)
}

/// A vector of three numbers, as examples are written.
fn parsed(text: &str) -> Option<DVec3> {
    let inner = text.strip_prefix('(')?.strip_suffix(')')?;
    let mut parts = inner.split(", ").map(|part| part.parse().ok());
    let vector = DVec3::new(parts.next()??, parts.next()??, parts.next()??);
    vector.is_finite().then_some(vector)
}
