//! A block with the values that its fields are given, and the defaults of the others.

use std::sync::LazyLock;

use super::eval::literal;
use crate::{
    schema::{self, BlockRow, FieldHandle, FieldRow, FieldValue, Preset, Value},
    source::Span,
    syntax::tree::Name,
};

/// A block with the values that its fields are given.
#[derive(Clone)]
pub struct LoweredBlock<'s> {
    pub row: &'static BlockRow,
    /// The keyword that the block starts with.
    pub keyword: Span,
    pub span: Span,
    pub name: Option<Name<'s>>,
    /// The value that each field of the row is given, if any.
    pub given: Vec<Option<Given>>,
    /// Fields that were probably meant by a mistyped name, or by text that could not be parsed.
    pub meant: Vec<&'static str>,
    /// Whether a field may have been lost.
    pub unfinished: bool,
}

/// A field as it is written in a block.
#[derive(Clone, Copy)]
pub struct Given {
    /// The field's name.
    pub name: Span,
    /// The value's text.
    pub span: Span,
    /// The value; `None` if it is wrong.
    pub value: Option<Value>,
}

impl Given {
    /// Returns the span of name and value; for the value of an argument, that of the value alone.
    pub fn field(self) -> Span {
        if self.name.source == self.span.source {
            self.name.to(self.span)
        } else {
            self.span
        }
    }
}

impl LoweredBlock<'_> {
    /// Returns a block none of whose fields is given.
    pub fn empty(row: &'static BlockRow, span: Span) -> Self {
        Self {
            row,
            keyword: span,
            span,
            name: None,
            given: vec![None; row.fields.len()],
            meant: Vec::new(),
            unfinished: false,
        }
    }

    /// Returns what a field is given.
    pub fn given<T>(&self, field: FieldHandle<T>) -> Option<Given> {
        debug_assert_eq!(self.row.kind, field.kind, "{}", field.name);
        self.given.get(field.index).copied().flatten()
    }

    /// Returns what the field of a name is given.
    pub fn given_by_name(&self, name: &str) -> Option<Given> {
        let index = self.row.fields.iter().position(|row| row.name == name)?;
        self.given.get(index).copied().flatten()
    }

    /// Returns the value of a field, or its default; `None` if it is missing or wrong.
    pub fn value<T: FieldValue + Copy>(&self, field: FieldHandle<T>) -> Option<T> {
        let value = match self.given(field) {
            Some(given) => given.value,
            None => *DEFAULTS.get(self.row.kind as usize)?.get(field.index)?,
        };
        T::from_value(value?)
    }

    /// Returns a copy in which one more field is given.
    pub fn with(&self, row: &FieldRow, given: Given) -> Self {
        let mut block = self.clone();
        let rows = block.row.fields.iter().zip(&mut block.given);
        for (_, slot) in rows.filter(|(other, _)| other.name == row.name) {
            *slot = Some(given);
        }
        block
    }

    /// Returns the span of a field's value, or of the block's keyword if the field is not given.
    pub fn place<T>(&self, field: FieldHandle<T>) -> Span {
        self.given(field).map_or(self.keyword, |given| given.span)
    }

    /// Whether neither a field is given nor one that it excludes.
    pub fn has_place(&self, row: &FieldRow) -> bool {
        let is_given = |name: &str| self.given_by_name(name).is_some();
        !is_given(row.name) && !self.row.excludes(row.name).any(is_given)
    }
}

/// The default values of all fields, by the kind of block and the index of the field.
static DEFAULTS: LazyLock<Vec<Vec<Option<Value>>>> = LazyLock::new(|| {
    let default = |field: &FieldRow| match field.preset {
        Preset::Value(written) => literal(written, field.takes),
        Preset::Required | Preset::Alternative | Preset::Nothing => None,
    };
    let defaults = |row: &BlockRow| row.fields.iter().map(default).collect();
    schema::BLOCKS.iter().map(defaults).collect()
});
