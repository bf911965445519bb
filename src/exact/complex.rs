//! Complex numbers and angles, as far as sums of waves need them.

use crate::math::{Double, Real, two_product};

/// A real and an imaginary part.
pub(super) type Complex = [f64; 2];

/// Less whole turns, in half turns: between −1 and 1.
pub(super) fn turn(x: f64) -> f64 {
    x - 2.0 * (0.5 * x).round_ties_even()
}

/// The same of a double-double number.
pub(super) fn turn_exactly(x: &Double) -> Double {
    Double::from_f64(turn(x.hi)).plus(&Double::from_f64(turn(x.lo)))
}

/// n times an angle that is given without whole turns, without whole turns: to within a rounding of itself, however small that is, as long as
/// double-double numbers tell.
pub(super) fn turned_times(n: f64, angle: &Double) -> f64 {
    let Double { hi, lo } = two_product(n, angle.hi);
    turn(hi) + (lo + n * angle.lo)
}

pub(super) fn times(a: Complex, b: Complex) -> Complex {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

pub(super) fn square(a: Complex) -> Complex {
    times(a, a)
}

pub(super) fn over(a: Complex, b: Complex) -> Complex {
    let norm = 1.0 / (b[0] * b[0] + b[1] * b[1]);
    [
        (a[0] * b[0] + a[1] * b[1]) * norm,
        (a[1] * b[0] - a[0] * b[1]) * norm,
    ]
}

pub(super) fn phase(x: f64) -> Complex {
    [libm::cos(x), libm::sin(x)]
}

/// What bounds it from above: |x| + |y|.
pub(super) fn size(z: Complex) -> f64 {
    z[0].abs() + z[1].abs()
}
