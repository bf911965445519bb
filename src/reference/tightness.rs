//! The law of error bounds: no error exceeds its bound, and no bound says little about its errors.
//!
//! A bound adds up the errors of a computation as if each were the greatest possible, and all had
//! one direction. If it has n independent roundings, a typical error is smaller by √n, and by the
//! ratio of a rounding to the greatest one. The law therefore looks at the greatest error of many
//! computations, multiplied by √n: it must be more than a hundredth of the bound.

use std::fmt::Debug;

/// Number by which a bound may at most exceed the greatest error of many computations.
const MOST: f64 = 100.0;

/// Minimum number of errors of one mechanism that are looked at.
const FEWEST: usize = 8;

/// Errors of values that one mechanism has computed.
#[derive(Debug, Default)]
pub struct Tightness {
    count: usize,
    /// Greatest quotient of an error, multiplied by the root of the number of roundings, and its
    /// bound.
    greatest: f64,
}

impl Tightness {
    /// Adds the error of a value whose bound has `roundings` parts. Panics if the error exceeds the
    /// bound.
    #[track_caller]
    pub fn add(&mut self, error: f64, bound: f64, roundings: usize, what: impl Debug) {
        assert!(error <= bound, "{error:e} > {bound:e}: {what:?}");
        self.count += 1;
        let typical = bound / (roundings as f64).sqrt();
        self.greatest = self.greatest.max(error / typical);
    }

    /// Panics if the mechanism was hardly used, or if all errors are far below their bounds.
    #[track_caller]
    pub fn assert(&self, mechanism: &str) {
        assert!(self.count >= FEWEST, "{mechanism}: {} values", self.count);
        let least = 1.0 / MOST;
        assert!(self.greatest >= least, "{mechanism}: {:e}", self.greatest);
    }
}
