//! The words of problems: what was found, what would do, in the author's own numbers and names.

use glam::DVec3;

use crate::{
    math::Angle,
    numbers,
    scene::{
        eval::in_bytes,
        schema::{Condition, Field, Preset, Type},
        value::Value,
    },
    syntax::{
        shorten,
        tree::{self, ValueKind},
    },
};

/// The label and the help for a condition that does not hold, and what can stand in the value's place.
pub fn range_words(
    row: &Field,
    condition: Condition,
    value: Value,
) -> (&'static str, String, Vec<String>) {
    let example = row.example();
    let number = match value {
        Value::Number(number) => number,
        _ => 0.0,
    };
    match condition {
        Condition::Whole => {
            let (below, above) = (number.floor(), number.ceil());
            match below >= 1.0 && above < 1e15 {
                true => (
                    "not whole",
                    format!("write `{below}` or `{above}`"),
                    vec![below.to_string(), above.to_string()],
                ),
                false => (
                    "not whole",
                    format!("write a whole number, such as `{example}`"),
                    vec![example],
                ),
            }
        }
        Condition::MoreThan(bound) if number < bound => {
            let opposite = numbers::short(-number);
            (
                "too small",
                format!("write `{opposite}`, or another number above {bound}"),
                vec![opposite],
            )
        }
        Condition::MoreThan(bound) => (
            "too small",
            format!("write a number above {bound}, such as `{example}`"),
            vec![example],
        ),
        Condition::AtLeast(bound) => (
            "too small",
            format!("write `{bound}` or more"),
            vec![bound.to_string()],
        ),
        Condition::AtMostTwoTo(power) => at_most(1_u64 << power),
        Condition::LessThanTwoTo(power) => at_most((1_u64 << power) - 1),
        Condition::LessThanHalfTurn => (
            "no field of view",
            "write an angle that lies between, such as `40deg`".to_owned(),
            vec!["40deg".to_owned()],
        ),
        Condition::NotZero => (
            "zero has no direction",
            format!("write a vector that points somewhere, such as `{example}`"),
            vec![example],
        ),
        Condition::EachMoreThanZero => (
            "not all of these are above 0",
            format!("write three numbers above 0, such as `{example}`"),
            vec![example],
        ),
    }
}

fn at_most(bound: u64) -> (&'static str, String, Vec<String>) {
    (
        "too large",
        format!("write `{bound}` or less"),
        vec![bound.to_string()],
    )
}

/// What to write in place of a value of the wrong type: in words, and as it can stand there if that is known.
pub fn right_type(
    row: &Field,
    tree: &tree::Value<'_>,
    value: Value,
    text: &str,
) -> (String, Vec<String>) {
    let literal = matches!(&tree.kind, ValueKind::Number(_) | ValueKind::Tuple(_));
    let write = |words: &str, make: &dyn Fn(&str) -> String| {
        (
            format!("{words} `{}`", make(&shorten(text))),
            vec![make(text)],
        )
    };
    let say = |words: String| (words, Vec::new());
    match (row.takes, value, &tree.kind) {
        (Type::Number, Value::Angle(_), ValueKind::Angle { number, .. }) => {
            write("without a unit, write", &|_| (*number).to_owned())
        }
        (Type::Number, Value::Angle(_), kind) => write(
            "an angle divided by `1deg` is a number:",
            &|text| match kind {
                ValueKind::Chain { .. } => format!("({text}) / 1deg"),
                _ => format!("{text} / 1deg"),
            },
        ),
        (Type::Number, Value::Vector(_), kind) if !matches!(kind, ValueKind::Tuple(_)) => write(
            "write a number, such as the length of the vector:",
            &|text| format!("length({text})"),
        ),
        (Type::Vector, Value::Number(_), _) if literal && matches!(row.name, "size" | "sides") => {
            write("write three numbers, such as", &|text| {
                format!("({text}, {text}, {text})")
            })
        }
        (Type::Vector, Value::Number(_), _) => say(format!(
            "write three numbers in parentheses, such as `{}`",
            row.example()
        )),
        (Type::Color, Value::Vector(parts), _) if rgb(parts, tree, text).is_some() => {
            write("of red, green and blue, write", &|text| {
                rgb(parts, tree, text).unwrap_or_default()
            })
        }
        (Type::Color, Value::Colors(_), ValueKind::Tuple(_)) => {
            say("write one colour; only a checkerboard has two".to_owned())
        }
        (Type::Color, ..) => say(format!(
            "write a colour, such as `{}`, `#808000` or `rgb(128, 128, 0)`",
            row.example()
        )),
        (Type::Colors, Value::Color(_), _) => {
            let other = if text == "white" { "gray" } else { "white" };
            write("write two colours:", &|text| format!("({text}, {other})"))
        }
        _ => say(format!(
            "write {}, such as `{}`",
            row.takes.noun(),
            row.example()
        )),
    }
}

