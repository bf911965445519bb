//! What is wrong only because a name does not stand for what it was to be.
//!
//! A definition of a name that the language has already is reported, and the name keeps its old meaning. What that leads to where the
//! name is used below, or where it is used through other definitions or in a `--set`, is not worth a report of its own.

use std::collections::HashSet;

use super::{Lowering, definitions::for_each_name};
use crate::{
    source::Span,
    syntax::tree::{Definition, Item, Name, Value},
};

impl<'s> Lowering<'s> {
    /// Leaves out the problems of values that hold such a name.
    pub(super) fn leave_out_consequences(&mut self, items: &[Item<'s>]) {
        if self.denied.is_empty() {
            return;
        }
        let explained = self.uses_of_denied(items);
        self.problems.retain(|problem| {
            let place = problem.place_of_value();
            !place.is_some_and(|place| holds_one(place, &explained))
        });
    }

    /// Where they are used, in the order of places.
    fn uses_of_denied(&self, items: &[Item<'s>]) -> Vec<Span> {
        let denied: HashSet<Span> = self.denied.iter().map(|name| name.span).collect();
        let mut uses = Uses::default();
        for item in items {
            match item {
                Item::Definition(Definition { name, value, .. }) => {
                    let set = name.and_then(|name| self.targets.get(&(None, name.text)));
                    let set = set.and_then(|&index| self.overrides.get(index));
                    let is_concerned = uses.are_in(set.map_or(value, |set| &set.value));
                    let Some(name) = name else { continue };
                    let Name { text, span } = *name;
                    let counts = self.names.place(text) == Some(span);
                    if denied.contains(&span) || (is_concerned && counts) {
                        uses.names.insert(text);
                    }
                }
                Item::Block(block) => block.fields.iter().for_each(|field| {
                    uses.are_in(&field.value);
                }),
                Item::Bad(_) => {}
            }
        }
        for set in self.overrides.iter().filter(|set| set.block.is_some()) {
            uses.are_in(&set.value);
        }
        uses.places.sort_unstable();
        uses.places
    }
}

/// The uses so far of names that do not stand for what they were to be.
#[derive(Default)]
struct Uses<'s> {
    /// These names.
    names: HashSet<&'s str>,
    places: Vec<Span>,
}

impl<'s> Uses<'s> {
    /// Adds those in a value, and says whether there are any.
    fn are_in(&mut self, value: &Value<'s>) -> bool {
        let before = self.places.len();
        for_each_name(value, &mut |name, place| {
            if self.names.contains(name) {
                self.places.push(place);
            }
        });
        self.places.len() > before
    }
}

/// Whether one of some places, which are in their order, lies in another one.
fn holds_one(whole: Span, places: &[Span]) -> bool {
    let next = places.partition_point(|place| *place < Span { end: 0, ..whole });
    let place = places.get(next);
    place.is_some_and(|place| place.source == whole.source && place.end <= whole.end)
}
