//! Suggestions for undefined names, which are kept until they have been tried.
//!
//! In: an undefined name, and the nearest defined one. Out: the meaning of the undefined name while
//! the suggestion is tried. Only the whole value shows whether the suggestion leads to another
//! error, so the caller evaluates the value again.

use std::cell::RefCell;

use crate::{
    schema::{Function, Value},
    source::Span,
};

/// A name to write in place of an undefined one.
#[derive(Clone, Debug)]
pub struct Suggestion<'s> {
    /// The undefined name.
    pub name: &'s str,
    /// The meaning of the suggested name.
    pub means: Meaning,
    /// The first label of the report.
    pub report: Span,
    /// The help of the report if the suggestion is withdrawn.
    pub otherwise: String,
}

/// The meaning of a suggested name.
#[derive(Clone, Copy, Debug)]
pub enum Meaning {
    /// A value; `None` if it has errors.
    Value(Option<Value>),
    /// A function.
    Function(&'static Function),
}

/// The suggestions made while a value is evaluated.
#[derive(Debug, Default)]
pub struct Suggestions<'s> {
    made: RefCell<Vec<Suggestion<'s>>>,
    /// The name whose suggestion is being tried, and its meaning.
    tried: RefCell<Option<(&'s str, Meaning)>>,
}

impl<'s> Suggestions<'s> {
    /// Adds a suggestion.
    pub fn push(&self, suggestion: Suggestion<'s>) {
        self.made.borrow_mut().push(suggestion);
    }

    /// Takes the suggestions made since they were last taken.
    pub fn take(&self) -> Vec<Suggestion<'s>> {
        self.made.take()
    }

    /// Begins to try a suggestion, or ends trying if there is none.
    pub fn set_tried(&self, suggestion: Option<&Suggestion<'s>>) {
        let tried = suggestion.map(|suggestion| (suggestion.name, suggestion.means));
        *self.tried.borrow_mut() = tried;
    }

    /// Whether a suggestion is being tried. Undefined names are not reported then.
    pub fn is_trying(&self) -> bool {
        self.tried.borrow().is_some()
    }

    /// Returns the meaning of a name if its suggestion is being tried.
    pub fn meaning(&self, name: &str) -> Option<Meaning> {
        let tried = *self.tried.borrow();
        tried.and_then(|(known, meaning)| (known == name).then_some(meaning))
    }
}
