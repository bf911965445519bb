//! The integral of the board's sign over a convex polygon of the picture.

use std::{array, sync::atomic::AtomicBool};

use glam::DVec2;

use super::{
    cells,
    displaced::displacements,
    edge,
    floor::{Fine, Floor},
    inverse::Inverse,
};
use crate::{
    math::{Double, Real},
    tracer,
};

/// The unit roundoff of `f64`.
pub(super) const UNIT: f64 = <f64 as Real>::UNIT;
/// Up to about this many squares are cut out one by one.
const FEW: f64 = 24.0;
/// The part of the board that is further away than so many squares is summed along its boundary: there the n-th term of the
/// series is at most n/π of its inverse times the one before.
pub(super) const FAR: f64 = 18.0;

/// Nothing is said of near squares beyond this m: there the horizon is a few roundings away. (The largest factor of L is
/// about 1.)
pub(super) const DEEP: f64 = 1e13;

/// An edge that crosses no more lines than this may be that of a pixel with so few squares that hardly anything is neglected there; one that
/// crosses more, but not all, is neglected less than one that runs into the horizon. (A pixel may have a dozen such edges.)
const COUNTED: f64 = 1e5;
const COUNTED_TAIL: f64 = 4e-14;
const FINITE_TAIL: f64 = 1e-10;

/// A sum along the boundary with no greater bound than this is good enough.
const GOOD_FAR: f64 = 1e-8;

/// Where roundings displace points by more than this, in pixels, edges and floor no longer fit each other.
const MISFIT: f64 = 0.1;

/// Where they displace points by no more than this, what may be on the horizon but for them is said to be on it.
const BESIDE: f64 = 1e-11;

/// What is farther than this m is next to nothing of a pixel.
const NEXT_TO_NOTHING: f64 = 1e9;

/// A number and a bound on its absolute error, in square pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Sum {
    pub value: f64,
    pub bound: f64,
}

impl Sum {
    /// Out of the range of numbers, or not worth having: then all that is known is that no sum is greater than the area.
    fn within(self, polygon: impl Iterator<Item = DVec2>) -> Self {
        let area = measure(polygon).0.abs();
        if self.value.is_finite() && self.bound < area {
            return self;
        }
        Self {
            value: 0.0,
            bound: area,
        }
    }

    pub(super) fn add(&mut self, other: Sum) {
        self.value += other.value;
        self.bound += other.bound;
    }
}

/// The infinite board as a pixel sees it.
///
/// A point of the picture, (x, y) in pixels from the pixel's centre (at most ½ either way), shows the point
/// (a, b) = (N_a/L, N_b/L) of the floor, in squares; each of N_a, N_b, L is a linear form c0·x + c1·y + c2, and L > 0 is the
/// side of the horizon where the floor is. The sign of a square is s(a)·s(b) with s the square wave.
///
/// With M the matrix of the three forms, 1/L = m(a, b) = p·a + q·b + r is the third row of M⁻¹: a depth, linear on the
/// floor. A piece da·db of floor covers J = K/m³ square pixels, K = 1/|det M|.
#[derive(Clone, Debug)]
pub(crate) struct Board {
    pub(super) across: [[f64; 3]; 2],
    pub(super) below: [f64; 3],
    /// What the inverse of these forms, as they are rounded, says of the floor: it fits corners that they have been asked for.
    pub(super) floor: Floor,
    /// The same with less rounding.
    pub(super) fine: Fine,
    /// How far, in pixels (|dx| + |dy|), rounding may displace a corner or a line of the board.
    pub(super) displacement: f64,
    /// The direction of the horizon, of length 1.
    pub(super) horizon: DVec2,
    /// The same for what is displaced across the direction of the horizon: on the horizon, and more for every 1 of L.
    pub(super) upwards: [f64; 2],
    /// What roundings leave of L on the horizon.
    pub(super) horizon_off: f64,
    /// What may be neglected at the horizon, for an edge that runs into it, in square pixels.
    pub(super) tail: f64,
    /// How many times as much as of a pixel may be neglected of its spot, which is a small part of one.
    pub(super) leeway: f64,
}

/// A corner of a region: where it is in the picture, what floor it shows, and m there.
///
/// On the horizon m is infinite, and a and b are the direction (da, db)/dm in which edges leave for it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    pub at: DVec2,
    pub floor: [f64; 2],
    /// What rounding left of the former, where that counts.
    pub low: [f64; 2],
    pub depth: f64,
}

