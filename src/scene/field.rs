//! The value of a field.
//!
//! In: a field's row of the table and the tree of its value. Out: what it is, if it is of the field's type and keeps its
//! conditions, or a problem that says what would do.

use glam::DVec3;

use super::{
    error::Problem,
    eval::Evaluator,
    schema::{self, Condition, Field, Literal, Preset, Type},
    value::{self, Value},
};
use crate::{
    math::Angle,
    numbers, suggest,
    syntax::{
        shorten,
        tree::{self, ValueKind},
    },
};

/// The value of a field, if it is of the field's type and keeps its conditions.
pub fn value<'s>(
    evaluator: &mut Evaluator<'_, 's>,
    row: &'static Field,
    tree: &tree::Value<'s>,
) -> Option<Value> {
    let value = match row.takes {
        Type::Method => return method(evaluator, row, tree),
        takes => evaluator.value(tree, Some(takes))?,
    };
    if value.kind() != row.takes {
        wrong_type(evaluator, row, tree, value);
        return None;
    }
    let broken = row.must.iter().find(|condition| !holds(**condition, value));
    if let Some(&condition) = broken {
        out_of_range(evaluator, row, condition, tree, value);
        return None;
    }
    Some(value)
}

fn method<'s>(
    evaluator: &mut Evaluator<'_, 's>,
    row: &'static Field,
    tree: &tree::Value<'s>,
) -> Option<Value> {
    let list = suggest::list(schema::method_names());
    let ValueKind::Name(written) = tree.kind else {
        if !matches!(tree.kind, ValueKind::Bad | ValueKind::Missing) {
            let found = evaluator.value(tree, None)?.kind();
            let problem = Problem::WrongType {
                name: row.name.to_owned(),
                takes: row.takes.noun(),
                written: evaluator.quoted(tree.span),
                found: found.noun().to_owned(),
                help: format!("the methods are {list}"),
                span: tree.span,
                label: found.noun().to_owned(),
            };
            evaluator.problems.push(problem);
        }
        return None;
    };
    if let Some(method) = schema::method(written) {
        return Some(Value::Method(method));
    }
    let help = match suggest::nearest(written, schema::method_names()) {
        Some(near) => format!("did you mean `{near}`? The methods are {list}."),
        None => format!("the methods are {list}"),
    };
    evaluator.problems.push(Problem::UnknownMethod {
        written: written.to_owned(),
        help,
        span: tree.span,
    });
    None
}

fn wrong_type<'s>(
    evaluator: &mut Evaluator<'_, 's>,
    row: &Field,
    tree: &tree::Value<'s>,
    value: Value,
) {
    let label = evaluator.described(tree, value.kind());
    let written = evaluator.quoted(tree.span);
    let text = shorten(evaluator.sources.text(tree.span));
    let problem = if (row.takes, value.kind()) == (Type::Angle, Type::Number) {
        let [degrees, radians] = evaluator.with_units(tree);
        Problem::BareAngle {
            what: format!("`{}`", row.name),
            written,
            help: format!("write `{degrees}` (or `{radians}`)"),
            span: tree.span,
            label,
        }
    } else {
        Problem::WrongType {
            name: row.name.to_owned(),
            takes: row.takes.noun(),
            written,
            found: value.kind().noun().to_owned(),
            help: type_help(row, tree, value.kind(), &text),
            span: tree.span,
            label,
        }
    };
    evaluator.problems.push(problem);
}

fn out_of_range(
    evaluator: &mut Evaluator<'_, '_>,
    row: &Field,
    condition: Condition,
    tree: &tree::Value<'_>,
    value: Value,
) {
    let written = shorten(evaluator.sources.text(tree.span));
    let found = match (&tree.kind, value) {
        (ValueKind::Name(_) | ValueKind::Call { .. } | ValueKind::Chain { .. }, value) => {
            shown(value)
        }
        _ => written,
    };
    let (label, help) = range_words(row, condition, value);
    let message = match condition {
        Condition::NotZero => format!("`{}` must not be zero", row.name),
        _ => format!("`{}` must be {condition}, and it is {found}", row.name),
    };
    evaluator.problems.push(Problem::OutOfRange {
        message,
        help,
        span: tree.span,
        label: label.to_owned(),
    });
}

fn holds(condition: Condition, value: Value) -> bool {
    let two_to = |power: u32| (1_u64 << power) as f64;
    match (condition, value) {
        (Condition::Whole, Value::Number(x)) => x.fract() == 0.0,
        (Condition::MoreThan(bound), Value::Number(x)) => x > bound,
        (Condition::AtLeast(bound), Value::Number(x)) => x >= bound,
        (Condition::AtMostTwoTo(power), Value::Number(x)) => x <= two_to(power),
        (Condition::LessThanTwoTo(power), Value::Number(x)) => x < two_to(power),
        (Condition::LessThanHalfTurn, Value::Angle(angle)) => {
            value::compare_with_zero(angle).is_gt() && value::compare_with_half_turn(angle).is_lt()
        }
        (Condition::NotZero, Value::Vector(v)) => v != DVec3::ZERO,
        (Condition::EachMoreThanZero, Value::Vector(v)) => v.min_element() > 0.0,
        _ => true,
    }
}

