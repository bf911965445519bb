//! The board's integral where its squares are near: row by row, and square by square at the ends of the rows.

use std::f64::consts::PI;

use glam::DVec2;

use super::block::Block;
use super::board::{Board, Corner, FAR, Sum, UNIT, form, measure};
use super::edge::MAX_TERMS;
use super::euler::{ORDERS, square_wave, waves};
use super::modes::GRADUAL;
use crate::math::two_sum;

/// A row with fewer whole squares is cut square by square.
const FEW: f64 = 3.0;
/// More squares of a row than this are summed at once.
pub(super) const MANY: f64 = 32.0;

/// More than this are left where points are too coarse to tell one line from the next: then nothing is said of them.
const TOO_MANY: f64 = 1000.0;
/// More rows than this, of a square each, take too long, which only the widest of views have in a pixel.
const TOO_MANY_ROWS: f64 = 1e6;

/// More rows than this, between two vertices, are summed at once.
const BLOCK: f64 = 3.0 * GRADUAL;

/// Whole squares are only known as well as the forms' inverse is: they are cut out, too, where that is worse than this.
const SOUND: f64 = 1e-10;

/// The axis of the board along which rows run: the one on which m changes less.
pub(super) fn along(board: &Board) -> usize {
    usize::from(board.slope[0].abs() > board.slope[1].abs())
}

/// The integral over a convex polygon that does not reach the horizon.
///
/// The squares of a row that lie wholly inside have a closed form each, and where a row is long most of it is summed at
/// once; what is left of it at the polygon's sides is cut out of the picture square by square.
pub(super) fn sum(board: &Board, corners: &[Corner]) -> Sum {
    sum_with_blocks(board, corners, BLOCK)
}

/// The same with blocks of more rows than `least`.
pub(super) fn sum_with_blocks(board: &Board, corners: &[Corner], least: f64) -> Sum {
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

/// What much of a polygon between two lines of the board is summed as, at once.
pub(super) trait Bulk {
    /// The part of it that can be.
    fn smooth(&self) -> [f64; 2];
    /// Adds its part between two lines, which is `piece`.
    fn add(&self, ends: [f64; 2], piece: &[DVec2], tally: &mut Tally);
}

/// Where vertices lie along an axis of the board, in order, and how uncertain that is.
fn vertices(board: &Board, axis: usize, points: &[DVec2]) -> Vec<(f64, f64)> {
    // Far away a vertex is uncertain by more than a square, and which side a line there crosses.
    let vertex = |&at: &DVec2| board.place(axis, at, form(&board.below, at));
    let mut ends: Vec<(f64, f64)> = points.iter().map(vertex).collect();
    ends.sort_by(|a, b| a.0.total_cmp(&b.0));
    ends
}

/// Adds the polygon with which a cutter has begun: in bulk what lies between two vertices with more than `least` lines
/// between them, and the rest by another way.
///
/// Between two vertices it is bounded by one side above and by one below.
fn in_bulk<B: Bulk>(
    cutter: &mut Cutter,
    vertices: &[(f64, f64)],
    least: f64,
    bulk: impl Fn([f64; 2], &[Chord; 2]) -> Option<B>,
    mut add_rest: impl FnMut(&[DVec2], &mut Tally),
    tally: &mut Tally,
) {
    for ends in vertices.windows(2) {
        let [from, to] = [ends[0], ends[1]];
        let first = (from.0 + from.1).ceil();
        let last = (to.0 - to.1).floor();
        let are_many = last - first > least;
        if !are_many {
            continue;
        }
        cutter.cut(first, tally);
        add_rest(&cutter.piece, tally);
        cutter.cut(last, tally);
        let Some(bulk) = bulk([first, last], &cutter.chords) else {
            add_rest(&cutter.piece, tally);
            continue;
        };
        let [first, last] = bulk.smooth();
        let are_many = last - first > least;
        if !are_many {
            add_rest(&cutter.piece, tally);
            continue;
        }
        let mut parts = cutter.again();
        parts.cut(first, tally);
        add_rest(&parts.piece, tally);
        parts.cut(last, tally);
        bulk.add([first, last], &parts.piece, tally);
        add_rest(&parts.rest, tally);
    }
    add_rest(&cutter.rest, tally);
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
struct Row<'a> {
    board: &'a Board,
    along: usize,
    number: f64,
    /// The sign of its square 0.
    sign: f64,
}

impl Row<'_> {
    fn place(&self, at: DVec2) -> f64 {
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
        let [slope, climb] = [board.slope[self.along], board.slope[1 - self.along]];
        let lower = climb * self.number + board.origin;
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
            + board.origin.abs();
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
            sum += sign * 0.5 * board.density * (left[0] + right[1]) / product;
            left = right;
        }
        tally.add(self.sign * sum, relative * area.abs());
        tally.has_inverse = true;
    }

    /// Adds the part of a long row that a polygon shows: most of it at once.
    fn long(&self, piece: &[DVec2], inside: &mut Cutter, squares: &mut Cutter, tally: &mut Tally) {
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
}

