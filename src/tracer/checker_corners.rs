//! The squares of a checkerboard at the corners of many pixels at once.
//!
//! In: a block of pixels in which a board is all that is seen. Out: runs of pixels that show one
//! colour, and the squares that each other pixel shows.
//!
//! Where a board alone is seen, most parts of the picture end as pixels, which have their corners
//! in common. So the squares that the corners of a block lie in are computed row by row, in plain
//! arrays, which the compiler makes vectors of: a ratio of linear forms is the greatest and the
//! least at corners, and a pixel whose corners lie in one square, each farther from its edge than
//! errors reach, shows nothing else.

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

/// The form below a quotient is at least so many times as great as its error: then (a ± e)/(l ± f)
/// is within 4/3 of (e + f·|a/l|)/l of a/l, and this takes the place of the 4/3.
const CLEAR: f64 = 4.0;

/// Places that are off by more than this, in squares, tell nothing worth having: only the half of
/// each square that is away from its lines would be certain.
const UNSURE: f64 = 0.25;

/// The greatest side of a block, in pixels: that of the squares that quartering begins with.
pub(super) const SIDE: usize = 32;

/// Its corners in a row, 33, and so many more that vectors of eight make them up.
const LANES: usize = 40;

/// The squares of a board that a pixel shows.
#[derive(Clone, Copy, Debug)]
pub struct Checks {
    pub(crate) squares: Squares,
    /// The squares of its corners, in x and in z: above on the left and on the right, and below.
    pub(crate) corners: [[f64; 4]; 2],
    /// Whether the corners are certain to lie in these squares. If not, lines of the board
    /// displaced by no more than the forms of `squares` may be off have the corners in them.
    pub(crate) is_certain: bool,
}

/// A block of pixels in which nothing but one board is seen.
struct Mesh {
    block: Area,
    squares: Squares,
    /// How far from the edges of squares corners must lie, in x and in z.
    slack: [f64; 2],
    /// The corners' columns, in units of the block's width from its centre.
    columns: [f64; LANES],
}

/// A row of corners.
struct CornerRow {
    /// Their squares in x and in z; NaN where that is not certain.
    squares: [[f64; LANES]; 2],
    /// 1, or −1 in the squares of the second colour, if the board begins with the first.
    sign: [f64; LANES],
}

/// What pixels show of a board.
#[derive(Clone, Copy, Debug)]
pub enum Shown<'a> {
    /// One square, or squares of one colour side by side; whether that is the second.
    One(bool),
    /// A few squares of one pixel.
    Squares(&'a Checks),
    /// One pixel, of which that is not known.
    Unknown,
}

