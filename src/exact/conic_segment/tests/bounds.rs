//! Checks the integrals of boards over segments, and their error bounds. The reference is a sum
//! over the board's squares, computed in multiple precision.

use std::cell::RefCell;

use proptest::{prelude::*, test_runner::TestRunner};

use super::{
    super::super::{DEFAULT_TOLERANCE, budget::PixelBudget},
    *,
};
use crate::{
    cancel,
    reference::{
        exact_board::{ExactBoard, NUMBER, Point, area, form, point},
        oracle::N,
        tightness::Tightness,
    },
};

/// An arc of a conic, with coordinates in multiple precision.
struct ExactArc {
    points: [Point; 3],
    weight: N,
}

impl ExactArc {
    fn new(arc: &Arc) -> Self {
        Self {
            points: [arc.start, arc.control, arc.end].map(point),
            weight: NUMBER.exact(arc.weight),
        }
    }

    /// Evaluates the curve's polar form (blossom) at the parameters `s` and `t`, as a point in
    /// homogeneous coordinates.
    fn blossom(&self, s: &N, t: &N) -> [N; 3] {
        let one = NUMBER.exact(1.0);
        let [u, v] = [s, t].map(|t| &one - t);
        let weights = [&u * &v, &self.weight * (s * &v + t * &u), s * t];
        let sum = |k: usize| {
            let [a, b, c] = &self.points;
            &a[k] * &weights[0] + &b[k] * &weights[1] + &c[k] * &weights[2]
        };
        [sum(0), sum(1), &weights[0] + &weights[1] + &weights[2]]
    }

    fn between(&self, from: &N, to: &N) -> Self {
        let all = [(from, from), (from, to), (to, to)].map(|(s, t)| self.blossom(s, t));
        let [start, middle, end] = &all;
        Self {
            weight: &middle[2] / (&start[2] * &end[2]).sqrt(),
            points: all.map(|[x, y, w]| [x / &w, y / w]),
        }
    }

    /// Returns the area between the arc and its chord. The arc is halved, then its halves, and so
    /// on for 60 rounds. Each arc is cut where its tangent is parallel to its chord. This brings
    /// the weight nearer to 1, the weight of a parabola.
    fn area(&self) -> N {
        let (mut share, mut scale, mut weight) =
            (NUMBER.exact(0.0), NUMBER.exact(1.0), self.weight.clone());
        for _ in 0..60 {
            let more = NUMBER.exact(1.0) + &weight;
            scale = &scale * &weight / &more;
            share += &scale;
            scale /= &more;
            weight = (more / NUMBER.exact(2.0)).sqrt();
        }
        // The remaining arcs are parabolas, whose segments are 2/3 of their triangles.
        area(&self.points) * (share + scale * NUMBER.exact(2.0) / NUMBER.exact(3.0))
    }

    /// Returns the parameters at which the arc crosses a line of the board, in ascending order.
    fn cuts(&self, board: &ExactBoard) -> Vec<N> {
        let mut cuts = vec![NUMBER.exact(0.0), NUMBER.exact(1.0)];
        for across in &board.numerators {
            let places = self
                .points
                .each_ref()
                .map(|p| form(across, p) / form(&board.denominator, p));
            let [low, high] = [places.iter().min(), places.iter().max()].map(|n| n.unwrap());
            let mut n = low.ceil();
            while n <= *high {
                let values = self
                    .points
                    .each_ref()
                    .map(|p| form(across, p) - &n * form(&board.denominator, p));
                cuts.extend(self.zeros(values));
                n += NUMBER.exact(1.0);
            }
        }
        cuts.sort();
        cuts
    }

