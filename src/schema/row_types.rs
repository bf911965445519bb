//! Columns of the language's tables: what is known about a kind of block and about a field.

use std::{fmt, marker::PhantomData};

use glam::DVec3;

use super::types::{Type, Value};
use crate::{
    math::compare_half_turns,
    suggest::{self, is_among},
};

/// A kind of block.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum BlockKind {
    /// The picture.
    Image,
    /// The camera.
    Camera,
    /// The sampler.
    Sampler,
    /// A sphere.
    Sphere,
    /// A triangle.
    Triangle,
    /// A box.
    Box,
    /// The checkerboard.
    Checkerboard,
}

/// The table's row for a kind of block.
#[derive(Debug)]
pub struct BlockRow {
    /// Kind of block.
    pub kind: BlockKind,
    /// The keyword that the block starts with.
    pub name: &'static str,
    /// The keyword with its article, for messages.
    pub noun: &'static str,
    /// Whether the block describes an object. A scene may have many objects, and each may have a
    /// name.
    pub is_object: bool,
    /// One line of help.
    pub help: &'static str,
    /// Rows of the block's fields.
    pub fields: &'static [FieldRow],
    /// Groups of fields that express the same thing in different ways and exclude each other.
    pub choices: &'static [Choice],
    /// Conditions that relate several fields to each other, as formulas in words with the fields'
    /// names, such as `near < far`.
    pub together: &'static [&'static str],
    /// Words that people use by mistake to give several fields at once.
    pub several: &'static [Several],
    /// Sets of words that people use together by mistake, such as three names for the three
    /// coordinates of one field.
    ///
    /// The words of a set are separated by spaces, and sets by `|`. The second element names either
    /// the one field whose parts the words stand for, or one field for each word.
    pub parted: &'static [(&'static str, &'static [&'static str])],
    /// Words that people use by mistake for the keyword, separated by spaces.
    pub also_tried: &'static str,
    /// Words of other programs that correspond to no field of the block, each with the help, which
    /// says what to write instead.
    pub elsewhere: &'static [(&'static str, &'static str)],
}

/// Fields that exclude each other, grouped into ways to express the same thing. A block uses one of
/// the ways.
#[derive(Debug)]
pub struct Choice {
    /// The fields of each way. A block that uses a way must have those of its fields whose preset
    /// is [`Preset::Alternative`].
    pub ways: &'static [&'static [&'static str]],
    /// The reason why a block can use only one of the ways, for messages.
    pub why: &'static str,
}

/// Words that people use by mistake to give several fields at once. A list with the values of these
/// fields follows the word, as in `resolution (640, 480)`.
#[derive(Debug)]
pub struct Several {
    /// The words, separated by spaces.
    pub words: &'static str,
    /// Names of the fields, in the order of the values.
    pub fields: &'static [&'static str],
}

/// The table's row for a field.
#[derive(Debug)]
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
    /// Returns the row of a field without conditions or additional words. Its example is its
    /// default.
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

    /// Returns whether a value meets the field's conditions. A condition on another type of value
    /// counts as met.
    pub fn allows(&self, value: Value) -> bool {
        self.must.iter().all(|condition| condition.holds(value))
    }
}

/// Typed handle of a field, whose values have the Rust type `T`.
///
/// Code refers to a field by such a constant, so that a misspelt name does not compile.
#[derive(Clone, Copy, Debug)]
pub struct FieldHandle<T> {
    /// The field's name.
    pub name: &'static str,
    /// The kind of block that has the field.
    pub kind: BlockKind,
    /// Index of the field's row in [`BlockRow::fields`].
    pub index: usize,
    values: PhantomData<T>,
}

impl<T> FieldHandle<T> {
    pub(super) const fn new(name: &'static str, kind: BlockKind, index: usize) -> Self {
        Self {
            name,
            kind,
            index,
            values: PhantomData,
        }
    }
}

/// Default of a field: what holds if a block does not have the field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Preset {
    /// No default: the field is required.
    Required,
    /// No default: the field is required if the block uses its way of a [`Choice`].
    Alternative,
    /// No default: the field may be left out.
    Nothing,
    /// A default, in the language's notation.
    Value(&'static str),
}

/// Condition on a field's value, in addition to its type.
#[derive(Clone, Copy, Debug, PartialEq)]
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
    /// Returns whether a value meets the condition. A condition on another type of value counts as
    /// met.
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

