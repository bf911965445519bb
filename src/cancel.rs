//! Cancellation of work whose result is no longer wanted.
//!
//! A flag requests it and stays set until the work has ended. Long work checks the flag regularly
//! and, once it is set, skips the rest; the partial result is useless, and [`Cancelled`] is
//! returned instead of it.

use std::sync::atomic::{AtomicBool, Ordering};

use thiserror::Error;

/// Error of cancelled work.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("interrupted")]
pub struct Cancelled;

/// Flag of work that is never cancelled.
pub(crate) static NEVER: AtomicBool = AtomicBool::new(false);

/// Returns whether the work is cancelled.
#[inline]
pub(crate) fn is_set(cancel: &AtomicBool) -> bool {
    cancel.load(Ordering::Relaxed)
}

/// Returns a result, or an error if the work was cancelled.
pub fn unless_set<T>(cancel: &AtomicBool, made: T) -> Result<T, Cancelled> {
    if is_set(cancel) {
        Err(Cancelled)
    } else {
        Ok(made)
    }
}
