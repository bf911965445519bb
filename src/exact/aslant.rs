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
//! room of the last (Ostrowski).
//!
//! Over 2q squares of the slope p/q it is 0 if p or q is even, and else 2/p at most (`diagonal`). A slope that is off by δ, if b is left as
//! it is in the middle, changes s(b) where a whole number is between both b's: along qδ of q squares, on either side, as b there goes by p
//! units, and one in q²δ is as much of each; so it changes the integral by 4q²δ. If p is 0, it changes by 2 where b crosses a line, which it
//! does 2δ times in two squares, and once more. And any part of 2q squares has q at most, where all add up to 0.

use glam::DVec2;

use super::board::{Board, UNIT, form, measure};
use crate::math::{Double, Real};

/// Slopes are not told from fractions of greater denominators.
const GREATEST: f64 = 1e15;

/// What lines of the picture that are parallel to the horizon show of a board.
pub(super) struct Aslant {
    /// The axis of which there are more squares on them.
    pub more: usize,
    /// ±ρ, how far the other one goes by one of these squares, and by how much that may be off.
    pub slope: Double,
    off: f64,
    /// How long such a square is at most, in pixels, by the polygon's height across the lines.
    weight: f64,
    area: f64,
}

impl Board {
    /// A bound on the integral over a convex polygon, in square pixels; infinite where nothing is known.
    pub(super) fn most_aslant(&self, polygon: &[DVec2]) -> f64 {
        let lines = self.aslant(polygon);
        lines.map_or(f64::INFINITY, |lines| lines.most())
    }

    /// `None` where they are nowhere.
    pub(super) fn aslant(&self, polygon: &[DVec2]) -> Option<Aslant> {
        let [of_a, of_b] = self.fine.floor.powers;
        let [a, b, l] = self.fine.given.each_ref();
        let [rad_a, rad_b, rad_l] = self.fine.rads;
        let minor = |n: &[Double; 3], rad: f64, power: i32| {
            let n = n.each_ref().map(|c| c.scaled(-power));
            let rad = libm::ldexp(rad, -power);
            let value = n[0].times(&l[1]).minus(&n[1].times(&l[0]));
            let [x, y] = [n[0].hi.abs(), n[1].hi.abs()];
            let [u, v] = [l[0].hi.abs(), l[1].hi.abs()];
            // A factor is off by twice as much as values are, and by a rounding.
            let off = 2.0 * rad * (u + v) + 2.0 * rad_l * (x + y + 2.0 * rad);
            (value, off + 8.0 * Double::UNIT * (x * v + y * u))
        };
        let minors = [minor(a, rad_a, of_a), minor(b, rad_b, of_b)];
        let size = |i: usize, power: i32| libm::ldexp(minors[i].0.hi.abs(), power - of_a);
        let more = usize::from(size(0, of_a) < size(1, of_b));
        let powers = [of_a, of_b];
        let (many, few, power) = (
            &minors[more],
            &minors[1 - more],
            powers[1 - more] - powers[more],
        );
        let gradient = many.0.hi.abs() - many.1;
        let slope = few.0.over(&many.0).scaled(power);
        let off = libm::ldexp(few.1, power) / gradient
            + slope.hi.abs() * (many.1 / gradient + 8.0 * Double::UNIT);
        let steepness = libm::hypot(l[0].hi, l[1].hi);
        let up = DVec2::new(l[0].hi, l[1].hi) / steepness;
        let heights = polygon.iter().map(|at| at.dot(up));
        let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), y| {
            (low.min(y), high.max(y))
        });
        // The lines' direction may be off, by as much as |∇L| may relative to it; a polygon is √2 across at most.
        let tilt = 3.0 * rad_l / steepness + 4.0 * UNIT;
        let height = high - low + 1.5 * tilt;
        let levels = polygon.iter().map(|&at| form(&self.below, at));
        let level = levels.fold(0.0, f64::max) + rad_l + 16.0 * UNIT;
        let square = libm::ldexp(level * steepness / gradient, -powers[more]);
        // A dozen roundings, and those of the area.
        let slack = 1.0 + tilt + 2.0 * UNIT * (16 + polygon.len()) as f64;
        let weight = height * square * slack;
        let (area, _) = measure(polygon.iter().copied());
        (weight >= 0.0 && gradient > 0.0).then_some(Aslant {
            more,
            slope,
            off,
            weight,
            area: (area.abs() + 8.0 * UNIT) * slack,
        })
    }
}

