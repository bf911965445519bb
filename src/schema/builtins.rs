//! The tables of predefined functions and constants.

use super::types::{Type, Value};
use crate::math::Angle;

/// Returns the function with the name `name`, or `None` if there is none.
pub fn function(name: &str) -> Option<&'static Function> {
    FUNCTIONS.iter().find(|function| function.name == name)
}

/// Defines the rows of functions. A line contains the name, the types of the arguments, the type of
/// the result, the help, and optional fields of [`Function`].
macro_rules! functions {
    ($($name:ident($($takes:ident)*) $gives:ident $help:literal $($more:ident($value:expr))*;)*) => {
        &[$(Function {
            $($more: $value,)*
            ..Function::new(stringify!($name), &[$(Type::$takes),*], Type::$gives, $help)
        }),*]
    };
}

/// Every function of the language.
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

/// A function of the language.
#[derive(Clone, Copy, Debug)]
pub struct Function {
    /// Name of the function.
    pub name: &'static str,
    /// The types of the arguments.
    pub takes: &'static [Type],
    /// Names of the parameters, for the signature in editors; empty if the types explain them.
    pub parameters: &'static [&'static str],
    /// Whether more arguments may follow those of `takes`. They have the type of its last element.
    pub more: bool,
    /// The type of the result.
    pub gives: Type,
    /// One line of help.
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

    /// Returns the type of the argument at `index`. Returns `None` if the function takes fewer
    /// arguments.
    pub fn parameter(&self, index: usize) -> Option<Type> {
        let last = self.takes.last().filter(|_| self.more);
        self.takes.get(index).or(last).copied()
    }

    /// Returns example arguments for the function, in the language's notation.
    pub fn example(&self) -> &'static [&'static str] {
        use Type::{Angle, Number, Vector};
        match self.takes {
            // A dot product of 0 would be a poor example, because few fields accept 0.
            [Vector, Vector] if self.gives == Number => &["(1, 2, 3)", "(0, 1, 0)"],
            [Vector, Vector] => &["(1, 0, 0)", "(0, 1, 0)"],
            [Vector] => &["(1, 2, 3)"],
            [Angle] => &["30deg"],
            [Number] => &["0.5"],
            [Number, Number] => &["1", "2"],
            _ => &["255", "165", "0"],
        }
    }

    /// Returns the text of a call with the example arguments.
    pub fn call(&self) -> String {
        format!("{}({})", self.name, self.example().join(", "))
    }

    /// Returns whether the function takes `count` arguments.
    pub fn accepts(&self, count: usize) -> bool {
        count == self.takes.len() || (self.more && count > self.takes.len())
    }
}

/// Predefined names except colours and functions, each with its value and a line of help.
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
