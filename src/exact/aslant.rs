//! Squares too small to be seen, however narrow the strip of floor is that a pixel shows: how much more a region may show of one colour of the
//! board than of the other.
//!
//! On a line of the picture that is parallel to the horizon L is the same everywhere, and so is the floor by the pixel; there a grows with the
//! line, by |∇N_a × ∇L|/|∇L|·L⁻¹ a pixel, and b by ρ times as much, where ρ is the same for all such lines. So what is shown is at most
//! L·|∇L|/|∇N_a × ∇L| times what the integral of s(a)·s(ρa + c) da over N squares may be, whatever c is, by the region's height. How deep the floor
//! is across those lines does not matter: in the widest of views that is next to nothing, and `small` then has nothing to add up.
//!
//! That integral over two squares is a function of c of the period 2, of the mean 0 and of the total variation 8 at most, which c goes on by 2ρ from.
//! Over q such pairs together it is at most 8 where |ρ − p/q| < 1/q², p/q in its lowest terms (the inequality of Denjoy and Koksma); and any
//! number of pairs is made of such q's of ρ's continued fraction, of each no more than the next partial quotient, and of as often as it has
//! room of the last (Ostrowski). If p or q is even, 2q squares of the slope p/q add up to nothing at all; a slope that is off by δ changes
//! that by 24q²δ, or, if p is 0, by 4 where b crosses a line.

use glam::DVec2;

use super::board::{Board, UNIT, form, measure};
use crate::math::{Double, Real};

/// Slopes are not told from fractions of greater denominators.
const GREATEST: f64 = 1e15;

impl Board {
    /// A bound on the integral over a convex polygon, in square pixels; infinite where nothing is known.
    pub(super) fn most_aslant(&self, polygon: &[DVec2]) -> f64 {
        let [of_a, of_b] = self.fine.floor.powers;
        let [a, b, l] = self.fine.forms.each_ref();
        let [rad_a, rad_b, rad_l] = self.fine.rads;
        // Whichever form it is that has been changed on purpose.
        let nudge = self.fine.nudge * UNIT;
        let rad_l = rad_l + nudge;
        let minor = |n: &[Double; 3], rad: f64, power: i32| {
            let n = n.each_ref().map(|c| c.scaled(-power));
            let rad = libm::ldexp(rad, -power) + nudge;
            let value = n[0].times(&l[1]).minus(&n[1].times(&l[0]));
            let [x, y] = [n[0].hi.abs(), n[1].hi.abs()];
            let [u, v] = [l[0].hi.abs(), l[1].hi.abs()];
            // A factor is off by twice as much as values are, and by a rounding.
            let off = 2.0 * rad * (u + v) + 2.0 * rad_l * (x + y + 2.0 * rad);
            (value, off + 8.0 * Double::UNIT * (x * v + y * u))
        };
        let minors = [minor(a, rad_a, of_a), minor(b, rad_b, of_b)];
        let size = |i: usize, power: i32| libm::ldexp(minors[i].0.hi.abs(), power - of_a);
        // Lines are counted by the axis along which there are more.
        let (more, fewer, power) = match size(0, of_a) >= size(1, of_b) {
            true => (&minors[0], &minors[1], of_b - of_a),
            false => (&minors[1], &minors[0], of_a - of_b),
        };
        let gradient = more.0.hi.abs() - more.1;
        let slope = fewer.0.over(&more.0).scaled(power);
        let slope = if slope.is_negative() {
            slope.negated()
        } else {
            slope
        };
        let off = libm::ldexp(fewer.1, power) / gradient
            + slope.hi * (more.1 / gradient + 8.0 * Double::UNIT);
        let steepness = libm::hypot(l[0].hi, l[1].hi);
        let up = DVec2::new(l[0].hi, l[1].hi) / steepness;
        let heights = polygon.iter().map(|at| at.dot(up));
        let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), y| {
            (low.min(y), high.max(y))
        });
        let levels = polygon.iter().map(|&at| form(&self.below, at));
        let level = levels.fold(0.0, f64::max) + rad_l + 16.0 * UNIT;
        let counted = if power == of_b - of_a { of_a } else { of_b };
        let square = libm::ldexp(level * steepness / gradient, -counted);
        let (area, _) = measure(polygon.iter().copied());
        // A dozen roundings, and those of the area.
        let slack = 1.0 + 2.0 * UNIT * (16 + polygon.len()) as f64;
        let most = most_of(&slope, off, (high - low) * square, area.abs() + 8.0 * UNIT) * slack;
        match most >= 0.0 && gradient > 0.0 {
            true => most,
            false => f64::INFINITY,
        }
    }
}