impl Aslant {
    fn most(&self) -> f64 {
        most_of(&size_of(&self.slope), self.off, self.weight, self.area)
    }

    /// The fraction p/q of odd numbers along which most evens out, and what does not but for the triangle wave: as `diagonal` has it.
    pub(super) fn diagonal(&self) -> Option<([f64; 2], f64)> {
        let left = |convergent: Convergent| {
            let [_, q] = convergent.fraction;
            let apart = convergent.apart + self.off;
            let ends = (1.0 + 6.0 * q * apart) * self.weight;
            (convergent.fraction, q * (3.0 * apart * self.area + ends))
        };
        let fractions = Convergents::of(&size_of(&self.slope)).filter(Convergent::is_odd);
        fractions
            .map(left)
            .min_by(|(_, one), (_, other)| one.total_cmp(other))
    }
}

fn size_of(x: &Double) -> Double {
    match x.is_negative() {
        true => x.negated(),
        false => *x,
    }
}

/// What integrals of s(a)·s(ρa + c) add up to at most, by `weight` for what there is of each however long it is, and by `length` squares in
/// all; 0 ≤ ρ ≤ 1, known but for `off`.
fn most_of(slope: &Double, off: f64, weight: f64, length: f64) -> f64 {
    let mut best = length;
    // Of what is too little for a last block, and a pair of squares that is cut.
    let mut rest = 2.0_f64;
    for convergent in Convergents::of(slope) {
        let [p, q] = convergent.fraction;
        let apart = convergent.apart + off;
        let is_near = apart * q * q < 1.0;
        if !is_near {
            break;
        }
        let mean = if convergent.is_odd() { 2.0 / p } else { 0.0 };
        let block = (4.0 * q * q * apart + mean).min(8.0);
        let once = if p == 0.0 { 2.0 } else { 0.0 };
        let ends = match convergent.is_odd() {
            true => rest,
            false => rest.min(q + 4.0 * q * q * apart),
        };
        best = best.min(weight * (ends + once) + block / (2.0 * q) * length);
        rest += once + convergent.quotient * block;
    }
    best
}

/// The continued fraction of ρ: its fractions from 0/1 on.
struct Convergents {
    slope: Double,
    before: [f64; 2],
    fraction: [f64; 2],
}

struct Convergent {
    /// p and q.
    fraction: [f64; 2],
    /// |ρ − p/q| at most.
    apart: f64,
    /// The next partial quotient.
    quotient: f64,
}

impl Convergent {
    /// Whether p and q are.
    fn is_odd(&self) -> bool {
        self.fraction.iter().all(|x| x % 2.0 != 0.0)
    }
}

impl Convergents {
    fn of(slope: &Double) -> Self {
        Self {
            slope: *slope,
            before: [1.0, 0.0],
            fraction: [0.0, 1.0],
        }
    }

    /// |ρq − p|.
    fn gap(&self, [p, q]: [f64; 2]) -> f64 {
        let [p, q] = [p, q].map(Double::from_f64);
        self.slope.times(&q).minus(&p).hi.abs()
    }
}

impl Iterator for Convergents {
    type Item = Convergent;

    fn next(&mut self) -> Option<Convergent> {
        let fraction = self.fraction;
        // Neither is a number where the slope is not.
        let is_known = self.slope.hi.is_finite() && fraction[1] <= GREATEST;
        if !is_known {
            return None;
        }
        // How often the gap makes good for the one before; without end if there is none.
        let quotient = (self.gap(self.before) / self.gap(fraction)).floor();
        self.fraction = match quotient >= 1.0 {
            true => [0, 1].map(|i| self.before[i] + quotient * fraction[i]),
            false => [f64::NAN; 2],
        };
        self.before = fraction;
        Some(Convergent {
            fraction,
            apart: self.gap(fraction) / fraction[1] + 4.0 * Double::UNIT,
            quotient,
        })
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
