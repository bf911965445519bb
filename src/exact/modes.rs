//! Sums over the very many lines that a side of a region crosses, at any distance.
//!
//! Crossing j of N, which may be without end, lies at t_j = t + τj, m_j = m + gj. Along t the board is
//! Im (4/π) Σ e^(iπnt)/n over the odd n. K·e^(iπnt)/m³ has along t the antiderivative K·e^(iπnt)·Y_p, where p is ∂m/∂t on
//! the floor and
//!
//! s·Y_s = −m⁻²·F(πnm/s), F(y) = ∫ e^(iyv) (1 + v)⁻³ dv over v ≥ 0, so that s·Y_s′ = m⁻³ − iπn·Y_s;
//!
//! and that has along the side, on which m climbs by c for every 1 of t, e^(iπnt)·U/(iπn(p − c)), U = pY_p − cY_c. What
//! is wanted is Σ (−1)^j of it: Σ e^(iθj)·U(m_j), θ = nπ(τ + 1) less turns. From one end on that is, by the formula of Euler
//! and Maclaurin as in `horizon`, ∫ e^(iθx)·U dx + (R − ½)·U − R′·dU/dj + …, and the integral has a closed form, too: with
//! w = m/g, y = πnm/p, πnτw and θw for p, c and θ,
//!
//! ∫ e^(iθx)·U dx = −i·w·m⁻²·(F[y_c, y_θ] − F[y_p, y_θ]),
//!
//! in divided differences of F. The first and the last crossing count half.

use super::board::{Sum, UNIT};
use super::complex::{Complex, phase, size, square, times, turn, turn_exactly, turned_times};
use super::exponential::{divided_difference, third};
use super::horizon::rest_of_pole;
use super::kinks;
use super::resonance::Resonances;
use crate::math::{Double, Real, two_product};
use std::{array, f64::consts::PI};

/// What is neglected of modes that are not in step, by what a mode's crossings add up to.
pub(super) const NOT_IN_STEP: f64 = DOUBLINGS / (PI * PI * PI * IN_STEP * FINE);
/// Where m grows twofold within fewer crossings than this, the formula of Euler and Maclaurin needs more terms than it has
/// here.
pub(super) const GRADUAL: f64 = 4000.0;
/// Where m changes by less than one part in so many, it is taken to be the same at all crossings: then the ends would cancel.
const STEADY: f64 = 3e7;
/// More modes than this take too long, of a whole pixel.
pub(super) const MOST: f64 = 1_000_000.0;
/// Up to here every mode is asked for, and beyond only those in step, ...
const DENSE: f64 = 2048.0;
/// ... of which there are about as many for each doubling of their number, if their angles are even; ...
const IN_STEP: f64 = 500.0;
/// ... or up to so many times as many, and as many times as far all of them, where too much would be neglected else, ...
const FINEST: f64 = 256.0;
/// ... of which so many take less time than lines one by one; ...
const FINE: f64 = 16.0;
/// ... and so many doublings or more may be needed.
const DOUBLINGS: f64 = 32.0;
/// However little time there is, so many may be computed: sums over what is left take for granted that these are not none.
const FEWEST: f64 = 16.0;
/// Where modes leave no more than so many times as much as wanted, they are enough.
const ENOUGH: f64 = 2.0;
/// To ask for one takes so much less time than to compute it.
const ASKED: f64 = 8.0;
/// The last of all.
const LAST: f64 = 1e15;
/// Σ |U| times this, by (Q − 1)², bounds all modes beyond Q: |F′(y)| ≤ 2.125/y², from integrating by parts twice, and Σ n⁻³ over
/// the odd n beyond Q is at most 1/4(Q − 1)².
const BEYOND: f64 = 4.0 / (PI * PI) * 2.125 / PI * 0.25;
/// Σ m⁻² times this, by Q − 1, bounds them, too: |F| ≤ ½, and Σ n⁻² over the odd n beyond Q is at most 1/2(Q − 1).
pub(super) const FLAT: f64 = 4.0 / (PI * PI) * 0.5;
/// By Abel |Σ e^(iθj)·U| is at most this by |θ| and m²: |1 − e^iθ| is at least 2|θ|/π, each of m⁻²F(y_p) and m⁻²F(y_c) is at
/// most ½m⁻² and varies by at most as much again and that of ∫ m⁻³·|yF′| dm, |yF′| ≤ 17/16, and half an end is left out.
pub(super) const ABEL: f64 = (1.0 + 2.0 * (0.5 + 17.0 / 32.0) + 1.0) * PI;

