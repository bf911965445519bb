//! The integral of the board's sign over a convex polygon of the picture.

use std::sync::atomic::AtomicBool;

use glam::DVec2;

use super::{cells, edge, sides::Known};
use crate::math::{Double, Real, two_product};

/// The unit roundoff of `f64`.
pub(super) const UNIT: f64 = <f64 as Real>::UNIT;
/// Up to about this many squares are cut out one by one.
const FEW: f64 = 24.0;
/// The part of the board that is further away than so many squares is summed along its boundary: there the n-th term of the
/// series is at most n/π of its inverse times the one before.
pub(super) const FAR: f64 = 18.0;

/// Nothing is said of near squares beyond this m: there the horizon is a few roundings away. (The largest factor of L is
/// about 1.)
const DEEP: f64 = 1e13;

/// Nor one of no more than this line by line.
const ENOUGH: f64 = 1e-13;

/// Forms of about the same size have no smaller determinant.
const LEAST: f64 = 1e-100;

/// A displacement of no more area than this is not looked at closely.
const LITTLE: f64 = 1e-14;

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
    /// ∂m/∂a and ∂m/∂b.
    pub(super) slope: [f64; 2],
    /// m where a and b are 0.
    pub(super) origin: f64,
    pub(super) density: f64,
    /// K over |∂m/∂a| and over |∂m/∂b|, with bounds relative to them: well known even where K itself is not.
    pub(super) per_slope: [Sum; 2],
    /// How far det M may be from the true one, relative to it.
    uncertain: f64,
    /// Whether the floor is seen mirrored: the sign of det M.
    pub(super) handed: f64,
    /// How far, in pixels (|dx| + |dy|), rounding may displace a corner or a line of the board.
    pub(super) displacement: f64,
    /// The direction of the horizon, of length 1.
    horizon: DVec2,
    /// The same for what is displaced across the direction of the horizon: on the horizon, and more for every 1 of L.
    upwards: [f64; 2],
    /// What may be neglected at the horizon, for an edge that runs into it, in square pixels.
    pub(super) tail: f64,
}

/// A corner of a region: where it is in the picture, what floor it shows, and m there.
///
/// On the horizon m is infinite, and a and b are the direction (da, db)/dm in which edges leave for it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    pub at: DVec2,
    pub floor: [f64; 2],
    pub depth: f64,
}

pub(super) fn form(c: &[f64; 3], p: DVec2) -> f64 {
    c[0] * p.x + c[1] * p.y + c[2]
}

/// What the terms of a form add up to at most.
pub(super) fn size([x, y, z]: &[f64; 3]) -> f64 {
    0.5 * (x.abs() + y.abs()) + z.abs()
}

/// A cross product, each part to within two roundings of itself.
fn cross(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    minors(a, b).map(|[plus, minus]| (plus.hi - minus.hi) + (plus.lo - minus.lo))
}

/// The products, without an error, of which a cross product's parts are the differences.
fn minors(a: &[f64; 3], b: &[f64; 3]) -> [[Double; 2]; 3] {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| [two_product(a[i], b[j]), two_product(a[j], b[i])])
}

/// A form by a power of two that brings its largest factor between 1 and 2, and that power.
fn normalized(form: [f64; 3]) -> ([f64; 3], i32) {
    let largest = form.iter().fold(f64::MIN_POSITIVE, |m, c| m.max(c.abs()));
    let exponent = libm::ilogb(largest);
    (form.map(|c| libm::ldexp(c, -exponent)), exponent)
}

