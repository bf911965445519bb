//! Squares too small to be seen: how much more a region may show of one colour of the board than of the other.
//!
//! Along a line on which b is constant, the sign's integral over a is never more than 1 from anywhere to anywhere. J = K/m³ is monotone
//! there; so, by the second mean value theorem, the integral of s(a)·s(b)·J is at most the sum of J at the line's two ends on the region's
//! boundary, and that over the region at most ∮ J |db|. On an edge from P to Q, b = N_b/L and J = K·L³ make
//! J |db| = K |N_b(Q) L(P) − N_b(P) L(Q)| L dτ, 0 ≤ τ ≤ 1, whose integral is that of a linear function; the horizon adds nothing. The same
//! holds with a and b exchanged.
//!
//! No line is looked at, however many there are, nor where it is; the smaller squares are, the less is left.

use std::array;

use glam::DVec2;

use super::board::{Board, UNIT, size};
use crate::math::{Double, Real};

impl Board {
    /// A bound on the integral over a polygon, in square pixels; infinite where nothing is known.
    pub(super) fn most(&self, polygon: &[DVec2]) -> f64 {
        let Some(&last) = polygon.last() else {
            return 0.0;
        };
        // For squares as large as a power of two, about as large as pixels: a K for smaller ones may be too small a number.
        let [of_a, of_b] = self.fine.floor.powers;
        let powers = [of_a, of_b, 0];
        let forms: [[Double; 3]; 3] =
            array::from_fn(|i| self.fine.forms[i].map(|c| c.scaled(-powers[i])));
        // What each form's values may be off by, roundings included.
        let [off_a, off_b, off_l] = [0, 1, 2].map(|i| {
            let form = forms[i].map(|factor| factor.hi);
            libm::ldexp(self.fine.rads[i], -powers[i]) + 8.0 * Double::UNIT * size(&form)
        });
        let values = |at: DVec2| {
            let [x, y] = [at.x, at.y].map(Double::from_f64);
            forms
                .each_ref()
                .map(|[a, b, c]| a.times(&x).plus(&b.times(&y)).plus(c))
        };
        let mut sums = [0.0; 2];
        let mut before = values(last);
        for &at in polygon {
            let after = values(at);
            let [start, end] = [&before[2], &after[2]];
            let level = 0.5 * (start.hi.max(0.0) + end.hi.max(0.0)) + off_l;
            for (axis, off) in [off_a, off_b].into_iter().enumerate() {
                let [from, to] = [&before[axis], &after[axis]];
                let minor = to.times(start).minus(&from.times(end)).hi.abs();
                let terms = from.hi.abs() + to.hi.abs();
                let levels = start.hi.abs() + end.hi.abs() + 2.0 * off_l;
                let minor_off = off * levels + (off_l + 8.0 * Double::UNIT * levels) * terms;
                sums[axis] += level * (minor + minor_off);
            }
            before = after;
        }
        // Each by the other axis' power, with a dozen roundings and those of the sums.
        let slack = 1.0 + 2.0 * UNIT * (16 + polygon.len()) as f64;
        let [by_a, by_b] = sums;
        let least = libm::ldexp(by_a, -of_b).min(libm::ldexp(by_b, -of_a));
        let most = least * self.fine.most_scaled_density() * slack + f64::MIN_POSITIVE;
        match most.is_nan() {
            true => f64::INFINITY,
            false => most,
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::exact::{cells, polygon::PIXEL, tests::WANTED};

    /// Of squares 2^scale times as small as they might be.
    fn board([a, b]: [[f64; 2]; 2], place: [f64; 2], tilt: [f64; 2], scale: i32) -> Board {
        let below = [tilt[0], tilt[1], 1.0];
        let across = [(a, place[0]), (b, place[1])].map(|([x, y], at)| {
            [x + at * below[0], y + at * below[1], at].map(|c| libm::ldexp(c, scale))
        });
        Board::new(across, below)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(500))]

        #[test]
        fn no_more_is_left_than_that(
            a in prop::array::uniform2(-9.0..9.0_f64),
            b in prop::array::uniform2(-9.0..9.0_f64),
            place in prop::array::uniform2(-2.0..2.0_f64),
            tilt in prop::array::uniform2(-0.99..0.99_f64),
            cut in 0.1..1.0_f64,
        ) {
            let [p, q, r, s] = PIXEL;
            for polygon in [&[p, q, q.lerp(r, cut), s.lerp(r, cut)][..], &[p, s.lerp(p, cut), q]] {
                let mut before = f64::INFINITY;
                for scale in 0..3 {
                    let seen = board([a, b], place, tilt, scale);
                    let most = seen.most(polygon);
                    let sum = cells::sum(&seen, &seen.visible(polygon), &WANTED);
                    prop_assert!(sum.value.abs() <= most + sum.bound, "{sum:?}, not {most}");
                    // All of it is as small as squares are.
                    prop_assert!(most <= 0.5001 * before, "{most}, not half of {before}");
                    before = most;
                }
            }
        }
    }

    /// In a square of the board nothing cancels, and half of the bound is met.
    #[test]
    fn half_of_it_is_met() {
        let seen = board([[1.0, 0.0], [0.0, 1.0]], [0.5, 0.5], [0.0; 2], 0);
        let most = seen.most(&PIXEL);
        assert!((2.0..2.0 + 1e-12).contains(&most), "{most}");
        let seen = board([[1e-9, 0.0], [0.0, 1.0]], [0.5, 0.5], [0.0; 2], 0);
        assert!((2.0..2.0 + 1e-12).contains(&seen.most(&PIXEL)));
    }

    /// However steep the board, beyond its horizon there is nothing of it.
    #[test]
    fn the_horizon_bounds_it() {
        let seen = board([[1.0, 0.0], [0.0, 1e-3]], [0.5, 0.5], [0.0, -4.0], 20);
        let [p, q, r, s] = PIXEL;
        let whole = seen.most(&PIXEL);
        let visible = seen.most(&[p, q, q.lerp(r, 0.75), p.lerp(s, 0.75)]);
        assert!(
            visible > 0.0 && (whole / visible - 1.0).abs() < 0.34,
            "{whole}, {visible}"
        );
    }
}