/// The label and the help for a condition that does not hold.
fn range_words(row: &Field, condition: Condition, value: Value) -> (&'static str, String) {
    let example = example(row);
    let number = match value {
        Value::Number(number) => number,
        _ => 0.0,
    };
    match condition {
        Condition::Whole => {
            let (below, above) = (number.floor(), number.ceil());
            let help = match below >= 1.0 && above < 1e15 {
                true => format!("write `{below}` or `{above}`"),
                false => format!("write a whole number, such as `{example}`"),
            };
            ("not whole", help)
        }
        Condition::MoreThan(bound) if number < bound => (
            "too small",
            format!(
                "write `{}`, or another number above {bound}",
                numbers::short(-number)
            ),
        ),
        Condition::MoreThan(bound) => (
            "too small",
            format!("write a number above {bound}, such as `{example}`"),
        ),
        Condition::AtLeast(bound) => ("too small", format!("write `{bound}` or more")),
        Condition::AtMostTwoTo(power) => {
            ("too large", format!("write `{}` or less", 1_u64 << power))
        }
        Condition::LessThanTwoTo(power) => (
            "too large",
            format!("write `{}` or less", (1_u64 << power) - 1),
        ),
        Condition::LessThanHalfTurn => (
            "no field of view",
            "write an angle that lies between, such as `40deg`".to_owned(),
        ),
        Condition::NotZero => (
            "zero has no direction",
            format!("write a vector that points somewhere, such as `{example}`"),
        ),
        Condition::EachMoreThanZero => (
            "not all of these are above 0",
            format!("write three numbers above 0, such as `{example}`"),
        ),
    }
}

fn type_help(row: &Field, tree: &tree::Value<'_>, found: Type, text: &str) -> String {
    let literal = matches!(&tree.kind, ValueKind::Number(_) | ValueKind::Tuple(_));
    match (row.takes, found, &tree.kind) {
        (Type::Number, Type::Angle, ValueKind::Angle { number, .. }) => {
            format!("write `{number}`, without a unit")
        }
        (Type::Number, Type::Angle, _) => {
            format!("an angle divided by `1deg` is a number: `{text} / 1deg`")
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
                example(row)
            )
        }
        (Type::Color, Type::Vector, _) if literal => {
            format!("write `rgb{text}` if these are red, green and blue from 0 to 255")
        }
        (Type::Color, Type::Colors, ValueKind::Tuple(parts)) if parts.len() == 2 => {
            "write one colour; only a checkerboard has two".to_owned()
        }
        (Type::Color, ..) => format!(
            "write a colour, such as `{}`, `#808000` or `rgb(128, 128, 0)`",
            example(row)
        ),
        (Type::Colors, Type::Color, _) => {
            let other = match text {
                "white" => "gray",
                _ => "white",
            };
            format!("write two colours: `({text}, {other})`")
        }
        _ => format!("write {}, such as `{}`", row.takes.noun(), example(row)),
    }
}

/// A computed value, for a message.
fn shown(value: Value) -> String {
    match value {
        Value::Number(number) => numbers::short(number),
        Value::Vector(v) => vector(v),
        Value::Angle(Angle {
            degrees,
            radians: 0.0,
        }) => format!("{}deg", numbers::short(degrees)),
        Value::Angle(Angle {
            degrees: 0.0,
            radians,
        }) => format!("{}rad", numbers::short(radians)),
        Value::Angle(angle) => {
            let degrees = angle.degrees + angle.radians.to_degrees();
            format!("{}deg", numbers::short(degrees))
        }
        Value::Color(color) => color.to_string(),
        Value::Colors([first, second]) => format!("({first}, {second})"),
        Value::Method(method) => method.name().to_owned(),
    }
}

/// A value that a field can have.
pub fn example(row: &Field) -> String {
    match (row.preset, row.takes) {
        (Preset::Value(literal), _) if literal != Literal::Degrees(0.0) => literal.to_string(),
        (_, Type::Number) => "100".to_owned(),
        (_, Type::Angle) => "30deg".to_owned(),
        (_, Type::Vector) if row.name == "eye" => "(0, 2, 8)".to_owned(),
        (_, Type::Vector) if row.name == "normal" => "(0, 0, 1)".to_owned(),
        (_, Type::Vector) => "(0, 1, 0)".to_owned(),
        (_, Type::Color) => "olive".to_owned(),
        (_, Type::Colors) => "(gray, white)".to_owned(),
        (_, Type::Method) => "jittered".to_owned(),
    }
}

/// A computed vector, for a message.
pub fn vector(v: DVec3) -> String {
    let [x, y, z] = v.to_array().map(numbers::short);
    format!("({x}, {y}, {z})")
}
