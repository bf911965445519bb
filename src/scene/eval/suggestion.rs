//! What is suggested in place of a name, until it is known whether it will do there.
//!
//! In: a name that stands for nothing, and the nearest one. Out: what the name stands for while the
//! suggestion is tried. Whether that makes another mistake only the whole value tells, which
//! whoever evaluates it does once more.

use std::cell::RefCell;

use crate::{
    schema::{Function, Value},
    source::Span,
};

/// A name to write in place of another one.
#[derive(Clone, Debug)]
pub struct Suggestion<'s> {
    /// The name that stands for nothing.
    pub name: &'s str,
    /// What the suggested one stands for.
    pub means: Meaning,
    /// The first label of the report.
    pub report: Span,
    /// The report's help if the suggestion will not do.
    pub otherwise: String,
}

/// What a suggested name stands for.
#[derive(Clone, Copy, Debug)]
pub enum Meaning {
    /// A value; none if it failed.
    Value(Option<Value>),
    /// A function.
    Function(&'static Function),
}

/// The suggestions in a value.
#[derive(Debug, Default)]
pub struct Suggestions<'s> {
    made: RefCell<Vec<Suggestion<'s>>>,
    /// The name that stands for something else while that is tried.
    tried: RefCell<Option<(&'s str, Meaning)>>,
}

impl<'s> Suggestions<'s> {
    /// Adds one.
    pub fn push(&self, suggestion: Suggestion<'s>) {
        self.made.borrow_mut().push(suggestion);
    }

    /// Those that were made since they were last taken.
    pub fn take(&self) -> Vec<Suggestion<'s>> {
        self.made.take()
    }

    /// Lets a name stand for what is suggested in its place, until it is given another one or none.
    pub fn set_tried(&self, suggestion: Option<&Suggestion<'s>>) {
        let tried = suggestion.map(|suggestion| (suggestion.name, suggestion.means));
        *self.tried.borrow_mut() = tried;
    }

    /// Whether one is being tried. No name is reported then.
    pub fn is_trying(&self) -> bool {
        self.tried.borrow().is_some()
    }

    /// What a name stands for while a suggestion is tried.
    pub fn meaning(&self, name: &str) -> Option<Meaning> {
        let tried = *self.tried.borrow();
        tried.and_then(|(known, meaning)| (known == name).then_some(meaning))
    }
}