impl Corner {
    /// Where it is along an axis of the floor.
    pub fn place(&self, axis: usize) -> Double {
        Double {
            hi: self.floor[axis],
            lo: self.low[axis],
        }
    }
}

pub(super) fn form(c: &[f64; 3], p: DVec2) -> f64 {
    c[0] * p.x + c[1] * p.y + c[2]
}

/// What the terms of a form add up to at most.
pub(super) fn size([x, y, z]: &[f64; 3]) -> f64 {
    0.5 * (x.abs() + y.abs()) + z.abs()
}

/// A form by a power of two that brings its largest factor between 1 and 2, and that power.
pub(super) fn normalized(form: [f64; 3]) -> ([f64; 3], i32) {
    let largest = form.iter().fold(f64::MIN_POSITIVE, |m, c| m.max(c.abs()));
    let exponent = libm::ilogb(largest);
    (form.map(|c| libm::ldexp(c, -exponent)), exponent)
}

impl Board {
    /// The board of three linear forms, N_a and N_b, and L; they may have any common positive factor, and M must be
    /// invertible. The nearer the origin of a and b is to the pixel, the smaller the bounds.
    #[cfg(test)]
    pub(crate) fn new([a, b]: [[f64; 3]; 2], below: [f64; 3]) -> Self {
        let forms = [a, b, below].map(|form| form.map(Double::from_f64));
        Self::fine(forms, [0.0; 3])
    }

    /// The board as a spot sees it.
    pub(crate) fn of(seen: &tracer::Board) -> Self {
        let [a, b] = seen.across;
        let forms = [a, b, seen.below];
        let fine = array::from_fn(|i| {
            array::from_fn(|k| Double {
                hi: forms[i][k],
                lo: seen.low[i][k],
            })
        });
        Self::fine(fine, seen.rads)
    }

    /// Whether its forms should be asked for more closely.
    pub(super) fn is_doubtful(&self) -> bool {
        self.fine.is_doubtful
    }

    fn fine(forms: [[Double; 3]; 3], rads: [f64; 3]) -> Self {
        let [a, b, below] = forms.map(|form| form.map(|c| c.hi));
        let (l, scale) = normalized(below);
        let [a, b] = [a, b].map(|form| form.map(|c| libm::ldexp(c, -scale)));
        let forms = forms.map(|form| form.map(|c| c.scaled(-scale)));
        let rads = rads.map(|rad| libm::ldexp(rad, -scale));
        // Squares may be of any size; the inverse is that of forms of about the same size.
        let [(wide, of_a), (high, of_b)] = [a, b].map(normalized);
        let powers = [of_a, of_b];
        let rounded = [wide, high, l];
        let inverse = Inverse::of_rounded(&rounded);
        let floor = Floor::new(&inverse, powers);
        let (fine, inverse) = match inverse.is_good() {
            true => (Fine::rounded(forms, rads, floor.clone()), inverse),
            false => Fine::new(forms, rads, powers),
        };
        // A form's value is off by at most three roundings of its largest terms; the fourth is for the quotient.
        let errors = rounded.map(|form| 4.0 * UNIT * size(&form));
        let steepness = libm::hypot(l[0], l[1]);
        let (displacement, upwards) = displacements(&errors, &inverse, steepness);
        Self {
            across: [a, b],
            below: l,
            floor,
            fine,
            displacement,
            horizon: DVec2::new(l[1], -l[0]) / steepness,
            upwards,
            horizon_off: match displacement <= BESIDE {
                true => 0.5 * errors[2],
                false => 0.0,
            },
            tail: 5e-10,
            leeway: 1.0,
        }
    }

    /// The integral of s(a)·s(b) over what a convex polygon shows of the floor, in square pixels; positive where the
    /// squares are, however the polygon is oriented. Once it is cancelled any sum will do.
    pub(super) fn over(&self, polygon: &[DVec2], cancel: &AtomicBool) -> Sum {
        let mut sum = self.unchecked(polygon, cancel);
        if self.fine.nudge > 0.0 {
            // What lies between the lines of both boards is in doubt, and that is less by as much as the nudge is than a rounding.
            sum.bound += self.fine.nudge * self.blurred(polygon.iter().copied());
        }
        sum.within(polygon.iter().copied())
    }

