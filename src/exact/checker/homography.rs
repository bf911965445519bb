//! The homography from a pixel to a checkerboard, and what the rounding of its forms may do.
//!
//! In: a board's three linear forms as the tracer has them for a sub-pixel. Out: places and depths
//! on the floor, the depth's slopes and the density of the floor in the picture, and a bound on how
//! far roundings move what a polygon shows (a first-order perturbation of the forms by four
//! roundings each, taken back to the picture by the inverse of their matrix).

use glam::DVec2;

use super::super::clip::{Chord, measure, split};
use crate::math::{Double, Real, two_product};

/// The unit roundoff of `f64`.
pub(in crate::exact) const UNIT: f64 = <f64 as Real>::UNIT;

/// A determinant of less than this, of forms whose largest factors are about 1, is taken for
/// singular and replaced by it, so that its inverse and products with that are numbers; what is
/// computed then is in doubt as a whole.
const LEAST_DETERMINANT: f64 = 1e-100;

/// If roundings displace points by no more than this, in pixels, a corner that only they keep off
/// the horizon is said to be on it: what that changes is in the bound, and a hundredth of what is
/// asked for.
const BESIDE: f64 = 1e-11;

/// A number and a bound on its absolute error, in square pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(in crate::exact) struct Sum {
    pub value: f64,
    pub bound: f64,
}

/// The infinite board as a pixel sees it.
///
/// A point of the picture, (x, y) in pixels from the pixel's centre (at most ½ either way), shows
/// the point (a, b) = (N_a/L, N_b/L) of the floor, in squares; each of N_a, N_b, L is a linear form
/// c0·x + c1·y + c2, and L > 0 is the side of the horizon where the floor is. The sign of a square
/// is s(a)·s(b) with s the square wave.
///
/// With M the matrix of the three forms, 1/L = m(a, b) = p·a + q·b + r is the third row of M⁻¹: a
/// depth, linear on the floor. A piece da·db of floor covers J = K/m³ square pixels, K = 1/|det M|.
#[derive(Clone, Debug)]
pub(in crate::exact) struct Homography {
    /// N_a and N_b.
    pub across: [[f64; 3]; 2],
    /// L, by a power of two that brings its largest factor between 1 and 2.
    pub below: [f64; 3],
    /// ∂m/∂a and ∂m/∂b.
    pub slope: [f64; 2],
    /// K.
    pub density: f64,
    /// How far K may be from that of the forms as they are rounded, relative to it.
    pub misfit: f64,
    /// Whether the floor is seen mirrored: the sign of det M.
    pub handed: f64,
    /// How far, in pixels (|dx| + |dy|), rounding may displace a corner or a line of the board.
    displacement: f64,
    /// The direction of the horizon, of length 1.
    horizon: DVec2,
    /// How far rounding may displace across the direction of the horizon: where L is 0, and so
    /// much more for each unit of L.
    upwards: [f64; 2],
    /// Up to this L a point may lie on the horizon but for roundings, and is said to.
    horizon_off: f64,
}

/// A corner of a region: what floor it shows, and m there.
///
/// On the horizon m is infinite, and a and b are the direction (da, db)/dm in which edges leave for
/// it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    pub floor: [f64; 2],
    pub depth: f64,
}

/// The part of a convex polygon where L ≥ 0, and what of it is on the horizon.
#[derive(Debug)]
pub(super) struct Visible {
    pub polygon: Vec<DVec2>,
    horizon: Chord,
}

impl Sum {
    /// Of a polygon of which nothing is known: the mean of both colours.
    pub fn nothing_known(polygon: &[DVec2]) -> Self {
        Self {
            value: 0.0,
            bound: measure(polygon).0.abs(),
        }
    }

    /// This sum over so much area; the mean of both colours if it is out of the range of numbers or
    /// its bound is no less than the area.
    pub fn or_unknown(self, area: f64) -> Self {
        match self.value.is_finite() && self.bound < area {
            true => self,
            false => Self {
                value: 0.0,
                bound: area,
            },
        }
    }

