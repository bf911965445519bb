//! Sums over the very many lines that a side of a region crosses, where they are hardly displaced against the squares from line to line: along
//! the diagonals of a board, where too many modes are in step to be computed (`modes`).
//!
//! The modes of a crossing at t, m add up to G_p − G_c, where G is that of `ahead`. As G(t + 1) is −G(t), Σ (−1)^j·G(t_j) is Σ G(t + εx) at the whole x, where ε is τ + 1 less turns. If εN is small, G is smooth but for few
//! kinks, where t + εx is a whole number; there its second derivative jumps, by 2sε²m⁻³. So the sum, its ends by half, is by Euler and Maclaurin
//! ∫ G dx + [G′]/12, up to ⅙∫ B₃·G‴, |B₃| < 0.0482; and the integral is that between kinks by Gauss's six nodes at a time.
//! With w = y + εx, G is ½s∫ Λ(t + w)·(m + (g − sε)x + sw)⁻³ dw from εx on, from which follows |G‴| ≤ 9ω²ε·m⁻⁴ + 24ω³·m⁻⁵,
//! ω = g + |s|ε, Λ being a triangle wave.
//!
//! Where it is not so from line to line, it may be so of every second one, or third, or some more.

use super::ahead::{Ahead, QUADRATURE, ROUNDED};
use super::board::{Sum, UNIT};
use super::complex::turned_times;
use super::euler::square_wave;
use super::modes::{ABEL, FLAT, Lines};
use crate::math::{Double, Real};
use std::f64::consts::PI;

/// So many kinks are looked at, and twice as many until what is left of the others is little; ...
const FEWEST: f64 = 64.0;
/// ... but no more than this in all classes: they would take longer than modes do at worst, ...
pub(super) const MOST: f64 = (1 << 14) as f64;
/// ... or than most modes do.
pub(super) const FEW: f64 = 256.0;
/// Nor are they more than this by the line.
const RARE: f64 = 1.0 / 16.0;
/// Every so many lines at most are looked at for themselves.
const CLASSES: u32 = 15;
/// m may grow by so much of it from line to line.
const GRADUAL: f64 = 1.0 / 16.0;
/// |B₃|/6 at most, B₃ made periodic.
const THIRD: f64 = 0.008_03;

/// Σ over the sides, each with its sign, of what `Lines::sum` is of one, of which `tolerance` may be neglected; `None` where there are more
/// kinks than `most`.
pub(super) fn sum(sides: &[(f64, &Lines)], tolerance: f64, most: f64) -> Option<Sum> {
    let mut sum = Sum::default();
    for (sign, side) in sides {
        let part = of_side(side, tolerance / sides.len() as f64, most)?;
        sum.value += sign * part.value;
        sum.bound += part.bound;
    }
    Some(sum)
}

/// Σ of one, by classes of every so many lines.
fn of_side(side: &Lines, tolerance: f64, most: f64) -> Option<Sum> {
    let counts = (1..=CLASSES).map(f64::from);
    let classes = |count: f64| {
        let growth = count * side.rise;
        let is_gradual = 0.0 <= growth && growth <= GRADUAL * side.depth;
        let is_finite = (side.depth + side.rise * side.lines).is_finite();
        let is_some = is_gradual && is_finite && count <= side.lines;
        let share = [tolerance, most].map(|all| all / count);
        let class = |first| Class::new(side, [f64::from(first), count], share);
        let classes = is_some.then(|| (0..count as u32).map(class));
        classes?.collect::<Option<Vec<_>>>()
    };
    let mut sum = Sum::default();
    for class in counts.into_iter().find_map(classes)? {
        let part = class.sum();
        sum.value += part.value;
        sum.bound += part.bound;
    }
    Some(sum)
}

/// Every so many of a side's lines.
struct Class {
    kinks: Kinks,
    /// Whether the first and the last of them have others of the side before and behind them.
    is_within: [bool; 2],
    /// How many there are; `kinks` may leave out those behind, ...
    lines: f64,
    /// ... of which no more than this is left.
    left: f64,
}

impl Class {
    /// From the line `first` on; `None` if there are too many kinks for so little to be neglected.
    fn new(side: &Lines, [first, count]: [f64; 2], [tolerance, most]: [f64; 2]) -> Option<Self> {
        let mut kinks = Kinks::new(side, [first, count]);
        let lines = kinks.lines;
        if kinks.turning > RARE {
            return None;
        }
        let is_within = [first > 0.0, first + count * lines < side.lines];
        let mut left = 0.0;
        let mut some = FEWEST.min(most);
        while kinks.turning * lines > some {
            if some > most {
                return None;
            }
            let these = (some / kinks.turning).floor();
            left = kinks.behind(these);
            if left <= tolerance {
                kinks.lines = these;
                break;
            }
            left = 0.0;
            some *= 2.0;
        }
        Some(Self {
            kinks,
            is_within,
            lines,
            left,
        })
    }