impl Board {
    /// The board of three linear forms, N_a and N_b, and L; they may have any common positive factor, and M must be
    /// invertible. The nearer the origin of a and b is to the pixel, the smaller the bounds.
    pub(crate) fn new(across: [[f64; 3]; 2], below: [f64; 3]) -> Self {
        let (l, scale) = normalized(below);
        let [a, b] = across.map(|form| form.map(|c| libm::ldexp(c, -scale)));
        // Squares may be of any size; the inverse is that of forms of about the same size.
        let [(wide, of_a), (high, of_b)] = [a, b].map(normalized);
        let columns = [cross(&high, &l), cross(&l, &wide), cross(&wide, &high)];
        let det = minors(&wide, &high)
            .iter()
            .zip(l)
            .fold(Double::from_f64(0.0), |sum, ([plus, minus], l)| {
                sum.plus(&plus.minus(minus).times(&Double::from_f64(l)))
            })
            .to_f64();
        // Where nothing is left of it, next to nothing will do: it is off by more.
        let det = if det.abs() > LEAST { det } else { LEAST };
        let third = |column: usize, exponent: i32| libm::ldexp(columns[column][2] / det, -exponent);
        let per_slope = |column: usize, form: &[f64; 3], exponent: i32| {
            let minor = columns[column][2].abs();
            let terms = (form[0] * l[1]).abs() + (form[1] * l[0]).abs();
            Sum {
                value: libm::ldexp(1.0 / minor, -exponent),
                bound: 2.0 * UNIT * (terms / minor + 2.0),
            }
        };
        let volume = det.abs();
        // Of each of the six products three factors are off by a rounding each, and what that leaves is rounded.
        let products: f64 = (0..3)
            .map(|i| {
                let [j, k] = [(i + 1) % 3, (i + 2) % 3];
                l[i].abs() * ((wide[j] * high[k]).abs() + (wide[k] * high[j]).abs())
            })
            .sum();
        // A form's value is off by at most three roundings of its largest terms, and M⁻¹ takes that to the picture. The
        // fourth is for the quotient; coordinates themselves are rounded, too.
        let forms = [wide, high, l];
        let errors = forms.map(|form| 4.0 * UNIT * size(&form));
        let (mut displacement, mut tilt) = (4.0 * UNIT, 0.0);
        for (error, column) in errors.iter().zip(&columns) {
            let column = column.map(f64::abs);
            displacement += error * column.iter().sum::<f64>() / volume;
            tilt += error * column[2] / volume;
        }
        let steepness = libm::hypot(l[0], l[1]);
        Self {
            across: [a, b],
            below: l,
            slope: [third(0, of_a), third(1, of_b)],
            origin: third(2, 0),
            density: libm::ldexp(1.0 / volume, -of_a - of_b),
            per_slope: [per_slope(0, &high, of_b), per_slope(1, &wide, of_a)],
            uncertain: 4.0 * UNIT * products / volume,
            handed: det.signum(),
            displacement,
            horizon: DVec2::new(l[1], -l[0]) / steepness,
            upwards: [errors[2] / steepness + 4.0 * UNIT, tilt / steepness],
            tail: 5e-10,
        }
    }

    /// The integral of s(a)·s(b) over what a convex polygon shows of the floor, in square pixels; positive where the
    /// squares are, however the polygon is oriented. Some of its sides may be known, if it is a whole pixel. Once it is cancelled
    /// any sum will do.
    pub(super) fn over(
        &self,
        polygon: &[DVec2],
        known: Option<&mut Known>,
        cancel: &AtomicBool,
    ) -> Sum {
        self.unchecked(polygon, known, cancel)
            .within(polygon.iter().copied())
    }