/// The colour whose parts were written as a vector: from 0 to 1 if none is more, or else from 0 to 255.
pub fn rgb(parts: DVec3, tree: &tree::Value<'_>, text: &str) -> Option<String> {
    let ValueKind::Tuple(elements) = &tree.kind else {
        return None;
    };
    let is_literal =
        |element: &tree::Element<'_>| matches!(element.value.kind, ValueKind::Number(_));
    let is_unit = parts.cmple(DVec3::ONE).all();
    if parts.min_element() < 0.0 || parts.max_element() > 255.0 {
        return None;
    }
    match is_unit {
        true if elements.iter().all(is_literal) => {
            let [r, g, b] = parts.to_array().map(in_bytes);
            Some(format!("rgb({r}, {g}, {b})"))
        }
        true => None,
        false => Some(format!("rgb{text}")),
    }
}

/// What to write in place of a list of numbers that is no vector: words, if there are better ones than of vectors in general, and
/// what can stand in its place, if something else can.
pub fn list_for(row: &Field, texts: &[&str]) -> (Option<String>, Option<Vec<String>>) {
    let write = |text: String| (Some(format!("write `{text}`")), Some(vec![text]));
    match (row.takes, texts) {
        // Any two sides and the longer of them once more form a triangle.
        (Type::Vector, [a, b]) if row.name == "sides" => {
            match (a.parse::<f64>(), b.parse::<f64>()) {
                (Ok(x), Ok(y)) => write(format!("({a}, {b}, {})", if x < y { b } else { a })),
                _ => (None, Some(Vec::new())),
            }
        }
        // A third number could be on the wrong side of the other corner, or make a vertex of another one.
        (Type::Vector, [_, _]) if row.preset == Preset::Alternative => (None, Some(Vec::new())),
        (Type::Vector, _) => (None, None),
        // A field without a default, such as `far`, has conditions of its own.
        (Type::Number, [first, rest @ ..])
            if row.preset != Preset::Nothing && rest.iter().all(|text| text == first) =>
        {
            write((*first).to_owned())
        }
        (Type::Color, [r, g, b, _]) => write(format!("rgb({r}, {g}, {b})")),
        _ => (None, Some(Vec::new())),
    }
}

/// A computed value that does not keep a condition.
pub fn shown(value: Value, condition: Condition) -> String {
    let two_to = |power: u32| (1_u64 << power) as f64;
    let bound = match (condition, value) {
        (Condition::Whole, Value::Number(number)) => number.round(),
        (Condition::MoreThan(bound) | Condition::AtLeast(bound), _) => bound,
        (Condition::AtMostTwoTo(power) | Condition::LessThanTwoTo(power), _) => two_to(power),
        (Condition::LessThanHalfTurn, _) => 180.0,
        _ => 0.0,
    };
    match value {
        Value::Number(number) => numbers::beside(number, &[bound]),
        Value::Vector(v) => numbers::short_vector(v),
        Value::Angle(Angle {
            degrees,
            radians: 0.0,
        }) => format!("{}deg", numbers::beside(degrees, &[bound])),
        Value::Angle(Angle {
            degrees: 0.0,
            radians,
        }) => format!("{}rad", numbers::beside(radians, &[std::f64::consts::PI])),
        Value::Angle(angle) => format!("{}deg + {}rad", angle.degrees, angle.radians),
        Value::Color(color) => color.to_string(),
        Value::Colors([first, second]) => format!("({first}, {second})"),
        Value::Method(method) => method.name().to_owned(),
    }
}

/// Whether a word stands in a text.
pub fn mentions(text: &str, word: &str) -> bool {
    let other = |c: char| !c.is_ascii_alphanumeric() && c != '_';
    text.split(other).any(|found| found == word)
}
