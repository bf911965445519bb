//! Values and what can be done with them.
//!
//! Operators and functions know no places in a text: they say what comes out, or that the types do not go together, and
//! the caller adds the place. What is not finite comes out as it is; the caller reports it.

use std::fmt;

use glam::DVec3;

use super::Method;
use crate::{
    color::Color,
    math::{Angle, trig},
    numbers,
    syntax::tree::Operator,
};

/// What a value can be.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Type {
    /// A number.
    Number,
    /// A number with a unit.
    Angle,
    /// Three numbers.
    Vector,
    /// An sRGB colour.
    Color,
    /// Two colours.
    Colors,
    /// The name of a sampling technique.
    Method,
}

impl Type {
    /// The type with its article.
    pub fn noun(self) -> &'static str {
        match self {
            Self::Number => "a number",
            Self::Angle => "an angle",
            Self::Vector => "a vector",
            Self::Color => "a colour",
            Self::Colors => "a pair of colours",
            Self::Method => "a method",
        }
    }

    /// The type without an article.
    pub fn word(self) -> &'static str {
        let noun = self.noun();
        noun.split_once(' ').map_or(noun, |(_, word)| word)
    }

    /// Two of the type.
    pub fn two(self) -> &'static str {
        match self {
            Self::Number => "two numbers",
            Self::Angle => "two angles",
            Self::Vector => "two vectors",
            Self::Color => "two colours",
            Self::Colors => "two pairs of colours",
            Self::Method => "two methods",
        }
    }
}

/// A value of the language.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    /// A number.
    Number(f64),
    /// An angle.
    Angle(Angle),
    /// A vector.
    Vector(DVec3),
    /// A colour.
    Color(Color),
    /// A pair of colours.
    Colors([Color; 2]),
    /// A sampling technique.
    Method(Method),
}

impl Value {
    /// What it is.
    pub fn kind(&self) -> Type {
        match self {
            Self::Number(_) => Type::Number,
            Self::Angle(_) => Type::Angle,
            Self::Vector(_) => Type::Vector,
            Self::Color(_) => Type::Color,
            Self::Colors(_) => Type::Colors,
            Self::Method(_) => Type::Method,
        }
    }

    /// Whether no part of it is infinite or not a number.
    pub fn is_finite(&self) -> bool {
        match self {
            Self::Number(number) => number.is_finite(),
            Self::Angle(angle) => angle.is_finite(),
            Self::Vector(vector) => vector.is_finite(),
            Self::Color(_) | Self::Colors(_) | Self::Method(_) => true,
        }
    }
}

/// As people read it, in the language's notation: six digits of each number.
impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => f.write_str(&numbers::short(*number)),
            Self::Angle(Angle {
                degrees: 0.0,
                radians,
            }) if *radians != 0.0 => write!(f, "{}rad", numbers::short(*radians)),
            Self::Angle(angle) => {
                let degrees = angle.degrees + angle.radians.to_degrees();
                write!(f, "{}deg", numbers::short(degrees))
            }
            Self::Vector(vector) => f.write_str(&numbers::short_vector(*vector)),
            Self::Color(color) => write!(f, "{color}"),
            Self::Colors([first, second]) => write!(f, "({first}, {second})"),
            Self::Method(method) => f.write_str(method.name()),
        }
    }
}

/// `left OPERATOR right`, if the types go together.
pub fn operate(operator: Operator, left: Value, right: Value) -> Option<Value> {
    use Value::{Angle, Number, Vector};
    Some(match (operator, left, right) {
        (Operator::Add, Number(a), Number(b)) => Number(a + b),
        (Operator::Add, Angle(a), Angle(b)) => Angle(a + b),
        (Operator::Add, Vector(a), Vector(b)) => Vector(a + b),
        (Operator::Subtract, Number(a), Number(b)) => Number(a - b),
        (Operator::Subtract, Angle(a), Angle(b)) => Angle(a - b),
        (Operator::Subtract, Vector(a), Vector(b)) => Vector(a - b),
        (Operator::Multiply, Number(a), Number(b)) => Number(a * b),
        (Operator::Multiply, Number(a), Angle(b)) => Angle(b * a),
        (Operator::Multiply, Angle(a), Number(b)) => Angle(a * b),
        (Operator::Multiply, Number(a), Vector(b)) => Vector(a * b),
        (Operator::Multiply, Vector(a), Number(b)) => Vector(a * b),
        (Operator::Divide, Number(a), Number(b)) => Number(a / b),
        (Operator::Divide, Angle(a), Number(b)) => Angle(a / b),
        (Operator::Divide, Angle(a), Angle(b)) => Number(ratio(a, b)),
        // Part by part: a factor 1/b would be rounded once more.
        (Operator::Divide, Vector(a), Number(b)) => Vector(DVec3::new(a.x / b, a.y / b, a.z / b)),
        _ => return None,
    })
}