    fn unchecked(&self, polygon: &[DVec2], known: Option<&mut Known>, cancel: &AtomicBool) -> Sum {
        let corners = self.visible(polygon);
        let first = match corners.first() {
            Some(first) if corners.len() > 2 => first,
            _ => return Sum::default(),
        };
        let endless = corners.iter().any(|c| c.depth.is_infinite());
        if endless {
            return self.far_or_both(&corners, known, cancel);
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
        self.far_or_both(&corners, known, cancel)
    }

    /// By how much rounding may change what a polygon shows of the board: the displacement of its boundary.
    ///
    /// A displacement v = M⁻¹e by errors e of the forms has L(v) = e_L: near the horizon points hardly move across it,
    /// however far they may move along it in the widest of views.
    pub(super) fn displaced(&self, points: impl Iterator<Item = DVec2> + Clone) -> f64 {
        let (_, perimeter) = measure(points.clone());
        let anyhow = self.displacement * perimeter;
        if anyhow <= LITTLE {
            return anyhow;
        }
        let level = points
            .clone()
            .fold(0.0, |m: f64, p| m.max(form(&self.below, p)));
        let [least, more] = self.upwards;
        let across = (least + more * level).min(self.displacement);
        let mut before = points.clone().last().unwrap_or_default();
        let sides = points.fold(0.0, |sum, point| {
            let step = point - before;
            before = point;
            let [along, up] = [self.horizon.dot(step), self.horizon.perp_dot(step)].map(f64::abs);
            sum + across * along + self.displacement * up
        });
        anyhow.min(sides)
    }

    /// The same, or less: line by line of the board, which counts in the widest of views, where the forms of a and b are so
    /// nearly parallel that points are displaced far along them, but no line is.
    ///
    /// Let corners be off by e_a, e_b and e_L of the forms, and what is between them by what is between. Moving every point up by
    /// e_L/|∇L| is the same as to change L by e_L, and N by e_L·(∇N·∇L)/|∇L|². On any straight way up e_L grows and falls as
    /// often as sides of triangles between corners are crossed, so that the motion changes the integral by up to
    /// 2·corners·E_L/|∇L| for every 1 of width. N that is off by up to E changes the signs of points where |N − iL| ≤ E, a strip
    /// along the line i, as wide as 2E/|∇N − i∇L|; that gradient is at least |i − i_0|·|∇L|, and at least |∇N × ∇L|/|∇L|,
    /// where i_0 = ∇N·∇L/|∇L|². Lines beyond 2^60 are all within E of the horizon.
    pub(super) fn blurred(&self, points: impl Iterator<Item = DVec2> + Clone) -> f64 {
        const LINES: f64 = 100.0;
        let displaced = self.displaced(points.clone());
        if displaced <= ENOUGH {
            return displaced;
        }
        let off = |form: &[f64; 3]| 8.0 * UNIT * size(form);
        let gradient = |[x, y, _]: [f64; 3]| DVec2::new(x, y);
        let up = gradient(self.below);
        let (steepness, of_l) = (up.length(), off(&self.below));
        let strips = self.across.map(|across| {
            let n = gradient(across);
            let middle = n.dot(up) / (steepness * steepness);
            let off = off(&across) + of_l * middle.abs();
            // Σ 1/max(|i − i_0|, k), of which those next to i_0 are 3 at most by 1/k, and the others twice a logarithm.
            let k = n.perp_dot(up).abs() / (steepness * steepness);
            4.0 * off * (3.0 * (1.0 / k).max(1.0) + LINES)
        });
        let (_, perimeter) = measure(points.clone());
        let widest = 0.5 * perimeter / steepness;
        let lines = widest * (2.0 * points.count() as f64 * of_l + strips[0] + strips[1]);
        displaced.min(lines)
    }

    /// How far the inverse of ∂m/∂a or of ∂m/∂b may be from the true one: that is known even where those may have any size.
    pub(super) fn flat(&self, axis: usize) -> f64 {
        let minor = self.per_slope[axis].bound;
        (self.uncertain + minor + 4.0 * UNIT) / self.slope[axis].abs()
    }

    /// Whether a polygon shows the horizon.
    pub(crate) fn is_endless(&self, polygon: &[DVec2]) -> bool {
        polygon.iter().any(|&at| form(&self.below, at) <= 0.0)
    }

    /// Along the boundary where the board is far enough for it, square by square where it is not.
    fn far_or_both(
        &self,
        corners: &[Corner],
        known: Option<&mut Known>,
        cancel: &AtomicBool,
    ) -> Sum {
        let depth = FAR * (self.slope[0].abs() + self.slope[1].abs());
        let nearest = corners.iter().fold(f64::INFINITY, |m, c| m.min(c.depth));
        let furthest = corners.iter().fold(0.0, |m: f64, c| m.max(c.depth));
        if nearest >= depth {
            return edge::sum(self, corners, known);
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
        sum.add(edge::sum(self, &far, known).within(far.iter().map(|c| c.at)));
        sum
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

    /// The corner at a point where L has a value; on the horizon, where it is 0.
    pub(super) fn corner(&self, at: DVec2, level: f64) -> Corner {
        let floor = [form(&self.across[0], at), form(&self.across[1], at)];
        let depth = 1.0 / level;
        // Where even the quotient overflows there is nothing but the horizon.
        if depth.is_finite() && (floor[0] * depth).is_finite() && (floor[1] * depth).is_finite() {
            Corner {
                at,
                floor: floor.map(|n| n * depth),
                depth,
            }
        } else {
            Corner {
                at,
                floor,
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