/// Small modes are neglected, too, which add up to no more than this part of the tolerance; or than as many modes as may be computed leave anyhow.
const LITTLE: f64 = 0.25;

/// The lines that a side crosses.
///
/// Places are kept without whole turns, of which there may be more than numbers have digits.
pub(super) struct Lines {
    /// Where along the other axis the first and the last are crossed, in half turns.
    pub t: f64,
    t_last: f64,
    /// τ + 1 in half turns, and τ.
    pub turning: Double,
    pub stride: f64,
    /// m where the first is crossed, and its step from line to line.
    pub depth: f64,
    pub rise: f64,
    pub lines: f64,
    is_odd: bool,
    /// ∂m/∂t on the floor.
    pub slope: f64,
    /// What the crossings of a mode add up to at most together with those of the other side, where more is known of that than of |U|.
    pub size: f64,
}

/// One end of a sum: m there and w, which is infinite where m does not change.
struct End {
    depth: f64,
    w: f64,
}

impl Lines {
    /// So many lines, from where t and m are `first` on, which grow by `step` from line to line, and m by `slope` along t on the floor.
    pub(super) fn new(first: &[Double; 2], step: &[Double; 2], count: &Double, slope: f64) -> Self {
        let [[t, depth], [stride, rise]] = [first, step];
        let last = t.plus(&stride.times(count));
        let turning = turn_exactly(stride).plus(&Double::from_f64(1.0));
        Self {
            t: turn_exactly(t).to_f64(),
            t_last: turn_exactly(&last).to_f64(),
            turning: turn_exactly(&turning),
            stride: stride.to_f64(),
            depth: depth.to_f64(),
            rise: rise.to_f64(),
            lines: count.hi,
            is_odd: count.hi.is_finite() && count.floor().1,
            slope,
            size: f64::INFINITY,
        }
    }

    /// Σ (4/π²n²) Im e^(iπnt)/i · Σ (−1)^j … U, of which as much as `tolerance` may be neglected, and what takes more modes than `most`.
    pub(super) fn sum(&self, tolerance: f64, most: f64) -> Sum {
        sum(&[(1.0, self)], self.in_step(), tolerance, most)
    }

    /// Whether of its late modes no more are in step than angles that are spread evenly have.
    pub(super) fn is_even(&self) -> bool {
        const SAMPLE: usize = 64;
        let within = IN_STEP / DENSE;
        let mut waves = Resonances::new(&self.turning, within);
        waves
            .nth(SAMPLE)
            .is_none_or(|wave| wave as f64 * within > SAMPLE as f64)
    }

    /// What the crossings of a mode add up to at most, by |θ|.
    pub(super) fn in_step(&self) -> f64 {
        ABEL / (self.nearest() * self.nearest())
    }

    fn last_depth(&self) -> f64 {
        self.depth + self.rise * self.lines
    }

    fn nearest(&self) -> f64 {
        self.depth.min(self.last_depth())
    }

    fn is_steady(&self) -> bool {
        self.rise.abs() * self.lines * STEADY < self.nearest()
    }

    fn ends(&self) -> [Option<End>; 2] {
        let end = |depth: f64| End {
            depth,
            w: depth / self.rise,
        };
        let is_endless = self.lines.is_infinite();
        [
            Some(end(self.depth)),
            (!is_endless).then(|| end(self.last_depth())),
        ]
    }

