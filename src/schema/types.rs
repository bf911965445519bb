//! What a value can be: the language's types and their values.

use std::fmt;

use glam::DVec3;

use super::methods::Method;
use crate::{color::Color, math::Angle, numbers};

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
    /// Three colours: of the faces of a box across x, y and z.
    FaceColors,
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
            Self::FaceColors => "a list of three colours",
            Self::Method => "a method",
        }
    }

    /// The type without an article.
    pub fn word(self) -> &'static str {
        let noun = self.noun();
        noun.split_once(' ').map_or(noun, |(_, word)| word)
    }

    /// Several of the type.
    pub fn plural(self) -> String {
        match self {
            Self::Colors => "pairs of colours".to_owned(),
            Self::FaceColors => "lists of three colours".to_owned(),
            _ => format!("{}s", self.word()),
        }
    }

    /// What to write for a value of the type, for a help.
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

    /// What a value is a list of, and of how many: a vector of three numbers, a pair of two
    /// colours.
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
    /// What it is.
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

    /// Whether no part of it is infinite or not a number.
    pub fn is_finite(&self) -> bool {
        match self {
            Self::Number(number) => number.is_finite(),
            Self::Angle(angle) => angle.is_finite(),
            Self::Vector(vector) => vector.is_finite(),
            Self::Color(_) | Self::Colors(_) | Self::FaceColors(_) | Self::Method(_) => true,
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
            Self::Angle(angle) => write!(f, "{}deg", numbers::short(angle.in_degrees())),
            Self::Vector(vector) => f.write_str(&numbers::short_vector(*vector)),
            Self::Color(color) => write!(f, "{color}"),
            Self::Colors([first, second]) => write!(f, "({first}, {second})"),
            Self::FaceColors([x, y, z]) => write!(f, "({x}, {y}, {z})"),
            Self::Method(method) => f.write_str(method.name()),
        }
    }
}
