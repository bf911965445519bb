//! Intervals of real numbers, for bounds over a rectangle of the picture.

use crate::math::UP;

/// The numbers from `low` to `high`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// The least number of the interval.
    pub low: f64,
    /// The greatest number of the interval.
    pub high: f64,
}

/// Coverage of a rectangle by an object that may be seen in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cover {
    /// Whether every ray through the rectangle hits the object.
    pub is_whole: bool,
    /// Interval that contains the inverse depths of all crossings with the object, including those
    /// that another object hides.
    pub inverse_depth: Interval,
}

/// Position of an interval relative to 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Side {
    Above,
    Below,
    Both,
    /// An end of the interval overflowed.
    Unknown,
}

impl Interval {
    /// The interval of all numbers.
    pub const ALL: Self = Self {
        low: f64::NEG_INFINITY,
        high: f64::INFINITY,
    };

    /// Returns an interval that contains all numbers at most `reach` from `middle`, rounding errors
    /// included.
    pub fn about(middle: f64, reach: f64) -> Self {
        let reach = reach * UP + f64::MIN_POSITIVE;
        Self {
            low: middle - reach,
            high: middle + reach,
        }
    }

    /// Returns the interval itself. If an overflow has left its ends NaN or in the wrong order,
    /// returns the interval of all numbers.
    pub fn or_all(self) -> Self {
        if self.low <= self.high {
            self
        } else {
            Self::ALL
        }
    }

    pub fn side(self) -> Side {
        if !(self.low.is_finite() && self.high.is_finite()) {
            Side::Unknown
        } else if self.low > 0.0 {
            Side::Above
        } else if self.high < 0.0 {
            Side::Below
        } else {
            Side::Both
        }
    }

    /// Returns whether 0 may lie in the interval. An end that is NaN is treated as infinite.
    pub fn holds_zero(self) -> bool {
        !(self.low > 0.0 || self.high < 0.0)
    }

    /// Returns an interval that contains the greatest (or the least) of several numbers. Each of
    /// these numbers lies in one interval of `ranges`. `which` is `f64::max` for the greatest and
    /// `f64::min` for the least. Returns `None` if `ranges` is empty.
    pub fn fold(ranges: impl Iterator<Item = Self>, which: fn(f64, f64) -> f64) -> Option<Self> {
        // An interval with a NaN end is first replaced by the interval of all numbers, because
        // `f64::max` and `f64::min` ignore NaN.
        ranges.map(Self::or_all).reduce(|a, b| Self {
            low: which(a.low, b.low),
            high: which(a.high, b.high),
        })
    }

    /// Multiplies both ends by a power of two.
    pub fn times_power(self, power: f64) -> Self {
        Self {
            low: self.low * power,
            high: self.high * power,
        }
    }
}
