//! Euler's polynomials made periodic, the repeated antiderivatives of the square wave.

use std::array;

use crate::math::ROUND;

/// One more than the highest order there is.
pub(super) const ORDERS: usize = 22;

/// How many even powers of η there are in the waves of the highest order.
const POWERS: usize = ORDERS / 2;

/// The coefficients of 1/cosh(x/2) in even powers of x: Euler's numbers by 4^j·(2j)!, and from the seventh on by
/// (−1)^j·4β(2j + 1)/π^(2j+1) with Dirichlet's β (DLMF 24.8.4 at x = ½), of which six terms are enough.
const SECH: [f64; POWERS] = {
    let mut all = [0.0; POWERS];
    all[0] = 1.0;
    all[1] = -1.0 / 8.0;
    all[2] = 5.0 / 384.0;
    all[3] = -61.0 / 46080.0;
    all[4] = 1385.0 / 10321920.0;
    all[5] = -50521.0 / 3715891200.0;
    all[6] = 2702765.0 / 1961990553600.0;
    let mut j = 7;
    while j < POWERS {
        let (mut sum, mut n) = (0.0, 6);
        while n > 0 {
            n -= 1;
            let term = power(1.0 / (2 * n + 1) as f64, 2 * j + 1);
            sum = if n % 2 == 0 { sum + term } else { sum - term };
        }
        let size = 4.0 * sum * power(std::f64::consts::FRAC_1_PI, 2 * j + 1);
        all[j] = if j % 2 == 0 { size } else { -size };
        j += 1;
    }
    all
};

const fn power(base: f64, exponent: usize) -> f64 {
    let (mut product, mut left) = (1.0, exponent);
    while left > 0 {
        product *= base;
        left -= 1;
    }
    product
}

/// The factors of η^i, i even or odd as k is, in A_k on a square: in the row k the factor of η^2j, or η^(2j+1), at j.
const FACTORS: [[f64; POWERS]; ORDERS] = {
    let mut factorials = [1.0; ORDERS];
    let mut k = 1;
    while k < ORDERS {
        factorials[k] = factorials[k - 1] * k as f64;
        k += 1;
    }
    let mut all = [[0.0; POWERS]; ORDERS];
    let mut k = 1;
    while k < ORDERS {
        let mut j = 0;
        while 2 * j + k % 2 <= k {
            let power = 2 * j + k % 2;
            all[k][j] = SECH[(k - power) / 2] / factorials[power];
            j += 1;
        }
        k += 1;
    }
    all
};

/// The square wave: +1 where floor(t) is even, −1 where it is odd.
pub(super) fn square_wave(t: f64) -> f64 {
    let half = t.floor() * 0.5;
    if half == half.floor() { 1.0 } else { -1.0 }
}

/// A_1(t) … A_TERMS+1(t), at their own index; what stands at index 0 and above is not meant to be read.
///
/// A_0 is the square wave, A_k+1′ = A_k and A_k(t + 1) = −A_k(t). On a square, with η = t − floor(t) − ½,
/// Σ A_k x^k = ±e^(ηx)/cosh(x/2), so that A_k(t) is ±E_k(t − floor t)/k! (DLMF 24.2; Borwein, Calkin and Manna,
/// "Euler–Boole summation revisited", 2009). They are continuous from k = 1 on, and |A_k| ≤ ½π^(1−k).
pub(super) fn waves<const TERMS: usize, const ROWS: usize>(t: f64) -> [f64; ROWS] {
    waves_at::<TERMS, ROWS, 1>([t]).map(|[wave]| wave)
}

/// The waves at several places: in each of the answer's rows one order, so that there must be two rows more than terms.
#[inline(always)]
pub(super) fn waves_at<const TERMS: usize, const ROWS: usize, const N: usize>(
    t: [f64; N],
) -> [[f64; N]; ROWS] {
    // At a tie either neighbour will do, for the waves are continuous. Half-way to t's last digits nothing is left to be said.
    let middle = t.map(|t| t - 0.5);
    let shifted = middle.map(|middle| middle + ROUND);
    let eta: [f64; N] = array::from_fn(|i| middle[i] - (shifted[i] - ROUND));
    let sign = shifted.map(|s| f64::from_bits(1.0_f64.to_bits() | (s.to_bits() << 63)));
    let square: [f64; N] = array::from_fn(|i| eta[i] * eta[i]);
    let odd: [f64; N] = array::from_fn(|i| sign[i] * eta[i]);
    let mut all = [[0.0; N]; ROWS];
    // Horner's rule in η², spelled out for the orders that are wanted most, since loops over them would not become vectors.
    macro_rules! order {
        ($k:literal, $first:expr, $($factor:literal)*) => {
            if TERMS + 1 >= $k {
                all[$k] = array::from_fn(|i| {
                    let mut sum = 0.0;
                    $(sum = sum * square[i] + FACTORS[$k][$factor];)*
                    $first[i] * sum
                });
            }
        };
    }
    order!(1, odd, 0);
    order!(2, sign, 1 0);
    order!(3, odd, 1 0);
    order!(4, sign, 2 1 0);
    order!(5, odd, 2 1 0);
    order!(6, sign, 3 2 1 0);
    order!(7, odd, 3 2 1 0);
    order!(8, sign, 4 3 2 1 0);
    order!(9, odd, 4 3 2 1 0);
    order!(10, sign, 5 4 3 2 1 0);
    order!(11, odd, 5 4 3 2 1 0);
    order!(12, sign, 6 5 4 3 2 1 0);
    order!(13, odd, 6 5 4 3 2 1 0);
    order!(14, sign, 7 6 5 4 3 2 1 0);
    order!(15, odd, 7 6 5 4 3 2 1 0);
    order!(16, sign, 8 7 6 5 4 3 2 1 0);
    order!(17, odd, 8 7 6 5 4 3 2 1 0);
    order!(18, sign, 9 8 7 6 5 4 3 2 1 0);
    order!(19, odd, 9 8 7 6 5 4 3 2 1 0);
    order!(20, sign, 10 9 8 7 6 5 4 3 2 1 0);
    order!(21, odd, 10 9 8 7 6 5 4 3 2 1 0);
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn waves_are_the_fourier_series() {
        for t in [-3.7, -1.0, -0.2, 0.0, 0.31, 0.5, 1.25, 2.0, 7.9] {
            for (k, wave) in waves::<20, ORDERS>(t).into_iter().enumerate().skip(2) {
                let mut sum = 0.0;
                for n in (1..4001).step_by(2) {
                    let x = f64::from(n) * PI;
                    let phase = f64::from(n) * PI * t - k as f64 * PI / 2.0;
                    sum += 4.0 / f64::from(n) * libm::sin(phase) / libm::pow(x, k as f64);
                }
                sum /= PI;
                assert!(
                    (sum - wave).abs() < 1e-8 / libm::pow(PI, k as f64),
                    "A_{k}({t}) = {} or {sum}",
                    wave
                );
                assert!(wave.abs() <= 0.5 * libm::pow(PI, 1.0 - k as f64));
            }
        }
    }
}
