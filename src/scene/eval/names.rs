//! The names that are defined at some place.

use std::{
    cell::{Cell, RefCell},
    collections::{HashMap, HashSet, hash_map::Entry},
};

use crate::{
    scene::value::Value,
    source::{SourceId, Span},
    suggest::Budget,
    syntax::tree::Name,
};

/// The names that are defined at some place.
#[derive(Debug, Default)]
pub struct Names<'s> {
    /// The `let`s so far.
    pub(super) defined: HashMap<&'s str, Defined>,
    /// Words in what was to be a name and cannot be one. They stand for nothing, and nothing is said of their uses.
    pub(super) parts: HashSet<&'s str>,
    /// The names that are defined, in order.
    order: Vec<&'s str>,
    /// The names of the whole file; none while it is still being read.
    whole: Option<Whole<'s>>,
    /// Whether something was asked about the whole file before it was read.
    asked_early: Cell<bool>,
    /// The comparisons that are left in search of the nearest name.
    budget: Budget,
    /// The names that were reported, with the problem's index: the next use of the same name is another label of it.
    pub(super) reported: RefCell<HashMap<&'s str, usize>>,
}

/// The names that stand in a file, wherever.
#[derive(Debug, Default)]
struct Whole<'s> {
    /// Every `let`.
    definitions: HashMap<&'s str, Span>,
    /// The names of objects, which are no values.
    objects: HashSet<&'s str>,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Defined {
    /// None if it failed.
    pub value: Option<Value>,
    /// The name in the definition.
    pub place: Span,
    /// The argument that set it, if one did.
    pub set: Option<SourceId>,
}

impl<'s> Names<'s> {
    /// No name is defined yet; these will be.
    pub fn new(
        everywhere: impl IntoIterator<Item = Name<'s>>,
        objects: impl IntoIterator<Item = &'s str>,
    ) -> Self {
        let mut whole = Whole {
            objects: objects.into_iter().collect(),
            definitions: HashMap::new(),
        };
        for name in everywhere {
            whole.definitions.entry(name.text).or_insert(name.span);
        }
        Self {
            whole: Some(whole),
            ..Self::default()
        }
    }

    /// Whether something was asked about the names of the whole file, which are not known: what was made of the answers
    /// does not count.
    pub fn were_asked_early(&self) -> bool {
        self.asked_early.get()
    }

    fn whole(&self) -> Option<&Whole<'s>> {
        if self.whole.is_none() {
            self.asked_early.set(true);
        }
        self.whole.as_ref()
    }

    /// Defines a name; a second time it keeps its value.
    pub fn define(&mut self, name: Name<'s>, value: Option<Value>, set: Option<SourceId>) {
        if let Entry::Vacant(free) = self.defined.entry(name.text) {
            self.order.push(name.text);
            free.insert(Defined {
                value,
                place: name.span,
                set,
            });
        }
    }

    /// Knows a word of what was to be a name and cannot be one.
    pub fn know_part(&mut self, word: &'s str) {
        self.parts.insert(word);
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
    pub(super) fn definition(&self, name: &str) -> Option<Span> {
        self.whole()?.definitions.get(name).copied()
    }

    /// Whether it is the name of an object.
    pub(super) fn is_object(&self, name: &str) -> bool {
        self.whole()
            .is_some_and(|whole| whole.objects.contains(name))
    }

    /// Whether any `let` of the file defines it.
    pub fn knows(&self, name: &str) -> bool {
        self.definition(name).is_some()
    }

    /// The names that are defined so far, to search for the nearest; none if there was enough of searching.
    pub(super) fn to_compare(&self) -> Option<&[&'s str]> {
        const PREDEFINED: usize = 200;
        let enough = self.budget.spend(self.order.len() + PREDEFINED);
        enough.then_some(&self.order)
    }

    /// The comparisons that are left in search of the nearest name.
    pub fn budget(&self) -> &Budget {
        &self.budget
    }

    /// Every name that the file defines.
    pub fn all(&self) -> impl Iterator<Item = &'s str> {
        let whole = self.whole().into_iter();
        whole.flat_map(|whole| whole.definitions.keys().copied())
    }
}
