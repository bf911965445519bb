//! The squares of a checkerboard at the corners of many pixels at once.
//!
//! In: a block of pixels in which only one board is seen. Out: runs of pixels (neighbours in a row)
//! that show one colour, and for every other pixel the squares that it shows.
//!
//! Other parts of the picture are divided recursively into quarters. A part with only a board would
//! mostly be divided down to single pixels. The square at a corner would then be computed four
//! times, once for each pixel that shares the corner. Here, the square at each corner of a block's
//! pixels is computed only once, row by row in plain arrays, which the compiler vectorizes. A
//! coordinate on the board is a ratio of linear forms, which has its extremes over a pixel at the
//! pixel's corners. A pixel therefore shows only one square if all its corners lie in this square,
//! farther from the square's edges than the error bound.

use std::{array, ops::ControlFlow};

use multiversion::multiversion;

use super::{
    checkerboard::LocalBoard,
    local_form::{LOCAL_ROUNDING, LocalForm},
    object::Object,
    world::{Precision, World},
};
use crate::{
    area::Area,
    math::{Double, ROUND, Real, UP, floor},
};

/// Minimum ratio of ℓ to its error bound f, where N/ℓ is a coordinate on the board, a quotient of
/// linear forms. If the ratio is smaller, the coordinate's error is treated as unbounded.
///
/// Let e be the error bound of N. If the ratio is at least 4, (N ± e)/(ℓ ± f) differs from N/ℓ by
/// at most 4/3 · (e + f·|N/ℓ|)/ℓ. The code uses the factor 4 instead of 4/3, which leaves a margin.
const MIN_CLEARANCE: f64 = 4.0;

/// Maximum error of a board coordinate, in squares. If the error is larger, the squares in a pixel
/// are not derived from the coordinates of its corners. With an error of 1/4, the square at a
/// corner is certain only if the corner lies in the middle half of the square's width. With a
/// larger error, few squares would be certain.
const MAX_COORDINATE_ERROR: f64 = 0.25;

/// Maximum side of a block of pixels, in pixels. The checkerboard squares at all pixel corners of a
/// block are computed together. The picture is first divided into blocks of this side, which are
/// then quartered recursively, so the side is a power of two. A smaller block would compute more
/// corners per pixel, because a block of n² pixels has (n + 1)² corners. A larger block would need
/// larger arrays.
pub(super) const SIDE: usize = 32;

/// Number of array entries for one row of pixel corners in a block. A block of 32 pixels has 33
/// corners in a row. This number is rounded up to a multiple of eight, the length of the widest
/// vectors.
const LANES: usize = 40;

/// The squares of a board in one pixel, derived from the squares at the pixel's corners.
#[derive(Clone, Copy, Debug)]
pub struct CheckerPixel {
    pub(crate) squares: CheckerForms,
    /// The squares at the pixel's four corners, by their indices in x and in z. The order of the
    /// corners is top left, top right, bottom left, bottom right.
    pub(crate) corners: [[f64; 4]; 2],
    /// Whether each corner of the pixel certainly lies in its square in `corners`. If not, a corner
    /// may lie in a neighbouring square instead. The error bounds in the field `squares` are then
    /// large enough for both squares.
    pub(crate) is_certain: bool,
}

/// A block of pixels in which only one board is seen.
struct BoardBlock {
    block: Area,
    squares: CheckerForms,
    /// Minimum distance, in squares, of a corner from the edges of its square, for x and for z. At
    /// a smaller distance, the square of the corner is uncertain.
    slack: [f64; 2],
    /// The position x of each column of pixel corners, measured from the block's centre in units of
    /// the block's width.
    columns: [f64; LANES],
}

/// The squares at one row of pixel corners in a block.
struct CornerRow {
    /// The square of each corner, by its indices in x and in z; NaN if the square is uncertain.
    squares: [[f64; LANES]; 2],
    /// The parity of each corner's square: 1 if the sum of its two indices is even, −1 if it is
    /// odd.
    sign: [f64; LANES],
}

/// The squares of a checkerboard that are seen in a run of pixels (neighbours in a row), or in one
/// pixel.
#[derive(Clone, Copy, Debug)]
pub enum ShownSquares<'a> {
    /// A run of pixels that show one colour; `true` for the second colour.
    One(bool),
    /// One pixel, with the squares that it may show.
    Squares(&'a CheckerPixel),
    /// One pixel whose squares could not be determined.
    Unknown,
}

