//! Squares too small to be seen that do not even out, since they are seen along a diagonal: what is left of them in the mean.
//!
//! On a line of the picture that is parallel to the horizon, b goes on by ±ρ where a goes on by 1 (`aslant`). Of the waves e^(iπ(ma + nb)),
//! m and n odd, of s(a)·s(b) those with mq = ∓np stand still if ρ is p/q, both odd; they are ±Λ(φ)/pq, where φ is qb ∓ pa and Λ the triangle
//! wave of the period 2 that is 1 − 2|φ| between −1 and 1. The others add up to nothing over 2q squares of the slope p/q: they are 1 − Λ/pq
//! on as much of these as makes good for −1 − Λ/pq on the rest, so that any part of them has q at most. A slope that is off by δ changes the
//! integral over such a block about its middle by 4q²δ, and that of Λ(φ)/pq by 2q²δ. So a line of N squares shows ±Λ(φ)/pq but for
//! 3qδ(N + 2q) + q.
//!
//! With t along the horizon in the picture, φ is f + (αt + β)/L. The mean of Λ between two points of a line has a closed form, as whole units
//! of φ add up to nothing; with M that from a line t = t₀ on, the integral over a polygon is ∮ (t − t₀)·M dz, z across the horizon. On an edge
//! (t − t₀)·M is made of 1, L and 1/L between the places where φ is a whole number, on the edge or at t₀; there it is integrated with
//! six nodes. Over what is next to the horizon Λ turns without end: on a line along which φ is monotone its integral is at most ½ by the
//! greatest of what φ takes for a unit, by the second mean value theorem, and that is L/|α| along the horizon, L²/|αt + β|·|∇L| across it.

use std::array;

use glam::DVec2;

use super::aslant::Aslant;
use super::board::{Board, Sum, UNIT, measure};
use super::complex::turn_exactly;
use super::quadrature::integral;
use crate::math::{Double, Real, floor};

/// Next to the horizon so little may be neglected, ...
const NEGLECTED: f64 = 1e-11;
/// ... unless that takes more turns than this, ...
const MOST_TURNS: f64 = (1 << 20) as f64;
/// ... and in any case what is as near to it as that, in pixels.
const NEXT_TO_IT: f64 = 1e-13;
/// An edge that climbs no more than this shows nothing.
const LEVEL: f64 = 1e-15;
/// L changes by no more than this from end to end of what is integrated at once.
const GROWTH: f64 = 9.0 / 8.0;
/// What six nodes are off by, of the greatest value and the length: a function c/L on 1 + κx, κ ≤ 1/17, has there the error
/// c·7.4e-4·κ¹²/(1 − κ)¹³, and c, which is the parabola of L times the integrand at L = 0, is at most T₂(1/κ) < 2/κ² times the greatest value
/// of that (Chebyshev).
const QUADRATURE: f64 = 1e-14;

impl Board {
    /// The integral over a polygon, positive where squares are however it is oriented; `None` if nothing is left in the mean, or its phase
    /// changes by more than so much by 1/L.
    pub(super) fn along_diagonal(&self, polygon: &[DVec2], most: f64) -> Option<Sum> {
        let lines = self.aslant(polygon)?;
        let ([p, q], rest) = lines.diagonal()?;
        let area = measure(polygon.iter().copied()).0;
        // It may be no number.
        let is_worth_it = rest < area.abs();
        if !is_worth_it {
            return None;
        }
        let mean = Phase::new(self, &lines, [p, q]).over(polygon, most)?;
        let sign = area.signum() * if lines.slope.is_negative() { -1.0 } else { 1.0 };
        Some(Sum {
            value: sign * mean.value / (p * q),
            bound: mean.bound / (p * q) + rest,
        })
    }
}

/// φ, and where it is.
struct Phase {
    /// L and its gradient's length.
    below: [Double; 3],
    steepness: f64,
    /// The direction of t.
    along: DVec2,
    /// f, α and β.
    base: f64,
    slope: f64,
    origin: f64,
    /// How far φ·L may be off, and by how much more for every 1 of |φ|; φ is at most `greatest` more than (αt + β)/L.
    off: f64,
    off_level: f64,
    greatest: f64,
}

