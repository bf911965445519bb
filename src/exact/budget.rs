//! Limits on the work on a pixel and on a picture, and the requested accuracy.
//!
//! In: the work of the next computation, in units of about 50 ns. Out: whether to do it. If the
//! budget of a pixel is spent, the rest of the pixel is not computed, and its area is added to the
//! error bound. Every pixel of any scene is therefore finished. Work is counted, not timed, so that
//! the same scene gives the same picture on every machine.

use std::{
    cell::Cell,
    sync::atomic::{AtomicBool, AtomicU64, Ordering::Relaxed},
};

/// Maximum work on a pixel, in units of about 50 ns. It limits the time for a pixel of any scene to
/// about 0.6 seconds. The area that is not computed by then is added to the error bound. 50 ns is
/// the measured time to cut one square of a checkerboard out of a polygon.
const PIXEL_WORK: f64 = 1.2e7;

/// Work of all threads on the pixels of a picture, and its limit.
#[derive(Debug)]
pub(super) struct PictureWork {
    spent: AtomicU64,
    limit: u64,
}

impl PictureWork {
    /// Starts counting the work on a picture. `limit` is in units of about 50 ns.
    pub fn new(limit: u64) -> Self {
        let spent = AtomicU64::new(0);
        Self { spent, limit }
    }

    /// Adds the work on a pixel, in units of about 50 ns.
    pub fn add(&self, work: u64) {
        self.spent.fetch_add(work, Relaxed);
    }

    /// Returns the work spent so far, in units of about 50 ns.
    pub fn spent(&self) -> u64 {
        self.spent.load(Relaxed)
    }

    /// Returns whether more work was spent than the limit.
    pub fn is_exceeded(&self) -> bool {
        self.spent() > self.limit
    }
}

/// Work that may still be spent on a pixel, and the flag that cancels the computation of its
/// picture.
#[derive(Debug)]
pub(super) struct PixelBudget<'a> {
    left: Cell<f64>,
    /// Requested error bound of the pixel's mean, as a fraction of the pixel's area. Checkerboards
    /// are integrated by infinite series and sums. These are truncated as soon as the omitted terms
    /// are at most a fixed fraction of this bound.
    pub tolerance: f64,
    /// Flag that is set once the picture is no longer wanted.
    cancel: &'a AtomicBool,
}

impl<'a> PixelBudget<'a> {
    /// Creates the budget of a pixel on which no work is spent yet.
    pub fn new(tolerance: f64, cancel: &'a AtomicBool) -> Self {
        Self {
            left: Cell::new(PIXEL_WORK),
            tolerance,
            cancel,
        }
    }

    /// Returns the work spent on the pixel so far, in units of about 50 ns.
    pub fn spent(&self) -> f64 {
        PIXEL_WORK - self.left.get()
    }

    /// Returns whether the picture is no longer wanted, so that all results are discarded.
    pub fn is_cancelled(&self) -> bool {
        self.cancel.load(Relaxed)
    }

    /// Returns whether the budget is used up or the picture is cancelled. Nothing more should then
    /// be computed.
    pub fn is_spent(&self) -> bool {
        self.left.get() <= 0.0 || self.is_cancelled()
    }

    /// Charges `work` if the budget affords it. Returns whether `work` was charged. It is not
    /// charged if it is infinite or NaN, or if the picture is cancelled.
    pub fn try_charge(&self, work: f64) -> bool {
        let is_affordable = self.affords(work);
        if is_affordable {
            self.charge(work);
        }
        is_affordable
    }

    /// Returns whether the budget affords `work` and the picture is not cancelled.
    pub fn affords(&self, work: f64) -> bool {
        work <= self.left.get() && !self.is_cancelled()
    }

    /// Charges `work` without a check, even if it exceeds the limit.
    pub fn charge(&self, work: f64) {
        self.left.set(self.left.get() - work);
    }
}
