//! Integrates a checkerboard's sign, 1 on squares of one colour and −1 on the others, over eight
//! pixels at once, in lanes that the compiler vectorises.
//!
//! In: eight pixels that show only a checkerboard. The board has two families of lines, those
//! between columns and those between rows of squares. All eight pixels are crossed by the same
//! number of lines of each family. Out: the integral over each pixel, with a bound on the rounding
//! errors of areas and on the displacement of lines by rounding.
//!
//! The lines of the family with fewer lines cut the pixel into strips i = 0, 1, … Strip i has the
//! sign σ_i = (−1)^i, which alternates from strip to strip. The lines of the other family that
//! cross the pixel have the numbers k = 1, 2, … A line k divides the plane into two half-planes.
//! Let H_k be the one in which the squares have greater numbers, and W_k the sum of the areas of
//! the strips in H_k, each multiplied by its sign:
//!
//! W_k = Σ_i σ_i·|strip i ∩ H_k|.
//!
//! W_0 is the same sum over the whole strips, and s_0 the sign of the pixel's first square. Because
//! the sign of the squares changes at each line, the integral of the board's sign over the pixel is
//!
//! s_0·(W_0 + 2·Σ_k (−1)^k·W_k).
//!
//! A strip's area beyond a line is a sum over the strip's sides, each from a point p to a point q:
//!
//! ½·Σ f·(p − O) × (q − p).
//!
//! Here f is the fraction of the side that lies beyond the line, and O is a point on the line. With
//! this choice of O, the part of the outline along the line contributes 0. Each side of the pixel
//! has a part in each strip, which may be empty. The two ends of an empty part are exactly the same
//! point, so it adds exactly 0.

use std::array;

use glam::DVec2;
use multiversion::multiversion;

use super::{
    super::clip::PIXEL,
    homography::{BoundedSum, UNIT},
    special::square_wave,
};
use crate::tracer::{CheckerForms, CheckerPixel, LocalForm};

/// Maximum number of lines that cut a pixel into strips. A pixel that is crossed by more lines of
/// both families of the board is computed alone. With 6 lines, the buffer contains 34 sides of 320
/// bytes each, which fit into the first-level cache.
pub(super) const MAX_STRIP_LINES: usize = 6;

/// Number of pixels that are computed at once. The widest vector registers hold eight `f64`.
pub(super) const PIXELS: usize = 8;

/// One number for each of the eight pixels that are computed at once.
type Lanes = [f64; PIXELS];

/// Maximum number of sides of a pixel's strips: four parts of the pixel's sides for each strip, and
/// one chord for each line between strips.
const SIDES: usize = 4 * (MAX_STRIP_LINES + 1) + MAX_STRIP_LINES;

/// The linear forms of eight pixels' boards. Of the board's two families of lines, the one with
/// fewer lines in the pixel comes first.
#[derive(Debug, Default)]
pub(super) struct BoardLanes {
    few: FormRows,
    many: FormRows,
    denominator: FormRows,
    /// Sign by which each pixel's integral is multiplied at the end. The integral is computed as if
    /// the pixel's first square had the board's first colour. The sign is −1 if this square has the
    /// second colour. The first square is in the column and the row with the least numbers that the
    /// pixel shows.
    sign: Lanes,
    /// Column number, or row number, of the square at each of the four corners of each pixel. It is
    /// counted from the pixel's first column or row. It is the row number if fewer lines between
    /// rows than between columns cross the pixel, and otherwise the column number.
    squares: [Lanes; 4],
}

/// One linear form per pixel: the factors of x, y and 1, and the maximum error of the form's
/// values.
#[derive(Debug, Default)]
struct FormRows {
    factors: [Lanes; 3],
    rad: Lanes,
}

impl FormRows {
    fn set(&mut self, place: usize, form: &LocalForm) {
        for (row, factor) in self.factors.iter_mut().zip(form.factors) {
            row[place] = factor;
        }
        self.rad[place] = form.rad;
    }
}

/// One directed side of a strip for each of eight pixels: the side's start and its vector, in
/// pixels, and the strip's sign.
#[derive(Clone, Copy, Debug, Default)]
struct Sides {
    start: [Lanes; 2],
    step: [Lanes; 2],
    sign: Lanes,
}