/// Much of a row: what lies between two lines of the board, and between two sides on which m is linear.
///
/// A line at a has G(a) = K/2|q|·(m^−2 − M^−2) of J = K/m³ between the sides, where m and M are theirs, and s(a)·G has the
/// antiderivative Σ (−1)^k A_k+1(a) G^(k)(a). At a line of the board just the odd waves are not 0.
struct Strip<'a> {
    row: &'a Row<'a>,
    first: f64,
    last: f64,
    sides: [Side; 2],
}

/// A side of a strip: where it begins and ends along the row and m there, and the slope of m.
///
/// Far away both are uncertain, but by the same factor 1/L, so that the slope is not.
struct Side {
    start: [f64; 2],
    end: [f64; 2],
    slope: f64,
}

impl<'a> Strip<'a> {
    /// Between two lines, given where they cut the row's piece.
    fn new(row: &'a Row, [first, last]: [f64; 2], chords: &[Chord; 2]) -> Option<Self> {
        let point = |at: DVec2| [row.place(at), 1.0 / form(&row.board.below, at)];
        let ends = |chord: Chord| {
            let [s, t] = chord?.map(point);
            Some(if s[1] <= t[1] { [s, t] } else { [t, s] })
        };
        let (from, to) = (ends(chords[0])?, ends(chords[1])?);
        let sides = [0, 1].map(|i| {
            let (start, end) = (from[i], to[i]);
            Side {
                start,
                end,
                slope: (end[1] - start[1]) / (end[0] - start[0]),
            }
        });
        Some(Self {
            row,
            first,
            last,
            sides,
        })
    }

    /// m on a side, from the end that is nearer.
    fn depth(&self, Side { start, end, slope }: &Side, i: f64) -> f64 {
        if i - self.first < self.last - i {
            start[1] + slope * (i - start[0])
        } else {
            end[1] + slope * (i - end[0])
        }
    }
}

impl Bulk for Strip<'_> {
    /// The part of it in which m changes little from line to line.
    fn smooth(&self) -> [f64; 2] {
        let [mut first, mut last] = [self.first, self.last];
        for Side { start, end, slope } in &self.sides {
            if *slope > 0.0 {
                first = first.max(self.first + (FAR - start[1] / slope).ceil());
            } else if *slope < 0.0 {
                last = last.min(self.last - (FAR + end[1] / slope).ceil());
            }
        }
        [first, last]
    }

    fn add(&self, [first, last]: [f64; 2], piece: &[DVec2], tally: &mut Tally) {
        let waves = waves::<MAX_TERMS>(0.0);
        let mut sum = 0.0;
        let mut bound = 0.0;
        for (i, sense) in [(first, -1.0), (last, 1.0)] {
            for (side, half) in self.sides.iter().zip([1.0, -1.0]) {
                let end = self.potential(&waves, self.depth(side, i), side.slope);
                sum += sense * half * square_wave(i) * end.value;
                bound += end.bound;
            }
        }
        let (_, perimeter) = measure(piece.iter().copied());
        // The sides are those between points that are a few roundings off.
        bound += 8.0 * UNIT * perimeter;
        tally.add(self.row.sign * sum, bound);
    }
}

impl Strip<'_> {
    /// Σ A_k+1(0)·(K/2|q|)·(k + 1)!·γ^k·m^(−2−k), with what it neglects: |A_n| ≤ ½π^(1−n), and G^(n−1) is monotonic.
    fn potential(&self, waves: &[f64; ORDERS], depth: f64, slope: f64) -> Sum {
        let board = self.row.board;
        let u = 1.0 / depth;
        let per_slope = board.per_slope[1 - self.row.along];
        let first = 0.5 * per_slope.value * u * u;
        // L is off by some roundings of its terms.
        let [x, y, z] = board.below.map(f64::abs);
        let off = 12.0 * UNIT * (0.5 * (x + y) + z) * depth;
        let (mut sum, mut factor) = (0.0, first);
        for k in 0..MAX_TERMS - 1 {
            sum += waves[k + 1] * factor;
            factor *= slope * u * (k + 2) as f64;
        }
        let neglected = 0.5 * factor.abs() / libm::pow(PI, (MAX_TERMS - 1) as f64);
        Sum {
            value: sum,
            bound: neglected + (per_slope.bound + off + 16.0 * UNIT) * first,
        }
    }
}

/// A sum of many numbers, and what it is off. The numbers' own rounding is kept and added in the end.
#[derive(Default)]
pub(super) struct Tally {
    value: f64,
    rest: f64,
    bound: f64,
    /// Whether anything was computed of the forms' inverse.
    pub(super) has_inverse: bool,
}

impl Tally {
    pub(super) fn add(&mut self, value: f64, bound: f64) {
        let sum = two_sum(self.value, value);
        self.value = sum.hi;
        self.rest += sum.lo;
        self.bound += bound;
    }

    fn sum(&self) -> Sum {
        Sum {
            value: self.value + self.rest,
            bound: self.bound + 2.0 * UNIT,
        }
    }
}

