//! How long a pixel may take, and how well it is to be known.
//!
//! In: what is about to be computed, in units of work. Out: whether to compute it. What is not
//! computed any more counts as the mean of what may be there, with its whole area as its bound, so
//! that every pixel ends, whatever the view. Work is counted, not timed: the same scene gives the
//! same picture.

use std::{
    cell::Cell,
    sync::atomic::{AtomicBool, Ordering},
};

/// Maximum number of units of work that are spent on a pixel. A unit is one square of a board cut
/// out of a polygon, some 50 ns on the machine where it was measured, and about 0.6 seconds for
/// all.
const PIXEL: f64 = 1.2e7;

/// The work that may still be spent on a pixel, and the flag by which its picture is given up.
#[derive(Debug)]
pub(super) struct Budget<'a> {
    left: Cell<f64>,
    /// The bound that is asked for, in area: what is neglected is a part of it.
    pub tolerance: f64,
    /// Set once nobody wants the picture any more.
    cancel: &'a AtomicBool,
}

impl<'a> Budget<'a> {
    /// That of a whole pixel.
    pub fn of_pixel(tolerance: f64, cancel: &'a AtomicBool) -> Self {
        Self {
            left: Cell::new(PIXEL),
            tolerance,
            cancel,
        }
    }

    /// The work that was spent.
    pub fn spent(&self) -> f64 {
        PIXEL - self.left.get()
    }

    /// Whether nobody wants the picture any more, so that all that is computed is thrown away.
    pub fn is_cancelled(&self) -> bool {
        self.cancel.load(Ordering::Relaxed)
    }

    /// Whether nothing more should be computed.
    pub fn is_spent(&self) -> bool {
        self.left.get() <= 0.0 || self.is_cancelled()
    }

    /// Spends so much, if it is there. What is not a number, or infinite, never is.
    pub fn spend(&self, work: f64) -> bool {
        let is_there = self.affords(work);
        if is_there {
            self.left.set(self.left.get() - work);
        }
        is_there
    }

    /// Whether so much may still be spent.
    pub fn affords(&self, work: f64) -> bool {
        work <= self.left.get() && !self.is_cancelled()
    }

    /// Takes so much away for what has been computed already.
    pub fn charge(&self, work: f64) {
        self.left.set(self.left.get() - work);
    }
}