/// What integrals of s(a)·s(ρa + c) add up to at most, by `weight` for what there is of each however long it is, and by `length` squares in
/// all; 0 ≤ ρ ≤ 1, known but for `off`.
fn most_of(slope: &Double, off: f64, weight: f64, length: f64) -> f64 {
    let mut best = length;
    // Of the fractions p/q: two in turn, and what is left of ρ's continued fraction.
    let (mut before, mut fraction) = ([1.0, 0.0], [0.0, 1.0]);
    let mut quotients = 0.0;
    loop {
        let [p, q] = fraction;
        let [of_p, of_q] = fraction.map(Double::from_f64);
        // (ρq − p), of which the next quotient is what it takes to make good for the last one.
        let gap = |[p, q]: [f64; 2]| {
            let [p, q] = [p, q].map(Double::from_f64);
            slope.times(&q).minus(&p).hi.abs()
        };
        let is_known = slope.hi.is_finite() && off.is_finite();
        let apart = slope.times(&of_q).minus(&of_p).hi.abs() / q + off + 4.0 * Double::UNIT;
        if !(is_known && q <= GREATEST) {
            return best;
        }
        if apart * q * q < 1.0 {
            let mut rate = 4.0 / q;
            let is_even = p % 2.0 == 0.0 || q % 2.0 == 0.0;
            if is_even {
                rate = rate.min(12.0 * q * apart);
            }
            best = best.min(weight * (10.0 + 8.0 * quotients) + rate * length);
        } else {
            return best;
        }
        let quotient = (gap(before) / gap(fraction)).floor();
        let next = [0, 1].map(|i| before[i] + quotient * fraction[i]);
        if !(quotient >= 1.0 && next[1] <= GREATEST) {
            return best;
        }
        quotients += quotient;
        (before, fraction) = (fraction, next);
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::exact::{cells, euler::square_wave, polygon::PIXEL, tests::WANTED};

    /// ∫ s(a)·s(ρa + c) da from 0 on.
    fn integral(slope: f64, c: f64, length: f64) -> f64 {
        let (mut sum, mut at) = (0.0, 0.0);
        while at < length {
            let b = slope * at + c;
            let next = (at.floor() + 1.0).min(length);
            let crossing = at + (b.floor() + 1.0 - b) / slope;
            let end = if crossing > at && crossing < next {
                crossing
            } else {
                next
            };
            let middle = 0.5 * (at + end);
            sum += (end - at) * square_wave(middle) * square_wave(slope * middle + c);
            at = end;
        }
        sum
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(300))]

        #[test]
        fn no_more_is_left_of_a_line_than_that(
            slope in 0.0..1.0_f64,
            simple in prop::option::of((0..6_u32, 1..6_u32, -8.0..-2.0_f64)),
            c in 0.0..2.0_f64,
            length in 0.0..3000.0_f64,
        ) {
            let near = |(p, q, off): (u32, u32, f64)| f64::from(p.min(q)) / f64::from(q) - libm::exp10(off);
            let slope = simple.map_or(slope, near).abs();
            let most = most_of(&Double::from_f64(slope), 0.0, 1.0, length);
            let found = integral(slope, c, length);
            prop_assert!(found.abs() <= most + 1e-9, "{found}, not {most}");
        }
    }

    #[test]
    fn of_long_lines_hardly_anything_is_left() {
        let golden = Double::from_f64(0.618_033_988_749_894_9);
        assert!(most_of(&golden, 1e-30, 1.0, 1e12) < 1000.0);
        // Along an axis of the board; along its diagonal all of it may be.
        assert!(most_of(&Double::from_f64(0.0), 0.0, 1.0, 1e12) < 20.0);
        assert!(most_of(&Double::from_f64(1.0), 0.0, 1.0, 1e12) >= 1e12);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(60))]

        /// Of a strip of floor that is as narrow as in the widest of views.
        #[test]
        fn no_more_is_left_of_a_pixel_than_that(
            count in 500.0..4000.0_f64,
            slope in 0.0..1.0_f64,
            across in prop::array::uniform2(-2.0..2.0_f64),
            place in prop::array::uniform2(-2.0..2.0_f64),
            tilt in prop::array::uniform2(-0.4..0.4_f64),
        ) {
            let below = [tilt[0], tilt[1], 1.0];
            let form = |count: f64, across: f64, place: f64| {
                let lines = [count, across, place];
                // Lines of the picture that are parallel to the horizon have so many squares.
                let [x, y] = [tilt[1], -tilt[0]];
                [lines[0] * x + lines[1] * tilt[0], lines[0] * y + lines[1] * tilt[1], lines[2]]
            };
            let forms = [form(count, across[0], place[0]), form(slope * count, across[1], place[1])];
            let seen = Board::new(forms, below);
            let most = seen.most_aslant(&PIXEL);
            let sum = cells::sum(&seen, &seen.visible(&PIXEL), &WANTED);
            prop_assert!(sum.value.abs() <= most + sum.bound, "{sum:?}, not {most}");
        }
    }
}