impl BlockRow {
    /// Returns the row of a field by its name.
    pub fn field(&self, name: &str) -> Option<&'static FieldRow> {
        self.fields.iter().find(|field| field.name == name)
    }

    /// Returns all fields of the block for which people use `written` by mistake, if there are
    /// several, so that its meaning is uncertain.
    pub fn fields_perhaps(&self, written: &str) -> impl Iterator<Item = &'static FieldRow> {
        let fields = self.fields.iter();
        fields.filter(move |field| is_among(written, field.perhaps))
    }

    /// Returns the help for a word of other programs that corresponds to no field.
    pub fn elsewhere(&self, written: &str) -> Option<&'static str> {
        let mut rows = self.elsewhere.iter();
        let row = rows.find(|(words, _)| is_among(written, words));
        row.map(|&(_, instead)| instead)
    }

    /// Returns the names of the fields.
    pub fn field_names(&self) -> impl Iterator<Item = &'static str> + use<> {
        self.fields.iter().map(|field| field.name)
    }

    /// Returns the choice that contains a field, if there is one.
    fn choice(&self, field: &str) -> Option<&'static Choice> {
        let holds = |choice: &&Choice| choice.ways.iter().any(|way| way.contains(&field));
        self.choices.iter().find(holds)
    }

    /// Returns the fields that a field excludes: the fields of the other ways of its [`Choice`].
    pub fn excludes(&self, field: &str) -> impl Iterator<Item = &'static str> {
        let ways = self.choice(field).into_iter().flat_map(|it| it.ways);
        let others = ways.filter(move |way| !way.contains(&field));
        others.flat_map(|way| way.iter().copied())
    }

    /// Returns those conditions in [`Self::together`] that contain the name of the field `field`.
    pub fn rules_of(&self, field: &str) -> impl Iterator<Item = &'static str> {
        self.together.iter().copied().filter(move |rule| {
            let mut words = rule.split(|c: char| !c.is_ascii_alphanumeric() && c != '_');
            words.any(|word| word == field)
        })
    }

    /// Returns the fields of a minimal block: the required ones, and of each choice those fields of
    /// the first way that have no default.
    pub fn least_fields(&self) -> Vec<&'static FieldRow> {
        let is_needed = |field: &&FieldRow| match field.preset {
            Preset::Required => true,
            Preset::Alternative => self
                .choice(field.name)
                .and_then(|choice| choice.ways.first())
                .is_some_and(|first| first.contains(&field.name)),
            Preset::Nothing | Preset::Value(_) => false,
        };
        self.fields.iter().filter(is_needed).collect()
    }

    /// Returns the text of a minimal block, with example values.
    pub fn example(&self) -> String {
        let fields = self.least_fields().into_iter();
        let fields = fields.map(|field| format!("{} {}", field.name, field.example));
        let fields: Vec<String> = fields.collect();
        if fields.is_empty() {
            format!("{} {{}}", self.name)
        } else {
            format!("{} {{ {} }}", self.name, fields.join("  "))
        }
    }

    /// Returns the field named `written`, ignoring case and `_`, or else the field for which people
    /// use `written` by mistake.
    pub fn field_tried(&self, written: &str) -> Option<&'static FieldRow> {
        let find = |words: fn(&FieldRow) -> &'static str| {
            let mut fields = self.fields.iter();
            fields.find(|field| is_among(written, words(field)))
        };
        find(|field| field.name).or_else(|| find(|field| field.also_tried))
    }

    /// Returns the field that was probably meant by `written`: its name is similar to `written` or
    /// occurs in it as a word, as in `near_clip` and `eyepoint`.
    pub fn nearest_field(&self, written: &str) -> Option<&'static FieldRow> {
        let words = suggest::words(written);
        let starts = |field: &&FieldRow| field.name.len() > 2 && written.starts_with(field.name);
        suggest::nearest(written, self.field_names())
            .and_then(|name| self.field(name))
            .or_else(|| {
                words
                    .iter()
                    .find_map(|word| self.field(&word.to_ascii_lowercase()))
            })
            .or_else(|| words.iter().rev().find_map(|word| self.field_tried(word)))
            .or_else(|| {
                self.fields
                    .iter()
                    .filter(starts)
                    .max_by_key(|field| field.name.len())
            })
    }
}