/// `-value`, if it has a negative.
pub fn negate(value: Value) -> Option<Value> {
    match value {
        Value::Number(number) => Some(Value::Number(-number)),
        Value::Angle(angle) => Some(Value::Angle(-angle)),
        Value::Vector(vector) => Some(Value::Vector(-vector)),
        Value::Color(_) | Value::Colors(_) | Value::Method(_) => None,
    }
}

/// How many times one angle the other is; of two angles in one unit the quotient of their numbers.
fn ratio(a: Angle, b: Angle) -> f64 {
    if a.radians == 0.0 && b.radians == 0.0 {
        return a.degrees / b.degrees;
    }
    if a.degrees == 0.0 && b.degrees == 0.0 {
        return a.radians / b.radians;
    }
    in_radians(a) / in_radians(b)
}

fn in_radians(angle: Angle) -> f64 {
    angle.degrees.to_radians() + angle.radians
}

/// What a function gives, if the arguments have its types. `rgb` is not among them: it can refuse a value.
pub fn call(function: &str, arguments: &[Value]) -> Option<Value> {
    use Value::{Number, Vector};
    Some(match (function, arguments) {
        ("sin", &[Value::Angle(a)]) => Number(trig::sin(a)),
        ("cos", &[Value::Angle(a)]) => Number(trig::cos(a)),
        ("tan", &[Value::Angle(a)]) => Number(trig::tan(a)),
        ("asin", &[Number(x)]) => Value::Angle(trig::asin(x)),
        ("acos", &[Number(x)]) => Value::Angle(trig::acos(x)),
        ("atan", &[Number(x)]) => Value::Angle(trig::atan(x)),
        ("atan2", &[Number(y), Number(x)]) => Value::Angle(trig::atan2(y, x)),
        ("sqrt", &[Number(x)]) => Number(x.sqrt()),
        ("abs", &[Number(x)]) => Number(x.abs()),
        ("min", numbers) => Number(fold(numbers, f64::min)?),
        ("max", numbers) => Number(fold(numbers, f64::max)?),
        ("length", &[Vector(v)]) => Number(length(v)),
        ("dot", &[Vector(v), Vector(w)]) => Number(v.dot(w)),
        ("cross", &[Vector(v), Vector(w)]) => Vector(v.cross(w)),
        ("normalize", &[Vector(v)]) => Vector(normalize(v)),
        ("rgb", &[Number(r), Number(g), Number(b)]) => Value::Color(Color { srgb: [r, g, b] }),
        _ => return None,
    })
}

fn fold(numbers: &[Value], choose: impl Fn(f64, f64) -> f64) -> Option<f64> {
    let mut chosen = None;
    for number in numbers {
        let &Value::Number(number) = number else {
            return None;
        };
        chosen = Some(chosen.map_or(number, |before| choose(before, number)));
    }
    chosen
}

/// The length of a vector, without a square that is too large or too small.
fn length(v: DVec3) -> f64 {
    let (scaled, scale) = to_unit_scale(v);
    scaled.dot(scaled).sqrt() * scale
}

/// The vector of length 1 in the same direction; nothing finite for zero.
fn normalize(v: DVec3) -> DVec3 {
    let (scaled, _) = to_unit_scale(v);
    let length = scaled.dot(scaled).sqrt();
    DVec3::new(scaled.x / length, scaled.y / length, scaled.z / length)
}

/// The vector with its greatest part between 1 and 2, and the power of two that was taken out. Nothing is rounded but parts
/// too small to show beside the greatest.
fn to_unit_scale(v: DVec3) -> (DVec3, f64) {
    let greatest = v.abs().max_element();
    if greatest == 0.0 || !greatest.is_finite() {
        return (v, 1.0);
    }
    let (_, exponent) = libm::frexp(greatest);
    let exponent = exponent - 1;
    let scaled = |x: f64| libm::ldexp(x, -exponent);
    let vector = DVec3::new(scaled(v.x), scaled(v.y), scaled(v.z));
    (vector, libm::ldexp(1.0, exponent))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_neither_overflow_nor_vanish() {
        assert_eq!(length(DVec3::new(3.0, 4.0, 0.0)), 5.0);
        for exponent in [600, -600] {
            let unit = libm::ldexp(1.0, exponent);
            assert_eq!(length(DVec3::new(3.0, 4.0, 0.0) * unit), 5.0 * unit);
        }
        assert_eq!(length(DVec3::ZERO), 0.0);
        assert_eq!(length(DVec3::X * 5e-324), 5e-324);
        assert_eq!(normalize(DVec3::X * 5e-324), DVec3::X);
        assert!(normalize(DVec3::ZERO).is_nan());
    }
}
