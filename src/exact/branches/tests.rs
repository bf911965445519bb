//! Compares the branches of conics with closed forms that are computed with 600 bits of precision.

use std::cell::RefCell;

use proptest::{prelude::*, test_runner::TestRunner};

use super::*;
use crate::reference::{
    oracle::{N, Number},
    tightness::Tightness,
};

const NUMBER: Number = Number { bits: 600 };

/// Maximum rounding error of the integral of a section, divided by the section's width. The value
/// is that of the constant with the same name in `slabs`.
const ROUNDING: f64 = 16.0 * f64::UNIT;

/// A branch of a conic, computed with 600 bits of precision.
struct ExactBranch {
    /// The coefficients A, B, C, D, E and F of the conic ([`ConicGraph`]).
    factors: [N; 6],
    /// Coefficients of x², 2x and 1 in Δ, the polynomial under the root in y = (−b ± √Δ)/C
    /// ([`ConicGraph`]).
    delta: [N; 3],
    side: f64,
}

impl ExactBranch {
    fn new(conic: &Conic, side: f64) -> Self {
        let factors = conic
            .factors
            .map(|Double { hi, lo }| NUMBER.exact(hi) + NUMBER.exact(lo));
        let [a, b, c, d, e, f] = &factors;
        let delta = [b * b - a * c, b * e - c * d, e * e - c * f];
        Self {
            factors,
            delta,
            side,
        }
    }

    /// Returns √Δ, the root in y = (−b ± √Δ)/C ([`ConicGraph`]), at `x`. Returns 0 if Δ is
    /// negative.
    fn root(&self, x: &N) -> N {
        let [p, q, r] = &self.delta;
        let delta = (p * x + NUMBER.exact(2.0) * q) * x + r;
        delta.max(NUMBER.exact(0.0)).sqrt()
    }

    fn y(&self, x: f64) -> N {
        let [_, b, c, _, e, _] = &self.factors;
        let x = NUMBER.exact(x);
        (NUMBER.exact(self.side) * self.root(&x) - b * &x - e) / c
    }

    /// Returns how far y(x) may move if the conic's equation has an error of eight roundings in
    /// double-double. The distance is large only if Δ ([`ConicGraph`]) is nearly 0 at `x`. The
    /// error bound of a section does not cover this movement; the error bound of the conic covers
    /// it.
    fn doubt(&self, x: f64) -> f64 {
        let c = self.factors[2].to_f64().value().abs();
        let root = self.root(&NUMBER.exact(x)).to_f64().value();
        let error = 8.0 * Double::UNIT * c;
        error / ((root * root + error).sqrt() + root) / c
    }

    /// Returns the integral of y from 0 to `x`, plus a constant.
    fn integral_to(&self, x: f64) -> N {
        let [_, b, c, _, e, _] = &self.factors;
        let x = NUMBER.exact(x);
        let line = (b * &x / NUMBER.exact(2.0) + e) * &x;
        (NUMBER.exact(self.side) * self.root_integral(&x) - line) / c
    }

    /// Returns the integral of √Δ, the root in y = (−b ± √Δ)/C ([`ConicGraph`]), from 0 to `x`,
    /// plus a constant.
    fn root_integral(&self, x: &N) -> N {
        let [p, q, r] = &self.delta;
        let (root, slope, twice) = (self.root(x), p * x + q, NUMBER.exact(2.0) * p);
        let determinant = p * r - q * q;
        let inverse = if *p > N::ZERO {
            let steepness = p.sqrt();
            // Beyond the branch's end, Δ is negative and counts as 0, so the integral keeps the
            // value that it has at the end.
            let sum = if root == N::ZERO {
                (-&determinant).sqrt()
            } else {
                &slope + &steepness * &root
            };
            sum.clone().max(-sum).ln() / steepness
        } else {
            let one = NUMBER.exact(1.0);
            let sine = (&slope / (-&determinant).sqrt()).clamp(-&one, one);
            -(sine.asin() / (-p).sqrt())
        };
        (slope * root + determinant * inverse) / twice
    }
}

/// Conics of all kinds that pass through the pixel: general ones, nearly straight ones, and pairs
/// of branches that nearly coincide.
fn conics() -> impl Strategy<Value = Conic> {
    let number = || -1.0..1.0_f64;
    let parts = (
        prop::array::uniform6(number()),
        prop::array::uniform3(number()),
        0..3_u8,
        0.0..20.0_f64,
    );
    parts.prop_filter_map("a line far away", |(six, line, kind, digits)| {
        let small = libm::exp10(-digits);
        let [a, b, c] = line;
        let factors = match kind {
            0 => six,
            1 => {
                let [u, v, w, ..] = six.map(|x| x * small * small);
                [u, v, w, a, b, 0.3 * c]
            }
            _ => {
                let squares = [a * a, a * b, b * b, 0.3 * a * c, 0.3 * b * c, 0.09 * c * c];
                std::array::from_fn(|i| squares[i] + small * six[i])
            }
        };
        let size = factors.iter().fold(0.0, |size: f64, x| size.max(x.abs()));
        let conic = Conic {
            factors: factors.map(|x| Double::from_f64(x / size)),
            rad: Double::UNIT,
        };
        conic.over_pixel().holds_zero().then_some(conic)
    })
}

