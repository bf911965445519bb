//! The tables of the language: its blocks and their fields, types, defaults and conditions, each
//! with a line of help.
//!
//! Each fact about the language is stated here once. A scene gets its defaults from these tables,
//! suggestions are chosen from them, and the language's reference is tested against them.
//!
//! `types` defines the language's types, and `row_types` the types of a row's parts. The rows
//! themselves are in `blocks`, `methods` and `builtins`, and the names of colours are in `css`.
//! Lookups are in this file and in `block_row`.

mod block_row;
mod blocks;
mod builtins;
pub mod css;
mod methods;
mod row_types;
mod types;

pub use blocks::*;
pub use builtins::{CONSTANTS, FUNCTIONS, Function, function};
pub use methods::{
    METHODS, Method, UnknownMethod, is_sure_method, method, method_names, nearest_method,
};
pub use row_types::{Choice, Condition, FieldRow, Preset};
pub use types::{FieldValue, Type, Value};

use crate::suggest::{self, is_among};

/// Returns the row of the kind of block with the keyword `name`, or `None` if there is none.
pub fn block(name: &str) -> Option<&'static BlockRow> {
    BLOCKS.iter().find(|block| block.name == name)
}

/// Returns whether a word is the keyword of a block or the name of a field.
pub fn is_word(word: &str) -> bool {
    let mut blocks = BLOCKS.iter();
    blocks.any(|block| block.name == word || block.field(word).is_some())
}

/// Returns the table's row for a kind of block.
pub fn of_kind(kind: BlockKind) -> &'static BlockRow {
    &BLOCKS[kind as usize]
}

/// Returns the keywords of all blocks.
pub fn block_names() -> impl Iterator<Item = &'static str> {
    BLOCKS.iter().map(|block| block.name)
}

/// Returns the row of the block whose keyword was probably meant by `written`. Returns `None` if no
/// keyword is similar.
pub fn nearest_block(written: &str) -> Option<&'static BlockRow> {
    let tried = BLOCKS
        .iter()
        .find(|block| is_among(written, block.also_tried));
    tried.or_else(|| suggest::nearest(written, block_names()).and_then(block))
}

/// Returns the row of a block by its keyword, or else by a word that is similar to a keyword.
/// Returns `None` if no keyword is similar.
pub fn block_or_nearest(written: &str) -> Option<&'static BlockRow> {
    block(written).or_else(|| nearest_block(written))
}

/// Meaning of a predefined name.
#[derive(Clone, Copy, Debug)]
pub enum Predefined {
    /// A colour or a constant.
    Value(Value),
    /// A function.
    Function(&'static Function),
}

impl Predefined {
    /// Returns a noun for what a predefined name stands for, such as "a function", for use in a
    /// message.
    pub fn noun(&self) -> &'static str {
        match self {
            Self::Function(_) => "a function",
            Self::Value(Value::Angle(_)) => "a unit",
            Self::Value(value) => value.kind().noun(),
        }
    }
}

/// Returns the meaning of a predefined name. Returns `None` for any other name.
pub fn predefined(name: &str) -> Option<Predefined> {
    let color = css::color(name).map(Value::Color);
    let constant = || CONSTANTS.iter().find(|(constant, ..)| *constant == name);
    let value = color.or_else(|| constant().map(|&(_, value, _)| value));
    let value = value.map(Predefined::Value);
    value.or_else(|| function(name).map(Predefined::Function))
}
