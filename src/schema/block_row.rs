//! Looks up the fields of a kind of block: by their names, by similar words, or by words that
//! people use for them by mistake.

use super::{
    blocks::BlockRow,
    row_types::{Choice, FieldRow, Preset},
    types::Type,
};
use crate::suggest::{self, is_among};

impl BlockRow {
    /// Returns the row of the field `name`. Returns `None` if the block has no such field.
    pub fn field(&self, name: &str) -> Option<&'static FieldRow> {
        self.fields.iter().find(|field| field.name == name)
    }

    /// Returns the fields that `written` may stand for according to their [`FieldRow::perhaps`].
    /// Users write such a word by mistake for different fields, so the meaning is uncertain.
    pub fn fields_perhaps(&self, written: &str) -> impl Iterator<Item = &'static FieldRow> {
        let fields = self.fields.iter();
        fields.filter(move |field| is_among(written, field.perhaps))
    }

    /// Returns the help for a word that names a field in other programs, although this block has no
    /// such field. Returns `None` for any other word.
    pub fn elsewhere(&self, written: &str) -> Option<&'static str> {
        let mut rows = self.elsewhere.iter();
        let row = rows.find(|(words, _)| is_among(written, words));
        row.map(|&(_, instead)| instead)
    }

    /// Returns the names of the fields.
    pub fn field_names(&self) -> impl Iterator<Item = &'static str> + use<> {
        self.fields.iter().map(|field| field.name)
    }

    /// Guesses the fields of values that are written without names at the start of a block, as in
    /// `sphere { (0, 1, 0) 2 }`, and returns the fields' names. Returns an empty list if no fields
    /// fit.
    ///
    /// `are_vectors` says of each value whether it is a vector.
    pub fn names_of_values(&self, are_vectors: &[bool]) -> &'static [&'static str] {
        let is_vector = |name: &&str| self.field(name).map(|field| field.takes == Type::Vector);
        let fits = |names: &&&[&str]| {
            let fields = names.iter().map(is_vector);
            fields.eq(are_vectors.iter().copied().map(Some))
        };
        self.nameless.iter().find(fits).copied().unwrap_or_default()
    }

    /// Returns the [`Choice`] that a field belongs to, such as the choice between the camera's
    /// fields `lookat` and `direction`. Returns `None` if the field belongs to no choice.
    fn choice(&self, field: &str) -> Option<&'static Choice> {
        let holds = |choice: &&Choice| choice.ways.iter().any(|way| way.contains(&field));
        self.choices.iter().find(holds)
    }

    /// Returns the fields that a block cannot have together with `field`, such as `direction` for
    /// `lookat`. They belong to the other ways of the field's [`Choice`].
    pub fn excludes(&self, field: &str) -> impl Iterator<Item = &'static str> {
        let ways = self.choice(field).into_iter().flat_map(|it| it.ways);
        let others = ways.filter(move |way| !way.contains(&field));
        others.flat_map(|way| way.iter().copied())
    }

    /// Returns the conditions on several fields, such as `near < far`, that mention the field.
    pub fn rules_of(&self, field: &str) -> impl Iterator<Item = &'static str> {
        self.joint_conditions.iter().copied().filter(move |rule| {
            let mut words = rule.split(|c: char| !c.is_ascii_alphanumeric() && c != '_');
            words.any(|word| word == field)
        })
    }

    /// Returns the fields of a minimal block: the required ones and, if there are alternatives,
    /// those fields of the first alternative that have no default.
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
    /// use `written` by mistake. Returns `None` if there is neither.
    pub fn field_tried(&self, written: &str) -> Option<&'static FieldRow> {
        let find = |words: fn(&FieldRow) -> &'static str| {
            let mut fields = self.fields.iter();
            fields.find(|field| is_among(written, words(field)))
        };
        find(|field| field.name).or_else(|| find(|field| field.also_tried))
    }

    /// Returns the field that was probably meant by `written`. The field's name is similar to
    /// `written`, or `written` contains the name as a word or at its start: `near` in `near_clip`,
    /// `eye` in `eyepoint`. Returns `None` if no field fits.
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
