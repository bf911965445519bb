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
use super::complex::{Complex, phase, size, square, times, turn};
use super::exponential::{divided_difference, third};
use super::horizon::rest_of_pole;
use std::f64::consts::PI;

/// Where m grows twofold within fewer crossings than this, the formula of Euler and Maclaurin needs more terms than it has
/// here.
pub(super) const GRADUAL: f64 = 4000.0;
/// Where m changes by less than one part in so many, it is taken to be the same at all crossings: then the ends would cancel.
const STEADY: f64 = 3e7;
/// More modes than this take too long.
pub(super) const MOST: f64 = 40_000.0;
/// Σ |U| times this, by (Q − 1)², bounds all modes beyond Q: |F′(y)| ≤ 2.125/y², from integrating by parts twice, and Σ n⁻³ over
/// the odd n beyond Q is at most 1/4(Q − 1)².
const BEYOND: f64 = 4.0 / (PI * PI) * 2.125 / PI * 0.25;
/// Σ m⁻² times this, by Q − 1, bounds them, too: |F| ≤ ½, and Σ n⁻² over the odd n beyond Q is at most 1/2(Q − 1).
const FLAT: f64 = 4.0 / (PI * PI) * 0.5;
/// By Abel |Σ e^(iθj)·U| is at most this by |θ| and m²: |1 − e^iθ| is at least 2|θ|/π, each of m⁻²F(y_p) and m⁻²F(y_c) is at
/// most ½m⁻² and varies by at most as much again and that of ∫ m⁻³·|yF′| dm, |yF′| ≤ 17/16, and half an end is left out.
const ABEL: f64 = (1.0 + 2.0 * (0.5 + 17.0 / 32.0) + 1.0) * PI;

/// A mode that is smaller than this part of what is neglected anyhow is neglected, too.
const LITTLE: f64 = 1e-4;

/// The lines that a side crosses.
pub(super) struct Lines {
    /// Where along the other axis the first is crossed, m there, and their steps from line to line.
    pub t: f64,
    pub stride: f64,
    pub depth: f64,
    pub rise: f64,
    pub lines: f64,
    /// ∂m/∂t on the floor.
    pub slope: f64,
    /// What late modes add up to, by the one-th of them, where more is known of that than of |U|.
    pub size: f64,
}

/// One end of a sum: m there and w, which is infinite where m does not change.
struct End {
    depth: f64,
    w: f64,
}

