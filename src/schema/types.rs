//! The language's types and values.

use std::fmt;

use crate::{math::Angle, numbers};

/// Defines the enums of the language's types and values, and implements [`FieldValue`] for the Rust
/// types that hold the values.
///
/// Each line contains a variant's name, its Rust type, the type's name with an article, the plural,
/// and the help that says what to write for a value of the type.
macro_rules! types {
    ($($variant:ident($contents:ty) noun $noun:literal plural $plural:literal such_as $such_as:literal;)*) => {
        /// A type of the language.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[non_exhaustive]
        pub enum Type {
            $(#[doc = concat!("The type of ", $plural, ".")] $variant,)*
        }

        impl Type {
            /// Returns the type with its article, such as `a number`.
            pub fn noun(self) -> &'static str {
                match self {
                    $(Self::$variant => $noun,)*
                }
            }

            /// Returns the plural of the type, such as `numbers`.
            pub fn plural(self) -> &'static str {
                match self {
                    $(Self::$variant => $plural,)*
                }
            }

            /// Returns a help text with an example value of the type.
            pub fn such_as(self) -> &'static str {
                match self {
                    $(Self::$variant => $such_as,)*
                }
            }
        }

        /// A value of the language.
        #[derive(Clone, Copy, Debug, PartialEq)]
        #[non_exhaustive]
        pub enum Value {
            $(#[doc = concat!("The value is ", $noun, ".")] $variant(contents::$variant),)*
        }

        impl Value {
            /// Returns the value's type.
            pub fn kind(&self) -> Type {
                match self {
                    $(Self::$variant(_) => Type::$variant,)*
                }
            }
        }

        /// The Rust types of values, under the names of the language's types.
        pub(super) mod contents {
            $(pub type $variant = $contents;)*
        }

        $(impl FieldValue for contents::$variant {
            fn from_value(value: Value) -> Option<Self> {
                match value {
                    Value::$variant(contents) => Some(contents),
                    _ => None,
                }
            }

            fn value(&self) -> Value {
                Value::$variant(*self)
            }

            fn set(&mut self, value: Value) -> Option<()> {
                *self = Self::from_value(value)?;
                Some(())
            }
        })*
    };
}

types! {
    Number(f64) noun "a number" plural "numbers"
        such_as "write a number, such as `2`";
    Angle(crate::math::Angle) noun "an angle" plural "angles"
        such_as "write an angle, such as `30deg`";
    Vector(glam::DVec3) noun "a vector" plural "vectors"
        such_as "write three numbers, such as `(0, 1, 0)`";
    Color(crate::color::Color) noun "a colour" plural "colours"
        such_as "write a colour, such as `olive` or `rgb(255, 165, 0)`";
    Colors([crate::color::Color; 2]) noun "a pair of colours" plural "pairs of colours"
        such_as "write two colours, such as `(gray, white)`";
    FaceColors([crate::color::Color; 3]) noun "a list of three colours" plural "lists of three colours"
        such_as "write three colours, such as `(tan, wheat, peru)`";
    Method(crate::schema::Method) noun "a method" plural "methods"
        such_as "write a method, such as `jittered`";
}

impl Type {
    /// Returns the type without an article, such as `number`.
    pub fn word(self) -> &'static str {
        let noun = self.noun();
        noun.split_once(' ').map_or(noun, |(_, word)| word)
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

impl Value {
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

/// Formats the value in the language's notation, for people to read. Numbers are rounded, most of
/// them to six digits.
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
pub trait FieldValue {
    /// Returns the contents of a value, or `None` if the value has another type.
    fn from_value(value: Value) -> Option<Self>
    where
        Self: Sized;

    /// Converts the Rust value into a value of the language.
    fn value(&self) -> Value;

    /// Replaces this value by `value`. Returns `None`, and changes nothing, if `value` has another
    /// type.
    fn set(&mut self, value: Value) -> Option<()>;
}
