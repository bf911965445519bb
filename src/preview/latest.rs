//! A place for one value, of which only the newest counts.

use std::sync::{
    Condvar, Mutex, MutexGuard, PoisonError,
    atomic::{AtomicBool, Ordering},
};

/// What one thread puts and another one takes. A value that is put takes the place of one that nobody has taken.
#[derive(Debug)]
pub struct Latest<T> {
    state: Mutex<State<T>>,
    news: Condvar,
    /// Written while the state is locked, so that it fits it.
    stale: AtomicBool,
}

#[derive(Debug)]
struct State<T> {
    next: Option<T>,
    is_over: bool,
}

impl<T> Default for Latest<T> {
    fn default() -> Self {
        Self {
            state: Mutex::new(State {
                next: None,
                is_over: false,
            }),
            news: Condvar::new(),
            stale: AtomicBool::new(false),
        }
    }
}

impl<T> Latest<T> {
    /// Waits for the next value; `None` means that there will be no more.
    pub fn take(&self) -> Option<T> {
        let mut state = self.lock();
        loop {
            if state.is_over {
                return None;
            }
            if let Some(value) = state.next.take() {
                self.stale.store(false, Ordering::SeqCst);
                return Some(value);
            }
            state = self
                .news
                .wait(state)
                .unwrap_or_else(PoisonError::into_inner);
        }
    }

    /// Set as soon as there is a newer value than the one that was taken, or nobody wants one any more: for cancelling work on it.
    pub fn stale(&self) -> &AtomicBool {
        &self.stale
    }

    /// Puts a newer value.
    pub fn put(&self, value: T) {
        self.change(|state| state.next = Some(value));
    }

    /// From now on there are no values.
    pub fn end(&self) {
        self.change(|state| state.is_over = true);
    }

    /// Whether it has ended.
    pub fn is_over(&self) -> bool {
        self.lock().is_over
    }

    fn change(&self, change: impl FnOnce(&mut State<T>)) {
        let mut state = self.lock();
        change(&mut state);
        self.stale.store(true, Ordering::SeqCst);
        self.news.notify_all();
    }

    fn lock(&self) -> MutexGuard<'_, State<T>> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use std::thread;

    use super::*;

    #[test]
    fn only_the_newest_counts() {
        let latest = Latest::default();
        latest.put(1);
        latest.put(2);
        assert!(latest.stale().load(Ordering::SeqCst));
        assert_eq!(latest.take(), Some(2));
        assert!(!latest.stale().load(Ordering::SeqCst));
        latest.put(3);
        assert!(latest.stale().load(Ordering::SeqCst));
        latest.end();
        assert_eq!(latest.take(), None);
        assert!(latest.stale().load(Ordering::SeqCst));
    }

    #[test]
    fn whoever_waits_gets_all_that_counts() {
        let latest = Latest::default();
        thread::scope(|scope| {
            let taker = scope.spawn(|| {
                let mut taken = Vec::new();
                while let Some(value) = latest.take() {
                    taken.push(value);
                    if value == 1000 {
                        latest.end();
                    }
                }
                taken
            });
            for value in 1..=1000 {
                latest.put(value);
            }
            let taken = taker.join().unwrap();
            assert!(taken.is_sorted_by(|a, b| a < b));
            assert_eq!(taken.last(), Some(&1000));
        });
    }
}
