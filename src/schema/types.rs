//! The language's types and values.

use std::fmt;

use glam::DVec3;

use super::methods::Method;
use crate::{color::Color, math::Angle, numbers};

/// A type of the language.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Type {
    /// A number.
    Number,
    /// An angle: a number with a unit.
    Angle,
    /// A list of three numbers.
    Vector,
    /// An sRGB colour.
    Color,
    /// A pair of colours.
    Colors,
    /// A list of three colours, for the faces of a box across x, y and z.
    FaceColors,
    /// The name of a sampling technique.
    Method,
}

impl Type {
    /// Returns the type with its article, such as `a number`.
    pub fn noun(self) -> &'static str {
        match self {
            Self::Number => "a number",
            Self::Angle => "an angle",
            Self::Vector => "a vector",
            Self::Color => "a colour",
            Self::Colors => "a pair of colours",
            Self::FaceColors => "a list of three colours",
            Self::Method => "a method",
        }
    }

    /// Returns the type without an article, such as `number`.
    pub fn word(self) -> &'static str {
        let noun = self.noun();
        noun.split_once(' ').map_or(noun, |(_, word)| word)
    }

    /// Returns the plural of the type, such as `numbers`.
    pub fn plural(self) -> String {
        match self {
            Self::Colors => "pairs of colours".to_owned(),
            Self::FaceColors => "lists of three colours".to_owned(),
            _ => format!("{}s", self.word()),
        }
    }

    /// Returns the help for a missing or wrong value of the type, with an example, such as "write a
    /// number, such as `2`".
    pub fn such_as(self) -> &'static str {
        match self {
            Self::Number => "write a number, such as `2`",
            Self::Angle => "write an angle, such as `30deg`",
            Self::Vector => "write three numbers, such as `(0, 1, 0)`",
            Self::Color => "write a colour, such as `olive` or `rgb(255, 165, 0)`",
            Self::Colors => "write two colours, such as `(gray, white)`",
            Self::FaceColors => "write three colours, such as `(tan, wheat, peru)`",
            Self::Method => "write a method, such as `jittered`",
        }
    }

    /// Returns the type and the number of a list's elements: three numbers for a vector, two
    /// colours for a pair. Returns `None` if the type is not a list.
    pub fn parts(self) -> Option<(Self, usize)> {
        match self {
            Self::Vector => Some((Self::Number, 3)),
            Self::Colors => Some((Self::Color, 2)),
            Self::FaceColors => Some((Self::Color, 3)),
            _ => None,
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
    /// Three colours.
    FaceColors([Color; 3]),
    /// A sampling technique.
    Method(Method),
}

impl Value {
    /// Returns the value's type.
    pub fn kind(&self) -> Type {
        match self {
            Self::Number(_) => Type::Number,
            Self::Angle(_) => Type::Angle,
            Self::Vector(_) => Type::Vector,
            Self::Color(_) => Type::Color,
            Self::Colors(_) => Type::Colors,
            Self::FaceColors(_) => Type::FaceColors,
            Self::Method(_) => Type::Method,
        }
    }

    /// Returns whether all numbers in the value are finite.
    pub fn is_finite(&self) -> bool {
        match self {
            Self::Number(number) => number.is_finite(),
            Self::Angle(angle) => angle.is_finite(),
            Self::Vector(vector) => vector.is_finite(),
            Self::Color(_) | Self::Colors(_) | Self::FaceColors(_) | Self::Method(_) => true,
        }
    }
}

/// Formats the value in the language's notation, for people to read: numbers have six digits.
impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => f.write_str(&numbers::short(*number)),
            Self::Angle(Angle {
                degrees: 0.0,
                radians,
            }) if *radians != 0.0 => write!(f, "{}rad", numbers::short(*radians)),
            Self::Angle(angle) => write!(f, "{}deg", numbers::short(angle.in_degrees())),
            Self::Vector(vector) => f.write_str(&numbers::short_vector(*vector)),
            Self::Color(color) => write!(f, "{color}"),
            Self::Colors([first, second]) => write!(f, "({first}, {second})"),
            Self::FaceColors([x, y, z]) => write!(f, "({x}, {y}, {z})"),
            Self::Method(method) => f.write_str(method.name()),
        }
    }
}

/// Rust type for the values of one of the language's types.
pub trait FieldValue: Copy {
    /// Returns the contents of a value, or `None` if the value has another type.
    fn from_value(value: Value) -> Option<Self>;
}

/// Defines the Rust type of each of the language's types, and its conversion from [`Value`].
macro_rules! contents {
    ($($variant:ident $contents:ty;)*) => {
        /// The Rust types of values, under the names of the language's types.
        pub(super) mod contents {
            $(pub type $variant = $contents;)*
        }

        $(#[allow(unused_qualifications, reason = "the paths must be right in `contents`, too")]
        impl FieldValue for $contents {
            fn from_value(value: Value) -> Option<Self> {
                match value {
                    Value::$variant(contents) => Some(contents),
                    _ => None,
                }
            }
        })*
    };
}

contents! {
    Number f64;
    Angle crate::math::Angle;
    Vector glam::DVec3;
    Color crate::color::Color;
    Colors [crate::color::Color; 2];
    FaceColors [crate::color::Color; 3];
    Method crate::schema::Method;
}
