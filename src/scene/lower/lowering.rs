//! The state of lowering: what is known of a scene while its items are read.

use std::{collections::HashMap, sync::atomic::AtomicBool};

use crate::{
    cancel,
    diagnostic::{Diagnostic, Problems},
    scene::{eval::Names, lowered_block::LoweredBlock, model::Object, shape::Checkerboard},
    source::{Sources, Span},
};

/// The state of lowering.
pub(super) struct Lowering<'s> {
    pub(super) sources: &'s Sources,
    /// Set by another thread to give up.
    pub(super) cancel: &'s AtomicBool,
    /// Whether a mistake hides the end of the text, such as a comment that is never closed.
    pub(super) cut: bool,
    pub(super) names: Names<'s>,
    /// The blocks other than objects, each the first of its kind.
    pub(super) blocks: Vec<LoweredBlock<'s>>,
    /// Whether the sum of the current indices is odd, within a repeated block.
    pub(super) is_odd: Option<bool>,
    /// The objects built so far.
    pub(super) objects: Vec<Object>,
    /// The checkerboards, each with the span of its `square`, or of its keyword.
    pub(super) boards: Vec<(Checkerboard, Span)>,
    /// Whether the file has any items.
    pub(super) has_items: bool,
    /// Whether the file has a block of an object, built or not.
    pub(super) has_objects: bool,
    /// The span of the first use of each object's name.
    pub(super) first_names: HashMap<&'s str, Span>,
    /// The texts of items that could not be parsed.
    pub(super) bad: Vec<&'s str>,
    /// Problems from before lowering: of the syntax, and of the targets of arguments.
    pub(super) found: Vec<Diagnostic>,
    pub(super) problems: Problems,
    /// The spans of the values of unknown fields, in the order of the text.
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

/// Whether a text contains a word.
pub(super) fn mentions(text: &str, word: &str) -> bool {
    let other = |c: char| !c.is_ascii_alphanumeric() && c != '_';
    text.split(other).any(|found| found == word)
}
