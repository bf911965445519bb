//! The integral of the board's sign between an arc of a conic and its chord.

use std::sync::atomic::AtomicBool;

use glam::DVec2;

use super::arc::Arc;
use super::board::{Board, Sum, UNIT, form};
use super::euler::square_wave;

/// An arc that may cross more lines than this is halved.
const LINES: f64 = 48.0;
/// A sliver so small, in square pixels, is neglected rather than halved once more: the slivers of n pieces are n³ times
/// smaller each.
const NEGLECTED: f64 = 2e-13;
/// Halves of an arc have slivers of less than this of its own: a quarter for a parabola, 0.37 for half an ellipse, less for a hyperbola.
const LEFT: f64 = 0.75;

impl Board {
    /// The integral of s(a)·s(b) over the region between an arc and its chord, in square pixels.
    ///
    /// An arc is cut where it crosses a line of the board, so that each of its slivers lies in one square, and what is left
    /// is a convex polygon. Where the lines are too many, toward the horizon, chords take the place of pieces so short that
    /// their slivers may be neglected.
    pub(super) fn sliver(&self, arc: &Arc, cancel: &AtomicBool) -> Sum {
        if let Some(sign) = self.one_square(arc) {
            return within_a_square(arc, sign);
        }
        let mut chords = Chords {
            points: vec![arc.start],
            sum: Sum::default(),
        };
        self.cut(arc, &mut chords);
        chords.sum.add(self.over(&chords.points, cancel));
        let area = arc.area();
        if chords.sum.value.is_finite() && chords.sum.bound < area {
            return chords.sum;
        }
        // Out of the range of numbers, or not worth having.
        Sum {
            value: 0.0,
            bound: area,
        }
    }

    /// Adds the slivers of an arc, and the points at which it was cut.
    fn cut(&self, arc: &Arc, chords: &mut Chords) {
        if let Some(sign) = self.one_square(arc) {
            chords.sum.add(within_a_square(arc, sign));
            chords.points.push(arc.end);
            return;
        }
        let lines = [0, 1].map(|i| self.lines(arc, i));
        if let [Some(a), Some(b)] = lines
            && a.1 - a.0 + b.1 - b.0 <= LINES
        {
            return self.cut_at_lines(arc, [a, b], chords);
        }
        let area = arc.area();
        let halves = [arc.between(0.0, 0.5), arc.between(0.5, 1.0)];
        // Not so where numbers that are too large or too small have left no arc of them.
        let is_halved = halves[0].area() + halves[1].area() < LEFT * area;
        if area > NEGLECTED && is_halved {
            for half in &halves {
                self.cut(half, chords);
            }
            return;
        }
        chords.sum.bound += if area.is_nan() { 1.0 } else { area };
        chords.points.push(arc.end);
    }

    fn cut_at_lines(&self, arc: &Arc, lines: [(f64, f64); 2], chords: &mut Chords) {
        let points = [arc.start, arc.control, arc.end];
        let below = points.map(|p| form(&self.below, p));
        let mut cuts = vec![1.0];
        for (across, (first, last)) in self.across.iter().zip(lines) {
            let values = points.map(|p| form(across, p));
            let mut line = first;
            while line <= last {
                let f = [0, 1, 2].map(|i| values[i] - line * below[i]);
                cuts.extend(
                    roots(f[0], 2.0 * arc.weight * f[1], f[2])
                        .into_iter()
                        .flatten(),
                );
                line += 1.0;
            }
        }
        cuts.sort_by(f64::total_cmp);
        let mut before = 0.0;
        for cut in cuts {
            if cut > before {
                let piece = arc.between(before, cut);
                let middle = piece.at(0.5);
                let depth = 1.0 / form(&self.below, middle);
                let [a, b] = self
                    .across
                    .map(|across| square_wave(form(&across, middle) * depth));
                chords.sum.add(self.between_lines(&piece, a * b));
                chords.points.push(piece.end);
            }
            before = cut;
        }
    }

    /// The sliver of an arc within a square between whose lines it was cut, wherever those are to within roundings.
    fn between_lines(&self, arc: &Arc, sign: f64) -> Sum {
        let mut sum = within_a_square(arc, sign);
        sum.bound += self.blurred([arc.start, arc.control, arc.end].into_iter());
        sum
    }

    /// The sign of the square that an arc's triangle lies in, if it is one.
    fn one_square(&self, arc: &Arc) -> Option<f64> {
        let mut sign = 1.0;
        for i in 0..2 {
            let (first, last) = self.lines(arc, i)?;
            if first <= last {
                return None;
            }
            sign *= square_wave(last);
        }
        Some(sign)
    }

    /// The first and the last line of a family, a = i or b = i, that may cross an arc; unless it nears the horizon.
    fn lines(&self, arc: &Arc, family: usize) -> Option<(f64, f64)> {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for p in [arc.start, arc.control, arc.end] {
            let level = form(&self.below, p);
            if level <= 0.0 {
                return None;
            }
            let (t, off) = self.place(family, p, level);
            low = low.min(t - off);
            high = high.max(t + off);
        }
        Some((low.floor() + 1.0, high.floor()))
    }
}

fn within_a_square(arc: &Arc, sign: f64) -> Sum {
    let area = arc.area();
    Sum {
        value: sign * area,
        bound: 16.0 * UNIT * area,
    }
}

/// The points of an arc at which it was cut, and the sum of the slivers between.
struct Chords {
    points: Vec<DVec2>,
    sum: Sum,
}

/// The roots in (0, 1) of f0·(1 − t)² + f1·t(1 − t) + f2·t².
fn roots(f0: f64, f1: f64, f2: f64) -> [Option<f64>; 2] {
    // Of squares as large as numbers can be the products would vanish.
    let scale = 1.0 / f0.abs().max(f1.abs()).max(f2.abs());
    let [f0, f1, f2] = [f0 * scale, f1 * scale, f2 * scale];
    let discriminant = f1 * f1 - 4.0 * f0 * f2;
    if discriminant < 0.0 {
        return [None, None];
    }
    // In r = t/(1 − t): f2·r² + f1·r + f0, and t = r/(1 + r), neither of the roots by a difference of like numbers.
    let q = -0.5 * (f1 + discriminant.sqrt().copysign(f1));
    [(q, f2), (f0, q)].map(|(above, below)| {
        let t = above / (above + below);
        (t > 0.0 && t < 1.0).then_some(t)
    })
}
