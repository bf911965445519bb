//! The values of a block's fields.

use std::{collections::HashMap, sync::LazyLock};

use glam::DVec3;

use super::Block;
use crate::{
    color::Color,
    math::Angle,
    scene::{
        Method,
        eval::{Evaluator, Names},
        schema::{self, Kind, Preset, Type},
        value::Value,
    },
    source::{Source, SourceId, Sources},
    syntax,
};

/// The values of a block's fields, defaults included. None where a value is missing or failed.
pub(super) struct Fields<'b, 's> {
    block: Option<&'b Block<'s>>,
    kind: Kind,
}

impl<'b, 's> Fields<'b, 's> {
    pub(super) fn of(block: Option<&'b Block<'s>>, kind: Kind) -> Self {
        Self { block, kind }
    }

    fn value(&self, name: &'static str) -> Option<Value> {
        match self.block.and_then(|block| block.given(name)) {
            Some(given) => given.value,
            None => DEFAULTS.get(&(self.kind, name)).copied(),
        }
    }
}

/// For each type of a field the method that gives its value.
macro_rules! accessors {
    ($($name:ident $variant:ident $gives:ty;)*) => {
        impl Fields<'_, '_> {
            $(pub(super) fn $name(&self, name: &'static str) -> Option<$gives> {
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
    method Method Method;
}

/// The values of the defaults, which the table has as they are written.
static DEFAULTS: LazyLock<HashMap<(Kind, &str), Value>> = LazyLock::new(|| {
    let rows = schema::BLOCKS.iter();
    let fields = rows.flat_map(|row| row.fields.iter().map(|field| (row.kind, field)));
    let defaults = fields.filter_map(|(kind, field)| {
        let Preset::Value(written) = field.preset else {
            return None;
        };
        let value = match field.takes {
            Type::Method => schema::method(written).map(Value::Method),
            takes => default(written, takes),
        };
        Some(((kind, field.name), value?))
    });
    defaults.collect()
});

fn default(written: &str, takes: Type) -> Option<Value> {
    let sources = Sources::new(Source::from_text("", written));
    let (tree, _) = syntax::parse_value(&sources.file, SourceId::File, 0);
    let mut evaluator = Evaluator {
        sources: &sources,
        names: &Names::default(),
        problems: &mut Vec::new(),
    };
    evaluator.value(&tree, Some(takes))
}