    /// The same of a sum over a polygon.
    pub fn within(self, polygon: &[DVec2]) -> Self {
        self.or_unknown(measure(polygon).0.abs())
    }

    pub fn add(&mut self, other: Self) {
        self.value += other.value;
        self.bound += other.bound;
    }
}

/// A form's value at a point.
pub(in crate::exact) fn form(c: &[f64; 3], p: DVec2) -> f64 {
    c[0] * p.x + c[1] * p.y + c[2]
}

/// What the terms of a form add up to at most.
pub(in crate::exact) fn size([x, y, z]: &[f64; 3]) -> f64 {
    0.5 * (x.abs() + y.abs()) + z.abs()
}

/// A form by a power of two that brings its largest factor between 1 and 2, and that power.
fn normalized(form: [f64; 3]) -> ([f64; 3], i32) {
    let largest = form.iter().fold(f64::MIN_POSITIVE, |m, c| m.max(c.abs()));
    let exponent = libm::ilogb(largest);
    (form.map(|c| libm::ldexp(c, -exponent)), exponent)
}

impl Homography {
    /// Of three linear forms, N_a and N_b, and L; they may have any common positive factor. The
    /// nearer the origin of a and b is to the pixel, the smaller the bounds.
    pub fn new(across: [[f64; 3]; 2], below: [f64; 3]) -> Self {
        let (below, scale) = normalized(below);
        let across = across.map(|form| form.map(|c| libm::ldexp(c, -scale)));
        // Squares may be of any size; the inverse is that of forms of about the same size.
        let [(a, of_a), (b, of_b)] = across.map(normalized);
        // The columns of det M·M⁻¹, each part to within two roundings of itself.
        let columns = [cross(&b, &below), cross(&below, &a), cross(&a, &b)];
        let det = determinant(&a, &b, &below);
        let is_singular = det.abs() <= LEAST_DETERMINANT;
        let det = if is_singular { LEAST_DETERMINANT } else { det };
        let products: f64 = (0..3)
            .map(|i| {
                let [j, k] = [(i + 1) % 3, (i + 2) % 3];
                below[i].abs() * ((a[j] * b[k]).abs() + (a[k] * b[j]).abs())
            })
            .sum();
        // How far det M may be off, relative to it, where each of the three factors of a product is
        // off by so much of itself, or each of its sums and products in double-double by
        // two units; and 1/det M by its own roundings.
        let det_off = |unit: f64| match is_singular {
            true => f64::INFINITY,
            false => 8.0 * unit * products / det.abs() + 4.0 * UNIT,
        };
        // A form's value is off by at most three roundings of its largest terms; the fourth is for
        // the quotient.
        let errors = [a, b, below].map(|form| 4.0 * UNIT * size(&form));
        let steepness = libm::hypot(below[0], below[1]);
        // v = M⁻¹·e is how far errors e of the forms displace a point; L(v) = e_L. Coordinates
        // themselves are rounded, too.
        let volume = det.abs() * (1.0 - det_off(UNIT)).max(0.0);
        let (mut displacement, mut tilt) = (4.0 * UNIT, 0.0);
        for (error, column) in errors.iter().zip(&columns) {
            displacement += error * column.iter().map(|c| c.abs()).sum::<f64>() / volume;
            tilt += error * column[2].abs() / volume;
        }
        Self {
            across,
            below,
            slope: [(0, of_a), (1, of_b)].map(|(i, by)| libm::ldexp(columns[i][2] / det, -by)),
            // Beyond the range of f64 an exponent is the largest there is, and this is no number.
            density: libm::ldexp(1.0 / det.abs(), (-of_a).saturating_sub(of_b)),
            misfit: det_off(Double::UNIT),
            handed: det.signum(),
            displacement,
            horizon: DVec2::new(below[1], -below[0]) / steepness,
            upwards: [errors[2] / steepness + 4.0 * UNIT, tilt / steepness],
            horizon_off: match displacement <= BESIDE {
                true => 0.5 * errors[2],
                false => 0.0,
            },
        }
    }

