//! Keeps the names that are defined so far while a scene is evaluated, and the reports about names.

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

/// Names that are defined so far while a scene is evaluated, and the reports about names.
#[derive(Debug, Default)]
pub struct Names<'s> {
    /// Values of the `let`s and of the indices (counters of a `for`) that are defined so far.
    pub(super) defined: HashMap<&'s str, Defined>,
    /// The names of `defined`, in the order of their definitions.
    order: Vec<&'s str>,
    /// Words of the text that could not be parsed. The text was reported as an error. It may
    /// contain definitions of names, so uses of these words are not reported as undefined.
    pub(super) parts: HashSet<&'s str>,
    /// Span of the name in each definition of the file, including definitions that are not
    /// evaluated yet.
    definitions: HashMap<&'s str, Span>,
    /// Names of the file's objects. If one of them is used as a value, the report says that an
    /// object is no value.
    pub(super) objects: HashSet<&'s str>,
    /// Names of the indices of all blocks. An index is the counter of a `for`, such as `i` in
    /// `for i < 8`.
    pub(super) indices: HashSet<&'s str>,
    /// Budget of comparisons between undefined names and known ones. The comparisons find the most
    /// similar known name.
    budget: ComparisonBudget,
    /// Problems of undefined names. Other problems are kept elsewhere, because some of them are
    /// discarded when a value is evaluated again.
    pub(in crate::scene) problems: RefCell<Problems>,
    /// Names that were reported as undefined. Further uses become labels of the same problem.
    pub(super) reported: RefCell<HashMap<&'s str, Reported>>,
    /// Names that reports suggest in place of undefined ones.
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

/// Definition of a name, by a `let` or as the index of a `for`.
#[derive(Clone, Copy, Debug)]
pub(in crate::scene) struct Defined {
    /// Value of the name. `None` if its expression has errors, or if the name already has a
    /// predefined meaning. If the name is the counter of a `for`, also `None` if the counter's
    /// value is unknown.
    pub value: Option<Value>,
    /// Span of the name in its definition.
    pub place: Span,
    /// Span of the value, in the file or in a `--set` argument of the command line.
    pub from: Span,
    /// Unit that the formula of the value suggests, such as radians if it uses `pi`. The unit
    /// matters if a number without a unit stands where an angle is required.
    pub origin: UnitOrigin,
}

impl<'s> Names<'s> {
    /// Collects the names of a file. Until [`Self::define`] is called, none of the names has a
    /// value.
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

    /// Returns the unit in which the author probably means the numbers of the expression `value`.
    /// An expression that uses `pi`, for example, suggests radians.
    pub fn origin(&self, value: &tree::Value<'_>) -> UnitOrigin {
        UnitOrigin::of(value, &|name| Some(self.defined.get(name)?.origin))
    }

    /// Defines an index, i.e. the counter of a `for`, of the current block. The value is `None` if
    /// it is unknown.
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

    /// Removes the `let` that has the name of `index`, stands further down in the file and is
    /// defined already, so that the index can be defined. Returns the removed `let`, or `None` if
    /// there is none. Definitions further down are defined already if there are `--set` arguments,
    /// since all definitions are then evaluated before the blocks.
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

    /// Removes an index, the counter of a `for`, at the end of its block.
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

    /// Returns the span of a name in its definition. Returns `None` if the name is not defined yet.
    pub fn place(&self, name: &str) -> Option<Span> {
        self.defined.get(name).map(|defined| defined.place)
    }

    /// Returns the value of a defined name. Returns `None` if the value has errors.
    pub fn value(&self, name: &str) -> Option<Value> {
        self.defined.get(name)?.value
    }

    /// Returns the span of a name in the first `let` of the file that defines it, even if this
    /// `let` stands further down.
    pub fn definition(&self, name: &str) -> Option<Span> {
        self.definitions.get(name).copied()
    }

    /// Returns the names that are defined so far, for comparison with an undefined name. Deducts
    /// one comparison for each of them, and for each predefined name, from `budget`, which limits
    /// the total time. Returns `None` if too few comparisons remain.
    pub(super) fn to_compare(&self) -> Option<&[&'s str]> {
        // Approximate number of predefined colours and constants. An undefined name is compared
        // with them too. An estimate is enough, because it only limits the number of searches.
        const PREDEFINED: usize = 200;
        let enough = self.budget.spend(self.order.len() + PREDEFINED);
        enough.then_some(&self.order)
    }

    /// Records that the report of an undefined name no longer suggests another name.
    pub fn withdraw(&self, name: &str) {
        if let Some(reported) = self.reported.borrow_mut().get_mut(name) {
            reported.suggested = None;
        }
    }

    /// Returns the budget of comparisons between undefined names and known ones. The comparisons
    /// find the most similar known name.
    pub fn budget(&self) -> &ComparisonBudget {
        &self.budget
    }
}
