//! What a crossing of a side with a line has of all squares ahead of it, in one direction along an axis of the board.
//!
//! With Λ the triangle wave that is 1 − 2t between 0 and 1, Λ(t + 1) = −Λ(t), what all squares ahead of a crossing have, where m is linear, is
//!
//! G_s(t, m) = ½s∫ Λ(t + y)·(m + sy)⁻³ dy over y ≥ 0, and over y ≤ 0 where s is negative: G_−s(−t, m) = G_s(t, m).
//!
//! By parts that is ¼m⁻²·Λ(t) − ½∫ s(t + y)·(m + sy)⁻² dy, of which the integral is, with f what is missing of t to the next whole
//! number,
//!
//! ±(1/m − 2β(m/s + f)/s)/s, β(z) = Σ (−1)^k/(z + k);
//!
//! and, again and again, m⁻² Σ A_k+1(t)·(k + 1)!/2·(s/m)^k, with the waves of `euler`, where m is large.

use super::board::UNIT;
use super::edge::{HALF_FACTORIAL, MAX_TERMS};
use super::euler::waves;
use super::quadrature::integral;

/// From so many times s on m is large: then no more than 2e-15·m⁻² is neglected, ...
const LARGE: f64 = 20.0;
/// ... and from so many times on with so few terms.
const VERY_LARGE: f64 = 4000.0;
const FEW_TERMS: usize = 4;
/// β has an asymptotic series from here on, of which so many terms leave no more than 1e-16.
const ASYMPTOTIC: f64 = 16.0;
const TERMS: usize = 9;
/// What is integrated at once: t changes by a quarter, m and z by this part of what they are where it begins.
const QUARTER: f64 = 0.25;
const PART: f64 = 1.0 / 9.0;
/// By m⁻² six nodes are then off by less than this.
///
/// A function of [−1, 1] that is at most M on the ellipse with the half axes (ρ ± 1/ρ)/2 they have but for (64/15)·M·ρ⁻¹²/(1 − ρ⁻²) (Trefethen,
/// “Approximation Theory and Approximation Practice”, theorem 19.3). With a half axis of 8½, ρ¹² is 5.6e14; on that ellipse m and z are at least half of
/// what they are in the middle, and t is off by 1⅛ at most, so that |Λ| ≤ 3½, |A_k| ≤ ½π^(1−k)·e^(1⅛π) and |β(z)| ≤ 1/Re z ≤ 2|s|/m: M is
/// at most 100·m⁻².
pub(super) const QUADRATURE: f64 = 1e-12;
/// How far roundings may put off a value, by m⁻², but for those of t: mostly of β, whose terms are at most 4 + 1/z together.
pub(super) const ROUNDED: f64 = 1000.0 * UNIT;

/// A place, in the sense in which G counts.
#[derive(Clone, Copy)]
pub(super) struct Ahead {
    /// |s|.
    slope: f64,
    /// ±1 by what G changes its sign in that sense.
    sign: f64,
    /// f, from there to the next whole number.
    missing: f64,
    depth: f64,
}

impl Ahead {
    /// At a place in the square [0, 1), and m there.
    pub(super) fn of(slope: f64, [within, depth]: [f64; 2]) -> Self {
        // A square seen from its end has the opposite sign of that from −1 to 0.
        let (sign, missing) = match slope < 0.0 {
            true => (-1.0, within),
            false => (1.0, 1.0 - within),
        };
        Self {
            slope: slope.abs(),
            sign,
            missing,
            depth,
        }
    }

    /// By so much of the way to another.
    fn towards(self, steps: [f64; 2], part: f64) -> Self {
        Self {
            missing: self.missing + part * steps[0],
            depth: self.depth + part * steps[1],
            ..self
        }
    }

    /// z.
    fn argument(self) -> f64 {
        self.depth / self.slope + self.missing
    }

    /// The integral over the first half of the way from one place to another, which is 1 long.
    fn first_half([from, to]: [Self; 2]) -> f64 {
        let steps = [to.missing - from.missing, to.depth - from.depth];
        let further = steps[0] + steps[1] / from.slope;
        let (mut sum, mut done) = (0.0, 0.0);
        while done < 0.5 {
            let here = from.towards(steps, done);
            let step = (QUARTER / steps[0].abs())
                .min(PART * here.depth / steps[1].abs())
                .min(PART * here.argument() / further.abs());
            let next = 0.5_f64.min(done + step);
            sum += integral(done, next, |part| from.towards(steps, part).value());
            done = next;
        }
        sum
    }

