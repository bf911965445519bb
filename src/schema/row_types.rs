//! What a row of the language's table says: of a kind of block, and of a field.

use std::fmt;

use glam::DVec3;

use super::types::{Type, Value};
use crate::{
    math::compare_half_turns,
    suggest::{self, is_among},
};

/// A kind of block.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Kind {
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

/// What there is to know about a kind of block.
#[derive(Debug)]
pub struct Block {
    /// Its kind.
    pub kind: Kind,
    /// The word that it starts with.
    pub name: &'static str,
    /// The word with its article, for messages.
    pub noun: &'static str,
    /// Whether it is an object: it may have a name, and there may be many.
    pub is_object: bool,
    /// What it is, in a line.
    pub help: &'static str,
    /// Its fields.
    pub fields: &'static [Field],
    /// What it says in one of several ways.
    pub choices: &'static [Choice],
    /// Conditions between fields, each by its name.
    pub together: &'static [&'static str],
    /// Other words that people try for several of its fields.
    pub several: &'static [Several],
    /// Words that people try together, several rows of them with `|` between, with the field that
    /// is made of such parts, or the field for each.
    pub parted: &'static [(&'static str, &'static [&'static str])],
    /// Other words that people try for it.
    pub also_tried: &'static str,
    /// Words of other languages for what is said elsewhere or otherwise here, with what to write
    /// instead.
    pub elsewhere: &'static [(&'static str, &'static str)],
}

/// Ways to say the same thing, of which a block takes one.
#[derive(Debug)]
pub struct Choice {
    /// Each way, with the fields that belong to it. A way that is taken needs those of them that
    /// are [alternatives](Preset::Alternative).
    pub ways: &'static [&'static [&'static str]],
    /// Why it is one of them.
    pub why: &'static str,
}

/// A word that people try for several fields at once, with a list of their values.
#[derive(Debug)]
pub struct Several {
    /// The words.
    pub words: &'static str,
    /// The fields.
    pub fields: &'static [&'static str],
}

/// What there is to know about a field.
#[derive(Debug)]
pub struct Field {
    /// Its name.
    pub name: &'static str,
    /// What it takes.
    pub takes: Type,
    /// What it is when it is not given.
    pub preset: Preset,
    /// What its value must be.
    pub must: &'static [Condition],
    /// What it is, in a line.
    pub help: &'static str,
    /// Other words that people try for it.
    pub also_tried: &'static str,
    /// Words that people try for it and for something else, so that a program cannot choose.
    pub perhaps: &'static str,
    /// Words that people try for twice its value.
    pub doubled: &'static str,
    /// A value that it can have, as it is written: for messages, and to type over.
    pub example: &'static str,
}

impl Field {
    /// A field for which any value of its type will do. Its example is its default.
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

    /// Whether a value keeps its conditions; one of another type has no say in it.
    pub fn allows(&self, value: Value) -> bool {
        self.must.iter().all(|condition| condition.holds(value))
    }
}

/// What a field is when it is not given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Preset {
    /// It must be given.
    Required,
    /// It must be given where its way of a [`Choice`] is taken.
    Alternative,
    /// Nothing.
    Nothing,
    /// This, as it is written.
    Value(&'static str),
}

/// What a field's value must be, beyond its type.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Condition {
    /// A number without a fraction.
    Whole,
    /// A number above this one.
    MoreThan(f64),
    /// A number not below this one.
    AtLeast(f64),
    /// A number not above 2 to this power.
    AtMostTwoTo(u32),
    /// A number below 2 to this power.
    LessThanTwoTo(u32),
    /// An angle between 0 and 180 degrees, both excluded.
    LessThanHalfTurn,
    /// A vector other than zero.
    NotZero,
    /// A vector whose three parts are above 0.
    EachMoreThanZero,
}

impl Condition {
    /// Whether a value keeps it; one of another type has no say in it.
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

/// What the value must be, in words.
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

impl Block {
    /// A field's row, found by its name.
    pub fn field(&self, name: &str) -> Option<&'static Field> {
        self.fields.iter().find(|field| field.name == name)
    }

    /// The fields that a word may stand for, among other things.
    pub fn fields_perhaps(&self, written: &str) -> impl Iterator<Item = &'static Field> {
        let fields = self.fields.iter();
        fields.filter(move |field| is_among(written, field.perhaps))
    }

    /// What to write instead of a word of other languages that no field stands for.
    pub fn elsewhere(&self, written: &str) -> Option<&'static str> {
        let mut rows = self.elsewhere.iter();
        let row = rows.find(|(words, _)| is_among(written, words));
        row.map(|&(_, instead)| instead)
    }

    /// The names of its fields.
    pub fn field_names(&self) -> impl Iterator<Item = &'static str> + use<> {
        self.fields.iter().map(|field| field.name)
    }

    /// The choice that a field is one of the ways of.
    fn choice(&self, field: &str) -> Option<&'static Choice> {
        let holds = |choice: &&Choice| choice.ways.iter().any(|way| way.contains(&field));
        self.choices.iter().find(holds)
    }

    /// The fields that a field excludes: those of the other ways to say the same.
    pub fn excludes(&self, field: &str) -> impl Iterator<Item = &'static str> {
        let ways = self.choice(field).into_iter().flat_map(|it| it.ways);
        let others = ways.filter(move |way| !way.contains(&field));
        others.flat_map(|way| way.iter().copied())
    }

    /// The conditions that hold between a field and others, or something else: those that name it.
    pub fn rules_of(&self, field: &str) -> impl Iterator<Item = &'static str> {
        let rules = self.together.iter().copied();
        rules.filter(move |rule| {
            let mut words = rule.split(|c: char| !c.is_ascii_alphanumeric() && c != '_');
            words.any(|word| word == field)
        })
    }

    /// The fields without which there is no such block: those that have no default, and of
    /// alternatives the first.
    pub fn least_fields(&self) -> Vec<&'static Field> {
        let is_needed = |field: &&Field| match field.preset {
            Preset::Required => true,
            Preset::Alternative => self
                .choice(field.name)
                .and_then(|choice| choice.ways.first())
                .is_some_and(|first| first.contains(&field.name)),
            Preset::Nothing | Preset::Value(_) => false,
        };
        self.fields.iter().filter(is_needed).collect()
    }

    /// A block with the fields that it needs, as it is written.
    pub fn example(&self) -> String {
        let fields = self.least_fields().into_iter();
        let fields = fields.map(|field| format!("{} {}", field.name, field.example));
        let fields: Vec<String> = fields.collect();
        match fields.is_empty() {
            true => format!("{} {{}}", self.name),
            false => format!("{} {{ {} }}", self.name, fields.join("  ")),
        }
    }

    /// The field that is written like this but for capitals and `_`, or that people try this word
    /// for.
    pub fn field_tried(&self, written: &str) -> Option<&'static Field> {
        let find = |words: fn(&Field) -> &'static str| {
            let mut fields = self.fields.iter();
            fields.find(|field| is_among(written, words(field)))
        };
        find(|field| field.name).or_else(|| find(|field| field.also_tried))
    }

    /// The field that was probably meant, if any is near: by its letters, or by a word within what
    /// was written, as in `near_clip` and `eyepoint`.
    pub fn nearest_field(&self, written: &str) -> Option<&'static Field> {
        let words = suggest::words(written);
        let starts = |field: &&Field| field.name.len() > 2 && written.starts_with(field.name);
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