/// φ = base + numerator/L on a line of the picture.
#[derive(Clone, Copy)]
struct Hyperbola {
    base: f64,
    numerator: f64,
}

/// An end of an edge: t, L and αt + β.
#[derive(Clone, Copy)]
struct End {
    t: f64,
    level: f64,
    turning: f64,
}

impl Phase {
    fn new(board: &Board, lines: &Aslant, [p, q]: [f64; 2]) -> Self {
        let fine = &board.fine;
        let p = if lines.slope.is_negative() { -p } else { p };
        let (of_many, of_few) = (&fine.given[lines.more], &fine.given[1 - lines.more]);
        let below = fine.given[2];
        let [by_p, by_q] = [p, q].map(Double::from_f64);
        let [x, y, one]: [Double; 3] =
            array::from_fn(|k| of_few[k].times(&by_q).minus(&of_many[k].times(&by_p)));
        let [u, v, w] = &below;
        let square = u.times(u).plus(&v.times(v));
        let steepness = square.hi.sqrt();
        let base = x.times(u).plus(&y.times(v)).over(&square);
        let slope = x.times(v).minus(&y.times(u));
        let origin = one.minus(&base.times(w));
        let terms = |form: &[Double; 3]| form.iter().map(|c| c.hi.abs()).sum::<f64>();
        let size = q * terms(of_few) + p.abs() * terms(of_many);
        let [off_many, off_few] = [lines.more, 1 - lines.more].map(|axis| fine.rads[axis]);
        // f is at most the forms' size by |∇L|, and made of it by eight roundings; L is 4 at most, and β and αt take as many.
        let rounding = 80.0 * Double::UNIT * size * (1.0 + 1.0 / steepness);
        Self {
            steepness,
            along: DVec2::new(v.hi, -u.hi) / steepness,
            base: turn_exactly(&base).to_f64(),
            slope: slope.hi / steepness,
            origin: origin.hi,
            off: q * off_few + p.abs() * off_many + rounding,
            off_level: fine.rads[2] + 32.0 * Double::UNIT,
            greatest: size / steepness,
            below,
        }
    }

