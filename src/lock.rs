//! Locks that can be used after a panic.
//!
//! A lock is poisoned if a thread panics while it holds the lock. Every change of a locked value in
//! this crate leaves the value valid, so the value can still be used after a panic.

use std::sync::{LockResult, Mutex, MutexGuard, PoisonError};

/// Locks a mutex, poisoned or not.
pub(crate) fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    unpoisoned(mutex.lock())
}

/// Returns the guard or the value of a lock, even if a thread panicked while it held the lock.
pub(crate) fn unpoisoned<T>(result: LockResult<T>) -> T {
    result.unwrap_or_else(PoisonError::into_inner)
}