    /// Of how many crossings m is about what it is at the first.
    fn crossings(&self) -> f64 {
        self.lines.min((self.nearest() / self.rise).abs())
    }

    /// Σ m_j⁻².
    fn squares(&self) -> f64 {
        (1.0 + self.crossings()) / (self.nearest() * self.nearest())
    }

    /// What a mode's crossings add up to at most beside what two sides have between them.
    ///
    /// Where j is x, e^(iπnt)·cY_c is −g∫ m⁻³·e^(iπnt) dx from there on, whatever c is, and with alternating signs, the ends by half, the
    /// crossings before some x add up to ±½: so all of them to ½g∫ m⁻³ dx, ¼m⁻². And ½m⁻² by the trapezoidal rule, for its
    /// integral, is off by no more than ⅛ of the integral of its second derivative's size, gm⁻³.
    pub(super) fn at_its_ends(&self) -> f64 {
        let nearest = self.nearest();
        (0.25 + 0.125 * (self.rise / nearest).abs()) / (nearest * nearest)
    }

    /// Σ m_j⁻³ with what |U| has before it.
    fn cubes(&self) -> f64 {
        let climb = self.rise / self.stride;
        (self.slope - climb).abs() * self.squares() / self.nearest()
    }

    /// What the formula of Euler and Maclaurin leaves out.
    fn curvature(&self) -> f64 {
        if self.is_steady() {
            // m⁻³ is off by 3·gN/2m from its value in the middle, and m⁻²·F by as much at most, since |F| and |yF′| are at
            // most ½; Σ 4/π²n² is ½. Roundings put m off, too.
            let change = self.rise.abs() * self.lines / self.nearest() + 4.0 * UNIT;
            return 0.5 * self.cubes().min(self.squares()) * 3.0 * change;
        }
        // |R″|/2 ≤ 0.04 on the whole line below −iθ, and each of pY_p and cY_c has a second derivative by j of at most 3·m⁻²w⁻².
        let ends = self.ends().iter().flatten().count() as f64;
        let steps = self.rise / (self.nearest() * self.nearest());
        0.5 * 0.04 * 6.0 * ends * steps * steps
    }

    /// What bounds |U|, by m⁻², from some depth on: F is at most ½, and 2/|y|.
    pub(super) fn largest(&self, depth: f64) -> f64 {
        let of_climb = 2.0 * (self.rise / (PI * self.stride * depth)).abs();
        0.5 + of_climb.min(0.5)
    }

    /// By what part of some area modes may be known that fill it.
    pub(super) fn share_neglected() -> f64 {
        2.0 * FLAT / MOST
    }

    /// How deep they must begin for so little to be neglected, and for m to grow slowly enough.
    pub(super) fn start(&self, tolerance: f64) -> f64 {
        let (rise, climb) = (self.rise.abs(), self.rise / self.stride);
        let each = BEYOND * (self.slope - climb).abs() / (tolerance * MOST * MOST);
        let flat = FLAT / (tolerance * MOST);
        // Of N crossings, or of as many as m/g.
        let modes = (each / rise)
            .sqrt()
            .min(libm::cbrt(each * self.lines))
            .min(flat / rise)
            .min((flat * self.lines).sqrt());
        modes.max(GRADUAL * rise)
    }