/// Calls `each` with every run of pixels of `part` that shows one colour of the checkerboard
/// `object`, and with every other pixel, until `each` returns `Break`. The caller ensures that
/// nothing but the board is seen in `part`, and that its sides are at most [`SIDE`] pixels long.
///
/// Returns `None` if the object is not a checkerboard, or if the board is too far away for its
/// squares to be distinguished. Otherwise, returns the last result of `each`.
pub fn show(
    world: &World,
    part: Area,
    object: usize,
    each: &mut impl FnMut(Area, ShownSquares) -> ControlFlow<()>,
) -> Option<ControlFlow<()>> {
    let Object::Checkerboard(board) = &*Double::object(&world.geometry, object) else {
        return None;
    };
    let camera = &Double::frame(&world.geometry).camera;
    let sides = [part.width, part.height]
        .map(|pixels| camera.pitch.times(&Double::from_f64(f64::from(pixels))));
    let board = board.local(&camera.direction(&camera.middle(part)), &sides);
    let board_block = BoardBlock::new(CheckerForms::new(&board), part)?;
    let [mut above, mut below] = [CornerRow::new(), CornerRow::new()];
    board_block.corners(0, &mut above);
    for row in 0..part.height {
        board_block.corners(row + 1, &mut below);
        let flow = board_block.row(row, &above, &below, each);
        if flow.is_break() {
            return Some(flow);
        }
        std::mem::swap(&mut above, &mut below);
    }
    Some(ControlFlow::Continue(()))
}

impl CornerRow {
    fn new() -> Self {
        Self {
            squares: [[0.0; LANES]; 2],
            sign: [0.0; LANES],
        }
    }

    /// Returns the indices in x and z of the square at the pixel corner in column `column`.
    fn at(&self, column: usize) -> [f64; 2] {
        [self.squares[0][column], self.squares[1][column]]
    }
}

impl BoardBlock {
    /// Prepares a block of pixels. Returns `None` if the board is too far away for its squares to
    /// be distinguished.
    fn new(squares: CheckerForms, block: Area) -> Option<Self> {
        let CheckerForms { numerators, .. } = squares;
        let least = squares.least()?;
        let slack = numerators.map(|form| {
            let greatest = (form.factors[2].abs() + form.spread() + form.rad) / least;
            squares.slack(&form, greatest, least)
        });
        if !slack.iter().all(|&slack| slack < MAX_COORDINATE_ERROR) {
            return None;
        }
        let mut columns = [0.0; LANES];
        for (column, x) in columns.iter_mut().enumerate() {
            *x = middle(2 * column as u32, block.width);
        }
        Some(Self {
            block,
            squares,
            slack,
            columns,
        })
    }

    fn corners(&self, row: u32, out: &mut CornerRow) {
        let y = middle(2 * row, self.block.height);
        let length = (self.block.width as usize + 1).next_multiple_of(8);
        corners_simd(self, y, length, out);
    }

    #[inline(always)]
    fn evaluate(&self, y: f64, length: usize, out: &mut CornerRow) {
        const ONE: u64 = 1.0f64.to_bits();
        let CheckerForms {
            numerators,
            denominator,
            ..
        } = &self.squares;
        let [n0, n1, l] = [&numerators[0], &numerators[1], denominator].map(|local| {
            let [a, b, c] = local.factors;
            (a, b * y + c)
        });
        let CornerRow {
            squares: [first, second],
            sign,
        } = out;
        let columns = &self.columns[..length];
        let out = first[..length]
            .iter_mut()
            .zip(&mut second[..length])
            .zip(&mut sign[..length]);
        for (&x, ((first, second), sign)) in columns.iter().zip(out) {
            let inverse = 1.0 / (l.0 * x + l.1);
            let square = |n: (f64, f64), slack: f64| {
                let middle = (n.0 * x + n.1) * inverse - 0.5;
                let rounded = middle + ROUND;
                let whole = rounded - ROUND;
                let margin = 0.5 - (middle - whole).abs();
                let square = if margin > slack { whole } else { f64::NAN };
                (square, rounded.to_bits())
            };
            let ((square0, bits0), (square1, bits1)) =
                (square(n0, self.slack[0]), square(n1, self.slack[1]));
            (*first, *second) = (square0, square1);
            *sign = f64::from_bits(ONE | (bits0 ^ bits1) << 63);
        }
    }