    fn sum(&self) -> Sum {
        let mut sum = self.kinks.sum();
        // What stands at an end is counted by half there, but only the first and the last line of all are.
        let [before, behind] = self.is_within;
        if before {
            sum.value += 0.5 * self.kinks.at(0.0);
        }
        if behind && self.kinks.lines == self.lines {
            sum.value += 0.5 * self.kinks.at(self.lines);
        }
        sum.bound += self.left;
        sum
    }
}

/// The lines, in the sense in which ε is not negative.
struct Kinks {
    t: f64,
    /// ε.
    turning: f64,
    depth: f64,
    rise: f64,
    lines: f64,
    /// p and c.
    slopes: [f64; 2],
}

impl Kinks {
    /// Of a side every so many lines, from one on: ε is as many times that of the side, less turns.
    fn new(side: &Lines, [first, count]: [f64; 2]) -> Self {
        let turning = turned_times(count, &side.turning);
        // Mirrored, t and its slopes change their signs.
        let sense = if turning < 0.0 { -1.0 } else { 1.0 };
        Self {
            t: sense * (side.t + turned_times(first, &side.turning)),
            turning: sense * turning,
            depth: side.depth + first * side.rise,
            rise: count * side.rise,
            lines: ((side.lines - first) / count).floor(),
            slopes: [side.slope, side.rise / side.stride].map(|slope| sense * slope),
        }
    }

    /// Σ (−1)^j·(G_p − G_c), the first and the last by half.
    fn sum(&self) -> Sum {
        let mut sum = Double::from_f64(0.0);
        let mut square = self.t.floor();
        let (mut done, mut from) = (0.0, self.place(0.0, square));
        while done < self.lines {
            let kink = (square + 1.0 - self.t) / self.turning;
            let (next, to) = if kink < self.lines {
                (kink, [1.0, self.depth + self.rise * kink])
            } else {
                (self.lines, self.place(self.lines, square))
            };
            let part = square_wave(square) * (next - done) * self.mean([from, to]);
            sum = sum.plus(&Double::from_f64(part));
            (done, from) = (next, [0.0, to[1]]);
            square += 1.0;
        }
        // G′ at both ends.
        let difference = |x: f64| self.at(x + 1.0) - self.at(x - 1.0);
        let ends = (difference(self.lines) - difference(0.0)) / 24.0;
        Sum {
            value: sum.hi + ends,
            bound: self.bound(),
        }
    }

    /// What is left at most of all lines behind so many, the first by half.
    ///
    /// Of the modes up to 1/ε, which have θ = nπε, by Abel (`modes`), Σ n⁻³ over the odd n being at most 1.052; of those behind all of Σ m⁻²; and half of the
    /// last line, which neither has.
    fn behind(&self, lines: f64) -> f64 {
        let depth = self.depth + self.rise * lines;
        let count = 1.0 + (self.lines - lines).min(depth / self.rise);
        let scale = 1.0 / (depth * depth);
        let weight = 4.0 / (PI * PI);
        let modes = weight * 1.052 * ABEL / (PI * self.turning);
        (modes + 1.5 * FLAT * self.turning * count + 0.25) * scale
    }

    /// What it is off by.
    fn bound(&self) -> f64 {
        let &Self {
            turning,
            depth,
            rise,
            lines,
            slopes,
            ..
        } = self;
        let last = depth + rise * lines;
        // ∫ m⁻² dx and ∫ x·m⁻² dx.
        let squares = lines / (depth * last);
        let moments =
            (0.5 * lines * lines / (depth * depth)).min(libm::log(last / depth) / (rise * rise));
        // |∂G/∂t| is at most ½m⁻².
        let displaced = 8.0 * UNIT * (squares + turning * moments);
        let formula: f64 = slopes.iter().map(|&slope| self.left_out(slope)).sum();
        // And values at the ends.
        let values = squares + 2.0 / (depth * depth);
        formula + 2.0 * (QUADRATURE + ROUNDED) * values + displaced
    }