    /// The part of a convex polygon that shows the floor.
    pub(super) fn visible(&self, polygon: &[DVec2]) -> Visible {
        let (mut above, mut visible) = (Vec::new(), Vec::with_capacity(polygon.len() + 1));
        let level = |at| form(&self.below, at);
        let horizon = split(polygon, level, &mut above, &mut visible);
        Visible {
            polygon: visible,
            horizon,
        }
    }

    /// What a point of what is visible shows.
    pub(super) fn corner(&self, at: DVec2, visible: &Visible) -> Corner {
        let is_on_horizon = |horizon: [DVec2; 2]| horizon.contains(&at);
        let level = match visible.horizon.is_some_and(is_on_horizon) {
            true => 0.0,
            false => form(&self.below, at),
        };
        let floor = self.across.map(|across| form(&across, at));
        let depth = match level <= self.horizon_off {
            true => f64::INFINITY,
            false => 1.0 / level,
        };
        // Where even the quotient overflows there is nothing but the horizon.
        let places = floor.map(|n| n * depth);
        match depth.is_finite() && places.iter().all(|place| place.is_finite()) {
            true => Corner {
                floor: places,
                depth,
            },
            false => Corner {
                floor,
                depth: f64::INFINITY,
            },
        }
    }

    /// Whether a point is said to be on the horizon just because of roundings.
    pub(super) fn is_beside_horizon(&self, at: DVec2) -> bool {
        let level = form(&self.below, at);
        level > 0.0 && level <= self.horizon_off
    }

    /// Where along an axis the floor is that a point shows, where L has a value above 0, and how
    /// far roundings may be off.
    pub(in crate::exact) fn place(&self, axis: usize, at: DVec2, level: f64) -> (f64, f64) {
        let place = form(&self.across[axis], at) / level;
        let terms = size(&self.across[axis]) + place.abs() * size(&self.below);
        // Three roundings in the factors of either form, four in its value, and one in the
        // quotient; twice that, where ℓ is off by half of itself at most.
        (place, 16.0 * UNIT / level * terms)
    }

    /// How much rounding may change what a polygon shows of the board, in square pixels: what the
    /// displacement of its boundary sweeps.
    ///
    /// A displacement v = M⁻¹e by errors e of the forms has L(v) = e_L: near the horizon points
    /// hardly move across it, however far they may move along it.
    pub(in crate::exact) fn displaced(&self, polygon: &[DVec2]) -> f64 {
        let (_, perimeter) = measure(polygon);
        let levels = polygon.iter().map(|&p| form(&self.below, p));
        let [least, more] = self.upwards;
        let across = (least + more * levels.fold(0.0, f64::max)).min(self.displacement);
        let mut before = polygon.last().copied().unwrap_or_default();
        let sides = polygon.iter().fold(0.0, |sum, &point| {
            let step = point - before;
            before = point;
            let [along, up] = [self.horizon.dot(step), self.horizon.perp_dot(step)].map(f64::abs);
            sum + across * along + self.displacement * up
        });
        sides.min(self.displacement * perimeter)
    }
}

/// A cross product, each part to within two roundings of itself.
fn cross(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    minors(a, b).map(|[plus, minus]| (plus.hi - minus.hi) + (plus.lo - minus.lo))
}

/// The determinant, whose products are added in double-double.
fn determinant(a: &[f64; 3], b: &[f64; 3], l: &[f64; 3]) -> f64 {
    let products = minors(a, b)
        .map(|[plus, minus]| plus.minus(&minus))
        .into_iter()
        .zip(l);
    let zero = Double::from_f64(0.0);
    products
        .fold(zero, |sum, (minor, &l)| {
            sum.plus(&minor.times(&Double::from_f64(l)))
        })
        .to_f64()
}

/// The products, without an error, of which a cross product's parts are the differences.
fn minors(a: &[f64; 3], b: &[f64; 3]) -> [[Double; 2]; 3] {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| [two_product(a[i], b[j]), two_product(a[j], b[i])])
}
