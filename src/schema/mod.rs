//! The facts of the language: its blocks and their fields, types, defaults and conditions, with a line of help each.
//!
//! Each fact stands here once. Lowering fills the scene from these rows, nearest names are sought among them, and the
//! language's reference is tested against them.
//!
//! `types` has what a value can be, `rows` what a row says; the rows stand in `blocks`, `methods` and `builtins`, the colours' names in `css`, and here they are looked up.

mod blocks;
mod builtins;
pub mod css;
mod methods;
mod row_types;
mod types;

pub use blocks::BLOCKS;
pub use builtins::{CONSTANTS, FUNCTIONS, Function, function};
pub use methods::{METHODS, Method, method, method_names, nearest_method};
pub use row_types::{Block, Choice, Condition, Field, Kind, Preset, Spread};

pub use types::{Type, Value};

use crate::suggest::{self, is_among};

/// A block's row, found by its word.
pub fn block(name: &str) -> Option<&'static Block> {
    BLOCKS.iter().find(|block| block.name == name)
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

/// What a predefined name is, if it is one.
pub fn predefined(name: &str) -> Option<&'static str> {
    if css::color(name).is_some() {
        Some("a colour")
    } else if function(name).is_some() {
        Some("a function")
    } else {
        let constant = CONSTANTS.iter().any(|&(constant, _)| constant == name);
        match name {
            "pi" if constant => Some("a number"),
            _ if constant => Some("a unit"),
            _ => None,
        }
    }
}