    /// What the formula of Euler and Maclaurin leaves out of G_s.
    ///
    /// G′ is taken as a difference, which is off by ⅙G‴ and half a jump of G″; a twelfth of that is wanted, of either end. |G‴| is what the header
    /// says; or, as |β‴| is at most 6z⁻⁴, that of ¼m⁻²·Λ, that of 1/2sm, and 6ω³/s·(m + sf)⁻⁴, which is integrated between two kinks.
    ///
    /// Where |s|ε is not small by m, next to kinks G changes as fast as all that, but by little: then ¼m⁻²·Λ is counted for itself, of which the first
    /// derivative jumps by εm⁻² there, and what is left of G, at most 1/2sm, by half of its variation.
    fn left_out(&self, slope: f64) -> f64 {
        let &Self {
            turning,
            depth,
            rise,
            lines,
            ..
        } = self;
        let slope = slope.abs();
        let swing = slope * turning;
        let fastest = rise + swing;
        let square = 1.0 / (depth * depth);
        let scale = square / depth;
        // ∫ m⁻³ dx is that of so many lines as the first, and those of further powers of fewer; twice as many for m⁻².
        let count = lines.min(0.5 * depth / rise);
        let kinks = 1.0 + turning * count;
        let growth = libm::log1p(rise * lines / depth);
        let all_kinks = 1.0 + turning * lines.min(depth / rise * growth);
        let most = (9.0 * turning + 24.0 * fastest / depth) * fastest * fastest / depth * scale;
        let smooth =
            scale * (9.0 * turning + 6.0 * rise / depth + 3.0 * rise / slope) * rise * rise / depth;
        let cube = scale * fastest * fastest * fastest / slope;
        let third = (most * count).min(smooth * count + 2.0 * cube / swing * kinks);
        let jump = 2.0 * turning * swing * scale;
        let at_once = THIRD * (third + jump * kinks)
            + 0.05 * most.min(smooth + 6.0 * cube / depth)
            + 0.1 * jump;
        let corner = turning * square;
        let in_parts = THIRD * smooth * count
            + 0.05 * smooth
            + (0.1 + 0.2 * kinks) * corner
            + 0.5 * (all_kinks + 3.0) / (slope * depth);
        at_once.min(in_parts)
    }

    /// Where it is behind so many lines, from the beginning of a square, and m.
    fn place(&self, x: f64, square: f64) -> [f64; 2] {
        [
            (self.t - square + self.turning * x).clamp(0.0, 1.0),
            self.depth + self.rise * x,
        ]
    }

    /// G_p − G_c behind so many lines.
    fn at(&self, x: f64) -> f64 {
        let square = (self.t + self.turning * x).floor();
        let place = self.place(x, square);
        let [of_p, of_c] = self.slopes.map(|slope| Ahead::of(slope, place).value());
        square_wave(square) * (of_p - of_c)
    }

    /// The mean of G_p − G_c between two places in a square.
    fn mean(&self, ends: [[f64; 2]; 2]) -> f64 {
        let [of_p, of_c] = self
            .slopes
            .map(|slope| Ahead::mean(ends.map(|place| Ahead::of(slope, place))));
        of_p - of_c
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(300))]

        #[test]
        fn a_sum_is_that_of_lines_one_by_one(
            t in 0.0..2.0_f64,
            kinks in -3.0..3.0_f64,
            lines in 2.0..5.0_f64,
            slope in -3.0..8.0_f64,
            swing in -4.0..3.0_f64,
            signs in prop::array::uniform3(prop::bool::ANY),
            denominator in prop::sample::select(vec![1.0, 1.0, 2.0, 3.0, 5.0, 7.0]),
            climb in 0.0..1.0_f64,
            tolerance in prop::sample::select(vec![0.0, 1e-6, 1e-3]),
        ) {
            let sign = |i: usize| if signs[i] { -1.0 } else { 1.0 };
            let lines = libm::exp10(lines).floor();
            let turning = sign(0) * (libm::exp10(kinks) / lines).min(0.4 * RARE / denominator);
            let slope = sign(1) * libm::exp10(slope);
            // m is as much more than what p·t grows by from line to line, and than g.
            let depth = (slope * turning).abs() / libm::exp10(swing);
            let rise = climb * libm::exp10(swing).min(0.5 * GRADUAL / denominator) * depth;
            let stride = Double::from_f64(sign(2)).over(&Double::from_f64(denominator));
            let side = Lines::new(
                &[t, depth].map(Double::from_f64),
                &[stride.plus(&Double::from_f64(turning)), Double::from_f64(rise)],
                &Double::from_f64(lines),
                slope,
            );
            let all = (lines + 1000.0) / (depth * (depth + rise * lines));
            let found = of_side(&side, tolerance * all, MOST).expect("few kinks");
            let every = Kinks::new(&side, [0.0, 1.0]);
            let mut expected = Double::from_f64(0.0);
            for j in 0..=lines as u32 {
                let x = f64::from(j);
                let half = if x == 0.0 || x == lines { 0.5 } else { 1.0 };
                expected = expected.plus(&Double::from_f64(half * every.at(x)));
            }
            let off = (found.value - expected.hi).abs();
            prop_assert!(off <= found.bound, "{found:?}, not {}", expected.hi);
            // What it tells is good to the square of how fast G changes in a class, but for its ends.
            let good = all * (tolerance + libm::exp10(2.0 * swing) * denominator * denominator);
            prop_assert!(swing > -1.0 || found.bound <= good, "{}, not {good}", found.bound);
        }
    }
}