    /// Returns the parameters between 0 and 1 at which a linear form is 0. The argument contains
    /// the form's values at the arc's start, control point and end.
    fn zeros(&self, [start, control, end]: [N; 3]) -> Vec<N> {
        // The form is proportional to end·r² + 2·half·r + start, where r = t/(1 − t).
        let half = &self.weight * control;
        let discriminant = &half * &half - &start * &end;
        if discriminant < N::ZERO {
            return Vec::new();
        }
        let root = discriminant.sqrt();
        let ratios = [-&half - &root, root - half].map(|above| above / &end);
        let ahead = ratios.into_iter().filter(|r| *r > N::ZERO);
        ahead.map(|r| &r / (NUMBER.exact(1.0) + &r)).collect()
    }
}

/// Integrates the sign of a board over the region between an arc and its chord.
fn integral(board: &ExactBoard, arc: &ExactArc) -> N {
    let cuts = arc.cuts(board);
    let (mut sum, mut chords) = (NUMBER.exact(0.0), vec![arc.points[0].clone()]);
    for pair in cuts.windows(2) {
        let piece = arc.between(&pair[0], &pair[1]);
        let half = NUMBER.exact(0.5);
        let [x, y, w] = piece.blossom(&half, &half);
        let middle = [x / &w, y / w];
        let is_odd = [0, 1].map(|i| {
            let place = form(&board.numerators[i], &middle) / form(&board.denominator, &middle);
            place.floor().to_f64().value().rem_euclid(2.0) == 1.0
        });
        let area = piece.area();
        sum += if is_odd[0] == is_odd[1] { area } else { -area };
        let [_, _, end] = piece.points;
        chords.push(end);
    }
    sum + board.integral_of(chords)
}

#[derive(Default)]
struct Found {
    one_square: Tightness,
    cut: Tightness,
    halved: Tightness,
}

#[test]
fn errors_of_segments_are_within_tight_bounds() {
    let budget = PixelBudget::new(DEFAULT_TOLERANCE, &cancel::NEVER);
    let found = RefCell::new(Found::default());
    let mut runner = TestRunner::default();
    let number = || -1.0..1.0_f64;
    let parts = (
        prop::array::uniform6(number()),
        prop::array::uniform2(number()),
        -1.5..1.7_f64,
        prop::array::uniform3(prop::array::uniform2(-0.5..0.5_f64)),
        -1.0..1.0_f64,
        prop::array::uniform3(prop::array::uniform3(number())),
    );
    runner
        .run(
            &parts,
            |(across, tilt, squares, points, weight, roundings)| {
                let squares = libm::exp10(squares);
                let below = [0.9 * tilt[0], 0.9 * tilt[1], 1.0];
                let [a, b] = [0, 3].map(|i| [0, 1, 2].map(|k| squares * across[i + k]));
                let board = Homography::new([a, b], below);
                let [start, control, end] = points.map(DVec2::from);
                let weight = libm::exp2(weight);
                let arc = Arc {
                    start,
                    control,
                    end,
                    weight,
                };
                let sum = board.over_segment(&arc, &budget);
                let [a, b] = board.numerators;
                let exact = ExactBoard::of_rounded([a, b, board.denominator], roundings);
                let expected = integral(&exact, &ExactArc::new(&arc));
                let error = (expected - NUMBER.exact(sum.value)).to_f64().value().abs();
                let lines = [0, 1].map(|i| board.lines(&arc, i));
                let span = match lines {
                    [Some(a), Some(b)] => a.1 - a.0 + b.1 - b.0,
                    _ => f64::INFINITY,
                };
                let mut found = found.borrow_mut();
                let (by, roundings) = if board.square_of(&arc).is_some() {
                    (&mut found.one_square, 1)
                } else if span <= MAX_LINES {
                    // Each line that crosses the arc contributes three roundings: two for the
                    // parameters of its crossings, and one for the area of a piece. The number of
                    // lines in a family is the number of the last line minus that of the first,
                    // plus 1.
                    (&mut found.cut, 3 * (span as usize + 2))
                } else {
                    (&mut found.halved, 1)
                };
                by.add(error, sum.bound, roundings, (&board, &arc));
                Ok(())
            },
        )
        .unwrap();
    let found = found.into_inner();
    found.one_square.assert("one square");
    found.cut.assert("cut");
    found.halved.assert("halved");
}