    /// The mean of G_s between two places.
    pub(super) fn mean([from, to]: [Self; 2]) -> f64 {
        // Each half from its end: there m may be little of what it is at the other.
        Self::first_half([from, to]) + Self::first_half([to, from])
    }

    /// G_s.
    pub(super) fn value(self) -> f64 {
        let Self {
            slope,
            sign,
            missing,
            depth,
        } = self;
        let scale = sign / (depth * depth);
        if depth >= VERY_LARGE * slope {
            scale * series::<FEW_TERMS, { FEW_TERMS + 2 }>(missing, slope / depth)
        } else if depth >= LARGE * slope {
            scale * series::<MAX_TERMS, { MAX_TERMS + 2 }>(missing, slope / depth)
        } else {
            let per_slope = 1.0 / slope;
            let along = (1.0 / depth - 2.0 * per_slope * alternating(self.argument())) * per_slope;
            0.25 * scale * (2.0 * missing - 1.0) - 0.5 * sign * along
        }
    }
}

/// Σ A_k+1(t)·(k + 1)!/2·r^k, t being in the square [0, 1) where so much is missing to 1.
fn series<const COUNT: usize, const ROWS: usize>(missing: f64, ratio: f64) -> f64 {
    let waves = waves::<COUNT, ROWS>(1.0 - missing);
    (1..=COUNT).rev().fold(0.0, |sum, k| {
        (sum + HALF_FACTORIAL[k] * waves[k + 1]) * ratio
    })
}

/// β(z) = Σ (−1)^k/(z + k), z > 0: some terms, and of the others 1/2z + Σ (4^k − 1)·B_2k/2k·z^(−2k) (DLMF 5.11.2).
fn alternating(z: f64) -> f64 {
    const FACTORS: [f64; TERMS] = [
        1.0 / 4.0,
        -1.0 / 8.0,
        1.0 / 4.0,
        -17.0 / 16.0,
        31.0 / 4.0,
        -691.0 / 8.0,
        5461.0 / 4.0,
        -929_569.0 / 32.0,
        3_202_291.0 / 4.0,
    ];
    let (mut sum, mut sign, mut z) = (0.0, 1.0, z);
    while z < ASYMPTOTIC {
        sum += sign / z;
        sign = -sign;
        z += 1.0;
    }
    let u = 1.0 / z;
    let square = u * u;
    let rest = FACTORS
        .iter()
        .rev()
        .fold(0.0, |rest, factor| (rest + factor) * square);
    sum + sign * (0.5 * u + rest)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// ½s∫ Λ(t + y)·(m + sy)⁻³ dy over so many squares and half of the next one, from where so much is missing of one.
    fn square_by_square(missing: f64, ratio: f64, squares: u32) -> f64 {
        // By ratio, s/m, and m = 1: of −½(1 + sy)⁻² and of its antiderivative, for Λ is linear on squares.
        let antiderivative = |y: f64| -0.5 / ((1.0 + ratio * y) * (1.0 + ratio * y));
        let second = |y: f64| 0.5 / (ratio * (1.0 + ratio * y));
        let (mut sum, mut from, mut sign) = (0.0, 0.0, 1.0);
        for square in 0..=squares {
            let to = missing + f64::from(square);
            let wave = |y: f64| sign * (1.0 - 2.0 * (y - missing + 1.0 - f64::from(square)));
            let by_parts = wave(to) * antiderivative(to) - wave(from) * antiderivative(from)
                + 2.0 * sign * (second(to) - second(from));
            let weight = if square == squares { 0.5 } else { 1.0 };
            sum += weight * by_parts;
            (from, sign) = (to, -sign);
        }
        0.5 * sum
    }

    proptest! {
        #[test]
        fn a_value_is_the_integral(missing in 0.0..1.0_f64, ratio in -2.0..7.0_f64) {
            let ratio = libm::exp10(ratio);
            let ahead = Ahead { slope: ratio, sign: 1.0, missing, depth: 1.0 };
            // Of two squares of which m⁻³ changes by its third derivative half of each other is left.
            let expected = square_by_square(missing, ratio, 20_000);
            let off = (ahead.value() - expected).abs();
            prop_assert!(off < 1e-9, "{}, not {expected}", ahead.value());
        }
    }
}
