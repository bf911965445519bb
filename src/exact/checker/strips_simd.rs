//! The integral of the board's sign over eight pixels at once, in lanes, which the compiler makes vectors of.
//!
//! In: eight pixels that show nothing but a checkerboard, and are all crossed by the same number of lines of the one family and of the other. Out: their integrals, each with a bound: roundings of areas,
//! and how far each line may be from the computed one.
//!
//! The lines of one family, of which there are fewer, cut the pixel into strips; in strip i the sign of their squares is σ_i. Beyond
//! line k of the other family lies the signed area W_k = Σ σ_i·|strip i ∩ H_k|, W_0 being all of it, and the sign changes from
//! line to line:
//!
//! ∬ s(a) s(b) dx dy = s_0·(W_0 + 2 Σ_k (−1)^k W_k).
//!
//! A strip's area beyond a line is ½ Σ (p − O) × (q − p)·f over the strip's sides from p to q, f being the part of the side that
//! lies beyond, if O is on the line: then what the line itself contributes is 0. A side of the pixel has a part, which may have no length, in each
//! strip; a part without length starts and ends at the same number, so that it adds 0, which takes no rounding.

use std::array;

use glam::DVec2;
use multiversion::multiversion;

use super::{
    super::clip::PIXEL,
    board_forms::{PIXELS, Views},
    homography::{Sum, UNIT},
    special::square_wave,
};
use crate::math::ROUND;

/// At most so many lines cut the pixels into strips: their sides, 34 of 320 bytes, stay in the first-level cache.
pub(super) const STRIPS: usize = 6;

/// A family whose lines are farther away than this, in squares, is left to others: sums of numbers of lines are exact below.
const OUT_OF_REACH: f64 = 1e9;

/// A number of each pixel.
type Row = [f64; PIXELS];

/// The factors of a linear form.
type FormRows = [Row; 3];

/// Sides of strips: parts of the sub-pixel's four, and a chord for each line.
const SIDES: usize = 4 * (STRIPS + 1) + STRIPS;

/// In which squares some pixels have their corners.
#[derive(Debug, Default)]
pub(super) struct Corners {
    /// By family and corner, the lower one's number.
    pub squares: [[Row; 4]; 2],
    /// By family, the number of the first square.
    pub first: [Row; 2],
    /// By family, how many lines cross the pixel; infinite where its corners do not show it.
    pub lines: [Row; 2],
}

impl Corners {
    /// Of pixels that see a board so.
    pub fn look(&mut self, views: &Views) {
        look_simd(views, self);
    }

    #[inline(always)]
    fn see(&mut self, views: &Views) {
        let Views {
            across, below, rad, ..
        } = views;
        let mut levels = [[0.0; PIXELS]; 4];
        // Where it is infinite nothing is known of the pixel.
        let mut doubt = [0.0; PIXELS];
        for (level, at) in levels.iter_mut().zip(PIXEL) {
            for i in 0..PIXELS {
                level[i] = below[0][i] * at.x + below[1][i] * at.y + below[2][i];
                let is_good = (level[i] > 0.0) & (rad[i] < f64::INFINITY);
                doubt[i] += if is_good { 0.0 } else { f64::INFINITY };
            }
        }
        let (mut firsts, mut lasts) = ([[OUT_OF_REACH; PIXELS]; 2], [[-OUT_OF_REACH; PIXELS]; 2]);
        for family in 0..2 {
            let [x, y, z] = &across[family];
            let (first, last) = (&mut firsts[family], &mut lasts[family]);
            for corner in 0..4 {
                let (at, level) = (PIXEL[corner], &levels[corner]);
                let mut squares = [0.0; PIXELS];
                for i in 0..PIXELS {
                    let place = (x[i] * at.x + y[i] * at.y + z[i]) / level[i];
                    doubt[i] += if place.abs() < OUT_OF_REACH {
                        0.0
                    } else {
                        f64::INFINITY
                    };
                    let nearest = nearest(place);
                    let square = nearest - if nearest > place { 1.0 } else { 0.0 };
                    squares[i] = square;
                    first[i] = first[i].min(square);
                    last[i] = last[i].max(square);
                }
                self.squares[family][corner] = squares;
            }
        }
        for family in 0..2 {
            self.first[family] = firsts[family];
            let mut lines = [0.0; PIXELS];
            for i in 0..PIXELS {
                lines[i] = lasts[family][i] - firsts[family][i] + doubt[i];
            }
            self.lines[family] = lines;
        }
    }
}

