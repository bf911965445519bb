//! What is known of a scene while its items are read.

use std::{collections::HashMap, sync::atomic::AtomicBool};

use super::block::Block;
use crate::{
    cancel,
    diagnostic::{Diagnostic, Problems},
    scene::{
        eval::Names,
        model::{Checkerboard, Object},
    },
    source::{Sources, Span},
};

pub(super) struct Lowering<'s> {
    pub(super) sources: &'s Sources,
    /// Once it is set, the rest is left out.
    pub(super) cancel: &'s AtomicBool,
    /// Whether a mistake took the end of the text, such as a comment that is never closed.
    pub(super) cut: bool,
    pub(super) names: Names<'s>,
    /// The blocks that are no objects, each the first of its kind.
    pub(super) blocks: Vec<Block<'s>>,
    /// Whether the sum of the indices is odd in the block that is read, if that has indices.
    pub(super) is_odd: Option<bool>,
    /// The objects.
    pub(super) objects: Vec<Object>,
    /// The checkerboards, each with the number of its squares' side, or its keyword.
    pub(super) boards: Vec<(Checkerboard, Span)>,
    /// Whether there is anything in the file but comments.
    pub(super) has_items: bool,
    /// Whether there is an object, built or not.
    pub(super) has_objects: bool,
    /// Where each object's name stands first.
    pub(super) first_names: HashMap<&'s str, Span>,
    /// The texts of items that could not be understood.
    pub(super) bad: Vec<&'s str>,
    /// What was found before: wrong with the syntax, and with the targets of arguments.
    pub(super) found: Vec<Diagnostic>,
    pub(super) problems: Problems,
    /// The values of unknown fields, in the order of the text.
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

/// Whether a word stands in a text.
pub(super) fn mentions(text: &str, word: &str) -> bool {
    let other = |c: char| !c.is_ascii_alphanumeric() && c != '_';
    text.split(other).any(|found| found == word)
}
