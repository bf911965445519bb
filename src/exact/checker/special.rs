//! Special functions: periodic Euler polynomials, and exponential integrals of imaginary arguments
//! with the complex numbers they need.
//!
//! The periodic Euler polynomials A_k are the repeated antiderivatives of the square wave (DLMF
//! 24.2; Borwein, Calkin and Manna, "Euler–Boole summation revisited", 2009). The error of a
//! computed value is a few unit roundoffs, relative to the polynomial's greatest value.
//!
//! The exponential integrals, with z = −iy (DLMF 8.19), are
//!
//! F_s(y) = e^z·E_s(z) = ∫_0^∞ e^(iyv)·(1 + v)^(−s) dv.
//!
//! F_s(−y) is the conjugate of F_s(y), and F_s+1 = (1 − z·F_s)/s (DLMF 8.19.12). The relative error
//! of F_3 is about 1e-14, and that of F_5 at most about 1e-13, at |y| = 64 ([`integrals`]).

use std::{f64::consts::FRAC_PI_2, sync::LazyLock};

use crate::math::{Double, ROUND, Real, two_product};

/// Ratio of a term to the sum below which a series of an exponential integral is truncated. The
/// value is about a tenth of the unit roundoff, so that the omitted terms do not change the sum.
const VANISHING: f64 = 1e-17;

/// A complex number: real and imaginary part.
pub(super) type Complex = [f64; 2];

/// Returns an angle of `x` half turns, reduced by whole turns to between −1 and 1 half turns.
pub(super) fn reduce(x: f64) -> f64 {
    x - 2.0 * (0.5 * x).round_ties_even()
}

/// Reduces an angle in half turns by whole turns. The absolute value of the result may exceed 1 by
/// a rounding, because the two parts of the double-double number are reduced separately.
pub(super) fn reduce_double(x: &Double) -> Double {
    Double::from_f64(reduce(x.hi)).plus(&Double::from_f64(reduce(x.lo)))
}

/// Returns `n`·`angle`, both angles in half turns, reduced by whole turns. `angle` must already be
/// reduced, and `n` must be below 2^51. The product is computed in double-double before it is
/// reduced, so that a small result is accurate, too.
pub(super) fn reduced_multiple(n: f64, angle: &Double) -> f64 {
    let Double { hi, lo } = two_product(n, angle.hi);
    let turns = (0.5 * hi + ROUND) - ROUND;
    (hi - 2.0 * turns) + (lo + n * angle.lo)
}

