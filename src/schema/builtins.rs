//! The tables of predefined words: functions and constants.

use super::types::{Type, Value};
use crate::math::Angle;

/// A function's row, found by its name.
pub fn function(name: &str) -> Option<&'static Function> {
    FUNCTIONS.iter().find(|function| function.name == name)
}

/// A row for each function: its name, what it takes and gives, and what it is; then what else there
/// is to say of it.
macro_rules! functions {
    ($($name:ident($($takes:ident)*) $gives:ident $help:literal $($more:ident($value:expr))*;)*) => {
        &[$(Function {
            $($more: $value,)*
            ..Function::new(stringify!($name), &[$(Type::$takes),*], Type::$gives, $help)
        }),*]
    };
}

/// Every function, with what it takes and gives.
pub const FUNCTIONS: &[Function] = functions! {
    sin(Angle) Number "the sine of an angle";
    cos(Angle) Number "the cosine of an angle";
    tan(Angle) Number "the tangent of an angle";
    asin(Number) Angle "the angle of this sine";
    acos(Number) Angle "the angle of this cosine";
    atan(Number) Angle "the angle of this tangent";
    atan2(Number Number) Angle "the angle of the point (x, y), called atan2(y, x)" parameters(&["y", "x"]);
    sqrt(Number) Number "the square root";
    abs(Number) Number "the number without its sign";
    min(Number Number) Number "the least of two or more numbers" more(true);
    max(Number Number) Number "the greatest of two or more numbers" more(true);
    length(Vector) Number "the length of a vector";
    dot(Vector Vector) Number "the dot product";
    cross(Vector Vector) Vector "the cross product";
    normalize(Vector) Vector "the vector of length 1 in the same direction";
    rgb(Number Number Number) Color "a colour of red, green and blue, 0 to 255 each" parameters(&["red", "green", "blue"]);
};

/// What there is to know about a function.
#[derive(Clone, Copy, Debug)]
pub struct Function {
    /// Its name.
    pub name: &'static str,
    /// The types of its arguments.
    pub takes: &'static [Type],
    /// What its arguments are called; nothing where their types say it all.
    pub parameters: &'static [&'static str],
    /// Whether it takes more of the last type.
    pub more: bool,
    /// The type of its result.
    pub gives: Type,
    /// What it is, in a line.
    pub help: &'static str,
}

impl Function {
    const fn new(
        name: &'static str,
        takes: &'static [Type],
        gives: Type,
        help: &'static str,
    ) -> Self {
        Self {
            name,
            takes,
            parameters: &[],
            more: false,
            gives,
            help,
        }
    }

    /// The type of an argument, by how many stand before it.
    pub fn parameter(&self, index: usize) -> Option<Type> {
        let last = self.takes.last().filter(|_| self.more);
        self.takes.get(index).or(last).copied()
    }

    /// Arguments that it can have, as they are written.
    pub fn example(&self) -> &'static [&'static str] {
        use Type::{Angle, Number, Vector};
        match self.takes {
            // Of those of the cross product it is 0, which few fields take.
            [Vector, Vector] if self.gives == Number => &["(1, 2, 3)", "(0, 1, 0)"],
            [Vector, Vector] => &["(1, 0, 0)", "(0, 1, 0)"],
            [Vector] => &["(1, 2, 3)"],
            [Angle] => &["30deg"],
            [Number] => &["0.5"],
            [Number, Number] => &["1", "2"],
            _ => &["255", "165", "0"],
        }
    }

    /// How it is called.
    pub fn call(&self) -> String {
        format!("{}({})", self.name, self.example().join(", "))
    }

    /// Whether it takes so many arguments.
    pub fn accepts(&self, count: usize) -> bool {
        count == self.takes.len() || (self.more && count > self.takes.len())
    }
}

/// The predefined names that are neither colours nor functions, each with its value and a line of
/// help.
pub const CONSTANTS: &[(&str, Value, &str)] = &[
    (
        "pi",
        Value::Number(std::f64::consts::PI),
        "the number 3.141592653589793",
    ),
    (
        "deg",
        Value::Angle(Angle::from_degrees(1.0)),
        "the angle 1deg",
    ),
    (
        "rad",
        Value::Angle(Angle::from_radians(1.0)),
        "the angle 1rad",
    ),
];