/// Tells `each` what the pixels of a part of the picture, in which a checkerboard is all that is
/// seen, show of it: in runs of one colour and singly. `None` if the object is none or the board
/// too far. The part's sides are at most [`SIDE`].
pub fn show(
    world: &World,
    part: Area,
    object: usize,
    each: &mut impl FnMut(Area, Shown) -> ControlFlow<()>,
) -> Option<ControlFlow<()>> {
    let Object::Checkerboard(board) = &*Double::object(&world.geometry, object) else {
        return None;
    };
    let camera = &Double::frame(&world.geometry).camera;
    let sides = [part.width, part.height]
        .map(|pixels| camera.pitch.times(&Double::from_f64(f64::from(pixels))));
    let board = board.local(&camera.direction(&camera.middle(part)), &sides);
    let mesh = Mesh::new(Squares::new(&board), part)?;
    let [mut above, mut below] = [CornerRow::new(), CornerRow::new()];
    mesh.corners(0, &mut above);
    for row in 0..part.height {
        mesh.corners(row + 1, &mut below);
        let flow = mesh.row(row, &above, &below, each);
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

    /// The squares of a corner.
    fn at(&self, column: usize) -> [f64; 2] {
        [self.squares[0][column], self.squares[1][column]]
    }
}

impl Mesh {
    /// `None` if the board is too far for its squares to be told apart so.
    fn new(squares: Squares, block: Area) -> Option<Self> {
        let Squares { across, .. } = squares;
        let least = squares.least()?;
        let slack = across.map(|across| {
            let greatest = (across.factors[2].abs() + across.spread() + across.rad) / least;
            squares.slack(&across, greatest, least)
        });
        if !slack.iter().all(|&slack| slack < UNSURE) {
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
        let Squares { across, below, .. } = &self.squares;
        let [n0, n1, l] = [&across[0], &across[1], below].map(|local| {
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

    /// Tells `each` the pixels of a row between two rows of corners.
    fn row(
        &self,
        row: u32,
        above: &CornerRow,
        below: &CornerRow,
        each: &mut impl FnMut(Area, Shown) -> ControlFlow<()>,
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
                    Some(checks) => each(area, Shown::Squares(&checks))?,
                    None => each(area, Shown::Unknown)?,
                }
                first += 1;
                continue;
            }
            let rest = shown[first..].iter();
            let length = rest.take_while(|&&other| other == sign).count();
            area.width = length as u32;
            each(area, Shown::One((sign < 0.0) ^ self.squares.odd))?;
            first += length;
        }
        ControlFlow::Continue(())
    }

    /// What a pixel shows: the squares in which its corners lie, or probably lie.
    fn checks(
        &self,
        row: u32,
        column: usize,
        above: &CornerRow,
        below: &CornerRow,
    ) -> Option<Checks> {
        let certain = [
            above.at(column),
            above.at(column + 1),
            below.at(column),
            below.at(column + 1),
        ];
        let is_certain = !certain.as_flattened().iter().any(|square| square.is_nan());
        let (corners, doubt) = match is_certain {
            true => (certain, [0.0; 2]),
            false => self.probable(certain, column, row)?,
        };
        let Area { width, height, .. } = self.block;
        let x = middle(2 * column as u32 + 1, width);
        let y = middle(2 * row + 1, height);
        let [width, height] = [width, height].map(f64::from);
        let local = |block: &LocalForm| {
            let [a, b, c] = block.factors;
            // The form of the block is off by its error, and the value at the pixel's centre by as
            // much again.
            LocalForm::new([a / width, b / height, a * x + b * y + c], 2.0 * block.rad)
        };
        let Squares { across, below, odd } = &self.squares;
        let below = local(below);
        let mut across = across.each_ref().map(local);
        if !is_certain {
            let greatest = below.factors[2].abs() + below.spread();
            for (across, doubt) in across.iter_mut().zip(doubt) {
                across.rad += doubt * greatest * UP;
            }
        }
        Some(Checks {
            squares: Squares {
                across,
                below,
                odd: *odd,
            },
            corners: [0, 1].map(|axis| corners.map(|corner| corner[axis])),
            is_certain,
        })
    }

    /// Fills in the squares in which a pixel's corners probably lie, and returns how far any of
    /// them may lie from the line next to it, in squares. Returns `None` if a quotient is no
    /// number.
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
                    corner[axis] =
                        floor(self.squares.across[axis].at(x, y) / self.squares.below.at(x, y));
                    // The computed quotient and the true one both lie within the slack of the line.
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

impl Checks {
    /// From which to which square there are any in the pixel, in x and in z.
    pub(crate) fn ranges(&self) -> [(f64, f64); 2] {
        self.corners.map(|squares| {
            let low = squares.into_iter().fold(f64::INFINITY, f64::min);
            let high = squares.into_iter().fold(f64::NEG_INFINITY, f64::max);
            (low, high)
        })
    }
}

/// Where so many half pixels lie from the left or from the top, in units of the block's side from
/// its centre.
fn middle(halves: u32, pixels: u32) -> f64 {
    (f64::from(halves) - f64::from(pixels)) / f64::from(2 * pixels)
}

#[multiversion(targets(
    "x86_64+avx512bw+avx512cd+avx512dq+avx512f+avx512vl+bmi1+bmi2+fma+lzcnt+popcnt",
    "x86_64+avx2+bmi1+bmi2+fma+lzcnt+popcnt",
))]
fn corners_simd(mesh: &Mesh, y: f64, length: usize, out: &mut CornerRow) {
    mesh.evaluate(y, length, out);
}

/// The sign of each pixel whose corners lie in one square, and 0 for all others.
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

/// Squares of a checkerboard: N₀/ℓ and N₁/ℓ, rounded down.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Squares {
    pub(crate) across: [LocalForm; 2],
    pub(crate) below: LocalForm,
    pub(crate) odd: bool,
}

/// The corners of a pixel, or of a part of the picture, from its middle.
const CORNERS: [(f64, f64); 4] = [(-0.5, -0.5), (0.5, -0.5), (-0.5, 0.5), (0.5, 0.5)];

impl Squares {
    pub(super) fn new(board: &LocalBoard) -> Self {
        let [a, b, below] = board.rads;
        Self {
            across: [
                LocalForm::new(board.across[0], a),
                LocalForm::new(board.across[1], b),
            ],
            below: LocalForm::new(board.below, below),
            odd: board.odd,
        }
    }

    /// The least value of ℓ in the pixel, if it is clearly positive.
    fn least(&self) -> Option<f64> {
        let least = self.below.factors[2] - self.below.spread() * UP;
        (least > CLEAR * self.below.rad).then_some(least)
    }

    /// How far a computed quotient may be from the true one, if it is no greater than this.
    fn slack(&self, across: &LocalForm, greatest: f64, least: f64) -> f64 {
        let inherited = (across.rad + greatest * self.below.rad) * CLEAR / least;
        (inherited + (greatest + 1.0) * LOCAL_ROUNDING) * UP
    }

    /// From which to which square there are any in the pixel, in x and in z: perhaps one square
    /// more than there are. `None` if that is not certain.
    pub(super) fn ranges(&self) -> Option<[(f64, f64); 2]> {
        let least = self.least()?;
        let inverse = CORNERS.map(|(x, y)| 1.0 / self.below.at(x, y));
        let [x, z] = self.across.each_ref().map(|across| {
            // A ratio of linear forms is the greatest and the least at corners.
            let values: [f64; 4] = array::from_fn(|i| {
                let (x, y) = CORNERS[i];
                across.at(x, y) * inverse[i]
            });
            let low = values.into_iter().fold(f64::INFINITY, f64::min);
            let high = values.into_iter().fold(f64::NEG_INFINITY, f64::max);
            let size = low.abs().max(high.abs());
            let slack = self.slack(across, size, least);
            (slack < UNSURE).then(|| (floor(low - slack), floor(high + slack)))
        });
        Some([x?, z?])
    }
}

pub(super) fn is_odd(whole: f64) -> bool {
    // `ranges` answers for numbers far below 2^53.
    whole as i64 & 1 == 1
}
