//! Types that describe a field in the tables of the language: its row, its default, the conditions
//! on its values, and the fields that it excludes.

use std::fmt;

use glam::DVec3;

use super::types::{Type, Value};
use crate::math::compare_half_turns;

/// Alternative ways to express the same thing, each with its own fields, such as `lookat` and
/// `direction` for the view of the camera. A block may use the fields of only one way.
#[derive(Debug)]
pub struct Choice {
    /// The alternative ways, each a list of fields. If a block uses a way, it must have all fields
    /// of this way whose preset is [`Preset::Alternative`].
    pub ways: &'static [&'static [&'static str]],
    /// Reason why a block can use only one of the alternative ways: a clause that messages put
    /// after a colon.
    pub why: &'static str,
}

/// Row for a field in the table of the language.
#[derive(Debug)]
#[non_exhaustive]
pub struct FieldRow {
    /// The field's name.
    pub name: &'static str,
    /// The type of the field's values.
    pub takes: Type,
    /// Default of the field, if it has one.
    pub preset: Preset,
    /// Conditions that every value of the field must meet.
    pub must: &'static [Condition],
    /// One line of help.
    pub help: &'static str,
    /// Words that people use by mistake for the field, separated by spaces.
    pub also_tried: &'static str,
    /// Words that people use by mistake both for this field and for other fields of the block, so
    /// that the meaning is uncertain.
    pub perhaps: &'static str,
    /// Words that people use by mistake for twice the field's value, such as `diameter` for a
    /// radius.
    pub doubled: &'static str,
    /// An example value in the language's notation, for messages and for editors to insert.
    pub example: &'static str,
}

impl FieldRow {
    /// Returns the row of a field without conditions or additional words. The field's default, if
    /// any, is also its example.
    pub(super) const fn new(
        name: &'static str,
        takes: Type,
        preset: Preset,
        help: &'static str,
    ) -> Self {
        Self {
            name,
            takes,
            preset,
            must: &[],
            help,
            also_tried: "",
            perhaps: "",
            doubled: "",
            example: match preset {
                Preset::Value(written) => written,
                _ => "",
            },
        }
    }

    /// Returns whether a value meets the field's conditions. A condition on values of another type
    /// is ignored.
    pub fn allows(&self, value: Value) -> bool {
        self.must.iter().all(|condition| condition.holds(value))
    }
}

/// The default of a field. For a field without a default, the variant says whether a block must
/// have the field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Preset {
    /// No default: the field is required.
    Required,
    /// No default: the field belongs to one of the alternative ways of a [`Choice`]. The field is
    /// required if the block uses this way.
    Alternative,
    /// No default: the field may be left out.
    Nothing,
    /// A default, in the language's notation.
    Value(&'static str),
}

/// Condition on a field's value, in addition to its type.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Condition {
    /// A number without a fraction.
    Whole,
    /// A number greater than the given one.
    MoreThan(f64),
    /// A number of at least the given one.
    AtLeast(f64),
    /// A number of at most 2 to the given power.
    AtMostTwoTo(u32),
    /// A number less than 2 to the given power.
    LessThanTwoTo(u32),
    /// An angle between 0 and 180 degrees, both excluded.
    LessThanHalfTurn,
    /// A vector other than zero.
    NotZero,
    /// A vector whose three coordinates are greater than 0.
    EachMoreThanZero,
}

impl Condition {
    /// Returns whether a value meets the condition. A condition on values of another type is
    /// ignored, i.e. the result is `true`.
    pub fn holds(&self, value: Value) -> bool {
        let two_to = |power: u32| (1_u64 << power) as f64;
        match (*self, value) {
            (Self::Whole, Value::Number(x)) => x.fract() == 0.0,
            (Self::MoreThan(bound), Value::Number(x)) => x > bound,
            (Self::AtLeast(bound), Value::Number(x)) => x >= bound,
            (Self::AtMostTwoTo(power), Value::Number(x)) => x <= two_to(power),
            (Self::LessThanTwoTo(power), Value::Number(x)) => x < two_to(power),
            (Self::LessThanHalfTurn, Value::Angle(angle)) => {
                compare_half_turns(angle, 0.0).is_gt() && compare_half_turns(angle, 1.0).is_lt()
            }
            (Self::NotZero, Value::Vector(v)) => v != DVec3::ZERO,
            (Self::EachMoreThanZero, Value::Vector(v)) => v.min_element() > 0.0,
            _ => true,
        }
    }
}

/// Formats the condition as words that follow "must be".
impl fmt::Display for Condition {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Whole => f.write_str("a whole number"),
            Self::MoreThan(bound) => write!(f, "more than {bound}"),
            Self::AtLeast(bound) => write!(f, "at least {bound}"),
            Self::AtMostTwoTo(power) => write!(f, "at most {} (2^{power})", 1_u64 << power),
            Self::LessThanTwoTo(power) => write!(f, "less than 2^{power}"),
            Self::LessThanHalfTurn => f.write_str("more than 0 and less than 180deg"),
            Self::NotZero => f.write_str("other than (0, 0, 0)"),
            Self::EachMoreThanZero => f.write_str("more than 0 in every part"),
        }
    }
}