/// Reusable buffer for the sides of the strips.
#[derive(Debug)]
pub(super) struct StripBuffer([Sides; SIDES]);

impl Default for StripBuffer {
    fn default() -> Self {
        Self([Sides::default(); SIDES])
    }
}

/// The integral of the board's sign over each of eight pixels, positive for the first colour, and
/// its error bound, in square pixels.
pub(super) struct LaneSums {
    values: Lanes,
    bounds: Lanes,
}

impl LaneSums {
    pub fn pixel(&self, pixel: usize) -> BoundedSum {
        let (value, bound) = (self.values[pixel], self.bounds[pixel]);
        BoundedSum {
            value,
            // If squares are extremely large, products overflow, and the sum is NaN. The bound is
            // then infinite.
            bound: if value.is_nan() { f64::INFINITY } else { bound },
        }
    }
}

impl BoardLanes {
    /// Sets the board of the pixel with the index `place`, from 0 to 7. A board has two families of
    /// parallel lines, those between columns (0) and those between rows (1). `families` lists the
    /// family with fewer lines in the pixel first. `first` holds the numbers of the pixel's first
    /// column and first row of squares.
    pub fn set(
        &mut self,
        place: usize,
        checks: &CheckerPixel,
        families: [usize; 2],
        first: [f64; 2],
    ) {
        let CheckerForms {
            numerators,
            denominator,
            odd,
        } = &checks.squares;
        let [few, many] =
            families.map(|family| numerators[family].less(first[family], denominator));
        self.few.set(place, &few);
        self.many.set(place, &many);
        self.denominator.set(place, denominator);
        let [above_left, above_right, below_left, below_right] = checks.corners[families[0]];
        let around = [above_left, above_right, below_right, below_left];
        for (row, square) in self.squares.iter_mut().zip(around) {
            row[place] = square - first[families[0]];
        }
        let wave = square_wave(first[0] + first[1]);
        self.sign[place] = if *odd { -wave } else { wave };
    }

    /// Computes the integral of the board's sign over each pixel. `lines` contains two numbers: how
    /// many lines of each of the board's two families cross every pixel. The smaller number comes
    /// first.
    pub fn sums(&self, lines: [usize; 2], buffer: &mut StripBuffer) -> LaneSums {
        sums_simd(self, lines, buffer)
    }

    #[inline(always)]
    fn compute(&self, [few, many]: [usize; 2], StripBuffer(sides): &mut StripBuffer) -> LaneSums {
        let sides = &mut sides[..4 * (few + 1) + few];
        let failed = self.strips(few, sides);
        let (mut sums, mut lengths, mut offs) = ([0.0; PIXELS], [0.0; PIXELS], [0.0; PIXELS]);
        for side in &*sides {
            for i in 0..PIXELS {
                let (x, y) = (side.step[0][i], side.step[1][i]);
                sums[i] += 0.5 * side.sign[i] * (side.start[0][i] * y - side.start[1][i] * x);
                lengths[i] += side.sign[i].abs() * (x.abs() + y.abs());
            }
        }
        let mut displaced = [0.0; PIXELS];
        for line in 0..few + 2 {
            self.add_off(&self.few, line as f64, &mut displaced);
        }
        for line in 0..many + 2 {
            self.add_off(&self.many, line as f64, &mut offs);
        }
        for line in 1..=many {
            let sign = if line % 2 == 0 { 1.0 } else { -1.0 };
            let beyond = self.beyond(line as f64, sides);
            for i in 0..PIXELS {
                sums[i] += sign * beyond[i];
            }
        }
        // Rounding errors: for every line, the part of a side beyond the line is computed by eight
        // operations from the side's length and a distance of at most √2. A strip has five sides,
        // four of them on sides of the pixel. Adding a side causes one rounding, and adding the sum
        // for a line causes two. The rounding of the strips' corners may also displace each line
        // between strips, and the next line on either side of the pixel, by four unit roundoffs.
        //
        // A displaced line sweeps an area of at most √2, the pixel's diagonal, times its
        // displacement. In this area, the sign is wrong, so the error is twice the area.
        // Displacements are multiplied by 3, which exceeds 2√2.
        let [strips, lines] = [few + 1, many + 1].map(|count| count as f64);
        let points = 4.0 * UNIT * (strips + 1.0);
        LaneSums {
            values: array::from_fn(|i| self.sign[i] * sums[i]),
            bounds: array::from_fn(|i| {
                let roundings = UNIT * lines * (16.0 * lengths[i] + 8.0 * strips + 2.0 * lines);
                let displaced = offs[i] * (1.0 + strips) + displaced[i] + points;
                3.0 * displaced + roundings + failed[i]
            }),
        }
    }