#[multiversion(targets = "simd")]
fn look_simd(views: &Views, corners: &mut Corners) {
    corners.see(views);
}

/// The boards of some pixels, the family with fewer lines first.
#[derive(Debug, Default)]
pub(super) struct Lines {
    few: Family,
    many: Family,
    below: FormRows,
    rad: Row,
    /// Of each pixel, −1 where square [0, 1)² has the second colour.
    sign: Row,
    /// In which squares of the first family the corners lie.
    squares: [Row; 4],
}

/// The lines of one family.
#[derive(Debug, Default)]
struct Family {
    across: FormRows,
    first: Row,
}

/// Directed sides of strips, from `start` on by `step`, one of each pixel, with the signs of the strips that they bound.
#[derive(Clone, Copy, Debug, Default)]
struct Sides {
    start: [Row; 2],
    step: [Row; 2],
    sign: Row,
}

/// Room for the sides of strips, which is used again.
#[derive(Debug)]
pub(super) struct Room([Sides; SIDES]);

impl Default for Room {
    fn default() -> Self {
        Self([Sides::default(); SIDES])
    }
}

/// What several pixels sum up to; positive for the first colour.
pub(super) struct Sums {
    values: Row,
    bounds: Row,
}

impl Sums {
    pub fn of(&self, pixel: usize) -> Sum {
        let (value, bound) = (self.values[pixel], self.bounds[pixel]);
        Sum {
            value,
            // Of squares as large as numbers can be products are lost.
            bound: if value.is_nan() { f64::INFINITY } else { bound },
        }
    }
}

impl Lines {
    /// Sets one of the pixels.
    pub fn set(&mut self, place: usize, views: &Views, corners: &Corners, pixel: usize) {
        let [a, b] = corners.lines.each_ref().map(|lines| lines[pixel]);
        let order = if a <= b { [0, 1] } else { [1, 0] };
        for (family, from) in [&mut self.few, &mut self.many].into_iter().zip(order) {
            family.first[place] = corners.first[from][pixel];
            for (out, factor) in family.across.iter_mut().zip(&views.across[from]) {
                out[place] = factor[pixel];
            }
        }
        for (out, factor) in self.below.iter_mut().zip(&views.below) {
            out[place] = factor[pixel];
        }
        for (out, square) in self.squares.iter_mut().zip(&corners.squares[order[0]]) {
            out[place] = square[pixel];
        }
        self.rad[place] = views.rad[pixel];
        self.sign[place] = views.sign[pixel];
    }

    /// The integrals over the pixels, which so many lines of either family cross.
    pub fn sums(&self, lines: [usize; 2], room: &mut Room) -> Sums {
        sums_simd(self, lines, room)
    }

    #[inline(always)]
    fn compute(&self, [few, many]: [usize; 2], Room(sides): &mut Room) -> Sums {
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
        // Each line that cuts, and the two next to them, may be off by 4 roundings of a point besides.
        let [strips, lines] = [few + 1, many + 1].map(|count| count as f64);
        let points = 4.0 * UNIT * (strips + 1.0);
        Sums {
            values: array::from_fn(|i| {
                let wave = square_wave(self.many.first[i] + self.few.first[i]);
                self.sign[i] * wave * sums[i]
            }),
            bounds: array::from_fn(|i| {
                let roundings = UNIT * lines * (16.0 * lengths[i] + 8.0 * strips + 2.0 * lines);
                let displaced = offs[i] * (1.0 + strips) + displaced[i] + points;
                3.0 * displaced + roundings + failed[i]
            }),
        }
    }

