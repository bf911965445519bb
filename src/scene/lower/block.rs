//! A block with what it was given, and the values of its fields, defaults included.

use std::{collections::HashMap, sync::LazyLock};

use glam::DVec3;

use crate::{
    color::Color,
    math::Angle,
    scene::eval::literal,
    schema::{self, Field, Kind, Method, Preset, Value},
    source::Span,
    syntax::tree::Name,
};

/// A block with what it was given.
#[derive(Clone)]
pub(super) struct Block<'s> {
    pub row: &'static schema::Block,
    /// The word that it starts with.
    pub keyword: Span,
    pub span: Span,
    pub name: Option<Name<'s>>,
    /// For each field of the row what it was given.
    pub given: Vec<Option<Given>>,
    /// Fields that were probably meant, by a mistyped name or in what was not understood.
    pub meant: Vec<&'static str>,
    /// Whether a field may have been lost.
    pub unfinished: bool,
}

/// What a field was given.
#[derive(Clone, Copy)]
pub(super) struct Given {
    /// The field's name.
    pub name: Span,
    /// The value's text.
    pub span: Span,
    /// None if it failed.
    pub value: Option<Value>,
}

impl Given {
    /// Name and value; of an argument's, that is the value alone.
    pub fn field(self) -> Span {
        match self.name.source == self.span.source {
            true => self.name.to(self.span),
            false => self.span,
        }
    }
}

impl Block<'_> {
    /// A block that is given nothing.
    pub fn empty(row: &'static schema::Block, span: Span) -> Self {
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

    /// What a field was given.
    pub fn given(&self, name: &str) -> Option<Given> {
        let index = self.row.fields.iter().position(|row| row.name == name)?;
        self.given.get(index).copied().flatten()
    }

    /// The same with one more field.
    pub fn with(&self, row: &Field, given: Given) -> Self {
        let mut block = self.clone();
        let rows = block.row.fields.iter().zip(&mut block.given);
        for (_, slot) in rows.filter(|(other, _)| other.name == row.name) {
            *slot = Some(given);
        }
        block
    }

    /// The value that stands for a field, or the block's keyword.
    pub fn place(&self, name: &str) -> Span {
        self.given(name).map_or(self.keyword, |given| given.span)
    }

    /// Whether it may still be given a field.
    pub fn has_place(&self, row: &Field) -> bool {
        let is_given = |name: &str| self.given(name).is_some();
        !is_given(row.name) && !self.row.excludes(row.name).any(is_given)
    }

    fn value(&self, name: &'static str) -> Option<Value> {
        match self.given(name) {
            Some(given) => given.value,
            None => DEFAULTS.get(&(self.row.kind, name)).copied(),
        }
    }
}

/// For each type of a field the method that gives its value; none where it is missing or failed.
macro_rules! accessors {
    ($($name:ident $variant:ident $gives:ty;)*) => {
        impl Block<'_> {
            $(pub fn $name(&self, name: &'static str) -> Option<$gives> {
                match self.value(name)? {
                    Value::$variant(value) => Some(value),
                    _ => None,
                }
            })*
        }
    };
}

accessors! {
    number Number f64;
    angle Angle Angle;
    vector Vector DVec3;
    color Color Color;
    colors Colors [Color; 2];
    face_colors FaceColors [Color; 3];
    method Method Method;
}

/// The values of the defaults, which the table has as they are written.
static DEFAULTS: LazyLock<HashMap<(Kind, &str), Value>> = LazyLock::new(|| {
    let rows = schema::BLOCKS.iter();
    let fields = rows.flat_map(|row| row.fields.iter().map(|field| (row.kind, field)));
    let defaults = fields.filter_map(|(kind, field)| match field.preset {
        Preset::Value(written) => Some(((kind, field.name), literal(written, field.takes)?)),
        _ => None,
    });
    defaults.collect()
});