    /// Calls `each` with the runs of pixels that show one colour, and with the other pixels, in row
    /// `row`. The row lies between the rows of corners `above` and `below`. Stops if `each` returns
    /// `Break`.
    fn row(
        &self,
        row: u32,
        above: &CornerRow,
        below: &CornerRow,
        each: &mut impl FnMut(Area, ShownSquares) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let mut shown = [0.0; SIDE];
        compare_simd(above, below, &mut shown);
        let shown = &shown[..self.block.width as usize];
        let mut first = 0;
        while first < shown.len() {
            let sign = shown[first];
            let mut area = Area {
                x: self.block.x + first as u32,
                y: self.block.y + row,
                width: 1,
                height: 1,
            };
            if sign == 0.0 {
                match self.checks(row, first, above, below) {
                    Some(checks) => each(area, ShownSquares::Squares(&checks))?,
                    None => each(area, ShownSquares::Unknown)?,
                }
                first += 1;
                continue;
            }
            let rest = shown[first..].iter();
            let length = rest.take_while(|&&other| other == sign).count();
            area.width = length as u32;
            each(area, ShownSquares::One((sign < 0.0) ^ self.squares.odd))?;
            first += length;
        }
        ControlFlow::Continue(())
    }

    /// Returns the squares in which the corners of a pixel lie. They are uncertain (`is_certain` is
    /// `false`) if a corner is too close to a line between squares. Returns `None` if the index of
    /// a square is not finite.
    fn checks(
        &self,
        row: u32,
        column: usize,
        above: &CornerRow,
        below: &CornerRow,
    ) -> Option<CheckerPixel> {
        let certain = [
            above.at(column),
            above.at(column + 1),
            below.at(column),
            below.at(column + 1),
        ];
        let is_certain = !certain.as_flattened().iter().any(|square| square.is_nan());
        let (corners, doubt) = if is_certain {
            (certain, [0.0; 2])
        } else {
            self.probable(certain, column, row)?
        };
        let Area { width, height, .. } = self.block;
        let x = middle(2 * column as u32 + 1, width);
        let y = middle(2 * row + 1, height);
        let [width, height] = [width, height].map(f64::from);
        let local = |block: &LocalForm| {
            let [a, b, c] = block.factors;
            // The error bound of the block's form is doubled, so that it also covers the rounding
            // errors of the three factors computed here.
            LocalForm::new([a / width, b / height, a * x + b * y + c], 2.0 * block.rad)
        };
        let CheckerForms {
            numerators,
            denominator,
            odd,
        } = &self.squares;
        let denominator = local(denominator);
        let mut numerators = numerators.each_ref().map(local);
        if !is_certain {
            let greatest = denominator.factors[2].abs() + denominator.spread();
            for (numerator, doubt) in numerators.iter_mut().zip(doubt) {
                numerator.rad += doubt * greatest * UP;
            }
        }
        Some(CheckerPixel {
            squares: CheckerForms {
                numerators,
                denominator,
                odd: *odd,
            },
            corners: [0, 1].map(|axis| corners.map(|corner| corner[axis])),
            is_certain,
        })
    }

    /// Replaces each uncertain index (NaN) in `corners` by the index of the square at the corner's
    /// computed position, and returns all indices. Also returns, for x and z, an upper bound of the
    /// distance, in squares, from an uncertain corner to the nearest line between squares; 0 if no
    /// corner is uncertain. Returns `None` if a quotient is not finite.
    #[cold]
    fn probable(
        &self,
        mut corners: [[f64; 2]; 4],
        column: usize,
        row: u32,
    ) -> Option<([[f64; 2]; 4], [f64; 2])> {
        let mut doubt = [0.0; 2];
        for (place, corner) in (0..).zip(&mut corners) {
            let x = self.columns[column + place % 2];
            let y = middle(2 * (row + place as u32 / 2), self.block.height);
            for axis in 0..2 {
                if corner[axis].is_nan() {
                    corner[axis] = floor(
                        self.squares.numerators[axis].at(x, y) / self.squares.denominator.at(x, y),
                    );
                    // The corner is uncertain, so its computed coordinate is at most `slack` from a
                    // line between squares. The true coordinate is at most `slack` from the
                    // computed one, so it is at most twice `slack` from the line.
                    doubt[axis] = 2.0 * self.slack[axis];
                }
            }
        }
        let is_known = corners
            .as_flattened()
            .iter()
            .all(|square| square.is_finite());
        is_known.then_some((corners, doubt))
    }
}

impl CheckerPixel {
    /// Returns the indices of the first and the last square in the pixel, for x and for z.
    pub(crate) fn ranges(&self) -> [(f64, f64); 2] {
        self.corners.map(|squares| {
            let low = squares.into_iter().fold(f64::INFINITY, f64::min);
            let high = squares.into_iter().fold(f64::NEG_INFINITY, f64::max);
            (low, high)
        })
    }
}

/// Returns a position along a side of a block, measured from the side's middle in units of its
/// length. The position is `halves` half pixels from the left or top end; the side's length is
/// `pixels` pixels.
fn middle(halves: u32, pixels: u32) -> f64 {
    (f64::from(halves) - f64::from(pixels)) / f64::from(2 * pixels)
}

