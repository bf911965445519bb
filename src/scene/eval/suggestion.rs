//! Suggestions for undefined names.
//!
//! In: an undefined name, and the nearest defined one. Out: a suggestion.
//!
//! The suggested name may cause another error in the value that uses it. To find out, the caller
//! tries the suggestion: it evaluates the whole value again, with the meaning of the suggested name
//! in place of the undefined one. The caller then keeps or withdraws the suggestion.

use std::cell::RefCell;

use crate::{
    schema::{Function, Value},
    source::Span,
};

/// A name that is suggested in place of an undefined one.
#[derive(Clone, Debug)]
pub struct Suggestion<'s> {
    /// The undefined name.
    pub name: &'s str,
    /// The meaning of the suggested name.
    pub means: Meaning,
    /// Span of the first label of the report about the undefined name. It identifies the report.
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

/// Suggestions that were made while a value was evaluated.
#[derive(Debug, Default)]
pub struct Suggestions<'s> {
    made: RefCell<Vec<Suggestion<'s>>>,
    /// The undefined name whose suggestion is being tried, and the meaning of the suggested name.
    /// `None` while no suggestion is being tried.
    tried: RefCell<Option<(&'s str, Meaning)>>,
}

impl<'s> Suggestions<'s> {
    /// Adds a suggestion.
    pub fn push(&self, suggestion: Suggestion<'s>) {
        self.made.borrow_mut().push(suggestion);
    }

    /// Returns and removes the suggestions that were added.
    pub fn take(&self) -> Vec<Suggestion<'s>> {
        self.made.take()
    }

    /// Sets the suggestion that is tried; `None` ends the trial.
    pub fn set_tried(&self, suggestion: Option<&Suggestion<'s>>) {
        let tried = suggestion.map(|suggestion| (suggestion.name, suggestion.means));
        *self.tried.borrow_mut() = tried;
    }

    /// Returns whether a suggestion is being tried. Undefined names are then not reported.
    pub fn is_trying(&self) -> bool {
        self.tried.borrow().is_some()
    }

    /// Returns the meaning of the suggested name while a suggestion for `name` is being tried.
    /// Otherwise, returns `None`.
    pub fn meaning(&self, name: &str) -> Option<Meaning> {
        let tried = *self.tried.borrow();
        tried.and_then(|(known, meaning)| (known == name).then_some(meaning))
    }
}
