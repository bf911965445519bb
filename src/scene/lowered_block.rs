//! A block with evaluated fields.
//!
//! In: a block of the syntax tree. Out: the value of each field that the block has, and the
//! defaults of the other fields.

use std::sync::{LazyLock, OnceLock};

use super::eval::literal;
use crate::{
    schema::{self, BlockRow, FieldHandle, FieldRow, FieldValue, Preset, Value},
    source::Span,
    syntax::tree::Name,
};

/// A block, and the evaluated fields that are written in it.
#[derive(Clone)]
pub struct LoweredBlock<'s> {
    pub row: &'static BlockRow,
    /// Span of the keyword that the block starts with.
    pub keyword: Span,
    pub span: Span,
    pub name: Option<Name<'s>>,
    /// Fields that the block has, in the order of the fields of [`Self::row`]; `None` for a field
    /// that it does not have.
    pub given: Vec<Option<Given>>,
    /// Names of fields that were probably meant by a mistyped name, or by text that could not be
    /// parsed. They are not reported as missing.
    pub meant: Vec<&'static str>,
    /// Whether a syntax error may have hidden a field. Missing fields are then not reported.
    pub unfinished: bool,
}

/// A field of a block: the spans of its name and its value, and the value.
#[derive(Clone, Copy)]
pub struct Given {
    /// Span of the field's name.
    pub name: Span,
    /// Span of the value's text.
    pub span: Span,
    /// The value; `None` if it has errors.
    pub value: Option<Value>,
}

impl Given {
    /// Returns the span of name and value. If the value comes from a `--set` argument, returns the
    /// span of the value alone.
    pub fn field(self) -> Span {
        if self.name.source == self.span.source {
            self.name.to(self.span)
        } else {
            self.span
        }
    }
}

impl LoweredBlock<'_> {
    /// Returns a block of the kind `row` without fields.
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

    /// Returns the span and the value of a field. Returns `None` if the block does not have the
    /// field.
    pub fn given<T>(&self, field: FieldHandle<T>) -> Option<Given> {
        debug_assert_eq!(self.row.kind, field.kind, "{}", field.name);
        self.given.get(field.index).copied().flatten()
    }

    /// Returns the span and the value of the field `name`. Returns `None` if the block does not
    /// have this field.
    pub fn given_by_name(&self, name: &str) -> Option<Given> {
        let index = self.row.fields.iter().position(|row| row.name == name)?;
        self.given.get(index).copied().flatten()
    }

    /// Returns the value of a field, or its default if the block does not have the field. Returns
    /// `None` if the value has errors, or if the field is missing and has no default.
    pub fn value<T: FieldValue + Copy>(&self, field: FieldHandle<T>) -> Option<T> {
        let value = match self.given(field) {
            Some(given) => given.value,
            None => default(self.row, field.index),
        };
        T::from_value(value?)
    }

    /// Returns a copy of the block with one more field.
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

    /// Returns whether the field `row` can be added to the block: the block has neither this field
    /// nor one that excludes it.
    pub fn has_place(&self, row: &FieldRow) -> bool {
        let is_given = |name: &str| self.given_by_name(name).is_some();
        !is_given(row.name) && !self.row.excludes(row.name).any(is_given)
    }
}

/// Returns the default value of the field with the index `index` of a kind of block; `None` if it
/// has none.
fn default(row: &BlockRow, index: usize) -> Option<Value> {
    // Default values of all fields, indexed by the kind of block and by the field's position in the
    // schema's row for this kind. Each is evaluated when it is first needed, because evaluating all
    // of them takes longer than reading a small scene.
    static DEFAULTS: LazyLock<Vec<Vec<OnceLock<Option<Value>>>>> = LazyLock::new(|| {
        let none = |row: &BlockRow| row.fields.iter().map(|_| OnceLock::new()).collect();
        schema::BLOCKS.iter().map(none).collect()
    });
    let field = row.fields.get(index)?;
    let slot = DEFAULTS.get(row.kind as usize)?.get(index)?;
    *slot.get_or_init(|| match field.preset {
        Preset::Value(written) => literal(written, field.takes),
        Preset::Required | Preset::Alternative | Preset::Nothing => None,
    })
}
