//! The columns of the language's table that do not depend on the kinds of blocks: what is known of a
//! field, its preset, its conditions, and choices among fields.

use std::fmt;

use glam::DVec3;

use super::types::{Type, Value};
use crate::math::compare_half_turns;

/// Several ways to say the same, of which a block takes one.
#[derive(Debug)]
pub struct Choice {
    /// The fields of each way. A block that takes a way needs those of its fields that are
    /// [alternatives](Preset::Alternative).
    pub ways: &'static [&'static [&'static str]],
    /// Why only one of them can be given.
    pub why: &'static str,
}

/// The table's row for a field.
#[derive(Debug)]
pub struct FieldRow {
    /// The field's name.
    pub name: &'static str,
    /// The type of its values.
    pub takes: Type,
    /// The value of a field that is not given.
    pub preset: Preset,
    /// Conditions that every value must meet.
    pub must: &'static [Condition],
    /// One line of help.
    pub help: &'static str,
    /// Other words that people try for the field.
    pub also_tried: &'static str,
    /// Words that people try for this field and for others, so that a program cannot choose.
    pub perhaps: &'static str,
    /// Words that people try for twice the field's value.
    pub doubled: &'static str,
    /// A possible value in the language's notation: for messages, and for editors to insert.
    pub example: &'static str,
}

impl FieldRow {
    /// Returns the row of a field without conditions or other words. The example is the default.
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

    /// Whether a value meets the field's conditions. Conditions on other types hold.
    pub fn allows(&self, value: Value) -> bool {
        self.must.iter().all(|condition| condition.holds(value))
    }
}

/// The value of a field that is not given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Preset {
    /// None: the field must be given.
    Required,
    /// None: the field must be given if its way of a [`Choice`] is taken.
    Alternative,
    /// None: the field may be left out.
    Nothing,
    /// A default, in the language's notation.
    Value(&'static str),
}

/// A condition on a field's value, beyond its type.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Condition {
    /// A number without a fraction.
    Whole,
    /// A number greater than this one.
    MoreThan(f64),
    /// A number not less than this one.
    AtLeast(f64),
    /// A number not greater than 2 to this power.
    AtMostTwoTo(u32),
    /// A number less than 2 to this power.
    LessThanTwoTo(u32),
    /// An angle between 0 and 180 degrees, both excluded.
    LessThanHalfTurn,
    /// A vector other than zero.
    NotZero,
    /// A vector whose three coordinates are greater than 0.
    EachMoreThanZero,
}

impl Condition {
    /// Whether a value meets the condition. Conditions on other types hold.
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

/// The condition in words, after "must be".
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