#[derive(Default)]
struct Found {
    sum: Tightness,
    quotient: Tightness,
    rounded: Tightness,
    double: Tightness,
    straight: Tightness,
    cut: usize,
}

impl Found {
    /// Compares the sections of a branch from `left` to `right` with the exact branch. If the
    /// branch turns too much to be one section, its two halves are compared.
    fn compare(&mut self, graph: &ConicGraph, exact: &ExactBranch, [left, right]: [f64; 2]) {
        let width = right - left;
        let Some(span) = graph.span(left, right) else {
            return;
        };
        let Some((track, section)) = span.branch(exact.side) else {
            return;
        };
        let Some(section) = section else {
            self.cut += 1;
            if width > 1e-9 {
                let middle = 0.5 * (left + right);
                self.compare(graph, exact, [left, middle]);
                self.compare(graph, exact, [middle, right]);
            }
            return;
        };
        for (x, y) in span.x.into_iter().zip(section.y) {
            assert_eq!(track.y(x), y);
            let error = (exact.y(x) - NUMBER.exact(y)).to_f64().value().abs();
            let [_, b, _, _, e, _] = &exact.factors;
            let is_sum = (NUMBER.exact(x) * b + e) * NUMBER.exact(exact.side) <= N::ZERO;
            let by = if is_sum {
                &mut self.sum
            } else {
                &mut self.quotient
            };
            let bound = 8.0 * f64::UNIT * y.abs().max(1.0) + exact.doubt(x);
            by.add(error, bound, 1, (graph, x, y));
        }
        if section.y.iter().any(|y| y.abs() > 1.0) {
            return;
        }
        let integral = exact.integral_to(right) - exact.integral_to(left);
        let error = integral - NUMBER.exact(section.integral(left, right));
        let bound = (section.error + ROUNDING) * width;
        let by = match &section.arc {
            None => &mut self.straight,
            Some((_, arc)) => {
                let ends = [(arc.start, 0), (arc.end, 2)].map(|(at, i)| ArcEnd {
                    at: [at.x, at.y],
                    root: exact.side * span.roots[i],
                });
                let factors = graph.factors.map(|factor| factor.hi);
                if Tangents::new(&factors, &ends).off <= ARC_TOLERANCE * width {
                    &mut self.rounded
                } else {
                    &mut self.double
                }
            }
        };
        by.add(error.to_f64().value().abs(), bound, 1, (graph, section));
    }
}

#[test]
fn errors_of_sections_are_within_tight_bounds() {
    let found = RefCell::new(Found::default());
    let mut runner = TestRunner::default();
    let cases = (conics(), prop::array::uniform2(-0.5..0.5_f64));
    runner
        .run(&cases, |(conic, cuts)| {
            let graph = ConicGraph::new(&conic);
            let mut cuts: Vec<f64> = cuts
                .into_iter()
                .chain([-0.5, 0.5])
                .chain(graph.ends())
                .collect();
            cuts.sort_by(f64::total_cmp);
            for side in [-1.0, 1.0] {
                let exact = ExactBranch::new(&conic, side);
                for pair in cuts.windows(2) {
                    found
                        .borrow_mut()
                        .compare(&graph, &exact, [pair[0], pair[1]]);
                }
            }
            Ok(())
        })
        .unwrap();
    let found = found.into_inner();
    found.sum.assert("(−b ± √Δ)/C");
    found.quotient.assert("g/(−b ∓ √Δ)");
    found.rounded.assert("arcs in f64");
    found.double.assert("arcs in double-double");
    found.straight.assert("chords");
    assert!(found.cut > 0);
}

/// In each case, two conics nearly coincide. The bound on the distance between their arcs is
/// compared with the exact distance at nine values of x.
#[test]
fn distances_of_parallel_arcs_are_tight() {
    let found = RefCell::new(Tightness::default());
    let cases = (
        conics(),
        prop::array::uniform6(-1.0..1.0_f64),
        -14.0..-3.0_f64,
        prop::array::uniform2(-0.5..0.5_f64),
    );
    TestRunner::default()
        .run(&cases, |(conic, changes, digits, [one, other])| {
            let mut near = conic;
            for (factor, change) in near.factors.iter_mut().zip(changes) {
                let change = Double::from_f64(libm::exp10(digits) * change);
                *factor = factor.plus(&change);
            }
            let graphs = [&conic, &near].map(ConicGraph::new);
            let [left, right] = [one.min(other), one.max(other)];
            for side in [-1.0, 1.0] {
                let exact = [&conic, &near].map(|conic| ExactBranch::new(conic, side));
                let sections = graphs.each_ref().map(|graph| {
                    let span = graph.span(left, right)?;
                    span.branch(side)?.1
                });
                let [Some(a), Some(b)] = sections else {
                    continue;
                };
                let distance = a.distance(&b);
                if a.arc.is_none() || distance > 0.1 {
                    continue;
                }
                let apart = (0..=8).map(|i| {
                    let x = left + f64::from(i) / 8.0 * (right - left);
                    let [a, b] = exact.each_ref().map(|branch| branch.y(x));
                    (a - b).to_f64().value().abs()
                });
                let apart = apart.fold(0.0, f64::max);
                found
                    .borrow_mut()
                    .add(apart, distance, 1, (&conic, &near, left, right));
            }
            Ok(())
        })
        .unwrap();
    found.into_inner().assert("arcs side by side");
}
