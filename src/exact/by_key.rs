//! Values ordered by a number, for a heap that returns the greatest first.

use std::cmp::Ordering;

/// A value with a number, its key. Values are compared by their keys only.
pub(super) struct ByKey<T>(pub f64, pub T);

impl<T> Ord for ByKey<T> {
    fn cmp(&self, other: &Self) -> Ordering {
        self.0.total_cmp(&other.0)
    }
}

impl<T> PartialOrd for ByKey<T> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<T> PartialEq for ByKey<T> {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl<T> Eq for ByKey<T> {}
