//! A slot that passes values between threads. It keeps only the newest value.

use std::{
    sync::{
        Condvar, Mutex,
        atomic::{AtomicBool, Ordering},
    },
    time::Duration,
};

use crate::lock::{lock, unpoisoned};

/// Slot that passes values from one thread to another. A new value replaces an older one that was
/// not taken yet.
#[derive(Debug)]
pub struct Latest<T> {
    state: Mutex<SlotState<T>>,
    news: Condvar,
    /// Whether work on the value that was last taken from the slot should stop, because a newer
    /// value is in the slot or the slot is closed. The flag is written only while `state` is
    /// locked, so that it always agrees with `state`.
    stale: AtomicBool,
}

#[derive(Debug)]
struct SlotState<T> {
    next: Option<T>,
    is_over: bool,
}

impl<T> Default for Latest<T> {
    fn default() -> Self {
        Self {
            state: Mutex::new(SlotState {
                next: None,
                is_over: false,
            }),
            news: Condvar::new(),
            stale: AtomicBool::new(false),
        }
    }
}

impl<T> Latest<T> {
    /// Takes the value in the slot. Returns `None` if the slot is empty.
    pub fn try_take(&self) -> Option<T> {
        let mut state = lock(&self.state);
        self.stale.store(state.is_over, Ordering::SeqCst);
        state.next.take()
    }

    /// Waits for a value and takes it. Returns `None` if [`end`](Self::end) was called.
    pub fn take(&self) -> Option<T> {
        self.take_while(Duration::MAX, || {})
    }

    /// Waits for a value as [`take`](Self::take) does, and calls `idle` each time it has waited for
    /// `pause`. Returns `None` if the slot is closed.
    pub fn take_while(&self, pause: Duration, mut idle: impl FnMut()) -> Option<T> {
        let mut state = lock(&self.state);
        loop {
            if state.is_over {
                return None;
            }
            if let Some(value) = state.next.take() {
                self.stale.store(false, Ordering::SeqCst);
                return Some(value);
            }
            let (waited, result) = unpoisoned(self.news.wait_timeout(state, pause));
            state = waited;
            if result.timed_out() && state.next.is_none() {
                // The lock is released while `idle` runs, since `idle` may take long and other
                // threads must be able to put in values.
                drop(state);
                idle();
                state = lock(&self.state);
            }
        }
    }

    /// Returns a flag that is set as soon as a newer value is put into the slot or the slot is
    /// closed. Work on the value taken last should then stop.
    pub fn stale(&self) -> &AtomicBool {
        &self.stale
    }

    /// Puts a value into the slot for the other thread. Sets the flag [`stale`](Self::stale), since
    /// the value that was taken last is now outdated.
    pub fn put(&self, value: T) {
        self.change(|state| state.next = Some(value));
    }

    /// Closes the slot, and sets the flag [`stale`](Self::stale). Threads that wait for a value get
    /// `None`.
    pub fn end(&self) {
        self.change(|state| state.is_over = true);
    }

    /// Returns whether the slot is closed, i.e. whether no further values are passed.
    pub fn is_over(&self) -> bool {
        lock(&self.state).is_over
    }

    fn change(&self, change: impl FnOnce(&mut SlotState<T>)) {
        let mut state = lock(&self.state);
        change(&mut state);
        self.stale.store(true, Ordering::SeqCst);
        self.news.notify_all();
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
    fn whoever_waits_long_does_something_else_meanwhile() {
        let latest = Latest::default();
        let mut idle = 0;
        let taken = latest.take_while(Duration::from_millis(1), || {
            idle += 1;
            if idle == 3 {
                latest.put(1);
            }
        });
        assert_eq!((taken, idle), (Some(1), 3));
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
