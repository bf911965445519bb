//! Compares sums over the points where an edge crosses lines of a board, and their error bounds,
//! with sums that are added term by term.

use std::cell::RefCell;

use proptest::{prelude::*, test_runner::TestRunner};

use super::{
    super::{
        super::{DEFAULT_TOLERANCE, budget::PixelBudget},
        crossings::MAX_TERMS,
        green::HALF_FACTORIAL,
        special::reduce_double,
    },
    *,
};
use crate::{cancel, math::two_sum, reference::tightness::Tightness};

/// An edge of a polygon: the points where it crosses lines of a board, and the series that gives
/// its contribution at each.
#[derive(Debug)]
struct Edge {
    all: LineCrossings,
    series: EdgeSeries,
}

impl Edge {
    /// Adds up the terms of the first `lines` crossings one by one. The coordinate of each crossing
    /// is computed in double-double.
    fn sum_of(&self, lines: f64) -> f64 {
        let (mut sum, mut rest, mut j) = (0.0, 0.0, 0.0);
        while j < lines {
            let t = self.all.reduced_at(&Double::from_f64(j)).hi;
            let term = self.series.at(t, self.all.depth + j * self.all.rise);
            let next = two_sum(sum, if j % 2.0 == 0.0 { term } else { -term });
            (sum, rest) = (next.hi, rest + next.lo);
            j += 1.0;
        }
        sum + rest
    }

    /// Returns an upper bound of the sum of the terms' absolute values from the crossing `from` on,
    /// for an edge with infinitely many crossings.
    fn most_beyond(&self, from: f64) -> f64 {
        let depth = self.all.depth + (from - 1.0) * self.all.rise;
        (1..=self.series.terms)
            .map(|k| self.series.size(k, depth) * depth / (self.all.rise * (k + 1) as f64))
            .sum()
    }
}

/// Edges of any direction with `lines` crossings. Along an edge, the depth increases by `growth`
/// times its value at the first crossing. If `lines` is infinite, the depth increases by `growth`
/// from one crossing to the next. The sum of the terms' absolute values over an edge's crossings is
/// at most about `size`.
fn edges(
    lines: impl Strategy<Value = f64>,
    growth: impl Strategy<Value = f64>,
    size: f64,
) -> impl Strategy<Value = Edge> {
    let direction = prop_oneof![
        -1.0..1.0_f64,
        prop::sample::select(vec![1.0, 0.0, 1.0 / 3.0, 0.4]),
        (-12.0..-2.0_f64).prop_map(|digits| 1.0 - libm::exp10(digits)),
    ];
    (
        lines,
        growth,
        direction,
        -1.0..1.0_f64,
        prop::array::uniform2(-1.0..1.0_f64),
    )
        .prop_map(move |(lines, growth, stride, t, [climb, slope])| {
            // The derivatives `climb` and `slope` of the depth are at most 1 in size. The depth is
            // therefore at least 18 (`NEAR_SQUARES`) times as large as each derivative. The series
            // is used only at such depths.
            let depth = 18.0;
            let rise = if lines.is_finite() {
                depth * growth / lines
            } else {
                growth
            };
            let (mut factors, mut s, mut power) = ([0.0; MAX_TERMS + 1], 1.0, slope);
            for k in 1..=MAX_TERMS {
                factors[k] = HALF_FACTORIAL[k] * s;
                s = climb * s + power;
                power *= slope;
            }
            let mut edge = Edge {
                all: LineCrossings {
                    reduced: [t, stride].map(|x| reduce_double(&Double::from_f64(x))),
                    depth,
                    rise,
                    count: Double::from_f64(lines),
                },
                series: EdgeSeries {
                    terms: MAX_TERMS,
                    factors,
                },
            };
            let most = if lines.is_finite() {
                lines * edge.series.size(1, depth)
            } else {
                edge.most_beyond(1.0)
            };
            edge.series
                .factors
                .iter_mut()
                .for_each(|factor| *factor *= size / most);
            edge
        })
}

#[test]
fn errors_of_sums_over_crossings_are_within_tight_bounds() {
    let tolerance = DEFAULT_TOLERANCE;
    let budget = PixelBudget::new(tolerance, &cancel::NEVER);
    let many = || (MAX_DIRECT + 1.0..40_000.0).prop_map(f64::floor);
    let few = (1.0..2000.0_f64).prop_map(f64::floor);
    let decades = |low: f64, high: f64| (low..high).prop_map(libm::exp10);
    let endless = Just(f64::INFINITY);
    for (kind, edges) in [
        ("few", edges(few, decades(-9.0, 3.0), 1e-4).boxed()),
        ("steady", edges(many(), decades(-12.0, -7.0), 1e-4).boxed()),
        ("level", edges(many(), decades(-6.0, -0.01), 1e-4).boxed()),
        ("receding", edges(many(), decades(0.5, 3.0), 1e-5).boxed()),
        ("endless", edges(endless, decades(-1.0, 0.0), 1e-5).boxed()),
    ] {
        let found = RefCell::new(Tightness::default());
        let cases = ProptestConfig {
            cases: 32,
            ..ProptestConfig::default()
        };
        let mut runner = TestRunner::new(cases);
        runner
            .run(&edges, |edge| {
                let sum = sum(&edge.all, &edge.series, tolerance, &budget);
                let lines = edge.all.count.hi.min(2e5);
                let left = if lines < edge.all.count.hi {
                    edge.most_beyond(lines)
                } else {
                    0.0
                };
                assert!(left <= 1e-2 * tolerance, "{left:e}");
                let expected = edge.sum_of(lines);
                let error = ((sum.value - expected).abs() - left).max(0.0);
                found.borrow_mut().add(error, sum.bound, 1, &edge);
                Ok(())
            })
            .unwrap();
        found.into_inner().assert(kind);
    }
}