    /// Σ e^(iθj)·U from one end on, half of U there, and the size of what it is made of.
    fn from(&self, end: &End, n: f64, theta: f64) -> (Complex, f64) {
        let &End { depth, w } = end;
        let (y_p, y_c, y_theta) = (
            PI * n * depth / self.slope,
            PI * n * self.stride * w,
            theta * w,
        );
        let [p, c, at_theta] = [y_p, y_c, y_theta].map(third);
        let (from_c, size_c) = divided_difference([y_c, y_theta], [c, at_theta]);
        let (from_p, size_p) = divided_difference([y_p, y_theta], [p, at_theta]);
        let (r, slope) = rest_of_pole(theta, phase(theta));
        let u = [c[0] - p[0], c[1] - p[1]];
        // dU/dj is i·(y_p·F(y_p) − y_c·F(y_c)) by m²w.
        let [rise_p, rise_c] = [by(y_p, p), by(y_c, c)];
        let rise = [-(rise_p[1] - rise_c[1]) / w, (rise_p[0] - rise_c[0]) / w];
        // −i·(x + iy) = y − ix.
        let sum = [
            w * (from_c[1] - from_p[1]) - r * u[1] - slope * rise[0],
            w * (from_p[0] - from_c[0]) + r * u[0] - slope * rise[1],
        ];
        let terms = w.abs() * (size_c + size_p) + size(p) + size(c) + 1.0 / w.abs();
        let scale = 1.0 / (depth * depth);
        (sum.map(|x| x * scale), terms * scale)
    }

    /// e^(iπnt) of the first and of the last line, the latter with the sign of its summand.
    fn places(&self, n: f64) -> [Complex; 2] {
        let [first, last] = [self.t, self.t_last].map(|t| {
            let Double { hi, lo } = two_product(n, t);
            phase((turn(hi) + lo) * PI)
        });
        [first, if self.is_odd { last.map(|x| -x) } else { last }]
    }

    /// θ of the wave n.
    fn angle(&self, n: f64) -> f64 {
        turned_times(n, &self.turning) * PI
    }

    /// The real part of a mode's sum, each end at its place, and the size of what it is made of.
    fn mode(&self, n: f64, places: [Complex; 2]) -> (f64, f64) {
        let theta = self.angle(n);
        if self.is_steady() {
            return self.steady(n, theta, places);
        }
        let (mut sum, mut terms) = (0.0, 0.0);
        for (i, end) in self.ends().iter().flatten().enumerate() {
            let (part, size) = self.from(end, n, theta);
            let part = times(places[i], part)[0];
            sum += if i == 0 { part } else { -part };
            terms += size;
        }
        (sum, terms)
    }

    /// The same for all crossings where m does not change.
    fn steady(&self, n: f64, theta: f64, [place, last_place]: [Complex; 2]) -> (f64, f64) {
        let depth = self.depth + 0.5 * self.rise * self.lines;
        let p = third(PI * n * depth / self.slope);
        let c = third(PI * n * depth * self.stride / self.rise);
        let u = [c[0] - p[0], c[1] - p[1]];
        // Σ e^(iθj), the ends by half, is e^(iθN/2)·sin(θN/2)·cot(θ/2) = ½(e^(iθN) − 1)·cot(θ/2)/i.
        let half = 0.5 * theta;
        let cotangent = libm::cos(half) / libm::sin(half);
        let (sum, all) = if (theta * self.lines).abs() < 1.0 {
            let whole = match theta {
                0.0 => self.lines,
                _ => libm::sin(half * self.lines) * cotangent,
            };
            let middle = times(place, phase(half * self.lines));
            (middle.map(|x| x * whole), whole)
        } else {
            let difference = [last_place[0] - place[0], last_place[1] - place[1]];
            let half = 0.5 * cotangent;
            (
                [difference[1] * half, -difference[0] * half],
                1.0 + cotangent.abs(),
            )
        };
        let scale = 1.0 / (depth * depth);
        (
            times(sum, u)[0] * scale,
            (size(p) + size(c)) * (all * scale).abs(),
        )
    }
}

/// Σ over the sides, each with its sign, of what `Lines::sum` is of one. A mode's crossings may add up to `in_step`, by |θ| of the
/// first side.
pub(super) fn sum(sides: &[(f64, &Lines)], in_step: f64, tolerance: f64, most: f64) -> Sum {
    let by_kinks = |most: f64| kinks::sum(sides, 0.5 * tolerance, most);
    if let Some(known) = by_kinks(kinks::FEW).filter(|known| known.bound <= tolerance) {
        return known;
    }
    let sum = by_modes(sides, in_step, tolerance, most);
    if sum.bound <= ENOUGH * tolerance {
        return sum;
    }
    let known = by_kinks(kinks::MOST);
    known
        .filter(|known| known.bound <= sum.bound)
        .unwrap_or(sum)
}

