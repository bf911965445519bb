//! How numbers that differ from the scene's are told: rounded as short as they may be, each with the value that the scene has.

use super::{
    candidate::{Cause, Named},
    parameters::Parameter,
};
use crate::{
    numbers::{found_near, short},
    scene::Scene,
};

/// A parameter with other numbers, as a mistake.
pub fn numbers(scene: &Scene, parameter: &Parameter, mut numbers: Vec<f64>) -> Named {
    level(parameter, &mut numbers);
    Named {
        id: match parameter.fields.as_slice() {
            [one] => one,
            _ => "eye_and_lookat",
        },
        message: String::new(),
        help: help(scene, parameter),
        cause: Cause::Numbers(parameter.clone(), numbers),
    }
}

/// Gives a vector of which the direction alone counts a length with which it is short: its greatest number is 1.
pub fn level(parameter: &Parameter, numbers: &mut [f64]) {
    if let ["normal" | "direction"] = parameter.fields[..] {
        let greatest = numbers.iter().fold(0.0, |most, x| f64::max(most, x.abs()));
        numbers.iter_mut().for_each(|x| *x /= greatest);
    }
}

fn help(scene: &Scene, parameter: &Parameter) -> String {
    let set = parameter.arguments(scene).join(" and ");
    match set.is_empty() {
        true => "compare it with the scene".to_owned(),
        false => format!("the scene says {set}"),
    }
}

/// What a mistake is, in words, with its numbers.
pub fn message(scene: &Scene, named: &Named) -> String {
    let Cause::Numbers(parameter, numbers) = &named.cause else {
        return named.message.clone();
    };
    let name = parameter.owner.name(scene);
    let should = parameter.numbers(scene);
    if parameter.fields.len() > 1 {
        return format!(
            "{name} stands and looks elsewhere: at {} towards {}",
            vector(&numbers[..3]),
            vector(&numbers[3..])
        );
    }
    let is = parameter
        .put(scene, numbers)
        .map(|scene| parameter.values(&scene));
    let written = |values: &[crate::schema::Value]| {
        values.first().map(ToString::to_string).unwrap_or_default()
    };
    let field = parameter.fields[0];
    let other: Vec<usize> = (0..numbers.len())
        .filter(|&i| numbers[i] != should[i])
        .collect();
    if let ("center" | "centroid", [1]) = (field, other.as_slice()) {
        let by = numbers[1] - should[1];
        let way = if by > 0.0 { "high" } else { "low" };
        return format!("{name} is {} too {way}", found_near(by.abs(), 0.0));
    }
    let is = is.map_or_else(|| vector(numbers), |values| written(&values));
    let should = written(&parameter.values(scene));
    let kind = match field {
        "color" | "colors" | "background" => "wrong colour",
        "center" | "centroid" => "wrong place",
        "radius" | "size" | "sides" | "square" => "wrong size",
        _ => "wrong value",
    };
    let verb = match field {
        "sides" | "colors" => "are",
        _ => "is",
    };
    format!("{name} has a {kind}: its {field} {verb} {is} instead of {should}")
}

fn vector(numbers: &[f64]) -> String {
    let numbers: Vec<_> = numbers.iter().map(|x| short(*x)).collect();
    format!("({})", numbers.join(", "))
}

/// A number rounded to a power of ten that is no more than what it may be off.
pub fn rounded(x: f64, error: f64) -> f64 {
    if !(error > 0.0 && error.is_finite()) {
        return x;
    }
    let digits = (-libm::log10(error).floor()).clamp(-12.0, 12.0);
    let unit = libm::pow(10.0, digits);
    let rounded = (x * unit).round() / unit;
    // Without the tail that a multiple of a power of ten has in binary, and without −0.
    format!("{rounded:.12e}").parse().unwrap_or(x) + 0.0
}