pub(super) fn times(a: Complex, b: Complex) -> Complex {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

pub(super) fn square(a: Complex) -> Complex {
    times(a, a)
}

pub(super) fn cis(x: f64) -> Complex {
    [libm::cos(x), libm::sin(x)]
}

/// Returns an upper bound of |z|: the sum of the absolute values of the real and imaginary parts.
fn size(z: Complex) -> f64 {
    z[0].abs() + z[1].abs()
}

/// Number of orders k, 0 to 21, for which the coefficients of the periodic Euler polynomials A_k
/// ([`waves`]) are stored. A series of at most 20 terms needs the orders up to 21.
const ORDERS: usize = 22;

/// Maximum number of coefficients of a periodic Euler polynomial A_k ([`waves`]) on one square of
/// the board. The polynomial has either only even or only odd powers.
const POWERS: usize = ORDERS / 2;

/// Coefficients of the Taylor series of 1/cosh(x/2): entry j is that of x^2j, and odd powers do not
/// occur. The function generates the periodic Euler polynomials ([`waves`]). The coefficients
/// follow from those of cosh(x/2), 1/(4^i·(2i)!), because the product of the two series is 1.
/// Rounding errors do not grow, because all terms of a coefficient are about as large as the
/// coefficient.
const SECH: [f64; POWERS] = {
    let mut all = [0.0; POWERS];
    all[0] = 1.0;
    let mut j = 1;
    while j < POWERS {
        let (mut cosh, mut i) = (1.0, 1);
        while i <= j {
            cosh /= (4 * (2 * i - 1) * (2 * i)) as f64;
            all[j] -= all[j - i] * cosh;
            i += 1;
        }
        j += 1;
    }
    all
};

/// Coefficients of the periodic Euler polynomials A_k ([`waves`]) on a square of the board, in
/// powers of η, the signed distance from the square's middle (−½ to ½). Row k, column j contains
/// the coefficient of η^2j if k is even, and of η^(2j+1) if k is odd.
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

/// Returns the square wave s(t): +1 if floor(t) is even, −1 if it is odd.
#[inline(always)]
pub(in crate::exact) fn square_wave(t: f64) -> f64 {
    let half = t.floor() * 0.5;
    if half == half.floor() { 1.0 } else { -1.0 }
}

/// Returns the signed distance of `t` from the middle of its square, and the sign of the square
/// wave on it. On the border of two squares, either square may be used, because the periodic Euler
/// polynomials A_k are continuous for k ≥ 1. |`t`| must be below 2^51, the limit of [`ROUND`].
#[inline(always)]
fn from_middle(t: f64) -> (f64, f64) {
    let middle = t - 0.5;
    let shifted = middle + ROUND;
    let sign = f64::from_bits(1.0_f64.to_bits() | (shifted.to_bits() << 63));
    (middle - (shifted - ROUND), sign)
}

/// Returns the periodic Euler polynomials A_1(t) … A_TERMS+1(t), where A_k(t) has the index k. The
/// entry at 0 is meaningless.
///
/// A_0 is the square wave, A_k+1′ = A_k and A_k(t + 1) = −A_k(t). On a square, with η = t −
/// floor(t) − ½,
///
/// Σ A_k·x^k = ±e^(ηx)/cosh(x/2),
///
/// so that A_k(t) is ±E_k(t − floor t)/k! with the Euler polynomials E_k (DLMF 24.2; Borwein,
/// Calkin and Manna, "Euler–Boole summation revisited", 2009). From k = 1 on, A_k is continuous and
/// |A_k| ≤ ½π^(1−k).
///
/// `TERMS` is a const parameter, so that the compiler can vectorise a loop over many t. `ROWS` must
/// be `TERMS` + 2.
#[inline(always)]
pub(super) fn waves<const TERMS: usize, const ROWS: usize>(t: f64) -> [f64; ROWS] {
    let (eta, sign) = from_middle(t);
    let (square, odd) = (eta * eta, sign * eta);
    let mut all = [0.0; ROWS];
    // Horner's rule in η², unrolled for each order, because the compiler does not vectorise loops
    // over the orders.
    macro_rules! order {
        ($k:literal, $first:expr, $($factor:literal)*) => {
            if TERMS + 1 >= $k {
                let mut sum = 0.0;
                $(sum = sum * square + FACTORS[$k][$factor];)*
                all[$k] = $first * sum;
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

/// Value of |y| below which the exponential integral F_3(y) ([`integrals`]) is computed by the
/// power series. No term of the series exceeds 3 for such y, so that few digits cancel.
const SMALL: f64 = 3.0;
/// Minimum |y| at which the exponential integrals ([`integrals`]) are computed by the asymptotic
/// series. For smaller |y|, the terms of the series might grow again before they are negligible.
const LARGE: f64 = 64.0;

/// Distance in y between neighbouring expansion points of the Taylor series of the exponential
/// integral F_3 ([`integrals`]). The series are used for |y| from `SMALL` to `LARGE`. A smaller
/// distance would need fewer terms per series but a larger table, which now has 123 series.
const STEP: f64 = 0.5;
/// Number of terms of a Taylor series of the exponential integral F_3 ([`integrals`]). The distance
/// of y from the expansion point is at most ¼, and y is at least 3. The first omitted term is
/// therefore at most (¼/3)^16 = 5e-18.
const EXPANSION_TERMS: usize = 16;
type Expansion = [Complex; EXPANSION_TERMS];
static EXPANSIONS: LazyLock<Vec<Expansion>> = LazyLock::new(expansions);

/// Returns the exponential integrals F_3(y), F_4(y) and F_5(y), where F_s(y) = ∫_0^∞ e^(iyv)·(1 +
/// v)^(−s) dv.
///
/// Their recurrence is s·F_(s+1) = 1 + iy·F_s (DLMF 8.19.12). A step from F_s to F_(s+1) multiplies
/// an error by y/s; the opposite step divides it by y/s. For |y| below [`LARGE`], F_4 and F_5
/// follow from F_3 by two steps, which multiply an error by at most y²/12, about 340. For larger
/// |y|, F_4 and F_3 follow from F_5.
pub(super) fn integrals(y: f64) -> [Complex; 3] {
    let size = y.abs();
    let integrals = if size < LARGE {
        let third = third(size);
        let fourth = next(size, third, 3.0);
        [third, fourth, next(size, fourth, 4.0)]
    } else {
        let fifth = asymptotic(size, 5);
        let fourth = previous(size, fifth, 4.0);
        [previous(size, fourth, 3.0), fourth, fifth]
    };
    integrals.map(|[re, im]| [re, im * 1.0_f64.copysign(y)])
}

/// Returns the exponential integral F_3(y) ([`integrals`]) for y from 0 to [`LARGE`], by the series
/// that suits y.
fn third(y: f64) -> Complex {
    if y >= SMALL {
        expanded(&EXPANSIONS, y)
    } else {
        power_series(y)
    }
}

/// Returns the exponential integral F_(s+1)(y) = (1 + iy·F_s(y))/s. `integral` is F_s(y), and
/// `order` is s.
fn next(y: f64, integral: Complex, order: f64) -> Complex {
    [(1.0 - y * integral[1]) / order, y * integral[0] / order]
}

/// Returns the exponential integral F_s(y) = (s·F_(s+1)(y) − 1)/(iy). `integral` is F_(s+1)(y), and
/// `order` is s.
fn previous(y: f64, integral: Complex, order: f64) -> Complex {
    [order * integral[1] / y, (1.0 - order * integral[0]) / y]
}

/// Computes the exponential integral F_s(y) for y ≥ `LARGE`, where s is `order`. Adds up the
/// following asymptotic series until its terms are negligible (DLMF 8.20.2, with z = −iy):
///
/// (1/z)·Σ (−1)^k·(s)_k·z^−k, where (s)_k = s·(s + 1)·…·(s + k − 1).
fn asymptotic(y: f64, order: u32) -> Complex {
    let u = 1.0 / y;
    // Because 1/z = i/y, each term is the previous one times −i·(k + s)/y.
    let (mut term, mut sum) = (u, [0.0; 2]);
    for k in 0..40 {
        match k % 4 {
            0 => sum[1] += term,
            1 => sum[0] += term,
            2 => sum[1] -= term,
            _ => sum[0] -= term,
        }
        term *= f64::from(k + order) * u;
        if term < VANISHING * u {
            break;
        }
    }
    sum
}

/// Evaluates the exponential integral F_3(y) ([`integrals`]) for y from 3 to 64 by the Taylor
/// series about the expansion point nearest to y.
fn expanded(expansions: &[Expansion], y: f64) -> Complex {
    let middle = f64::from((y / STEP + 0.5) as u32);
    let step = y - middle * STEP;
    at_step(&expansions[(middle - SMALL / STEP) as usize], step)
}

/// Evaluates a Taylor series at the distance `step` from its expansion point. `terms` are the
/// series' coefficients.
fn at_step(terms: &Expansion, step: f64) -> Complex {
    terms.iter().rev().fold([0.0; 2], |sum, term| {
        [sum[0] * step + term[0], sum[1] * step + term[1]]
    })
}

/// Computes the Taylor series of the exponential integral F_3 ([`integrals`]) about points from 3
/// to 64, and returns them in ascending order.
fn expansions() -> Vec<Expansion> {
    // The series are computed in descending order: the value at each point comes from the series of
    // the next greater point, a `STEP` above.
    //
    // (s − 1)·F_s = 1 + iy·F_s−1 (DLMF 8.19.12) and F_s′ = i·(F_s−1 − F_s) give the differential
    // equation
    //
    // y·F_s′ = (s − 1 − iy)·F_s − 1.
    //
    // An error of F_s satisfies this equation without the −1, so it is proportional to y^(s−1),
    // whereas F_s is about proportional to 1/y. Towards smaller y, errors therefore decay. The
    // coefficients c_k of the Taylor series about y satisfy the recurrence
    //
    // (k + 1)·y·c_k+1 = (s − 1 − k − iy)·c_k − i·c_k−1 − δ_k,
    //
    // where δ_k is 1 if k = 0, and 0 otherwise.
    let middles = (SMALL / STEP) as u32..=(LARGE / STEP) as u32;
    let mut value = asymptotic(LARGE, 3);
    let about = |middle: u32| {
        let y = f64::from(middle) * STEP;
        let mut terms = [[0.0; 2]; EXPANSION_TERMS];
        terms[0] = value;
        for k in 1..EXPANSION_TERMS {
            let done = (k - 1) as f64;
            let mut term = times([2.0 - done, -y], terms[k - 1]);
            match k.checked_sub(2) {
                Some(before) => {
                    let [re, im] = terms[before];
                    term = [term[0] + im, term[1] - re];
                }
                None => term[0] -= 1.0,
            }
            terms[k] = term.map(|part| part / (y * (done + 1.0)));
        }
        value = at_step(&terms, -STEP);
        terms
    };
    let mut all: Vec<Expansion> = middles.rev().map(about).collect();
    all.reverse();
    all
}

/// Computes the exponential integral F_3(y) ([`integrals`]) for |y| < `SMALL`, from F_1 by two
/// steps of the recurrence F_s+1 = (1 − z·F_s)/s, where z = −iy.
fn power_series(y: f64) -> Complex {
    let first = first(y);
    // The recurrence for s = 1 is F_2 = 1 − z·F_1, with −z = iy.
    let second = [1.0 - y * first[1], y * first[0]];
    [0.5 * (1.0 - y * second[1]), 0.5 * y * second[0]]
}

/// Computes the exponential integral F_1(y) = e^z·E_1(z) with z = −iy, for |y| < `SMALL` (DLMF
/// 6.6.2) from the following series, where γ is Euler's constant:
///
/// E_1(z) = −γ − ln z − Σ (−z)^k/(k·k!)
///
/// At y = 0, F_1 has a logarithmic pole. The function returns 0 there, because the caller needs
/// only y·F_1, whose limit is 0.
fn first(y: f64) -> Complex {
    const EULER: f64 = 0.577_215_664_901_532_9;
    if y == 0.0 {
        return [0.0; 2];
    }
    let mut first = [-EULER - libm::log(y.abs()), FRAC_PI_2.copysign(y)];
    let mut term = [1.0, 0.0];
    for k in 1..40 {
        let k = f64::from(k);
        // Each term is the previous one times −z/k = iy/k.
        term = [-term[1] * y / k, term[0] * y / k];
        first = [first[0] - term[0] / k, first[1] - term[1] / k];
        if size(term) < VANISHING {
            break;
        }
    }
    times(first, cis(-y))
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
                    let cis = f64::from(n) * PI * t - k as f64 * PI / 2.0;
                    sum += 4.0 / f64::from(n) * libm::sin(cis) / libm::pow(x, k as f64);
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

    fn close(found: Complex, expected: Complex, relative: f64) {
        let error = (found[0] - expected[0]).abs() + (found[1] - expected[1]).abs();
        let size = expected[0].abs() + expected[1].abs();
        assert!(error <= relative * size, "{found:?}, not {expected:?}");
    }

    #[test]
    fn the_series_of_f3_agree_where_they_meet() {
        close(expanded(&EXPANSIONS, 64.0), asymptotic(64.0, 3), 1e-15);
        close(expanded(&EXPANSIONS, 3.0), power_series(3.0), 1e-14);
    }

    /// Compares the exponential integrals for large |y| with the first two terms of their
    /// asymptotic series, separately for real and imaginary parts. The third term is at most
    /// 6·7·8·9·y⁻⁴ times the first, about 3.02e-13 at y = 10⁴. The tolerance is this ratio plus a
    /// few roundings.
    #[test]
    fn integrals_of_large_arguments_have_all_their_digits() {
        for y in [1e4, -1e4, 3e7, 5e10, -1e15] {
            for (s, [re, im]) in (3..).map(f64::from).zip(integrals(y)) {
                let expected = [
                    s / (y * y) * (1.0 - (s + 1.0) * (s + 2.0) / (y * y)),
                    (1.0 - s * (s + 1.0) / (y * y)) / y,
                ];
                for (part, expected) in [re, im].into_iter().zip(expected) {
                    let error = (part - expected).abs();
                    assert!(error <= 3.1e-13 * expected.abs(), "F_{s}({y}): {error:e}");
                }
            }
        }
    }

    #[test]
    fn f3_is_its_integral() {
        // Number of steps of the midpoint rule that computes F_3(y) = ∫_0^∞ e^(iyv)·(1 + v)^(−3) dv
        // for comparison. With v = x/(1 − x), this is the integral of (1 − x)·e^(iyv) over x from 0
        // to 1. With a hundredth of the steps, the error would exceed the tolerance.
        const STEPS: u32 = 400_000;
        for y in [0.0, 0.01, 0.7, 3.5, 12.0] {
            let mut sum = [0.0; 2];
            for i in 0..STEPS {
                let x = (f64::from(i) + 0.5) / f64::from(STEPS);
                let wave = cis(y * x / (1.0 - x));
                sum = [sum[0] + (1.0 - x) * wave[0], sum[1] + (1.0 - x) * wave[1]];
            }
            // Near x = 1, the integrand oscillates too fast for the midpoint rule. The error stays
            // below the tolerance of 1e-4, because the part of the integral from x to 1 is only of
            // order (1 − x)².
            close(third(y), sum.map(|x| x / f64::from(STEPS)), 1e-4);
        }
    }
}