/// The same by modes, whatever lines there are.
fn by_modes(sides: &[(f64, &Lines)], in_step: f64, tolerance: f64, most: f64) -> Sum {
    let Some(&(_, reference)) = sides.first() else {
        return Sum::default();
    };
    let most = most.max(FEWEST);
    let total = |of: fn(&Lines) -> f64| sides.iter().map(|(_, side)| of(side)).sum::<f64>();
    let all = BEYOND * total(Lines::cubes);
    let flat = FLAT * total(Lines::squares).min(reference.size);
    let is_known = all.is_finite() && flat.is_finite();
    if !is_known {
        // Out of the range of numbers.
        return Sum {
            value: 0.0,
            bound: f64::INFINITY,
        };
    }
    let beyond = |last: f64| (all / ((last - 1.0) * (last - 1.0))).min(flat / (last - 1.0));
    let last = ((all / tolerance).sqrt().ceil() + 2.0)
        .min((flat / tolerance).ceil() + 2.0)
        .clamp(3.0, LAST);
    let wanted = tolerance / DOUBLINGS;
    let coarse = in_step / (PI * PI * PI * IN_STEP);
    let finer = (coarse / wanted).clamp(1.0, FINEST);
    let budget = wanted.max(coarse / finer);
    // One mode after the other as far as it goes, if what is beyond is less than what of so many would be neglected.
    let all_in_turn = last.min(most);
    let (last, dense) = match beyond(all_in_turn) <= budget * DOUBLINGS {
        true => (all_in_turn, all_in_turn),
        false => (last, last.min(DENSE * finer).min(most)),
    };
    // Those of which 4/π²n² times S/|θ|, S being `in_step`, is at most λ are neglected. If angles are spread evenly, with πQ²λ = 4S/π² these
    // add up to 4S/π³Q = √(4Sλ/π³), and Q others are left, of which there should be no more than half as many as `most`. If not, no more than
    // four times as much is neglected.
    let may_go = (LITTLE * tolerance).max(32.0 / (PI * PI * PI) * in_step / most);
    let little = PI * PI * PI / 64.0 * may_go * may_go / in_step;
    let (mut value, mut rounding, mut skipped) = (0.0, 0.0, 0.0);
    // Whether it has been added, and is not neglected.
    let mut add = |n: f64, places: &dyn Fn(usize) -> [Complex; 2]| {
        let theta = reference.angle(n).abs();
        let weight = 4.0 / (PI * PI * n * n);
        let at_most = weight * in_step;
        if at_most <= little * theta && skipped + at_most / theta <= may_go {
            skipped += at_most / theta;
            return false;
        }
        for (i, (sign, side)) in sides.iter().enumerate() {
            let (sum, terms) = side.mode(n, places(i));
            value -= sign * weight * sum;
            // F is good to some 100 roundings, to which θ, off by a few, adds as many, and each place of the mode n to 4n.
            rounding += weight * terms * (256.0 + 8.0 * n) * UNIT;
        }
        true
    };
    let mut places: Vec<[Complex; 2]> = sides.iter().map(|(_, side)| side.places(1.0)).collect();
    let steps: Vec<[Complex; 2]> = places.iter().map(|places| places.map(square)).collect();
    let mut n = 1.0;
    while n <= dense {
        add(n, &|i| places[i]);
        for (places, steps) in places.iter_mut().zip(&steps) {
            *places = array::from_fn(|i| times(places[i], steps[i]));
        }
        n += 2.0;
    }
    // Of late modes only those in step; of the others, n² being at least that at a doubling's start, what is left is neglected.
    let mut reached = last;
    if last > dense {
        let within = |from: f64| within(in_step, from, budget);
        let others = |from: f64| 4.0 / (PI * PI * PI) * in_step / (3.0 * from * within(from));
        let mut waves = Resonances::new(&reference.turning, within(dense));
        let (mut from, mut neglected) = (dense, others(dense));
        let (mut asked, mut added) = (0.0, 0.0);
        while let Some(wave) = waves.next() {
            let n = wave as f64;
            if n > last {
                break;
            }
            if n > 2.0 * from {
                while n > 2.0 * from {
                    from *= 2.0;
                    neglected += others(from);
                }
                waves.narrow(within(from));
            }
            if n <= dense {
                continue;
            }
            asked += 1.0;
            if asked > ASKED * most || added > most {
                reached = n;
                break;
            }
            if add(n, &|i| sides[i].1.places(n)) {
                added += 1.0;
            }
        }
        reached = reached.min(waves.reached());
        while reached > 2.0 * from {
            from *= 2.0;
            neglected += others(from);
        }
        skipped += neglected;
    }
    let beyond = beyond(reached);
    Sum {
        value,
        bound: beyond + skipped + total(Lines::curvature) + rounding,
    }
}