    fn unchecked(&self, polygon: &[DVec2], cancel: &AtomicBool) -> Sum {
        let corners = self.visible(polygon);
        let first = match corners.first() {
            Some(first) if corners.len() > 2 => first,
            _ => return Sum::default(),
        };
        let endless = corners.iter().any(|c| c.depth.is_infinite());
        if endless {
            let mut sum = self.far_or_both(&corners, cancel);
            let is_beside = |&at: &DVec2| {
                let level = form(&self.below, at);
                level > 0.0 && level <= self.horizon_off
            };
            if polygon.iter().any(is_beside) {
                // Said to be on the horizon, such corners displace what is seen once more as roundings do.
                sum.bound += self.blurred(corners.iter().map(|c| c.at));
            }
            return sum;
        }
        let spans = spans(&corners);
        if spans == [1.0, 1.0] {
            let low = first.floor;
            let sign = super::euler::square_wave(low[0]) * super::euler::square_wave(low[1]);
            let points = corners.iter().map(|c| c.at);
            return Sum {
                value: sign * measure(points.clone()).0.abs(),
                bound: if self.is_certain(&corners) {
                    2.0 * UNIT
                } else {
                    self.blurred(points)
                },
            };
        }
        if squares(&corners).min(spans[0] * spans[1]) <= FEW {
            return cells::sum(self, &corners, cancel);
        }
        self.far_or_both(&corners, cancel)
    }

    /// What may be neglected of an edge that crosses so many lines, in square pixels.
    pub(super) fn tail(&self, lines: f64) -> f64 {
        match lines {
            ..=COUNTED => COUNTED_TAIL,
            ..f64::INFINITY => FINITE_TAIL * self.leeway,
            _ => self.tail * self.leeway,
        }
    }

    /// Along the boundary where the board is far enough for it, square by square where it is not.
    fn far_or_both(&self, corners: &[Corner], cancel: &AtomicBool) -> Sum {
        let [p, q] = self.fine.floor.slope;
        let depth = FAR * (p.abs() + q.abs());
        let nearest = corners.iter().fold(f64::INFINITY, |m, c| m.min(c.depth));
        let furthest = corners.iter().fold(0.0, |m: f64, c| m.max(c.depth));
        if nearest >= depth {
            return self.far(corners, cancel);
        }
        if depth.min(furthest) > DEEP {
            let [near, behind] = self.split(corners, DEEP);
            let mut sum = cells::sum(self, &near, cancel);
            sum.bound += measure(behind.iter().map(|c| c.at)).0.abs();
            return sum;
        }
        if furthest <= depth {
            return cells::sum(self, corners, cancel);
        }
        let [near, far] = self.split(corners, depth);
        let mut sum = cells::sum(self, &near, cancel);
        sum.add(self.far(&far, cancel));
        sum
    }

    /// Along the boundary; or, where corners as they are rounded do not tell m from a and b, as if it were near, but for next to nothing.
    fn far(&self, corners: &[Corner], cancel: &AtomicBool) -> Sum {
        let along =
            |corners: &[Corner]| edge::sum(self, corners).within(corners.iter().map(|c| c.at));
        let fits = self.displacement <= MISFIT;
        let sum = fits.then(|| along(corners));
        if let Some(sum) = sum.filter(|sum| !self.fine.is_needed || sum.bound <= GOOD_FAR) {
            return sum;
        }
        let [near, behind] = self.split(corners, NEXT_TO_NOTHING);
        let mut other = cells::sum(self, &near, cancel);
        other.add(match fits {
            true => along(&behind),
            false => Sum {
                value: 0.0,
                bound: measure(behind.iter().map(|c| c.at)).0.abs(),
            },
        });
        sum.filter(|sum| sum.bound <= other.bound).unwrap_or(other)
    }

    /// The parts in front of a depth and behind it.
    fn split(&self, corners: &[Corner], depth: f64) -> [Vec<Corner>; 2] {
        let mut line = self.below;
        line[2] -= 1.0 / depth;
        [
            self.clip(corners, &line),
            self.clip(corners, &line.map(|c| -c)),
        ]
    }

