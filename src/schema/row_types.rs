//! The rows of the language's table: what is known of a kind of block, and of a field.

use std::{fmt, marker::PhantomData};

use glam::DVec3;

use super::types::{FieldValue, Type, Value};
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
    /// The samples.
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
    /// The kind.
    pub kind: BlockKind,
    /// The keyword that the block starts with.
    pub name: &'static str,
    /// The keyword with its article, for messages.
    pub noun: &'static str,
    /// Whether the block describes an object: a scene may have many, and each may have a name.
    pub is_object: bool,
    /// One line of help.
    pub help: &'static str,
    /// The fields.
    pub fields: &'static [FieldRow],
    /// Groups of fields that say the same in several ways.
    pub choices: &'static [Choice],
    /// Conditions between fields, written with the fields' names.
    pub together: &'static [&'static str],
    /// Words that people try for several of the fields at once, with a list of the fields' values,
    /// and these fields.
    pub several: &'static [(&'static str, &'static [&'static str])],
    /// Sets of words that people try together for the parts of one field, or for one field each.
    ///
    /// The words of a set are separated by blanks, and sets by `|`. The second part names the one
    /// field whose parts the words stand for, or as many fields as there are words.
    pub parted: &'static [(&'static str, &'static [&'static str])],
    /// Other words that people try for the keyword.
    pub also_tried: &'static str,
    /// Words of other programs that no field stands for, each with what to write instead.
    pub elsewhere: &'static [(&'static str, &'static str)],
}

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

/// A field of one kind of block whose values are of the Rust type `T`.
///
/// Code names a field by such a constant, so that a misspelt name does not compile.
#[derive(Clone, Copy, Debug)]
pub struct FieldHandle<T> {
    /// The field's name.
    pub name: &'static str,
    /// The kind of block that has the field.
    pub kind: BlockKind,
    /// The index of the field's row among those of its block.
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

impl<T: FieldValue> FieldHandle<T> {
    /// Returns a reference to the field's value if the name is the field's.
    pub fn of<'a>(self, name: &str, value: &'a mut T) -> Option<&'a mut dyn FieldValue> {
        (name == self.name).then_some(value)
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

impl BlockRow {
    /// Returns the row of a field by its name.
    pub fn field(&self, name: &str) -> Option<&'static FieldRow> {
        self.fields.iter().find(|field| field.name == name)
    }

    /// Returns the fields that a word may stand for, if it may stand for several.
    pub fn fields_perhaps(&self, written: &str) -> impl Iterator<Item = &'static FieldRow> {
        let fields = self.fields.iter();
        fields.filter(move |field| is_among(written, field.perhaps))
    }

    /// Returns what to write instead of a word of other programs that no field stands for.
    pub fn elsewhere(&self, written: &str) -> Option<&'static str> {
        let mut rows = self.elsewhere.iter();
        let row = rows.find(|(words, _)| is_among(written, words));
        row.map(|&(_, instead)| instead)
    }

    /// Returns the names of the fields.
    pub fn field_names(&self) -> impl Iterator<Item = &'static str> + use<> {
        self.fields.iter().map(|field| field.name)
    }

    /// Returns the choice that a field is a part of.
    fn choice(&self, field: &str) -> Option<&'static Choice> {
        let holds = |choice: &&Choice| choice.ways.iter().any(|way| way.contains(&field));
        self.choices.iter().find(holds)
    }

    /// Returns the fields that a field excludes: those of the other ways of its choice.
    pub fn excludes(&self, field: &str) -> impl Iterator<Item = &'static str> {
        let ways = self.choice(field).into_iter().flat_map(|it| it.ways);
        let others = ways.filter(move |way| !way.contains(&field));
        others.flat_map(|way| way.iter().copied())
    }

    /// Returns the conditions between fields that mention a field.
    pub fn rules_of(&self, field: &str) -> impl Iterator<Item = &'static str> {
        self.together.iter().copied().filter(move |rule| {
            let mut words = rule.split(|c: char| !c.is_ascii_alphanumeric() && c != '_');
            words.any(|word| word == field)
        })
    }

    /// Returns the fields that a block needs: the required ones, and those of the first way of each
    /// choice that have no default.
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

    /// Writes a block with the fields that it needs.
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

    /// Returns the field whose name is a word, apart from capitals and `_`; or else the field that
    /// people try the word for.
    pub fn field_tried(&self, written: &str) -> Option<&'static FieldRow> {
        let find = |words: fn(&FieldRow) -> &'static str| {
            let mut fields = self.fields.iter();
            fields.find(|field| is_among(written, words(field)))
        };
        find(|field| field.name).or_else(|| find(|field| field.also_tried))
    }

    /// Returns the field that was probably meant, if its name is near to what is written or to a
    /// word within it, as in `near_clip` and `eyepoint`.
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
