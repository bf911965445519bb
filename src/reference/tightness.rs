//! Checks the error bounds of a computation: no error may exceed its bound. The largest errors must
//! also come near to their bounds, because otherwise the bounds would be needlessly large.
//!
//! A bound adds up the rounding errors of a computation as if each had its greatest possible size
//! and all had the same sign. With n independent roundings, the actual error is typically smaller
//! by a factor of √n. For this reason, the greatest error of many computations is multiplied by √n.
//! The product must be at least a hundredth of the bound.

use std::fmt::Debug;

/// Maximum ratio of an error bound to the greatest error of many computations, after the error is
/// multiplied by √n for n roundings. Typical errors are smaller than the greatest possible error,
/// so the ratio cannot be close to 1.
const MOST: f64 = 100.0;

/// Minimum number of errors on which a check of an error bound is based. With too few errors, all
/// of them may be far below their bounds by chance.
const FEWEST: usize = 8;

/// Errors of many computed values, to check that their error bounds are not needlessly large.
#[derive(Debug, Default)]
pub struct Tightness {
    count: usize,
    /// Greatest value of error·√n/bound, where n is the number of roundings in the computation.
    greatest: f64,
}

impl Tightness {
    /// Adds the error of a value that is computed with `roundings` roundings. Panics if the error
    /// exceeds the bound.
    #[track_caller]
    pub fn add(&mut self, error: f64, bound: f64, roundings: usize, what: impl Debug) {
        assert!(error <= bound, "{error:e} > {bound:e}: {what:?}");
        self.count += 1;
        let typical = bound / (roundings as f64).sqrt();
        self.greatest = self.greatest.max(error / typical);
    }

    /// Panics if too few errors were added, or if all of them are far below their bounds.
    /// `mechanism` names the computation in the message.
    #[track_caller]
    pub fn assert(&self, mechanism: &str) {
        assert!(self.count >= FEWEST, "{mechanism}: {} values", self.count);
        let least = 1.0 / MOST;
        assert!(self.greatest >= least, "{mechanism}: {:e}", self.greatest);
    }
}