/// Within how many half turns modes are in step from one of them on, so that what others add up to before there are twice as many
/// is neglected.
fn within(in_step: f64, from: f64, budget: f64) -> f64 {
    (2.0 / (PI * PI * PI) * in_step / (from * budget)).min(0.5)
}

/// Of two sides whose lines are the same ones, in the same sense, what the crossings of a mode add up to at most, by |θ| of the first side.
///
/// Line c has of a mode n between the sides e^(iπnt_1)·W, W = ∫ m⁻³·e^(iπny) dy over the row's length δ, and the row j
/// (−1)^j·∫ of that, which by parts is e^(iθj)·S with |S| ≤ (2·sup|W| + V)/πn|τ|, where V is the variation of W; and that of S is at most
/// 4V/πn|τ|. By Abel the rows add up to π/|θ| times sup|S| and S's variation. |W| is at most δm⁻³. It varies by
/// ∫ |δ′|·m⁻³ dc, δ being linear, and by ∫∫ 3|g|·m⁻⁴ dy dc: with m ≥ m_0 + gc, δ ≤ δ_0 + δ′c and r the greater of the g by
/// the smaller one, all of it is at most (7 + 5r)·(δ_0·m_0⁻³ + δ′·m_0⁻²/2g). In area that is 4K/πn times as much, and 2K/|q|
/// times 4/π²n² is taken out here.
pub(super) fn between(first: &Lines, second: &Lines, [start, growth]: [f64; 2], q: f64) -> f64 {
    let [low, high] = [first.rise.min(second.rise), first.rise.max(second.rise)];
    let depth = first.depth.min(second.depth);
    let rows = start / (depth * depth * depth) + growth.max(0.0) / (2.0 * low * depth * depth);
    0.5 * PI * (q / first.stride).abs() * (7.0 + 5.0 * high / low) * rows
}

