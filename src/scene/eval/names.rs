//! Keeps the names that are defined at the current place of the text, and what was reported about
//! names.

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

/// Names that are defined at the current place of the text, and what was reported about names.
#[derive(Debug, Default)]
pub struct Names<'s> {
    /// Definitions and indices so far, with their values.
    pub(super) defined: HashMap<&'s str, Defined>,
    /// The names of `defined`, in the order of their definitions.
    order: Vec<&'s str>,
    /// Words of texts that could not be parsed and were reported. They may have been meant as
    /// names, so their uses are not reported.
    pub(super) parts: HashSet<&'s str>,
    /// Every definition of the file with the span of its name, including later ones.
    definitions: HashMap<&'s str, Span>,
    /// Names of the file's objects. They have no value, but a message can explain that.
    pub(super) objects: HashSet<&'s str>,
    /// The names of the indices of all blocks.
    pub(super) indices: HashSet<&'s str>,
    /// Number of comparisons of names that are left for all searches for the nearest name.
    budget: ComparisonBudget,
    /// Problems of undefined names. They are kept apart because some of the other problems are
    /// discarded when a value is evaluated again.
    pub(in crate::scene) problems: RefCell<Problems>,
    /// Names that were reported as undefined. Further uses become labels of the same problem.
    pub(super) reported: RefCell<HashMap<&'s str, Reported>>,
    /// Suggestions in place of undefined names.
    pub(in crate::scene) suggestions: Suggestions<'s>,
}

/// Report of an undefined name.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reported {
    /// Index of the report in [`Names::problems`].
    pub index: usize,
    /// Meaning of the name that the report suggests, if it suggests one.
    pub suggested: Option<Meaning>,
}

/// A defined name: a `let` or an index.
#[derive(Clone, Copy, Debug)]
pub(in crate::scene) struct Defined {
    /// The value. `None` if it has errors, or for an index without a value yet.
    pub value: Option<Value>,
    /// Span of the name in its definition.
    pub place: Span,
    /// The span of the value, in the file or in an argument.
    pub from: Span,
    /// Unit in which the name's number is meant, as far as the formula of its value shows. It
    /// matters if the number lacks a unit.
    pub origin: UnitOrigin,
}

impl<'s> Names<'s> {
    /// Collects the names of a file. None of them is defined yet.
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

    /// Defines a name with its value, unless it is defined already. `tree` is the value's
    /// expression.
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

    /// Returns the unit in which the numbers of `value` are meant, as far as its formula shows.
    pub fn origin(&self, value: &tree::Value<'_>) -> UnitOrigin {
        UnitOrigin::of(value, &|name| Some(self.defined.get(name)?.origin))
    }

    /// Defines an index of the current block with the value `value`, or with an unknown value if it
    /// is `None`.
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

    /// Removes and returns the `let` that has the same name as `index` and stands further down in
    /// the file, if it is defined already, so that the index can be defined. With `--set`
    /// arguments, all definitions are evaluated before the blocks.
    pub fn hide_below(&mut self, index: Name<'s>) -> Option<(&'s str, Defined)> {
        let place = self.place(index.text)?;
        let is_below = place.source == index.span.source && place.start > index.span.start;
        if is_below {
            self.defined.remove_entry(index.text)
        } else {
            None
        }
    }

    /// Restores definitions that [`Self::hide_below`] removed.
    pub fn restore(&mut self, hidden: Vec<(&'s str, Defined)>) {
        self.defined.extend(hidden);
    }

    /// Removes an index at the end of its block.
    pub fn forget_index(&mut self, name: Name<'s>) {
        if self.place(name.text) == Some(name.span) {
            self.defined.remove(name.text);
            let last = self.order.iter().rposition(|other| *other == name.text);
            last.map(|at| self.order.remove(at));
        }
    }

    /// Records the words of a text that could not be parsed, so that their uses are not reported as
    /// undefined.
    pub fn know_words(&mut self, text: &'s str) {
        let is_other = |c: char| !c.is_ascii_alphanumeric() && c != '_';
        self.parts.extend(text.split(is_other));
    }

    /// Returns the span of a name in its definition; `None` if the name is not defined yet.
    pub fn place(&self, name: &str) -> Option<Span> {
        self.defined.get(name).map(|defined| defined.place)
    }

    /// Returns the value of a defined name; `None` if it has errors.
    pub fn value(&self, name: &str) -> Option<Value> {
        self.defined.get(name)?.value
    }

    /// Returns the span of a name in the first `let` of the file that defines it, even further
    /// down.
    pub fn definition(&self, name: &str) -> Option<Span> {
        self.definitions.get(name).copied()
    }

    /// Returns the names that are defined so far, for a search for the nearest one. Charges the
    /// search to the budget of comparisons, and returns `None` if that is spent.
    pub(super) fn to_compare(&self) -> Option<&[&'s str]> {
        // About the number of colours and constants, with which the name is compared, too.
        const PREDEFINED: usize = 200;
        let enough = self.budget.spend(self.order.len() + PREDEFINED);
        enough.then_some(&self.order)
    }

    /// Removes the suggestion from the report of an undefined name.
    pub fn withdraw(&self, name: &str) {
        if let Some(reported) = self.reported.borrow_mut().get_mut(name) {
            reported.suggested = None;
        }
    }

    /// Returns the budget of comparisons in searches for the nearest name.
    pub fn budget(&self) -> &ComparisonBudget {
        &self.budget
    }
}
