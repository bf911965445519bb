//! Keeps the state of lowering, i.e. of the conversion of a tree to a scene: the names, blocks,
//! objects and problems that were found so far.

use std::{collections::HashMap, sync::atomic::AtomicBool};

use crate::{
    cancel,
    diagnostic::{Diagnostic, Problems},
    scene::{eval::Names, lowered_block::LoweredBlock, model::Object, shape::Checkerboard},
    source::{Sources, Span},
};

/// State of the conversion of a tree to a scene.
pub(super) struct Lowering<'s> {
    pub(super) sources: &'s Sources,
    /// Flag that another thread sets to cancel lowering.
    pub(super) cancel: &'s AtomicBool,
    /// Whether a mistake, such as a comment that is never closed, hides the end of the text. No
    /// missing block is then reported.
    pub(super) cut: bool,
    pub(super) names: Names<'s>,
    /// Blocks that are not objects, such as `camera`; only the first of each kind.
    pub(super) blocks: Vec<LoweredBlock<'s>>,
    /// Whether the sum of the current indices (the counters of a `for`) is odd; `None` outside of
    /// repeated blocks. If an object's colour is a pair, the first colour is used for an even sum,
    /// and the second for an odd one.
    pub(super) is_odd: Option<bool>,
    /// The objects built so far.
    pub(super) objects: Vec<Object>,
    /// Checkerboards, each with the span of its `square` field, or of its keyword if that field is
    /// not given.
    pub(super) boards: Vec<(Checkerboard, Span)>,
    /// Whether the file has any items.
    pub(super) has_items: bool,
    /// Whether the file has a block of an object, even one with errors.
    pub(super) has_objects: bool,
    /// The span of the first use of each object's name.
    pub(super) first_names: HashMap<&'s str, Span>,
    /// The texts of items that could not be parsed.
    pub(super) bad: Vec<&'s str>,
    /// Problems that were found before the tree is converted: those of the syntax, and of the
    /// targets of `--set` arguments.
    pub(super) found: Vec<Diagnostic>,
    pub(super) problems: Problems,
    /// The spans of the values of unknown fields, in the order of the text. Syntax problems within
    /// them are dropped.
    pub(super) unknown: Vec<Span>,
}

impl<'s> Lowering<'s> {
    pub(super) fn new(sources: &'s Sources, names: Names<'s>, cancel: &'s AtomicBool) -> Self {
        Self {
            sources,
            cancel,
            cut: false,
            names,
            blocks: Vec::new(),
            is_odd: None,
            objects: Vec::new(),
            boards: Vec::new(),
            has_items: false,
            has_objects: false,
            first_names: HashMap::new(),
            bad: Vec::new(),
            found: Vec::new(),
            problems: Problems::default(),
            unknown: Vec::new(),
        }
    }

    pub(super) fn is_wanted(&self) -> bool {
        !cancel::is_set(self.cancel)
    }
}

/// Returns whether `text` contains the name `word`.
pub(super) fn mentions(text: &str, word: &str) -> bool {
    let other = |c: char| !c.is_ascii_alphanumeric() && c != '_';
    text.split(other).any(|found| found == word)
}
