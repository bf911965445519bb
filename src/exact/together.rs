//! Pixels that show nothing but a checkerboard and few of its lines, several at a time.
//!
//! The same sums as those of `grid`, by the same formulas: strips between the lines of the family of which there are fewer, and the area of
//! those beyond each line of the other. But here it is pixels that lie beside each other in vectors, not lines: so `groups` sorts them by how
//! many lines of either family cross them, and what is done for each is the same for all that are computed together. A side of the pixel has a
//! part, which may have no length, in each strip.
//!
//! The bound is that of `grid`, too. A part without length starts and ends at the same number, so that it adds 0, which takes no rounding: there
//! are no more sides to count than there.

use std::array;

use glam::DVec2;
use multiversion::multiversion;

use super::{
    board::{Sum, UNIT},
    groups::{Corners, STRIPS},
    polygon::PIXEL,
};
use crate::{
    math::ROUND,
    tracer::{PIXELS, Views},
};

/// A number of each pixel.
pub(super) type Row = [f64; PIXELS];

/// The factors of a linear form.
type Form = [Row; 3];

/// Sides of strips: parts of the spot's four, and a chord for each line.
const SIDES: usize = 4 * (STRIPS + 1) + STRIPS;

/// The boards of some pixels, the family with fewer lines first.
#[derive(Debug, Default)]
pub(super) struct Lines {
    few: Family,
    many: Family,
    below: Form,
    rad: Row,
    /// Of each pixel, −1 where square [0, 1)² has the second colour.
    sign: Row,
    /// In which squares of the first family the corners lie.
    squares: [Row; 4],
}

/// The lines of one family.
#[derive(Debug, Default)]
struct Family {
    across: Form,
    first: Row,
}

/// Directed sides as in `grid`, one of each pixel.
#[derive(Clone, Copy)]
struct Sides {
    start: [Row; 2],
    step: [Row; 2],
    sign: Row,
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
    pub fn sums(&self, lines: [usize; 2]) -> Sums {
        sums_widely(self, lines)
    }

