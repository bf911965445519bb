//! Intervals: what is certain of numbers all over a rectangle of the picture.

use crate::math::UP;

/// The numbers from `low` to `high`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// The least.
    pub low: f64,
    /// The greatest.
    pub high: f64,
}

/// How an object that may be seen in a rectangle stands to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cover {
    /// Whether every ray through the rectangle meets the object.
    pub is_whole: bool,
    /// Holds the inverse depths of what is met of it, seen or hidden.
    pub inverse_depth: Range,
}

/// Where all numbers of a range stand to 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Side {
    Above,
    Below,
    Both,
    /// It has overflowed.
    Unknown,
}

impl Range {
    /// All numbers.
    pub const ALL: Self = Self {
        low: f64::NEG_INFINITY,
        high: f64::INFINITY,
    };

    /// The numbers that are no farther from `middle` than `reach`.
    pub fn about(middle: f64, reach: f64) -> Self {
        let reach = reach * UP + f64::MIN_POSITIVE;
        Self {
            low: middle - reach,
            high: middle + reach,
        }
    }

    /// Itself, or all numbers where an overflow left none.
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

    /// Whether it holds 0, as far as is known: NaN holds everything.
    pub fn holds_zero(self) -> bool {
        !(self.low > 0.0 || self.high < 0.0)
    }

    /// The greatest (or least) of some numbers, one of each range.
    pub fn fold(ranges: impl Iterator<Item = Self>, which: fn(f64, f64) -> f64) -> Option<Self> {
        // Not so NaN, of which the greater would be the other.
        ranges.map(Self::or_all).reduce(|a, b| Self {
            low: which(a.low, b.low),
            high: which(a.high, b.high),
        })
    }

    /// Times a power of two.
    pub fn times_power(self, power: f64) -> Self {
        Self {
            low: self.low * power,
            high: self.high * power,
        }
    }
}
