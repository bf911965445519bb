//! The board's integral where its squares are near: row by row, and square by square at the ends of the rows.

use std::sync::atomic::{AtomicBool, Ordering};

use glam::DVec2;

use super::block::Block;
use super::board::{Board, Corner, Sum, UNIT, form, measure, size};
use super::bulk::{in_bulk, vertices};
use super::cutter::{Cutter, Tally, split};
use super::euler::square_wave;
use super::modes::GRADUAL;
use super::strip::Strip;

/// More squares of a row than this are summed at once.
pub(super) const MANY: f64 = 32.0;

/// More than this are left where points are too coarse to tell one line from the next: then nothing is said of them.
const TOO_MANY: f64 = 1000.0;
/// More rows than this, of a square each, take too long, which only the widest of views have in a pixel.
const TOO_MANY_ROWS: f64 = 2e6;

/// Of a row that goes on to so many times the depth of its near end hardly anything lies behind: not so much of its area by the square.
const DEEPER: f64 = 1e5;

/// More rows than this, between two vertices, are summed at once.
const BLOCK: f64 = 3.0 * GRADUAL;

/// Whole squares are only known as well as the forms' inverse is: they are cut out, too, where that is worse than this.
const SOUND: f64 = 1e-10;

/// The axis of the board along which rows run: the one on which m changes less.
pub(super) fn along(board: &Board) -> usize {
    let [p, q] = board.fine.floor.slope;
    usize::from(p.abs() > q.abs())
}

/// The integral over a convex polygon that does not reach the horizon.
///
/// The squares of a row that lie wholly inside have a closed form each, and where a row is long most of it is summed at
/// once; what is left of it at the polygon's sides is cut out of the picture square by square. There may be a million rows: once it is
/// cancelled the rest of them is left out.
pub(super) fn sum(board: &Board, corners: &[Corner], cancel: &AtomicBool) -> Sum {
    sum_with_blocks(board, corners, BLOCK, cancel)
}

/// The same with blocks of more rows than `least`.
pub(super) fn sum_with_blocks(
    board: &Board,
    corners: &[Corner],
    least: f64,
    cancel: &AtomicBool,
) -> Sum {
    let along = along(board);
    let mut tally = Tally::default();
    let moved = board.displaced(corners.iter().map(|c| c.at));
    let mut rows = Rows {
        board,
        along,
        is_sound: moved <= SOUND,
        lines: Cutter::new(board, 1 - along),
        inside: Cutter::new(board, along),
        squares: Cutter::new(board, along),
        cancel,
    };
    let polygon: Vec<DVec2> = corners.iter().map(|c| c.at).collect();
    let mut blocks = Cutter::new(board, 1 - along);
    blocks.start(polygon.iter().copied());
    if blocks.count() <= least {
        rows.add(&polygon, &mut tally);
    } else {
        in_bulk(
            &mut blocks,
            &vertices(board, 1 - along, &polygon),
            least,
            |ends, chords| Block::new(board, along, ends, chords),
            |piece, tally| rows.add(piece, tally),
            &mut tally,
        );
    }
    let mut sum = tally.sum();
    if tally.has_inverse {
        // What is of the forms' inverse the rounding of the forms moves as a whole.
        sum.bound += moved;
    }
    sum
}

/// Sums polygons row by row.
struct Rows<'a> {
    board: &'a Board,
    along: usize,
    /// Whether the forms' inverse is good enough for whole squares.
    is_sound: bool,
    lines: Cutter,
    inside: Cutter,
    squares: Cutter,
    cancel: &'a AtomicBool,
}

impl Rows<'_> {
    fn add(&mut self, polygon: &[DVec2], tally: &mut Tally) {
        let Rows {
            board,
            along,
            is_sound,
            lines,
            inside,
            squares,
            cancel,
        } = self;
        let (board, along) = (*board, *along);
        lines.start(polygon.iter().copied());
        squares.start(polygon.iter().copied());
        // A row takes as long as its squares, up to many.
        let length = (squares.count() / lines.count()).min(MANY);
        let takes_too_long = lines.count() * (1.0 + 0.25 * length) > TOO_MANY_ROWS;
        if takes_too_long || lines.count().is_infinite() {
            let (area, _) = measure(polygon.iter().copied());
            return tally.add(0.0, area.abs());
        }
        while let Some(number) = lines.next(tally) {
            if cancel.load(Ordering::Relaxed) {
                return;
            }
            let row = Row {
                board,
                along,
                sign: square_wave(number),
                number,
            };
            squares.start(lines.piece.iter().copied());
            if squares.count() > MANY {
                row.long(&lines.piece, inside, squares, tally);
            } else if *is_sound && let Some(inner) = lines.whole(board, along) {
                inside.start(lines.piece.iter().copied());
                inside.cut(inner[0], tally);
                row.squares(&inside.piece, squares, tally);
                inside.cut(inner[1], tally);
                row.whole(inner, &inside.piece, tally);
                row.squares(&inside.rest, squares, tally);
            } else {
                row.started(squares, tally);
            }
        }
    }
}

