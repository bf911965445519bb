//! Integrates the sign of a checkerboard's picture, +1 or −1, over a polygon. The integral is
//! computed square by square with 256-bit numbers.

use dashu_int::IBig;
use glam::DVec2;

use super::oracle::{N, Number};
use crate::math::Real;

/// Arithmetic of the computations with a checkerboard: every result is rounded to 256 bits.
pub const NUMBER: Number = Number { bits: 256 };

/// A checkerboard seen by a camera, as linear forms a·x + b·y + c that map a point (x, y) of the
/// picture to the board. Each form is given by its three coefficients.
pub struct ExactBoard {
    /// The linear forms N_a and N_b. The point (x, y) of the picture shows the point (N_a/L, N_b/L)
    /// of the board, in squares, where L is the form `denominator`.
    pub numerators: [[N; 3]; 2],
    /// The linear form L, the denominator of the coordinates N_a/L and N_b/L on the board.
    pub denominator: [N; 3],
}

/// A point of the picture.
pub type Point = [N; 2];

impl ExactBoard {
    /// Returns a board whose linear forms N_a, N_b and L differ from `forms` by rounding errors.
    /// Each coefficient is multiplied by 1 + k·u, where k is the corresponding entry of
    /// `roundings`, from −1 to 1, and u is the unit roundoff of `f64`.
    pub fn of_rounded(forms: [[f64; 3]; 3], roundings: [[f64; 3]; 3]) -> Self {
        let [a, b, denominator] = [0, 1, 2].map(|i| {
            [0, 1, 2].map(|k| {
                let rounding = NUMBER.exact(roundings[i][k] * f64::UNIT);
                NUMBER.exact(forms[i][k]) * (NUMBER.exact(1.0) + rounding)
            })
        });
        Self {
            numerators: [a, b],
            denominator,
        }
    }

    /// Integrates the board's sign, +1 on even and −1 on odd squares, over a convex polygon with
    /// corners in `f64`. The denominator must be positive on the polygon.
    pub fn integral(&self, polygon: &[DVec2]) -> N {
        self.integral_of(polygon.iter().copied().map(point).collect())
    }

    /// Integrates the board's sign, +1 on even and −1 on odd squares, over a convex polygon with
    /// corners of any precision. The denominator must be positive on the polygon.
    pub fn integral_of(&self, polygon: Vec<Point>) -> N {
        let mut sum = N::ZERO;
        self.strips(0, polygon, &mut |row, strip| {
            self.strips(1, strip, &mut |column, square| {
                let area = area(&square);
                let is_odd = (row + column) & IBig::ONE == IBig::ONE;
                sum += if is_odd { -area } else { area };
            });
        });
        sum
    }

    /// Returns the number of the board's grid lines, in both directions, that cross a convex
    /// polygon. Returns 1 if no line crosses it.
    pub fn lines(&self, polygon: &[DVec2]) -> usize {
        let mut count = 0;
        for family in 0..2 {
            let polygon = polygon.iter().copied().map(point).collect();
            self.strips(family, polygon, &mut |_, _| count += 1);
        }
        // In each of the two directions, n lines divide the polygon into n + 1 strips. The number
        // of lines is therefore the number of strips minus 2.
        (count - 2).max(1)
    }

    /// Divides the polygon into strips along the grid lines on which the board's coordinate with
    /// the index `family` is an integer. Calls `visit` with each strip, and with the integer of the
    /// grid line at the strip's start.
    fn strips(&self, family: usize, polygon: Vec<Point>, visit: &mut dyn FnMut(&IBig, Vec<Point>)) {
        let numerator = &self.numerators[family];
        let square = |p: &Point| {
            (form(numerator, p) / form(&self.denominator, p))
                .floor()
                .to_int()
                .value()
        };
        let Some(mut first) = polygon.iter().map(square).min() else {
            return;
        };
        let mut rest = polygon;
        while rest.len() > 2 {
            let next = &first + IBig::ONE;
            let n = N::from(next.clone()).with_precision(NUMBER.bits).value();
            let line = [0, 1, 2].map(|k| &numerator[k] - &n * &self.denominator[k]);
            let [before, beyond] = split(&rest, &line);
            if before.len() > 2 {
                visit(&first, before);
            }
            (rest, first) = (beyond, next);
        }
    }
}

/// Converts a point of the picture to 256-bit numbers.
pub fn point(at: DVec2) -> Point {
    [at.x, at.y].map(|x| NUMBER.exact(x))
}

/// Returns the value of a linear form at a point.
pub fn form([a, b, c]: &[N; 3], [x, y]: &Point) -> N {
    a * x + b * y + c
}

/// Divides a convex polygon along the line on which a linear form is zero. Returns the part on
/// which the form is negative, and the part on which it is positive.
pub fn split(polygon: &[Point], line: &[N; 3]) -> [Vec<Point>; 2] {
    let mut parts = [Vec::new(), Vec::new()];
    let values: Vec<N> = polygon.iter().map(|p| form(line, p)).collect();
    for (i, to) in polygon.iter().enumerate() {
        let before = (i + polygon.len() - 1) % polygon.len();
        let (from, [start, end]) = (&polygon[before], [before, i].map(|i| &values[i]));
        let [starts_below, is_below] = [start, end].map(|value| *value < N::ZERO);
        if starts_below != is_below {
            let t = start / (start - end);
            let at = [0, 1].map(|k| &from[k] + (&to[k] - &from[k]) * &t);
            parts.iter_mut().for_each(|part| part.push(at.clone()));
        }
        parts[usize::from(!is_below)].push(to.clone());
    }
    parts
}

/// Returns the area of a convex polygon.
pub fn area(polygon: &[Point]) -> N {
    let mut twice = N::ZERO;
    for (i, [x, y]) in polygon.iter().enumerate() {
        let [next_x, next_y] = &polygon[(i + 1) % polygon.len()];
        twice += x * next_y - next_x * y;
    }
    let twice = if twice < N::ZERO { -twice } else { twice };
    twice / NUMBER.exact(2.0)
}
