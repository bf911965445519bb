//! The homography from a pixel to a checkerboard, and the effect of the rounding of its forms.
//!
//! In: a board's three linear forms as the tracer has them for a sub-pixel. Out: places and depths
//! on the floor, the depth's slopes and the density of the floor in the picture, and a bound on how
//! far roundings displace what a polygon shows (a first-order perturbation of the forms by four
//! roundings each, mapped back to the picture by the inverse of their matrix).

use glam::DVec2;

use super::super::clip::{Chord, measure, split};
use crate::math::{Double, Real, two_product};

/// Unit roundoff of `f64`.
pub(in crate::exact) const UNIT: f64 = <f64 as Real>::UNIT;

/// Determinant below which a matrix counts as singular, for forms whose largest factors are 1 to 2.
/// It replaces the determinant, so that the inverse and its products are finite; the error bound
/// then covers the whole polygon.
const MIN_DETERMINANT: f64 = 1e-100;

/// Displacement by rounding, in pixels, up to which a corner is set on the horizon if only rounding
/// keeps it off. The change is counted in the bound, and is a hundredth of the usual tolerance.
const MAX_HORIZON_DISPLACEMENT: f64 = 1e-11;

/// A number and a bound on its absolute error, in square pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(in crate::exact) struct BoundedSum {
    pub value: f64,
    pub bound: f64,
}

/// The infinite board as a pixel sees it.
///
/// A point of the picture, (x, y) in pixels from the pixel's centre (at most ½ in each direction),
/// shows the point (a, b) = (N_a/L, N_b/L) of the floor, in squares. N_a, N_b and L are linear
/// forms c0·x + c1·y + c2, and L > 0 on the floor's side of the horizon. The sign of a square is
/// s(a)·s(b), where s is the square wave.
///
/// With M the matrix of the three forms, 1/L = m(a, b) = p·a + q·b + r is the third row of M⁻¹: a
/// depth, linear on the floor. A piece da·db of floor covers J = K/m³ square pixels, K = 1/|det M|.
#[derive(Clone, Debug)]
pub(in crate::exact) struct Homography {
    /// N_a and N_b.
    pub across: [[f64; 3]; 2],
    /// L, scaled by a power of two so that its largest factor is between 1 and 2.
    pub below: [f64; 3],
    /// ∂m/∂a and ∂m/∂b.
    pub slope: [f64; 2],
    /// K.
    pub density: f64,
    /// Maximum relative difference of K from that of the rounded forms.
    pub density_error: f64,
    /// Sign of det M, which tells whether the floor is seen mirrored.
    pub orientation: f64,
    /// Maximum displacement of a corner or a line of the board by rounding, in pixels (|dx| +
    /// |dy|).
    displacement: f64,
    /// Unit vector along the horizon.
    horizon: DVec2,
    /// Maximum displacement by rounding across the horizon's direction, in pixels: where L is 0,
    /// and its increase per unit of L.
    across_horizon: [f64; 2],
    /// L up to which a point counts as on the horizon because of rounding.
    horizon_tolerance: f64,
}

/// A corner of a region: the floor that it shows, and m there.
///
/// On the horizon m is infinite, and a and b are the direction (da, db)/dm in which edges approach
/// it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    pub floor: [f64; 2],
    pub depth: f64,
}

/// The part of a convex polygon where L ≥ 0, with its segment on the horizon.
#[derive(Debug)]
pub(super) struct VisiblePart {
    pub polygon: Vec<DVec2>,
    horizon: Chord,
}

impl BoundedSum {
    /// Returns 0 with a bound.
    pub fn zero_within(bound: f64) -> Self {
        Self { value: 0.0, bound }
    }

    /// Returns the sum of a polygon of which nothing is known: the mean of both colours.
    pub fn unknown(polygon: &[DVec2]) -> Self {
        Self::zero_within(measure(polygon).0.abs())
    }

    /// Returns the sum over an area, or the mean of both colours if it overflowed or its bound is
    /// not less than the area.
    pub fn or_unknown(self, area: f64) -> Self {
        if self.value.is_finite() && self.bound < area {
            return self;
        }
        Self::zero_within(area)
    }

    /// Returns the sum over a polygon, or the mean of both colours if that is no worse.
    pub fn within(self, polygon: &[DVec2]) -> Self {
        self.or_unknown(measure(polygon).0.abs())
    }

    pub fn add(&mut self, other: Self) {
        self.value += other.value;
        self.bound += other.bound;
    }
}

/// Evaluates a form at a point.
pub(in crate::exact) fn form(c: &[f64; 3], p: DVec2) -> f64 {
    c[0] * p.x + c[1] * p.y + c[2]
}

/// Bounds the sum of the absolute terms of a form.
pub(in crate::exact) fn size([x, y, z]: &[f64; 3]) -> f64 {
    0.5 * (x.abs() + y.abs()) + z.abs()
}

/// Scales a form by a power of two so that its largest factor is between 1 and 2, and returns that
/// power.
fn normalized(form: [f64; 3]) -> ([f64; 3], i32) {
    let largest = form.iter().fold(f64::MIN_POSITIVE, |m, c| m.max(c.abs()));
    let exponent = libm::ilogb(largest);
    (form.map(|c| libm::ldexp(c, -exponent)), exponent)
}