    /// ∬ Λ(φ) over a polygon in its sense, as far as it is not beyond the horizon.
    fn over(&self, polygon: &[DVec2], most: f64) -> Option<Sum> {
        let ends: Vec<End> = polygon.iter().map(|&at| self.end(at)).collect();
        let range = |of: fn(&End) -> f64| {
            let values = ends.iter().map(of);
            values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
                (low.min(value), high.max(value))
            })
        };
        let (left, right) = range(|end| end.t);
        let (lowest, _) = range(|end| end.level);
        let (low, high) = range(|end| end.turning);
        let turning = low.abs().max(high.abs());
        let width = right - left;
        let turns = (0.5 * turning * width / (NEGLECTED * self.steepness))
            .sqrt()
            .clamp(1.0, MOST_TURNS);
        let cut = (turning / turns).max(NEXT_TO_IT * self.steepness);
        let is_known = turning <= most
            && self.off.is_finite()
            && self.off_level < 1e-3 * cut
            && cut.is_finite();
        if !is_known {
            return None;
        }
        let mut sum = Sum::default();
        if lowest < cut {
            let slowest = if low * high > 0.0 {
                low.abs().min(high.abs())
            } else {
                0.0
            };
            let height = cut / self.steepness;
            let across = 0.5 * cut * height / slowest;
            let along = 0.25 * cut * height / self.slope.abs();
            sum.bound += (width * height.min(across)).min(along);
        }
        let reference = Reference {
            t: 0.5 * (left + right),
            phase: Hyperbola {
                base: self.base,
                numerator: self.slope * 0.5 * (left + right) + self.origin,
            },
            turning,
            cut,
        };
        let mut cuts = Vec::new();
        for (i, from) in ends.iter().enumerate() {
            let to = &ends[(i + 1) % ends.len()];
            sum.add(self.edge([from, to], &reference, &mut cuts));
        }
        Some(sum)
    }

    fn end(&self, at: DVec2) -> End {
        let [x, y] = [at.x, at.y].map(Double::from_f64);
        let [u, v, w] = &self.below;
        let t = at.dot(self.along);
        End {
            t,
            level: u.times(&x).plus(&v.times(&y)).plus(w).hi,
            turning: self.slope * t + self.origin,
        }
    }

    /// ∫ (t − t₀)·M dz on an edge.
    fn edge(&self, [from, to]: [&End; 2], reference: &Reference, cuts: &mut Vec<f64>) -> Sum {
        let (low, high, sense) = match from.level <= to.level {
            true => (from, to, 1.0),
            false => (to, from, -1.0),
        };
        let first = low.level.max(reference.cut);
        let mut sum = Sum::default();
        let height = (high.level - first) / self.steepness;
        let reach = (low.t - reference.t)
            .abs()
            .max((high.t - reference.t).abs());
        if height <= LEVEL {
            sum.bound = reach * height.max(0.0);
            return sum;
        }
        let climb = 1.0 / (high.level - low.level);
        let rate = (high.turning - low.turning) * climb;
        let edge = Hyperbola {
            base: self.base + rate,
            numerator: low.turning - rate * low.level,
        };
        cuts.clear();
        for phase in [&edge, &reference.phase] {
            phase.whole(first, high.level, cuts);
        }
        cuts.push(high.level);
        cuts.sort_by(f64::total_cmp);
        let across = |level: f64| {
            let t = low.t + (high.t - low.t) * ((level - low.level) * climb);
            t - reference.t
        };
        // Of φ in `f64`, by 1 and by 1/L.
        let rounded = [
            8.0 * UNIT * (1.0 + rate.abs()),
            8.0 * UNIT
                * (edge.numerator.abs()
                    + (rate * low.level).abs()
                    + reference.turning
                    + self.slope.abs()
                    + self.origin.abs()),
        ];
        let mut before = first;
        for &cut in cuts.iter() {
            while before < cut {
                let next = cut.min(before * GROWTH);
                let at =
                    |level: f64| across(level) * mean(reference.phase.at(level), edge.at(level));
                sum.value += integral(before, next, at);
                // Λ changes twice as much as φ. A node may be on the wrong side of a whole number, by as much at most, and both then go on as
                // they came, which doubles it; at either of two points.
                let of_phase = self.greatest + reference.turning / before;
                let off = rounded[0]
                    + rounded[1] / before
                    + 1.01 * (self.off + of_phase * self.off_level) / before;
                sum.bound += (next - before) * reach * (8.0 * off + QUADRATURE).min(2.0);
                before = next;
            }
        }
        sum.value *= sense / self.steepness;
        // z and t are rounded, and so is each sum of what is less than 1 pixel.
        sum.bound = (sum.bound + 16.0 * UNIT * high.level) / self.steepness
            + UNIT * (cuts.len() as f64 + 256.0) * reach;
        sum
    }
}

/// The line t = t₀; what is the same for all edges.
struct Reference {
    t: f64,
    phase: Hyperbola,
    /// |αt + β| at most.
    turning: f64,
    /// The least L that is not neglected.
    cut: f64,
}

impl Hyperbola {
    fn at(&self, level: f64) -> f64 {
        self.base + self.numerator / level
    }

    /// Where it is a whole number.
    fn whole(&self, first: f64, last: f64, out: &mut Vec<f64>) {
        let [from, to] = [first, last].map(|level| self.at(level));
        let (mut n, last_n) = (from.min(to).ceil(), from.max(to).floor());
        while n <= last_n {
            let level = self.numerator / (n - self.base);
            if first < level && level < last {
                out.push(level);
            }
            n += 1.0;
        }
    }
}

/// The mean of Λ between two places.
fn mean(from: f64, to: f64) -> f64 {
    let [low, high] = [from.min(to), from.max(to)];
    let [first, last] = [low, high].map(floor);
    if first == last {
        return triangle(first, 0.5 * (low + high));
    }
    // Of the units between nothing is left.
    let [begun, ended] = [first + 1.0 - low, high - last];
    let ends =
        begun * triangle(first, low + 0.5 * begun) + ended * triangle(last, last + 0.5 * ended);
    ends / (high - low)
}

