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
    syntax::tree::{self, ValueKind},
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

/// What can stand in place of a value of the wrong type.
pub fn of_right_type(row: &Field, tree: &tree::Value<'_>, value: Value, text: &str) -> Vec<String> {
    let literal = matches!(&tree.kind, ValueKind::Number(_) | ValueKind::Tuple(_));
    match (row.takes, value.kind(), &tree.kind) {
        (Type::Number, Type::Angle, ValueKind::Angle { number, .. }) => vec![(*number).to_owned()],
        (Type::Number, Type::Angle, _) => vec![in_degrees(tree, text)],
        (Type::Number, Type::Vector, kind) if !matches!(kind, ValueKind::Tuple(_)) => {
            vec![format!("length({text})")]
        }
        (Type::Vector, Type::Number, _) if literal && matches!(row.name, "size" | "sides") => {
            vec![format!("({text}, {text}, {text})")]
        }
        (Type::Color, Type::Vector, _) => match value {
            Value::Vector(parts) => rgb(parts, tree, text).into_iter().collect(),
            _ => Vec::new(),
        },
        (Type::Colors, Type::Color, _) => {
            let other = if text == "white" { "gray" } else { "white" };
            vec![format!("({text}, {other})")]
        }
        _ => Vec::new(),
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
        (Type::Number, [first, rest @ ..]) if rest.iter().all(|text| text == first) => {
            write((*first).to_owned())
        }
        (Type::Color, [r, g, b, _]) => write(format!("rgb({r}, {g}, {b})")),
        _ => (None, Some(Vec::new())),
    }
}

/// What to write in place of a value of the wrong type.
pub fn type_help(row: &Field, tree: &tree::Value<'_>, value: Value, text: &str) -> String {
    let literal = matches!(&tree.kind, ValueKind::Number(_) | ValueKind::Tuple(_));
    match (row.takes, value.kind(), &tree.kind) {
        (Type::Number, Type::Angle, ValueKind::Angle { number, .. }) => {
            format!("write `{number}`, without a unit")
        }
        (Type::Number, Type::Angle, _) => {
            let number = in_degrees(tree, text);
            format!("an angle divided by `1deg` is a number: `{number}`")
        }
        (Type::Number, Type::Vector, kind) if !matches!(kind, ValueKind::Tuple(_)) => {
            format!("write a number, such as the length of the vector: `length({text})`")
        }
        (Type::Vector, Type::Number, _) if literal && matches!(row.name, "size" | "sides") => {
            format!("write three numbers, such as `({text}, {text}, {text})`")
        }
        (Type::Vector, Type::Number, _) => {
            format!(
                "write three numbers in parentheses, such as `{}`",
                row.example()
            )
        }
        (Type::Color, Type::Vector, _) if of_right_type(row, tree, value, text).len() == 1 => {
            let color = of_right_type(row, tree, value, text).concat();
            format!("write `{color}` if these are red, green and blue")
        }
        (Type::Color, Type::Colors, ValueKind::Tuple(parts)) if parts.len() == 2 => {
            "write one colour; only a checkerboard has two".to_owned()
        }
        (Type::Color, ..) => format!(
            "write a colour, such as `{}`, `#808000` or `rgb(128, 128, 0)`",
            row.example()
        ),
        (Type::Colors, Type::Color, _) => {
            let other = match text {
                "white" => "gray",
                _ => "white",
            };
            format!("write two colours: `({text}, {other})`")
        }
        _ => format!("write {}, such as `{}`", row.takes.noun(), row.example()),
    }
}

/// The number of degrees of an angle.
fn in_degrees(tree: &tree::Value<'_>, text: &str) -> String {
    match tree.kind {
        ValueKind::Chain { .. } => format!("({text}) / 1deg"),
        _ => format!("{text} / 1deg"),
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

/// A vector along an axis, such as `−z`.
pub fn axis_name(v: DVec3) -> Option<String> {
    let (axis, part) = axis(v)?;
    let sign = if part < 0.0 { '−' } else { '+' };
    Some(format!("{sign}{axis}"))
}

/// The unit vector along an axis as it is written.
pub fn axis_vector(v: DVec3) -> Option<String> {
    let (axis, part) = axis(v)?;
    let one = if part < 0.0 { "-1" } else { "1" };
    Some(match axis {
        'x' => format!("({one}, 0, 0)"),
        'y' => format!("(0, {one}, 0)"),
        _ => format!("(0, 0, {one})"),
    })
}

fn axis(v: DVec3) -> Option<(char, f64)> {
    match v.to_array() {
        [x, 0.0, 0.0] if x != 0.0 => Some(('x', x)),
        [0.0, y, 0.0] if y != 0.0 => Some(('y', y)),
        [0.0, 0.0, z] if z != 0.0 => Some(('z', z)),
        _ => None,
    }
}

/// Whether a word stands in a text.
pub fn mentions(text: &str, word: &str) -> bool {
    let other = |c: char| !c.is_ascii_alphanumeric() && c != '_';
    text.split(other).any(|found| found == word)
}