impl Lines {
    /// Σ (4/π²n²) Im e^(iπnt)/i · Σ (−1)^j … U, of which as much as `tolerance` may be neglected.
    pub(super) fn sum(&self, tolerance: f64) -> Sum {
        let last_depth = self.depth + self.rise * self.lines;
        let nearest = self.depth.min(last_depth);
        let w = (nearest / self.rise).abs();
        let crossings = self.lines.min(w);
        // Σ m_j⁻² and Σ m_j⁻³, the latter with what |U| has before it.
        let squares = (1.0 + crossings) / (nearest * nearest);
        let climb = self.rise / self.stride;
        let most = (self.slope - climb).abs() * squares / nearest;
        let (all, flat) = (BEYOND * most, FLAT * squares.min(self.size));
        let last = ((all / tolerance).sqrt().ceil() + 2.0)
            .min((flat / tolerance).ceil() + 2.0)
            .clamp(3.0, MOST);
        let beyond = (all / ((last - 1.0) * (last - 1.0))).min(flat / (last - 1.0));

        let is_steady = self.rise.abs() * self.lines * STEADY < nearest;
        let first = End {
            depth: self.depth,
            w: self.depth / self.rise,
        };
        let end = self.lines.is_finite().then(|| End {
            depth: last_depth,
            w: last_depth / self.rise,
        });
        let stride = turn(self.stride);
        let stride = stride - 1.0_f64.copysign(stride);
        let mut place = phase(turn(self.t) * PI);
        let step = square(place);
        let (mut value, mut rounding, mut skipped) = (0.0, 0.0, 0.0);
        let abel = ABEL / (nearest * nearest);
        let little = LITTLE * tolerance.max(beyond);
        let mut n = 1.0;
        while n <= last {
            let theta = turn(n * stride) * PI;
            let weight = 4.0 / (PI * PI * n * n);
            let at_most = weight * abel;
            if at_most <= little * theta.abs() {
                skipped += at_most / theta.abs();
                place = times(place, step);
                n += 2.0;
                continue;
            }
            let (sum, terms) = if is_steady {
                self.steady(n, theta)
            } else {
                let (mut sum, mut terms) = self.from(&first, n, theta);
                if let Some(end) = &end {
                    let (rest, more) = self.from(end, n, theta);
                    let rest = times(phase(turn(theta / PI * self.lines) * PI), rest);
                    sum = [sum[0] - rest[0], sum[1] - rest[1]];
                    // Its place is off by three roundings of θN, |θ| ≤ π.
                    terms += more + 0.1 * self.lines * size(rest);
                }
                (sum, terms)
            };
            value -= weight * (place[0] * sum[0] - place[1] * sum[1]);
            // F is good to some 100 roundings, and the place of the mode n to 4n.
            rounding += weight * terms * (128.0 + 4.0 * n) * UNIT;
            place = times(place, step);
            n += 2.0;
        }
        // |R″|/2 ≤ 0.04 on the whole line below −iθ, and each of pY_p and cY_c has a second derivative by j of at most 3·m⁻²w⁻².
        let curvature = if is_steady {
            // m⁻³ is off by 3·gN/2m from its value in the middle, and m⁻²·F by as much at most, since |F| and |yF′| are at
            // most ½; Σ 4/π²n² is ½.
            0.5 * most.min(squares) * 3.0 / STEADY
        } else {
            let ends = 1.0 + f64::from(u8::from(end.is_some()));
            0.5 * 0.04 * 6.0 * ends / (nearest * nearest * w * w)
        };
        // τ is off by a rounding, and θ by one of nπ times what is left of τ, for which another was made, and by one of its own, so
        // that the wave n is at crossing j off by πnj(2 + |τ|) units and a little. Of |U| there are two bounds: with
        // 2.125·|p − c|/πnm³ the modes add up to 2.125/2 of Σ jm⁻³, and with that by m² to (4/π)·Σ 1/n of Σ jm⁻², which grows
        // like a logarithm where m does.
        let growth = last_depth.max(self.depth) / nearest;
        let waves = 4.0 / PI * (1.0 + 0.5 * libm::log(last)) * (1.0 + libm::log(growth));
        let by_size = 1.1 * most * crossings;
        let by_squares = waves * self.largest(nearest) * crossings * squares;
        let displaced = UNIT * (2.5 + self.stride.abs()) * by_size.min(by_squares);
        Sum {
            value,
            bound: beyond + skipped + curvature + rounding + displaced,
        }
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

    /// The same for all crossings where m does not change.
    fn steady(&self, n: f64, theta: f64) -> (Complex, f64) {
        let depth = self.depth + 0.5 * self.rise * self.lines;
        let p = third(PI * n * depth / self.slope);
        let c = third(PI * n * depth * self.stride / self.rise);
        let u = [c[0] - p[0], c[1] - p[1]];
        // Σ e^(iθj), the ends by half, is e^(iθN/2)·sin(θN/2)·cot(θ/2).
        let half = 0.5 * theta;
        let ratio = match libm::sin(half) {
            0.0 => self.lines,
            sine => libm::cos(half) * libm::sin(turn(half / PI * self.lines) * PI) / sine,
        };
        let middle = phase(turn(half / PI * self.lines) * PI);
        let scale = ratio / (depth * depth);
        (
            times(middle, u).map(|x| x * scale),
            (size(p) + size(c)) * scale.abs(),
        )
    }
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
            let lines = Lines {
                t: 0.37,
                stride,
                depth: 0.9,
                rise,
                lines: 40.0,
                slope,
                size: f64::INFINITY,
            };
            let (found, expected) = (lines.sum(1e-7), by_quadrature(&lines));
            let error = (found.value - expected).abs();
            // The quadrature's steps are aslant to kinks.
            assert!(error < 2e-5, "{} or {expected}", found.value);
        }
    }
}
