//! Cancellation of work whose result is no longer wanted.
//!
//! A flag requests cancellation and stays set until the work has ended. Long work checks the flag
//! regularly and skips the rest once it is set. The partial result is useless, so [`Cancelled`] is
//! returned instead.

use std::sync::atomic::{AtomicBool, Ordering};

use thiserror::Error;

/// Error of work that was cancelled.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("interrupted")]
pub struct Cancelled;

/// Cancellation flag for work that nobody can cancel: it is never set.
pub(crate) static NEVER: AtomicBool = AtomicBool::new(false);

/// Returns whether the flag `cancel` is set.
#[inline]
pub(crate) fn is_set(cancel: &AtomicBool) -> bool {
    cancel.load(Ordering::Relaxed)
}

/// Returns `made`, the result of some work, unless the flag `cancel` is set.
///
/// # Errors
///
/// Returns [`Cancelled`] if the flag is set.
pub fn unless_set<T>(cancel: &AtomicBool, made: T) -> Result<T, Cancelled> {
    if is_set(cancel) {
        Err(Cancelled)
    } else {
        Ok(made)
    }
}
