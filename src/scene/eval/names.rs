//! The names that are defined at some place.

use std::{
    cell::RefCell,
    collections::{HashMap, HashSet, hash_map::Entry},
};

use super::{
    origin::Origin,
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

/// The names that are defined at some place.
#[derive(Debug, Default)]
pub struct Names<'s> {
    /// The `let`s so far.
    pub(super) defined: HashMap<&'s str, Defined>,
    /// The same names, in order.
    order: Vec<&'s str>,
    /// Words in what was reported, such as what was to be a name and cannot be one. They stand for
    /// nothing, and nothing is said of their uses.
    pub(super) parts: HashSet<&'s str>,
    /// Every `let` of the file, wherever.
    definitions: HashMap<&'s str, Span>,
    /// The names of the file's objects, which are no values.
    pub(super) objects: HashSet<&'s str>,
    /// The indices of all its blocks.
    pub(super) indices: HashSet<&'s str>,
    /// The comparisons that are left in search of the nearest name.
    budget: ComparisonBudget,
    /// What was reported of names, apart from the other problems, some of which are dropped again.
    pub(in crate::scene) problems: RefCell<Problems>,
    /// The names that were reported: the next use of the same name is another label of its
    /// problem.
    pub(super) reported: RefCell<HashMap<&'s str, Reported>>,
    /// What is suggested in place of names.
    pub(in crate::scene) suggestions: Suggestions<'s>,
}

/// A name that was reported.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reported {
    /// The index of its problem.
    pub index: usize,
    /// What the name stands for that is suggested in its place, unless none is.
    pub suggested: Option<Meaning>,
}

#[derive(Clone, Copy, Debug)]
pub(in crate::scene) struct Defined {
    /// None if it failed.
    pub value: Option<Value>,
    /// The name in the definition.
    pub place: Span,
    /// Its value, in the file or in an argument.
    pub from: Span,
    /// What its formula tells of the unit that it lacks.
    pub origin: Origin,
}

impl<'s> Names<'s> {
    /// The names of a file, none of which is defined yet.
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

    /// Defines a name; a second time it keeps its value.
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

    /// What a number's formula tells of the unit that it lacks.
    pub fn origin(&self, value: &tree::Value<'_>) -> Origin {
        Origin::of(value, &|name| Some(self.defined.get(name)?.origin))
    }

    /// Gives an index a value, within its block; none while it is not known yet.
    pub fn set_index(&mut self, name: Name<'s>, value: Option<Value>) {
        let index = Defined {
            value,
            place: name.span,
            from: name.span,
            origin: Origin::Plain,
        };
        if self.defined.insert(name.text, index).is_none() {
            self.order.push(name.text);
        }
    }

    /// Takes away what an index hides: a definition of its name that stands further down, and is
    /// known already where values are set.
    pub fn hide_below(&mut self, index: Name<'s>) -> Option<(&'s str, Defined)> {
        let place = self.place(index.text)?;
        let is_below = place.source == index.span.source && place.start > index.span.start;
        if is_below {
            self.defined.remove_entry(index.text)
        } else {
            None
        }
    }

    /// Has what was hidden known again.
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

    /// Knows the words of what cannot be told, such as what was to be a name and cannot be one.
    pub fn know_words(&mut self, text: &'s str) {
        let is_other = |c: char| !c.is_ascii_alphanumeric() && c != '_';
        self.parts.extend(text.split(is_other));
    }

    /// Where a name was defined, if it was.
    pub fn place(&self, name: &str) -> Option<Span> {
        self.defined.get(name).map(|defined| defined.place)
    }

    /// The value of a name that was defined; none if it failed.
    pub fn value(&self, name: &str) -> Option<Value> {
        self.defined.get(name)?.value
    }

    /// The first `let` of the file that defines it.
    pub fn definition(&self, name: &str) -> Option<Span> {
        self.definitions.get(name).copied()
    }

    /// The names that are defined so far, to search for the nearest; none if there was enough of
    /// searching.
    pub(super) fn to_compare(&self) -> Option<&[&'s str]> {
        const PREDEFINED: usize = 200;
        let enough = self.budget.spend(self.order.len() + PREDEFINED);
        enough.then_some(&self.order)
    }

    /// Forgets what is suggested in place of a name.
    pub fn withdraw(&self, name: &str) {
        if let Some(reported) = self.reported.borrow_mut().get_mut(name) {
            reported.suggested = None;
        }
    }

    /// The comparisons that are left in search of the nearest name.
    pub fn budget(&self) -> &ComparisonBudget {
        &self.budget
    }
}