    /// Adds to `out` the maximum distance, in pixels, between the true line number `n` of one
    /// family of the board's lines and the computed line. The error consists of the forms' own
    /// errors, three roundings of their factors, and four roundings of their values.
    #[inline(always)]
    fn add_off(&self, across: &FormRows, n: f64, out: &mut Lanes) {
        let denominator = &self.denominator;
        for (i, out) in out.iter_mut().enumerate() {
            let size =
                |k: usize| across.factors[k][i].abs() + (n * denominator.factors[k][i]).abs();
            let slope = |k: usize| (across.factors[k][i] - n * denominator.factors[k][i]).abs();
            let roundings = 7.0 * UNIT * (0.5 * (size(0) + size(1)) + size(2));
            let value = roundings + across.rad[i] + n * denominator.rad[i];
            *out += value / slope(0).max(slope(1));
        }
    }

    /// Cuts each pixel into `few` + 1 strips and writes the strips' sides to `sides`. The signs of
    /// the strips alternate and start with 1. Returns a number to add to each pixel's error bound:
    /// 0, or infinity if the pixel could not be cut.
    #[inline(always)]
    fn strips(&self, few: usize, sides: &mut [Sides]) -> Lanes {
        let mut failed = [0.0; PIXELS];
        let (parts, chords) = sides.split_at_mut(4 * (few + 1));
        // For each side of the pixel, the position up to which earlier strips cover the side. The
        // strips start at the end with the smaller square number. A position is 0 at the side's
        // start and 1 at its end.
        let mut reached = [[0.0; PIXELS]; 4];
        for (corner, reached) in reached.iter_mut().enumerate() {
            let [here, next] = [corner, (corner + 1) % 4].map(|corner| &self.squares[corner]);
            for (i, reached) in reached.iter_mut().enumerate() {
                *reached = if next[i] >= here[i] { 0.0 } else { 1.0 };
            }
        }
        for strip in 0..=few {
            let sign = if strip % 2 == 0 { 1.0 } else { -1.0 };
            let (n, is_last) = ((strip + 1) as f64, strip == few);
            let mut ends = [[[0.0; PIXELS]; 2]; 2];
            let mut crossings = [[0.0; PIXELS]; 2];
            for corner in 0..4 {
                let (from, to) = (PIXEL[corner], PIXEL[(corner + 1) % 4]);
                let [here, next] = [corner, (corner + 1) % 4].map(|corner| &self.squares[corner]);
                let part = &mut parts[4 * strip + corner];
                let [x, y] = [to.x - from.x, to.y - from.y];
                let value = |line: [f64; 3], p: DVec2| line[0] * p.x + line[1] * p.y + line[2];
                let mut places = [0.0; PIXELS];
                let mut crossed = [[0.0; PIXELS]; 2];
                for i in 0..PIXELS {
                    let factor =
                        |k: usize| self.few.factors[k][i] - n * self.denominator.factors[k][i];
                    let line = [factor(0), factor(1), factor(2)];
                    let (start, end) = (value(line, from), value(line, to));
                    let place = start / (start - end);
                    let place = if place > 0.0 { place } else { 0.0 };
                    let place = if place < 1.0 { place } else { 1.0 };
                    // After the last strip, there is no line. Both ends of each side of the pixel
                    // are then treated as lying before the line, so that all parts reach to the
                    // ends of their sides.
                    let (starts_below, ends_below) =
                        (is_last | (here[i] < n), is_last | (next[i] < n));
                    let is_up = next[i] >= here[i];
                    let whole = if starts_below == is_up { 1.0 } else { 0.0 };
                    places[i] = if starts_below != ends_below {
                        place
                    } else {
                        whole
                    };
                    // If the line's form has the same value at both ends of the pixel's side, the
                    // crossing cannot be computed, and the pixel cannot be cut.
                    let known = if start == end { f64::INFINITY } else { 1.0 };
                    crossed[0][i] = if starts_below & !ends_below {
                        known
                    } else {
                        0.0
                    };
                    crossed[1][i] = if ends_below & !starts_below {
                        known
                    } else {
                        0.0
                    };
                }
                for i in 0..PIXELS {
                    let is_up = next[i] >= here[i];
                    let (before, place) = (reached[corner][i], places[i]);
                    let first = if is_up { before } else { place };
                    let second = if is_up { place } else { before };
                    let (start_x, start_y) = (from.x + x * first, from.y + y * first);
                    part.start[0][i] = start_x;
                    part.start[1][i] = start_y;
                    part.step[0][i] = (from.x + x * second) - start_x;
                    part.step[1][i] = (from.y + y * second) - start_y;
                    part.sign[i] = sign;
                }
                for way in 0..2 {
                    for i in 0..PIXELS {
                        let is_way = crossed[way][i] > 0.0;
                        let (at_x, at_y) = (from.x + x * places[i], from.y + y * places[i]);
                        ends[way][0][i] += if is_way { at_x } else { 0.0 };
                        ends[way][1][i] += if is_way { at_y } else { 0.0 };
                        crossings[way][i] += crossed[way][i];
                    }
                }
                reached[corner] = places;
            }
            let Some(chord) = chords.get_mut(strip) else {
                break;
            };
            // The chord is stored with a direction: from the point where the pixel's boundary
            // enters the strips before the line, to the point where the boundary leaves these
            // strips. The chord is a side of two strips. In the outline of the strip after the
            // line, the chord has the stored direction. In the outline of the strip before the
            // line, it has the opposite direction. Because the two strips have opposite signs, the
            // chord's total weight is −2 times the sign of the strip before the line.
            let [up, down] = ends;
            for i in 0..PIXELS {
                let is_one = (crossings[0][i] == 1.0) & (crossings[1][i] == 1.0);
                failed[i] += if is_one { 0.0 } else { f64::INFINITY };
                for axis in 0..2 {
                    chord.start[axis][i] = down[axis][i];
                    chord.step[axis][i] = up[axis][i] - down[axis][i];
                }
                chord.sign[i] = -2.0 * sign;
            }
        }
        failed
    }

