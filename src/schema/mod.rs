//! The facts of the language: its blocks and their fields, types, defaults and conditions, with a
//! line of help each.
//!
//! Each fact stands here once. Lowering fills the scene from these rows, nearest names are sought
//! among them, and the language's reference is tested against them.
//!
//! `types` has what a value can be, `row_types` what a row says; the rows stand in `blocks`,
//! `methods` and `builtins`, the colours' names in `css`, and here they are looked up.

mod blocks;
mod builtins;
pub mod css;
mod methods;
mod row_types;
mod types;

pub use blocks::BLOCKS;
pub use builtins::{CONSTANTS, FUNCTIONS, Function, function};
pub use methods::{METHODS, Method, is_sure_method, method, method_names, nearest_method};
pub use row_types::{Block, Choice, Condition, Field, Kind, Preset, Several};

pub use types::{Type, Value};

use crate::suggest::{self, is_among};

/// A block's row, found by its word.
pub fn block(name: &str) -> Option<&'static Block> {
    BLOCKS.iter().find(|block| block.name == name)
}

/// Whether a word is that of a block or of a field.
pub fn is_word(word: &str) -> bool {
    let mut blocks = BLOCKS.iter();
    blocks.any(|block| block.name == word || block.field(word).is_some())
}

/// The row of a kind of block.
pub fn of_kind(kind: Kind) -> &'static Block {
    const {
        let mut at = 0;
        while at < BLOCKS.len() {
            assert!(
                BLOCKS[at].kind as usize == at,
                "rows stand in the order of their kinds"
            );
            at += 1;
        }
    }
    &BLOCKS[kind as usize]
}

/// The words that blocks start with.
pub fn block_names() -> impl Iterator<Item = &'static str> {
    BLOCKS.iter().map(|block| block.name)
}

/// The block that was probably meant, if any is near.
pub fn nearest_block(written: &str) -> Option<&'static Block> {
    let tried = BLOCKS
        .iter()
        .find(|block| is_among(written, block.also_tried));
    tried.or_else(|| suggest::nearest(written, block_names()).and_then(block))
}

/// The row of a block; for a mistyped word that of the nearest one.
pub fn block_or_nearest(written: &str) -> Option<&'static Block> {
    block(written).or_else(|| nearest_block(written))
}

/// What a predefined name stands for.
#[derive(Clone, Copy, Debug)]
pub enum Predefined {
    /// A colour or a constant.
    Value(Value),
    /// A function.
    Function(&'static Function),
}

impl Predefined {
    /// What it is, for messages.
    pub fn noun(&self) -> &'static str {
        match self {
            Self::Function(_) => "a function",
            Self::Value(Value::Angle(_)) => "a unit",
            Self::Value(value) => value.kind().noun(),
        }
    }
}

/// What a predefined name stands for, if it is one.
pub fn predefined(name: &str) -> Option<Predefined> {
    let color = css::color(name).map(Value::Color);
    let constant = || CONSTANTS.iter().find(|(constant, ..)| *constant == name);
    let value = color.or_else(|| constant().map(|&(_, value, _)| value));
    let value = value.map(Predefined::Value);
    value.or_else(|| function(name).map(Predefined::Function))
}
