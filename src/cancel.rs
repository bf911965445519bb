//! Work that is given up when nobody wants its result any more.
//!
//! A flag says so, which stays set until the work has ended. What takes long looks at it in between
//! and, once it is set, leaves out the rest; what was made then is of no use, and whoever was asked
//! for it says [`Cancelled`] in its place.

use std::sync::atomic::{AtomicBool, Ordering};

use thiserror::Error;

/// There is no result: it was not wanted any more.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("interrupted")]
pub struct Cancelled;

/// The flag of work that is done in any case.
pub(crate) static NEVER: AtomicBool = AtomicBool::new(false);

/// Whether the result is wanted no more.
#[inline]
pub(crate) fn is_set(cancel: &AtomicBool) -> bool {
    cancel.load(Ordering::Relaxed)
}

/// What was made, if it was wanted to the end.
pub fn unless_set<T>(cancel: &AtomicBool, made: T) -> Result<T, Cancelled> {
    match is_set(cancel) {
        false => Ok(made),
        true => Err(Cancelled),
    }
}
