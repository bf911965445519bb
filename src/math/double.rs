//! Double-double numbers: the unevaluated sum of two `f64`, accurate to about 32 digits.

use super::{Big, Real};

/// A double-double number: the sum of two `f64`. The second is at most half a unit in the last
/// place of the first.
///
/// The algorithms are Dekker's and Knuth's error-free transformations. Sum and product are the
/// accurate versions analysed by Joldes, Muller and Popescu, "Tight and rigorous error bounds for
/// basic building blocks of double-word arithmetic" (2017). Their relative errors are at most 3u²
/// and 5u², where u = 2^−53. The quotient is computed by long division, and the root by a step of
/// Newton's method. Their residuals are computed in double-double.
///
/// The error of a product in `f64` is computed by Dekker's splitting. A fused multiply-add would
/// give the same result, but is a slow function call on processors without this instruction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Double {
    /// The number rounded to `f64`.
    pub hi: f64,
    /// The difference between the number and `hi`.
    pub lo: f64,
}

/// Returns `a` + `b` as the rounded sum and its exact error (Knuth).
#[inline(always)]
pub fn two_sum(a: f64, b: f64) -> Double {
    let hi = a + b;
    let of_b = hi - a;
    let lo = (a - (hi - of_b)) + (b - of_b);
    Double { hi, lo }
}

/// Returns `a` + `b` as the rounded sum and its exact error (Dekker). Requires |`a`| ≥ |`b`|.
#[inline(always)]
fn quick_two_sum(a: f64, b: f64) -> Double {
    let hi = a + b;
    Double {
        hi,
        lo: b - (hi - a),
    }
}

/// Returns `a` · `b` as the rounded product and its exact error (Dekker, with Veltkamp's
/// splitting).
#[inline(always)]
pub fn two_product(a: f64, b: f64) -> Double {
    /// Veltkamp's factor 2^27 + 1. Multiplying by it splits a number of 53 bits into an upper part
    /// of 26 bits, and a lower part of 26 bits and a sign.
    const SPLIT: f64 = ((1u64 << 27) + 1) as f64;
    fn split(x: f64) -> (f64, f64) {
        let scaled = x * SPLIT;
        let high = scaled - (scaled - x);
        (high, x - high)
    }
    let hi = a * b;
    let (a_high, a_low) = split(a);
    let (b_high, b_low) = split(b);
    let lo = ((a_high * b_high - hi) + a_high * b_low + a_low * b_high) + a_low * b_low;
    Double { hi, lo }
}

impl Double {
    /// Returns −`self` if `condition` holds, otherwise `self`.
    pub fn negated_if(self, condition: bool) -> Self {
        if condition { self.negated() } else { self }
    }
}

impl Real for Double {
    type Radius = f64;

    /// Maximum relative error of one operation: 2^−102. The quotient has the largest error of all
    /// operations, 10u², where u = 2^−53.
    const UNIT: f64 = 1.0 / (1u128 << 102) as f64;
    /// Upper bound of the absolute error of an operation that underflows: 2^−1022. In fact, the
    /// error is much smaller: splitting the factors of a product loses at most a few times 2^−1074.
    const TINY: f64 = f64::MIN_POSITIVE;
    const LAST: bool = false;

    fn from_f64(x: f64) -> Self {
        Self { hi: x, lo: 0.0 }
    }
    fn difference(a: f64, b: f64) -> Self {
        two_sum(a, -b)
    }
    fn from_big(x: &Big) -> Self {
        let hi = x.to_f64();
        let lo = if hi.is_finite() {
            x.minus(&Big::from_f64(hi)).to_f64()
        } else {
            0.0
        };
        Self { hi, lo }
    }
    fn to_f64(&self) -> f64 {
        self.hi
    }
    fn magnitude(&self) -> f64 {
        self.hi.abs()
    }
    fn is_negative(&self) -> bool {
        self.hi < 0.0
    }
    fn is_zero(&self) -> bool {
        self.hi == 0.0
    }
    #[inline(always)]
    fn plus(&self, other: &Self) -> Self {
        let s = two_sum(self.hi, other.hi);
        let t = two_sum(self.lo, other.lo);
        let s = quick_two_sum(s.hi, s.lo + t.hi);
        quick_two_sum(s.hi, s.lo + t.lo)
    }
    fn minus(&self, other: &Self) -> Self {
        self.plus(&other.negated())
    }
    #[inline(always)]
    fn times(&self, other: &Self) -> Self {
        let p = two_product(self.hi, other.hi);
        let cross = self.hi * other.lo + self.lo * other.hi;
        quick_two_sum(p.hi, p.lo + cross)
    }
    fn over(&self, other: &Self) -> Self {
        // The quotient is a long division with two digits, each an `f64`, and a correction.
        let first = self.hi / other.hi;
        let rest = self.minus(&other.times(&Self::from_f64(first)));
        let second = rest.hi / other.hi;
        let rest = rest.minus(&other.times(&Self::from_f64(second)));
        let third = rest.hi / other.hi;
        quick_two_sum(first, second).plus(&Self::from_f64(third))
    }
    fn sqrt(&self) -> Self {
        if self.hi == 0.0 {
            return *self;
        }
        // One step of Newton's method improves the root in `f64`; the residual is in double-double.
        let root = f64::sqrt(self.hi);
        let rest = self.minus(&two_product(root, root));
        quick_two_sum(root, rest.hi / (2.0 * root))
    }
    fn negated(&self) -> Self {
        Self {
            hi: -self.hi,
            lo: -self.lo,
        }
    }
    fn scaled(&self, exponent: i32) -> Self {
        Self {
            hi: Real::scaled(&self.hi, exponent),
            lo: Real::scaled(&self.lo, exponent),
        }
    }
    fn floor(&self) -> (Self, bool) {
        let (hi, hi_odd) = Real::floor(&self.hi);
        if hi != self.hi {
            return (Self { hi, lo: 0.0 }, hi_odd);
        }
        let (lo, lo_odd) = Real::floor(&self.lo);
        (quick_two_sum(hi, lo), hi_odd != lo_odd)
    }
}
