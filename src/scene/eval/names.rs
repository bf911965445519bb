//! The names that are defined at a place of the text.

use std::{
    cell::RefCell,
    collections::{HashMap, HashSet, hash_map::Entry},
};

use super::{
    origin::UnitOrigin,
    suggestion::{Meaning, Suggestions},
};
use crate::{
    diagnostic::Problems,
    schema::Value,
    source::Span,
    suggest::ComparisonBudget,
    syntax::{
        Tree,
        tree::{self, Item, Name},
    },
};

/// The names that are defined at a place of the text.
#[derive(Debug, Default)]
pub struct Names<'s> {
    /// The `let`s and indices so far.
    pub(super) defined: HashMap<&'s str, Defined>,
    /// The names of `defined`, in the order of their definitions.
    order: Vec<&'s str>,
    /// Words of texts that could not be parsed and were reported. They may have been meant as
    /// names, so their uses are not reported.
    pub(super) parts: HashSet<&'s str>,
    /// Every `let` of the file, wherever it is.
    definitions: HashMap<&'s str, Span>,
    /// The names of the file's objects, which are no values.
    pub(super) objects: HashSet<&'s str>,
    /// The names of the indices of all blocks.
    pub(super) indices: HashSet<&'s str>,
    /// The number of comparisons left for nearest names.
    budget: ComparisonBudget,
    /// Problems of names, kept apart from the other problems, some of which are dropped again.
    pub(in crate::scene) problems: RefCell<Problems>,
    /// The names that were reported. Further uses become labels of the same problem.
    pub(super) reported: RefCell<HashMap<&'s str, Reported>>,
    /// The names that are suggested in place of undefined ones.
    pub(in crate::scene) suggestions: Suggestions<'s>,
}

/// A name that was reported.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reported {
    /// The index of its problem.
    pub index: usize,
    /// The meaning of the name that is suggested instead, if one is.
    pub suggested: Option<Meaning>,
}

/// A `let` or an index.
#[derive(Clone, Copy, Debug)]
pub(in crate::scene) struct Defined {
    /// The value; `None` if it has errors or is not known yet.
    pub value: Option<Value>,
    /// The name in the definition.
    pub place: Span,
    /// The span of the value, in the file or in an argument.
    pub from: Span,
    /// The unit of a number without one, as far as its formula tells.
    pub origin: UnitOrigin,
}

impl<'s> Names<'s> {
    /// Returns the names of a file, none of which is defined yet.
    pub fn of(tree: &Tree<'s>) -> Self {
        let mut names = Self::default();
        for item in &tree.items {
            match item {
                Item::Definition(definition) => {
                    if let Some(name) = definition.name {
                        names.definitions.entry(name.text).or_insert(name.span);
                    }
                }
                Item::Block(block) => {
                    names.objects.extend(block.name.map(|name| name.text));
                    let indices = block.repetition.iter().flat_map(|it| &it.indices);
                    names.indices.extend(indices.map(|index| index.name.text));
                }
                Item::Bad(_) => {}
            }
        }
        names
    }

    /// Defines a name, unless it is defined already.
    pub fn define(&mut self, name: Name<'s>, value: Option<Value>, tree: &tree::Value<'s>) {
        let origin = self.origin(tree);
        if let Entry::Vacant(free) = self.defined.entry(name.text) {
            self.order.push(name.text);
            free.insert(Defined {
                value,
                place: name.span,
                from: tree.span,
                origin,
            });
        }
    }

    /// Returns the unit that a number without one counts, as far as its formula tells.
    pub fn origin(&self, value: &tree::Value<'_>) -> UnitOrigin {
        UnitOrigin::of(value, &|name| Some(self.defined.get(name)?.origin))
    }

    /// Gives an index a value within its block, or `None` if it is not known yet.
    pub fn set_index(&mut self, name: Name<'s>, value: Option<Value>) {
        let index = Defined {
            value,
            place: name.span,
            from: name.span,
            origin: UnitOrigin::Plain,
        };
        if self.defined.insert(name.text, index).is_none() {
            self.order.push(name.text);
        }
    }

    /// Removes and returns the definition that an index hides: one of the same name further down,
    /// which is known already if arguments are given.
    pub fn hide_below(&mut self, index: Name<'s>) -> Option<(&'s str, Defined)> {
        let place = self.place(index.text)?;
        let is_below = place.source == index.span.source && place.start > index.span.start;
        if is_below {
            self.defined.remove_entry(index.text)
        } else {
            None
        }
    }

    /// Restores hidden definitions.
    pub fn restore(&mut self, hidden: Vec<(&'s str, Defined)>) {
        self.defined.extend(hidden);
    }

    /// Forgets an index behind its block.
    pub fn forget_index(&mut self, name: Name<'s>) {
        if self.place(name.text) == Some(name.span) {
            self.defined.remove(name.text);
            let last = self.order.iter().rposition(|other| *other == name.text);
            last.map(|at| self.order.remove(at));
        }
    }

    /// Remembers the words of a text that could not be parsed: uses of them are not reported.
    pub fn know_words(&mut self, text: &'s str) {
        let is_other = |c: char| !c.is_ascii_alphanumeric() && c != '_';
        self.parts.extend(text.split(is_other));
    }

    /// Returns the span of the name in its definition, if it is defined.
    pub fn place(&self, name: &str) -> Option<Span> {
        self.defined.get(name).map(|defined| defined.place)
    }

    /// Returns the value of a defined name; `None` if it has errors.
    pub fn value(&self, name: &str) -> Option<Value> {
        self.defined.get(name)?.value
    }

    /// Returns the first `let` of the file that defines a name, wherever it is.
    pub fn definition(&self, name: &str) -> Option<Span> {
        self.definitions.get(name).copied()
    }

    /// Returns the names that are defined so far, to search for the nearest one; `None` if the
    /// budget of comparisons is spent.
    pub(super) fn to_compare(&self) -> Option<&[&'s str]> {
        const PREDEFINED: usize = 200;
        let enough = self.budget.spend(self.order.len() + PREDEFINED);
        enough.then_some(&self.order)
    }

    /// Forgets the suggestion for a name.
    pub fn withdraw(&self, name: &str) {
        if let Some(reported) = self.reported.borrow_mut().get_mut(name) {
            reported.suggested = None;
        }
    }

    /// Returns the number of comparisons left for nearest names.
    pub fn budget(&self) -> &ComparisonBudget {
        &self.budget
    }
}