/// A convex polygon from which one strip of squares after the other is cut off, along one axis of the board.
struct Cutter {
    across: [f64; 3],
    below: [f64; 3],
    rest: Vec<DVec2>,
    piece: Vec<DVec2>,
    spare: Vec<DVec2>,
    strips: Option<(i64, i64)>,
    /// Where the lines on both sides of the piece cut the polygon.
    chords: [Chord; 2],
}

/// What a line has of a polygon: its ends, if it was met.
pub(super) type Chord = Option<[DVec2; 2]>;

impl Cutter {
    fn new(board: &Board, axis: usize) -> Self {
        Self {
            across: board.across[axis],
            below: board.below,
            rest: Vec::new(),
            piece: Vec::new(),
            spare: Vec::new(),
            strips: None,
            chords: [None; 2],
        }
    }

    /// Begins with a polygon.
    fn start(&mut self, points: impl Iterator<Item = DVec2>) {
        self.rest.clear();
        self.rest.extend(points);
        self.strips = self.range();
        self.chords = [None; 2];
    }

    /// Makes `piece` the part of the rest between the lines i and i + 1, and returns i.
    fn next(&mut self, tally: &mut Tally) -> Option<f64> {
        if self.rest.len() < 3 {
            return None;
        }
        let (i, last) = self.strips?;
        self.strips = Some((i + 1, last));
        if i >= last {
            self.chords = [self.chords[1], None];
            std::mem::swap(&mut self.piece, &mut self.rest);
            self.rest.clear();
            return Some(last as f64);
        }
        self.cut((i + 1) as f64, tally);
        Some(i as f64)
    }

    /// The first and the last strip that the polygon meets; none if they are out of the range of numbers.
    fn range(&self) -> Option<(i64, i64)> {
        let mut range = None;
        for &p in &self.rest {
            let place = form(&self.across, p) / form(&self.below, p);
            if place.is_nan() || place.abs() > 1e18 {
                return None;
            }
            let i = place.floor() as i64;
            let (low, high) = range.unwrap_or((i, i));
            range = Some((low.min(i), high.max(i)));
        }
        range
    }

    /// How many strips are left.
    fn count(&self) -> f64 {
        self.strips
            .map_or(f64::INFINITY, |(first, last)| (last - first + 1) as f64)
    }

    /// Another cutter that begins with the piece.
    fn again(&self) -> Self {
        let mut again = Self {
            across: self.across,
            below: self.below,
            rest: Vec::new(),
            piece: Vec::new(),
            spare: Vec::new(),
            strips: None,
            chords: [None; 2],
        };
        again.start(self.piece.iter().copied());
        again
    }

    /// Makes `piece` the part of the rest before the line n.
    fn cut(&mut self, n: f64, tally: &mut Tally) {
        let line: [f64; 3] = std::array::from_fn(|k| self.across[k] - n * self.below[k]);
        self.piece.clear();
        self.spare.clear();
        let chord = split(&self.rest, &line, &mut self.piece, &mut self.spare);
        std::mem::swap(&mut self.rest, &mut self.spare);
        self.chords = [self.chords[1], chord];
        let Some([from, to]) = chord else { return };
        let size = |k: usize| self.across[k].abs() + (n * self.below[k]).abs();
        // The factors are off by three roundings of these, the form's value by four, and the point by four of its own.
        let off = 7.0 * UNIT * (0.5 * (size(0) + size(1)) + size(2));
        let step = (to - from).abs();
        tally.bound += (off / line[0].abs().max(line[1].abs()) + 4.0 * UNIT) * (step.x + step.y);
    }

    /// The whole squares of the strip, as lines of the other axis count them, if there are some.
    fn whole(&self, board: &Board, axis: usize) -> Option<[f64; 2]> {
        let [Some(lower), Some(upper)] = self.chords else {
            return None;
        };
        let [lower, upper] = [lower, upper].map(|chord| {
            let [s, t] = chord.map(|p| form(&board.across[axis], p) / form(&self.below, p));
            [s.min(t), s.max(t)]
        });
        let first = lower[0].max(upper[0]).ceil();
        let last = lower[1].min(upper[1]).floor();
        (last - first >= FEW).then_some([first, last])
    }
}

/// A convex polygon's parts on the negative and on the positive side of a line, and the line's chord.
fn split(
    points: &[DVec2],
    line: &[f64; 3],
    negative: &mut Vec<DVec2>,
    positive: &mut Vec<DVec2>,
) -> Chord {
    let mut before = points.last().map(|&last| (last, form(line, last)))?;
    let mut chord: Chord = None;
    let mut meet = |at: DVec2| chord = Some([chord.map_or(at, |[first, _]| first), at]);
    for &point in points {
        let side = form(line, point);
        if (side > 0.0 && before.1 < 0.0) || (side < 0.0 && before.1 > 0.0) {
            let at = before.0 + (point - before.0) * (before.1 / (before.1 - side));
            negative.push(at);
            positive.push(at);
            meet(at);
        }
        if side <= 0.0 {
            negative.push(point);
        }
        if side >= 0.0 {
            positive.push(point);
        }
        if side == 0.0 {
            meet(point);
        }
        before = (point, side);
    }
    chord
}