#[multiversion(targets(
    "x86_64+avx512bw+avx512cd+avx512dq+avx512f+avx512vl+bmi1+bmi2+fma+lzcnt+popcnt",
    "x86_64+avx2+bmi1+bmi2+fma+lzcnt+popcnt",
))]
fn corners_simd(board_block: &BoardBlock, y: f64, length: usize, out: &mut CornerRow) {
    board_block.evaluate(y, length, out);
}

/// Compares the squares at the four corners of each pixel of a row. If they are certain and equal,
/// writes their `sign` (1 or −1) to `out`; otherwise, writes 0.
#[multiversion(targets(
    "x86_64+avx512bw+avx512cd+avx512dq+avx512f+avx512vl+bmi1+bmi2+fma+lzcnt+popcnt",
    "x86_64+avx2+bmi1+bmi2+fma+lzcnt+popcnt",
))]
fn compare_simd(above: &CornerRow, below: &CornerRow, out: &mut [f64; SIDE]) {
    let [a, b] = [&above.squares[0], &below.squares[0]];
    let [c, d] = [&above.squares[1], &below.squares[1]];
    for i in 0..SIDE {
        let first = (a[i] == a[i + 1]) & (a[i] == b[i]) & (a[i] == b[i + 1]);
        let second = (c[i] == c[i + 1]) & (c[i] == d[i]) & (c[i] == d[i + 1]);
        out[i] = if first & second { above.sign[i] } else { 0.0 };
    }
}

/// The position on a checkerboard as ratios of linear forms: x = N₀/ℓ and z = N₁/ℓ, in squares. x
/// and z rounded down are the indices of a square. `numerators` are N₀ and N₁, and `denominator`
/// is ℓ. `odd` is `true` if the square with the indices (0, 0) has the second colour.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CheckerForms {
    pub(crate) numerators: [LocalForm; 2],
    pub(crate) denominator: LocalForm,
    pub(crate) odd: bool,
}

/// Offsets of the four corners of a rectangle from its centre, in units of its sides, x to the
/// right and y down.
const CORNERS: [(f64, f64); 4] = [(-0.5, -0.5), (0.5, -0.5), (-0.5, 0.5), (0.5, 0.5)];

impl CheckerForms {
    pub(super) fn new(board: &LocalBoard) -> Self {
        let [a, b, l] = board.rads;
        Self {
            numerators: [
                LocalForm::new(board.numerators[0], a),
                LocalForm::new(board.numerators[1], b),
            ],
            denominator: LocalForm::new(board.denominator, l),
            odd: board.odd,
        }
    }

    /// Returns the least value of the denominator of the board's coordinates over the rectangle.
    /// Returns `None` if it is not clearly positive.
    fn least(&self) -> Option<f64> {
        let least = self.denominator.factors[2] - self.denominator.spread() * UP;
        (least > MIN_CLEARANCE * self.denominator.rad).then_some(least)
    }

    /// Returns an upper bound of the error of the board coordinate whose numerator is `numerator`.
    /// `greatest` is the maximum absolute value of the coordinate, and `least` the minimum of the
    /// denominator.
    fn slack(&self, numerator: &LocalForm, greatest: f64, least: f64) -> f64 {
        let inherited = (numerator.rad + greatest * self.denominator.rad) * MIN_CLEARANCE / least;
        (inherited + (greatest + 1.0) * LOCAL_ROUNDING) * UP
    }

    /// Returns the indices of the first and the last square in the rectangle, for x and for z. A
    /// range may contain one square too many at each end. Returns `None` if the denominator of the
    /// board's coordinates is not clearly positive or an error is too large.
    pub(super) fn ranges(&self) -> Option<[(f64, f64); 2]> {
        let least = self.least()?;
        let inverse = CORNERS.map(|(x, y)| 1.0 / self.denominator.at(x, y));
        let [x, z] = self.numerators.each_ref().map(|numerator| {
            // A ratio of linear forms has its extremes over the rectangle at the rectangle's
            // corners, so it is evaluated only there.
            let values: [f64; 4] = array::from_fn(|i| {
                let (x, y) = CORNERS[i];
                numerator.at(x, y) * inverse[i]
            });
            let low = values.into_iter().fold(f64::INFINITY, f64::min);
            let high = values.into_iter().fold(f64::NEG_INFINITY, f64::max);
            let size = low.abs().max(high.abs());
            let slack = self.slack(numerator, size, least);
            (slack < MAX_COORDINATE_ERROR).then(|| (floor(low - slack), floor(high + slack)))
        });
        Some([x?, z?])
    }
}

pub(super) fn is_odd(whole: f64) -> bool {
    // The index of a square is a whole number far below 2^53, so the conversion to `i64` is exact.
    whole as i64 & 1 == 1
}