    /// Returns twice the signed area of those parts of the strips that lie beyond a line. The line
    /// belongs to the family of the board's lines with more lines in the pixel. Its number is
    /// `line`, counted from the pixel's first square.
    #[inline(always)]
    fn beyond(&self, line: f64, sides: &[Sides]) -> Lanes {
        let mut area = [0.0; PIXELS];
        let (mut form, mut origin) = ([[0.0; PIXELS]; 3], [[0.0; PIXELS]; 2]);
        for i in 0..PIXELS {
            let factor = |k: usize| self.many.factors[k][i] - line * self.denominator.factors[k][i];
            let (x, y, z) = (factor(0), factor(1), factor(2));
            let foot = -z / (x * x + y * y);
            (form[0][i], form[1][i], form[2][i]) = (x, y, z);
            origin[0][i] = foot * x;
            origin[1][i] = foot * y;
        }
        for side in sides {
            let (start, step, sign) = (&side.start, &side.step, &side.sign);
            for i in 0..PIXELS {
                let (x, y) = (start[0][i], start[1][i]);
                let (across, down) = (step[0][i], step[1][i]);
                let value = |x: f64, y: f64| (form[0][i] * x + form[1][i] * y) + form[2][i];
                let (here, there) = (value(x, y), value(x + across, y + down));
                let beyond = here.max(0.0) + there.max(0.0);
                // If a side lies on the line, both values are 0, and the side contributes 0 without
                // a division by 0.
                let all = here.abs() + there.abs() + f64::MIN_POSITIVE;
                let twice = (x - origin[0][i]) * down - (y - origin[1][i]) * across;
                area[i] += sign[i] * twice * (beyond / all);
            }
        }
        area
    }
}

#[multiversion(targets(
    "x86_64+avx512bw+avx512cd+avx512dq+avx512f+avx512vl+bmi1+bmi2+fma+lzcnt+popcnt",
    "x86_64+avx2+bmi1+bmi2+fma+lzcnt+popcnt",
))]
fn sums_simd(pixels: &BoardLanes, lines: [usize; 2], buffer: &mut StripBuffer) -> LaneSums {
    pixels.compute(lines, buffer)
}