/// A row of the board.
pub(super) struct Row<'a> {
    pub board: &'a Board,
    pub along: usize,
    number: f64,
    /// The sign of its square 0.
    pub sign: f64,
}

impl Row<'_> {
    pub(super) fn place(&self, at: DVec2) -> f64 {
        form(&self.board.across[self.along], at) / form(&self.board.below, at)
    }

    /// Cuts the part of the row that a polygon shows into squares.
    fn squares(&self, piece: &[DVec2], squares: &mut Cutter, tally: &mut Tally) {
        squares.start(piece.iter().copied());
        self.started(squares, tally);
    }

    /// Cuts a polygon with which a cutter has begun.
    fn started(&self, squares: &mut Cutter, tally: &mut Tally) {
        if squares.count() > TOO_MANY {
            let (area, _) = measure(squares.rest.iter().copied());
            return tally.add(0.0, area.abs());
        }
        while let Some(square) = squares.next(tally) {
            let (area, perimeter) = measure(squares.piece.iter().copied());
            // Of each of a few products of two steps three roundings.
            let rounding = 4.0 * UNIT * perimeter * perimeter;
            tally.add(self.sign * square_wave(square) * area.abs(), rounding);
        }
    }

    /// Adds the whole squares between two lines. Together they are `piece`.
    fn whole(&self, [first, last]: [f64; 2], piece: &[DVec2], tally: &mut Tally) {
        let board = self.board;
        let [slope, climb] = [
            board.floor.slope[self.along],
            board.floor.slope[1 - self.along],
        ];
        let lower = climb * self.number + board.floor.origin;
        let depth = |i: f64| {
            let m = slope * i + lower;
            [m, m + climb]
        };
        let (area, _) = measure(piece.iter().copied());
        let nearest = [depth(first), depth(last)]
            .as_flattened()
            .iter()
            .fold(f64::INFINITY, |m, &depth| m.min(depth));
        let terms = slope.abs() * first.abs().max(last.abs())
            + climb.abs() * (self.number.abs() + 1.0)
            + board.floor.origin.abs();
        // Seven roundings of its terms for each of the four m, and those of the formula and of the sum.
        let relative = UNIT * (28.0 * terms / nearest + 12.0 + last - first);
        if !(nearest > 0.0 && relative < 1.0) {
            return tally.add(0.0, area.abs());
        }
        let mut sum = 0.0;
        let (mut i, mut left) = (first, depth(first));
        while i < last {
            let sign = square_wave(i);
            i += 1.0;
            let right = depth(i);
            // K/m³ integrates to K(m_00 + m_11)/(2·m_00·m_01·m_10·m_11) on a square.
            let product = (left[0] * left[1]) * (right[0] * right[1]);
            sum += sign * 0.5 * board.floor.density * (left[0] + right[1]) / product;
            left = right;
        }
        tally.add(self.sign * sum, relative * area.abs());
        tally.has_inverse = true;
    }

    /// Adds the part of a long row that a polygon shows: most of it at once.
    fn long(&self, piece: &[DVec2], inside: &mut Cutter, squares: &mut Cutter, tally: &mut Tally) {
        let distinct = self.distinct(piece, tally);
        let piece = distinct.as_deref().unwrap_or(piece);
        inside.start(piece.iter().copied());
        in_bulk(
            inside,
            &vertices(self.board, self.along, piece),
            MANY,
            |ends, chords| Strip::new(self, ends, chords),
            |piece, tally| self.squares(piece, squares, tally),
            tally,
        );
    }

    /// The part of a row in which squares can be told from each other, if what lies behind is next to nothing of it.
    ///
    /// So it is where all lines of a board meet in a point of the picture, but for what roundings do: only there a row has very many squares.
    fn distinct(&self, piece: &[DVec2], tally: &mut Tally) -> Option<Vec<DVec2>> {
        let board = self.board;
        let deepest = 1.0 / (16.0 * UNIT * size(&board.across[self.along]));
        let levels = piece.iter().map(|&at| form(&board.below, at));
        let (least, most) = levels.fold((f64::INFINITY, 0.0), |(least, most): (f64, f64), l| {
            (least.min(l), most.max(l))
        });
        let is_needed = least * deepest < 1.0 && most * deepest > DEEPER;
        is_needed.then(|| {
            let mut line = board.below;
            line[2] -= 1.0 / deepest;
            let (mut behind, mut before) = (Vec::new(), Vec::new());
            split(piece, &line, &mut behind, &mut before);
            tally.add(0.0, measure(behind.into_iter()).0.abs());
            before
        })
    }
}