/// y·F(y), which has the limit i.
fn by(y: f64, f: Complex) -> Complex {
    if y.is_infinite() {
        [0.0, y.signum()]
    } else {
        f.map(|x| y * x)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::euler::square_wave;
    use super::*;

    /// −∫ s(t + y)·(m + py)⁻³ dy over y ≥ 0, square by square: the antiderivative along t of s(t)/m³.
    fn along(t: f64, m: f64, p: f64) -> f64 {
        let antiderivative = |y: f64| -0.5 / (p * (m + p * y) * (m + p * y));
        let (mut sum, mut from) = (0.0, 0.0);
        let mut to = (t + 1.0).floor() - t;
        let mut squares = 0;
        while squares < 4000 {
            sum += square_wave(t + 0.5 * (from + to)) * (antiderivative(to) - antiderivative(from));
            (from, to) = (to, to + 1.0);
            squares += 1;
        }
        -sum
    }

    /// −½ ∫ s(c)·ρ⁻¹·p_c·Φ dc from line to line, with c from 0: what the sum stands for.
    fn by_quadrature(lines: &Lines) -> f64 {
        const STEPS: u32 = 400;
        let mut sum = 0.0;
        let rows = lines.lines as u32;
        for row in 0..rows {
            let mut part = 0.0;
            for i in 0..STEPS {
                let c = f64::from(row) + (f64::from(i) + 0.5) / f64::from(STEPS);
                let (t, m) = (lines.t + lines.stride * c, lines.depth + lines.rise * c);
                part += along(t, m, lines.slope);
            }
            sum += square_wave(f64::from(row)) * part / f64::from(STEPS);
        }
        // The sum is that by ½·p_c, p_c = g − pτ.
        0.5 * sum * (lines.rise - lines.slope * lines.stride)
    }

    /// Of a small part of a pixel next to no modes may be computed.
    #[test]
    fn what_is_neglected_is_never_less_than_nothing() {
        let lines = Lines::new(
            &[0.37, 0.9].map(Double::from_f64),
            &[1.7320508, 1e-6].map(Double::from_f64),
            &Double::from_f64(40.0),
            0.3,
        );
        let expected = by_quadrature(&lines);
        for most in [0.0, 0.5, 1.0, 3.0, 20.0] {
            let found = lines.sum(1e-12, most);
            let error = (found.value - expected).abs();
            assert!(
                found.bound > 0.0 && error <= found.bound + 2e-5,
                "{found:?}"
            );
        }
    }

    #[test]
    fn a_sum_is_the_integral_along_a_side() {
        for (stride, slope, rise) in [
            (1.7320508, 0.3, 1e-4),
            (1.7320508, 0.3, 1e-6),
            (1.0, 0.5, 2e-5),
            (3.0, 0.2, -1e-5),
            (-2.2, 0.4, 3e-5),
            (1.5, 0.01, 1e-4),
        ] {
            let lines = Lines::new(
                &[0.37, 0.9].map(Double::from_f64),
                &[stride, rise].map(Double::from_f64),
                &Double::from_f64(40.0),
                slope,
            );
            let expected = by_quadrature(&lines);
            let modes = by_modes(&[(1.0, &lines)], lines.in_step(), 1e-7, MOST);
            for found in [modes, lines.sum(1e-7, MOST)] {
                let error = (found.value - expected).abs();
                // The quadrature's steps are aslant to kinks.
                assert!(error < 2e-5, "{} or {expected}", found.value);
            }
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(60))]

        /// Modes and what lies between kinks have nothing in common but the lines.
        #[test]
        fn where_there_are_few_kinks_it_is_what_modes_give(
            t in 0.0..2.0_f64,
            kinks in -3.0..2.0_f64,
            lines in 4.0..9.0_f64,
            slope in -5.0..8.0_f64,
            signs in prop::array::uniform3(prop::bool::ANY),
            swing in -4.0..2.0_f64,
            climb in 0.0..1.0_f64,
        ) {
            let sign = |i: usize| if signs[i] { -1.0 } else { 1.0 };
            let lines = libm::exp10(lines).floor();
            let turning = sign(0) * libm::exp10(kinks) / lines;
            let slope = sign(1) * libm::exp10(slope);
            let depth = ((slope * turning).abs() / libm::exp10(swing)).max(1.0);
            let side = Lines::new(
                &[t, depth].map(Double::from_f64),
                &[sign(2) + turning, climb * depth / 8001.0].map(Double::from_f64),
                &Double::from_f64(lines),
                slope,
            );
            let all = side.squares();
            let found = kinks::sum(&[(1.0, &side)], 0.0, kinks::MOST).expect("few kinks");
            let modes = by_modes(&[(1.0, &side)], side.in_step(), 1e-9 * all, 2e4);
            let off = (found.value - modes.value).abs();
            prop_assert!(off <= found.bound + modes.bound, "{found:?}, {modes:?}");
            prop_assert!(swing > -3.0 || found.bound <= 1e-6 * all, "{found:?} of {all}");
        }
    }
}