    /// The corners of the part of a convex polygon where L ≥ 0.
    pub(super) fn visible(&self, polygon: &[DVec2]) -> Vec<Corner> {
        let mut corners = Vec::with_capacity(polygon.len() + 2);
        let Some(&last) = polygon.last() else {
            return corners;
        };
        let mut before = (last, form(&self.below, last));
        for &at in polygon {
            let level = form(&self.below, at);
            if (level > 0.0 && before.1 < 0.0) || (level < 0.0 && before.1 > 0.0) {
                let t = before.1 / (before.1 - level);
                corners.push(self.corner(before.0 + (at - before.0) * t, 0.0));
            }
            if level >= 0.0 {
                corners.push(self.corner(at, level));
            }
            before = (at, level);
        }
        corners
    }

    /// Where along an axis the floor is that a point shows, where L has a value above 0, and by how much roundings may be off.
    pub(super) fn place(&self, axis: usize, at: DVec2, level: f64) -> (f64, f64) {
        let place = form(&self.across[axis], at) / level;
        let terms = size(&self.across[axis]) + place.abs() * size(&self.below);
        (place, 16.0 * UNIT / level * terms)
    }

    /// The corner at a point where L has a value; on the horizon, where that is 0 or may be but for roundings.
    pub(super) fn corner(&self, at: DVec2, level: f64) -> Corner {
        let floor = [form(&self.across[0], at), form(&self.across[1], at)];
        let depth = match level <= self.horizon_off {
            true => f64::INFINITY,
            false => 1.0 / level,
        };
        // Where even the quotient overflows there is nothing but the horizon.
        if depth.is_finite() && (floor[0] * depth).is_finite() && (floor[1] * depth).is_finite() {
            Corner {
                at,
                floor: floor.map(|n| n * depth),
                low: [0.0; 2],
                depth,
            }
        } else {
            Corner {
                at,
                floor,
                low: [0.0; 2],
                depth: f64::INFINITY,
            }
        }
    }

    /// Whether all corners are in the same square whatever roundings do.
    fn is_certain(&self, corners: &[Corner]) -> bool {
        corners.iter().all(|corner| {
            (0..2).all(|axis| {
                let (place, off) = self.place(axis, corner.at, form(&self.below, corner.at));
                (place - off).floor() == (place + off).floor()
            })
        })
    }

    /// The part where a form of the picture is not negative.
    fn clip(&self, corners: &[Corner], line: &[f64; 3]) -> Vec<Corner> {
        let mut kept = Vec::with_capacity(corners.len() + 2);
        let Some(last) = corners.last() else {
            return kept;
        };
        let mut before = (last, form(line, last.at));
        for corner in corners {
            let side = form(line, corner.at);
            if (side > 0.0 && before.1 < 0.0) || (side < 0.0 && before.1 > 0.0) {
                let at = before.0.at + (corner.at - before.0.at) * (before.1 / (before.1 - side));
                kept.push(self.corner(at, form(&self.below, at)));
            }
            if side >= 0.0 {
                kept.push(*corner);
            }
            before = (corner, side);
        }
        kept
    }
}

/// How many squares a region meets along each axis.
fn spans(corners: &[Corner]) -> [f64; 2] {
    [0, 1].map(|i| {
        let squares = corners.iter().map(|corner| corner.floor[i].floor());
        let (low, high) = squares.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), t| {
            (low.min(t), high.max(t))
        });
        high - low + 1.0
    })
}

/// About how many squares a region meets: its area plus half its perimeter. A slanted strip has many fewer than its box.
fn squares(corners: &[Corner]) -> f64 {
    let [a, b] = spans(corners);
    a + b + measure(corners.iter().map(|c| c.floor.into())).0.abs()
}

/// The signed area and the perimeter, in |dx| + |dy|, of a polygon.
pub(super) fn measure(mut points: impl Iterator<Item = DVec2>) -> (f64, f64) {
    let Some(origin) = points.next() else {
        return (0.0, 0.0);
    };
    let (mut twice, mut perimeter, mut before) = (0.0, 0.0, DVec2::ZERO);
    for point in points.map(|p| p - origin) {
        twice += before.perp_dot(point);
        perimeter += (point.x - before.x).abs() + (point.y - before.y).abs();
        before = point;
    }
    (0.5 * twice, perimeter + before.x.abs() + before.y.abs())
}