    #[inline(always)]
    fn compute(&self, [few, many]: [usize; 2]) -> Sums {
        let mut sides = [Sides {
            start: [[0.0; PIXELS]; 2],
            step: [[0.0; PIXELS]; 2],
            sign: [0.0; PIXELS],
        }; SIDES];
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
        // As in `grid`: each line that cuts, and the two next to them, may be off by 4 roundings of a point besides.
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

    /// Adds how far line `line` of a family, counted from its first, may be from the computed one.
    #[inline(always)]
    fn add_off(&self, family: &Family, line: f64, out: &mut Row) {
        for (i, out) in out.iter_mut().enumerate() {
            let n = family.first[i] + line;
            let size = |k: usize| family.across[k][i].abs() + (n * self.below[k][i]).abs();
            let slope = |k: usize| (family.across[k][i] - n * self.below[k][i]).abs();
            let value =
                6.0 * UNIT * (0.5 * (size(0) + size(1)) + size(2)) + self.rad[i] * (1.0 + n.abs());
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

/// The square wave at a whole number below 2^51.
#[inline(always)]
fn square_wave(n: f64) -> f64 {
    let half = 0.5 * n;
    if nearest(half) == half { 1.0 } else { -1.0 }
}

/// A whole number that is nearest to one below 2^51.
#[inline(always)]
pub(super) fn nearest(x: f64) -> f64 {
    (x + ROUND) - ROUND
}

#[multiversion(targets = "simd")]
fn sums_widely(pixels: &Lines, lines: [usize; 2]) -> Sums {
    pixels.compute(lines)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::{
        groups::Groups,
        waiting::{self, of_several},
    };
    use proptest::prelude::*;

    /// As many boards as there are pixels, seen about a place, each a little farther on.
    fn seen([a, b]: [[f64; 2]; 2], place: [f64; 2], tilt: [f64; 2], step: f64) -> Views {
        let mut views = Views::default();
        for pixel in 0..PIXELS {
            let below = [tilt[0], tilt[1], 1.0];
            for (form, (slopes, at)) in [(a, place[0]), (b, place[1])].into_iter().enumerate() {
                let at = at + step * pixel as f64;
                let across = [slopes[0] + at * below[0], slopes[1] + at * below[1], at];
                for (out, factor) in views.across[form].iter_mut().zip(across) {
                    out[pixel] = factor;
                }
            }
            for (out, factor) in views.below.iter_mut().zip(below) {
                out[pixel] = factor;
            }
            views.sign[pixel] = if pixel % 3 == 0 { -1.0 } else { 1.0 };
        }
        views
    }

    /// The sum of each pixel for itself, in a group that others fill up; none if no group takes it.
    fn sums(views: &Views) -> Vec<Option<Sum>> {
        let mut corners = Corners::default();
        corners.look(views);
        let at = |pixel: usize| {
            let mut groups = Groups::default();
            let group = groups.of(&corners, pixel)?;
            while !group.push((), views, &corners, pixel) {}
            let sums = group.sums();
            assert_eq!(group.pixels.len(), PIXELS);
            for other in 1..PIXELS {
                assert_eq!(sums.of(other).value.to_bits(), sums.of(0).value.to_bits());
            }
            Some(sums.of(0))
        };
        (0..PIXELS).map(at).collect()
    }

    #[test]
    fn many_lines_and_the_horizon_are_left_to_others() {
        for views in [
            seen([[40.0, 0.0], [0.0, 40.0]], [0.5; 2], [0.0; 2], 0.01),
            seen([[0.0, 500.0], [0.1, 0.0]], [0.5; 2], [0.0; 2], 0.01),
            seen([[1.0, 0.0], [0.0, 1.0]], [0.5; 2], [0.0, 2.5], 0.01),
            seen([[1.0, 0.0], [0.0, 1.0]], [1e10; 2], [0.0; 2], 0.01),
            seen([[1.0, 0.0], [0.0, 1.0]], [f64::NAN; 2], [0.0; 2], 0.01),
        ] {
            assert!(sums(&views).iter().all(Option::is_none), "{views:?}");
        }
    }

    #[test]
    fn nothing_is_said_where_all_of_a_pixel_is_on_a_line() {
        let views = seen([[0.0; 2], [1.0, 0.0]], [0.0, 0.5], [0.0; 2], 0.0);
        for sum in sums(&views).into_iter().flatten() {
            assert!(sum.bound.is_nan() || sum.bound >= 1.0, "{sum:?}");
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(600))]

        #[test]
        fn it_is_what_each_pixel_gives_for_itself(
            a in prop::array::uniform2(-3.0..3.0f64),
            b in prop::array::uniform2(-9.0..9.0f64),
            place in prop::array::uniform2(-2.0..2.0f64),
            tilt in prop::array::uniform2(-0.6..0.6f64),
            step in 0.0..1.0f64,
            whole in prop::bool::ANY,
        ) {
            // Lines through corners and along sides among them.
            let round = |x: f64| if whole { (2.0 * x).round() * 0.5 } else { x };
            let views = seen([a.map(round), b.map(round)], place.map(round), tilt, round(step));
            for (pixel, sum) in sums(&views).into_iter().enumerate() {
                let (Some(sum), Some(other)) = (sum, waiting::alone(&of_several(&views, pixel))) else { continue };
                // What has no bound here is asked for elsewhere, and that is no more than lines through corners.
                if whole && !sum.bound.is_finite() {
                    continue;
                }
                let off = (sum.value - other.value).abs();
                prop_assert!(off <= sum.bound + other.bound, "{sum:?} and {other:?}");
                // The same terms, none of which is negative, in another order.
                prop_assert!(sum.bound <= other.bound * (1.0 + 1000.0 * UNIT), "{sum:?} and {other:?}");
            }
        }
    }
}