impl Homography {
    /// Derives the homography of the forms N_a and N_b, and L, which may share any positive factor.
    /// The closer the origin of a and b is to the pixel, the smaller the bounds.
    pub fn new(across: [[f64; 3]; 2], below: [f64; 3]) -> Self {
        let (below, scale) = normalized(below);
        let across = across.map(|form| form.map(|c| libm::ldexp(c, -scale)));
        // Squares may be of any size; the inverse is that of forms of about equal size.
        let [(a, of_a), (b, of_b)] = across.map(normalized);
        // The columns of det M·M⁻¹, each component accurate to two roundings of itself.
        let columns = [cross(&b, &below), cross(&below, &a), cross(&a, &b)];
        let det = determinant(&a, &b, &below);
        let is_singular = det.abs() <= MIN_DETERMINANT;
        let det = if is_singular { MIN_DETERMINANT } else { det };
        let products: f64 = (0..3)
            .map(|i| {
                let [j, k] = [(i + 1) % 3, (i + 2) % 3];
                below[i].abs() * ((a[j] * b[k]).abs() + (a[k] * b[j]).abs())
            })
            .sum();
        // The maximum relative error of det M, if each of the three factors of a product has a
        // relative error of one unit and each of its sums and products in double-double two; and of
        // 1/det M by its own roundings.
        let det_off = |unit: f64| {
            if is_singular {
                f64::INFINITY
            } else {
                8.0 * unit * products / det.abs() + 4.0 * UNIT
            }
        };
        // A form's value is off by at most three roundings of its largest terms; the fourth is that
        // of the quotient.
        let errors = [a, b, below].map(|form| 4.0 * UNIT * size(&form));
        let steepness = libm::hypot(below[0], below[1]);
        // v = M⁻¹·e is the displacement of a point by errors e of the forms; L(v) = e_L.
        // Coordinates are rounded, too.
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
            // Exponents beyond the range of f64 saturate; the density is then no number anyway.
            density: libm::ldexp(1.0 / det.abs(), (-of_a).saturating_sub(of_b)),
            density_error: det_off(Double::UNIT),
            orientation: det.signum(),
            displacement,
            horizon: DVec2::new(below[1], -below[0]) / steepness,
            across_horizon: [errors[2] / steepness + 4.0 * UNIT, tilt / steepness],
            horizon_tolerance: if displacement <= MAX_HORIZON_DISPLACEMENT {
                0.5 * errors[2]
            } else {
                0.0
            },
        }
    }

    /// Returns the part of a convex polygon that shows the floor.
    pub(super) fn visible(&self, polygon: &[DVec2]) -> VisiblePart {
        let (mut above, mut visible) = (Vec::new(), Vec::with_capacity(polygon.len() + 1));
        let level = |at| form(&self.below, at);
        let horizon = split(polygon, level, &mut above, &mut visible);
        VisiblePart {
            polygon: visible,
            horizon,
        }
    }

    /// Returns what a point of the visible part shows.
    pub(super) fn corner(&self, at: DVec2, visible: &VisiblePart) -> Corner {
        let is_on_horizon = |horizon: [DVec2; 2]| horizon.contains(&at);
        let level = if visible.horizon.is_some_and(is_on_horizon) {
            0.0
        } else {
            form(&self.below, at)
        };
        let floor = self.across.map(|across| form(&across, at));
        let depth = if level <= self.horizon_tolerance {
            f64::INFINITY
        } else {
            1.0 / level
        };
        // If even the quotient overflows, the point counts as on the horizon.
        let places = floor.map(|n| n * depth);
        if depth.is_infinite() || !places.iter().all(|place| place.is_finite()) {
            let depth = f64::INFINITY;
            return Corner { floor, depth };
        }
        let floor = places;
        Corner { floor, depth }
    }

    /// Returns whether a point is set on the horizon only because of rounding.
    pub(super) fn is_set_on_horizon(&self, at: DVec2) -> bool {
        let level = form(&self.below, at);
        level > 0.0 && level <= self.horizon_tolerance
    }

    /// Returns the coordinate along an axis of the floor that a point shows, and its maximum
    /// rounding error. `level` is the value of L there, greater than 0.
    pub(in crate::exact) fn place(&self, axis: usize, at: DVec2, level: f64) -> (f64, f64) {
        let place = form(&self.across[axis], at) / level;
        let terms = size(&self.across[axis]) + place.abs() * size(&self.below);
        // Three roundings in the factors of either form, four in its value, and one in the
        // quotient; twice all that, because L may be off by half of itself.
        (place, 16.0 * UNIT / level * terms)
    }

    /// Bounds the change of a polygon's integral by rounding, in square pixels: the area that the
    /// displacement of its boundary sweeps.
    ///
    /// A displacement v = M⁻¹e by errors e of the forms has L(v) = e_L. Near the horizon, points
    /// therefore hardly move across it, however far they move along it.
    pub(in crate::exact) fn displacement_error(&self, polygon: &[DVec2]) -> f64 {
        let (_, perimeter) = measure(polygon);
        let levels = polygon.iter().map(|&p| form(&self.below, p));
        let [least, more] = self.across_horizon;
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

/// Returns a cross product, each component accurate to two roundings of itself.
fn cross(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    minors(a, b).map(|[plus, minus]| (plus.hi - minus.hi) + (plus.lo - minus.lo))
}

/// Returns the determinant, whose products are added in double-double.
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

/// Returns the exact products whose differences are the components of a cross product.
fn minors(a: &[f64; 3], b: &[f64; 3]) -> [[Double; 2]; 3] {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| [two_product(a[i], b[j]), two_product(a[j], b[i])])
}