/// Λ in the unit from n on.
fn triangle(n: f64, x: f64) -> f64 {
    let falling = 1.0 - 2.0 * (x - n);
    if n as i64 & 1 == 0 { falling } else { -falling }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::exact::{cells, polygon::PIXEL, tests::WANTED};

    /// Of a polygon by the middles of many small parts.
    fn by_parts(phase: impl Fn(DVec2) -> Option<f64>) -> f64 {
        const PARTS: u32 = 1500;
        let middle = |i: u32| (f64::from(i) + 0.5) / f64::from(PARTS) - 0.5;
        let mut sum = 0.0;
        for i in 0..PARTS {
            for j in 0..PARTS {
                if let Some(phase) = phase(DVec2::new(middle(i), middle(j))) {
                    sum += triangle(phase.floor(), phase);
                }
            }
        }
        sum / (f64::from(PARTS) * f64::from(PARTS))
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]

        #[test]
        fn of_a_triangle_wave_it_is_the_integral(
            base in -1.0..1.0_f64,
            turning in -3.0..3.0_f64,
            slope in prop::option::of(-9.0..9.0_f64),
            tilt in prop::array::uniform2(-1.0..1.0_f64),
            level in -0.1..1.0_f64,
        ) {
            let slope = slope.unwrap_or(0.0);
            let steepness = libm::hypot(tilt[0], tilt[1]);
            prop_assume!(steepness > 0.1);
            let along = DVec2::new(tilt[1], -tilt[0]) / steepness;
            let phase = Phase {
                below: [tilt[0], tilt[1], level].map(Double::from_f64),
                steepness,
                along,
                base,
                slope,
                origin: turning,
                off: 0.0,
                off_level: 0.0,
                greatest: 0.0,
            };
            let found = phase.over(&PIXEL, f64::INFINITY).expect("it");
            let expected = by_parts(|at| {
                let level = at.dot(tilt.into()) + level;
                (level > 0.0).then(|| base + (slope * at.dot(along) + turning) / level)
            });
            prop_assert!(found.bound < 1e-9, "{found:?}");
            prop_assert!((found.value - expected).abs() < 2e-3, "{found:?}, not {expected}");
            let mirrored: Vec<DVec2> = PIXEL.into_iter().rev().collect();
            let back = phase.over(&mirrored, f64::INFINITY).expect("it");
            prop_assert!((found.value + back.value).abs() <= found.bound + back.bound);
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(200))]

        /// Of a strip of floor that is narrow, along a diagonal or nearly so.
        #[test]
        fn it_is_what_squares_add_up_to(
            count in 500.0..4000.0_f64,
            odd in prop::array::uniform2(0..3_u32),
            apart in prop::option::of(-7.0..-3.0_f64),
            across in -2.0..2.0_f64,
            place in prop::array::uniform2(-2.0..2.0_f64),
            turned in -3.0..3.0_f64,
            tilt in prop::array::uniform2(-1.0..1.0_f64),
            signs in prop::array::uniform2(prop::bool::ANY),
            exchanged in prop::bool::ANY,
        ) {
            let [p, q] = odd.map(|i| f64::from(2 * i + 1));
            let (p, q) = (p.min(q), p.max(q));
            let signed = |x: f64, i: usize| if signs[i] { -x } else { x };
            let slope = p / q + apart.map_or(0.0, libm::exp10);
            let below = [tilt[0], tilt[1], 1.0];
            // Lines of the picture that are parallel to the horizon have so many squares.
            let form = |count: f64, across: f64, place: f64| {
                let [x, y] = [tilt[1], -tilt[0]];
                [count * x + across * tilt[0], count * y + across * tilt[1], place]
            };
            let a = form(signed(count, 0), across, place[0]);
            let b = form(signed(slope * count, 1), across * p / q + turned, place[1]);
            let seen = Board::new(if exchanged { [b, a] } else { [a, b] }, below);
            for polygon in [&PIXEL[..], &PIXEL[1..]] {
                let Some(found) = seen.along_diagonal(polygon, f64::INFINITY) else { continue };
                let sum = cells::sum(&seen, &seen.visible(polygon), &WANTED);
                let off = (found.value - sum.value).abs();
                prop_assert!(off <= found.bound + sum.bound, "{found:?}, not {sum:?}");
            }
        }
    }
}