    /// Adds how far line `line` of a family, counted from its first, may be from the computed one: its factors have three roundings, its value four.
    #[inline(always)]
    fn add_off(&self, family: &Family, line: f64, out: &mut Row) {
        for (i, out) in out.iter_mut().enumerate() {
            let n = family.first[i] + line;
            let size = |k: usize| family.across[k][i].abs() + (n * self.below[k][i]).abs();
            let slope = |k: usize| (family.across[k][i] - n * self.below[k][i]).abs();
            let value =
                7.0 * UNIT * (0.5 * (size(0) + size(1)) + size(2)) + self.rad[i] * (1.0 + n.abs());
            *out += value / slope(0).max(slope(1));
        }
    }

    /// Cuts the pixels into strips. The square wave is 1 in the first of them. 0 for each that could be cut, else infinite.
    #[inline(always)]
    fn strips(&self, few: usize, sides: &mut [Sides]) -> Row {
        let mut failed = [0.0; PIXELS];
        let (parts, chords) = sides.split_at_mut(4 * (few + 1));
        // Along each side how far the part in the next strip reaches.
        let mut reached = [[0.0; PIXELS]; 4];
        for (corner, reached) in reached.iter_mut().enumerate() {
            let [here, next] = [corner, (corner + 1) % 4].map(|corner| &self.squares[corner]);
            for (i, reached) in reached.iter_mut().enumerate() {
                *reached = if next[i] >= here[i] { 0.0 } else { 1.0 };
            }
        }
        for strip in 0..=few {
            let sign = if strip % 2 == 0 { 1.0 } else { -1.0 };
            let is_last = strip == few;
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
                    let n = self.few.first[i] + (strip + 1) as f64;
                    let factor = |k: usize| self.few.across[k][i] - n * self.below[k][i];
                    let line = [factor(0), factor(1), factor(2)];
                    let (start, end) = (value(line, from), value(line, to));
                    let place = start / (start - end);
                    let place = if place > 0.0 { place } else { 0.0 };
                    let place = if place < 1.0 { place } else { 1.0 };
                    // Beyond the last line there is nothing.
                    let (starts_below, ends_below) =
                        (is_last | (here[i] < n), is_last | (next[i] < n));
                    let is_up = next[i] >= here[i];
                    let whole = if starts_below == is_up { 1.0 } else { 0.0 };
                    places[i] = if starts_below != ends_below {
                        place
                    } else {
                        whole
                    };
                    // Where both ends are on the line, no place can be told.
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
            // The strip above runs along its chord from where the boundary leaves it to where it came in.
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

    /// Twice the signed area of the strips beyond a line of the second family, counted from its first.
    #[inline(always)]
    fn beyond(&self, line: f64, sides: &[Sides]) -> Row {
        let mut area = [0.0; PIXELS];
        let (mut form, mut origin) = ([[0.0; PIXELS]; 3], [[0.0; PIXELS]; 2]);
        for i in 0..PIXELS {
            let n = self.many.first[i] + line;
            let factor = |k: usize| self.many.across[k][i] - n * self.below[k][i];
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
                // A side that lies on the line as a whole contributes nothing either way.
                let all = here.abs() + there.abs() + f64::MIN_POSITIVE;
                let twice = (x - origin[0][i]) * down - (y - origin[1][i]) * across;
                area[i] += sign[i] * twice * (beyond / all);
            }
        }
        area
    }
}

/// A whole number that is nearest to one below 2^51.
#[inline(always)]
fn nearest(x: f64) -> f64 {
    (x + ROUND) - ROUND
}

#[multiversion(targets = "simd")]
fn sums_simd(pixels: &Lines, lines: [usize; 2], room: &mut Room) -> Sums {
    pixels.compute(lines, room)
}
