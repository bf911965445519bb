//! The homography (perspective map) from a pixel to the plane of a checkerboard, and how rounding
//! errors displace what the pixel shows.
//!
//! In: three linear forms c0·x + c1·y + c2 from the tracer, which give the board's coordinates at a
//! point (x, y) of a sub-pixel (a pixel or a square part of one). Out: points of the floor (the
//! infinite plane of the board) and their depths; the derivatives of the depth; the density of the
//! floor in the picture; and a bound on how far rounding errors displace what a polygon shows. This
//! bound is a first-order perturbation: each form has an error of four roundings, and the inverse
//! of the forms' matrix maps these errors to the picture.

use glam::DVec2;

use super::super::clip::{Chord, measure, split};
use crate::math::{Double, Real, two_product};

/// Unit roundoff of `f64`, 2^−53.
pub(in crate::exact) const UNIT: f64 = <f64 as Real>::UNIT;

/// Maximum absolute value of the determinant of the matrix of N_a, N_b and L ([`Homography`]) at
/// which the matrix is treated as singular. Each form is first scaled so that its largest
/// coefficient is between 1 and 2. For a singular matrix, the determinant is replaced by this value
/// to keep results finite, and the error bound covers the whole polygon. Not critical: a
/// determinant of products of about 1 has a rounding error of about 1e-31, so a much smaller
/// determinant has no correct digit.
const MIN_DETERMINANT: f64 = 1e-100;

/// Maximum displacement of squares by rounding errors, in pixels, at which corners may be moved
/// onto the horizon. [`Homography::corner`] moves a corner if its distance from the horizon may be
/// only a rounding error. If squares may be displaced farther, no corner is moved, because the move
/// would increase the error bound too much. With this displacement, the move adds about a hundredth
/// of the default tolerance to the bound.
const MAX_HORIZON_DISPLACEMENT: f64 = 1e-11;

/// An integral of a checkerboard's sign (1 on squares of one colour, −1 on the others), and a bound
/// on its absolute error, both in square pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(in crate::exact) struct BoundedSum {
    pub value: f64,
    pub bound: f64,
}

/// The homography between a pixel and the infinite plane of its board, the floor.
///
/// A point (x, y) of the picture, in pixels from the pixel's centre (at most ½ in each direction),
/// shows the point (a, b) of the floor, in squares:
///
/// a = N_a/L, b = N_b/L.
///
/// N_a, N_b and L are linear forms c0·x + c1·y + c2, and L > 0 below the horizon. The square at (a,
/// b) has the sign s(a)·s(b), where s is the square wave: 1 if its argument, rounded down, is even,
/// and −1 if it is odd.
///
/// M is the matrix of the three forms. The depth m = 1/L is linear on the floor:
///
/// m(a, b) = p·a + q·b + r,
///
/// where (p, q, r) is the third row of M⁻¹. At the depth m, a unit of the floor's area covers J =
/// K/m³ square pixels, where K = 1/|det M|.
#[derive(Clone, Debug)]
pub(in crate::exact) struct Homography {
    /// The linear forms N_a and N_b, the numerators of the floor's coordinates a = N_a/L and b =
    /// N_b/L.
    pub numerators: [[f64; 3]; 2],
    /// The linear form L, the denominator of the floor's coordinates; 0 on the horizon. It is
    /// scaled by a power of two so that its largest factor is between 1 and 2.
    pub denominator: [f64; 3],
    /// Derivatives ∂m/∂a and ∂m/∂b of the depth m = 1/L with respect to the floor's coordinates a
    /// and b.
    pub slope: [f64; 2],
    /// Factor K of the floor's density in the picture: a unit of the floor at the depth m covers
    /// K/m³ square pixels.
    pub density: f64,
    /// Maximum relative error of `density` due to rounding in its computation from the linear
    /// forms. Rounding errors in the forms' own factors are not included.
    pub density_error: f64,
    /// Sign of the determinant of the matrix of the linear forms N_a, N_b and L ([`Homography`]).
    /// It depends on whether the floor is seen mirrored.
    pub orientation: f64,
    /// Maximum displacement of a corner of a polygon, or of a line of the board, by rounding
    /// errors: |dx| + |dy|, in pixels.
    displacement: f64,
    /// Unit vector along the horizon.
    horizon: DVec2,
    /// Coefficients d and e, in pixels. Rounding errors displace a point by at most d + e·L
    /// perpendicular to the horizon. L is the value of the form `denominator` at the point; it is 0
    /// on the horizon.
    across_horizon: [f64; 2],
    /// Maximum value of the form `denominator`, which is 0 on the horizon, at which a point is
    /// treated as lying on the horizon. A value up to this maximum may be only a rounding error.
    horizon_tolerance: f64,
}

/// A corner of a polygon in the picture. `floor` is the point (a, b) of the floor that it shows, in
/// squares of the board, and `depth` is the depth m = 1/L there (see [`Homography`]).
///
/// On the horizon, this point is infinitely far away: `depth` is infinite, and `floor` is the limit
/// of (a, b)/m, the direction of the point on the floor.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    pub floor: [f64; 2],
    pub depth: f64,
}

/// The part of a convex polygon of the picture that shows the floor, and its edge on the horizon,
/// if it has one.
#[derive(Debug)]
pub(super) struct VisiblePart {
    pub polygon: Vec<DVec2>,
    horizon: Chord,
}

impl BoundedSum {
    /// Returns 0 with the error bound `bound`.
    pub fn zero_within(bound: f64) -> Self {
        Self { value: 0.0, bound }
    }

    /// Returns the result for a polygon that is not integrated: 0, the mean of both colours, with
    /// the polygon's area as the bound.
    pub fn unknown(polygon: &[DVec2]) -> Self {
        Self::zero_within(measure(polygon).0.abs())
    }

    /// Returns this sum. If its value is not finite or its bound is at least `area`, returns 0 with
    /// the bound `area` instead.
    pub fn or_unknown(self, area: f64) -> Self {
        if self.value.is_finite() && self.bound < area {
            return self;
        }
        Self::zero_within(area)
    }

    /// Returns this sum. If its value is not finite or its bound is at least the polygon's area,
    /// returns 0 with this area as the bound instead.
    pub fn within(self, polygon: &[DVec2]) -> Self {
        self.or_unknown(measure(polygon).0.abs())
    }

    pub fn add(&mut self, other: Self) {
        self.value += other.value;
        self.bound += other.bound;
    }
}

/// Returns c0·x + c1·y + c2, the value of the linear form `c` at the point `p`.
pub(in crate::exact) fn form(c: &[f64; 3], p: DVec2) -> f64 {
    c[0] * p.x + c[1] * p.y + c[2]
}

/// Returns an upper bound of |c0·x| + |c1·y| + |c2| for the points (x, y) of a pixel, where |x| and
/// |y| are at most ½. The parameter `[x, y, z]` contains the factors c0, c1 and c2 of a linear
/// form.
pub(in crate::exact) fn size([x, y, z]: &[f64; 3]) -> f64 {
    0.5 * (x.abs() + y.abs()) + z.abs()
}

/// Divides a form by a power of two so that its largest factor is between 1 and 2. Returns the form
/// and the exponent of the power.
fn normalized(form: [f64; 3]) -> ([f64; 3], i32) {
    let largest = form.iter().fold(f64::MIN_POSITIVE, |m, c| m.max(c.abs()));
    let exponent = libm::ilogb(largest);
    (form.map(|c| libm::ldexp(c, -exponent)), exponent)
}

impl Homography {
    /// Derives the homography from the three linear forms of [`Homography`]. Multiplying all three
    /// forms by the same positive factor changes nothing, because only their quotients are used.
    /// The error bounds are smallest if the origin of the floor's coordinates is near the part of
    /// the floor that the pixel shows.
    pub fn new(numerators: [[f64; 3]; 2], denominator: [f64; 3]) -> Self {
        let (denominator, scale) = normalized(denominator);
        let numerators = numerators.map(|form| form.map(|c| libm::ldexp(c, -scale)));
        // Squares may be of any size. N_a and N_b are therefore scaled like L, each by its own
        // power of two, before the matrix is inverted.
        let [(a, of_a), (b, of_b)] = numerators.map(normalized);
        // The columns of the adjugate det M·M⁻¹, where M is the matrix of the three forms. Each
        // component is accurate to two roundings of its own value.
        let columns = [
            cross(&b, &denominator),
            cross(&denominator, &a),
            cross(&a, &b),
        ];
        let det = determinant(&a, &b, &denominator);
        let is_singular = det.abs() <= MIN_DETERMINANT;
        let det = if is_singular { MIN_DETERMINANT } else { det };
        let products: f64 = (0..3)
            .map(|i| {
                let [j, k] = [(i + 1) % 3, (i + 2) % 3];
                denominator[i].abs() * ((a[j] * b[k]).abs() + (a[k] * b[j]).abs())
            })
            .sum();
        // Returns the maximum relative error of 1/det M, where M is the matrix of the three forms.
        // The determinant is a sum of products of three factors. Each factor has a relative error
        // of one `unit`. The products and their sum, in double-double, have errors of two `unit`s
        // each. The division adds roundings in `f64`.
        let det_off = |unit: f64| {
            if is_singular {
                f64::INFINITY
            } else {
                8.0 * unit * products / det.abs() + 4.0 * UNIT
            }
        };
        // The value of a linear form is computed with three roundings of its terms, and the
        // quotient of two forms with one more rounding. Each form is therefore given an error of
        // four roundings.
        let errors = [a, b, denominator].map(|form| 4.0 * UNIT * size(&form));
        let steepness = libm::hypot(denominator[0], denominator[1]);
        // Errors e of the forms displace a point by v = M⁻¹·e, where M is the matrix of the three
        // forms. The rounding errors of the point's own coordinates displace it by up to four unit
        // roundoffs, the initial value of `displacement`.
        let volume = det.abs() * (1.0 - det_off(UNIT)).max(0.0);
        let (mut displacement, mut tilt) = (4.0 * UNIT, 0.0);
        for (error, column) in errors.iter().zip(&columns) {
            displacement += error * column.iter().map(|c| c.abs()).sum::<f64>() / volume;
            tilt += error * column[2].abs() / volume;
        }
        Self {
            numerators,
            denominator,
            slope: [(0, of_a), (1, of_b)].map(|(i, by)| libm::ldexp(columns[i][2] / det, -by)),
            // If a form has overflowed, its exponent `of_a` or `of_b` is `i32::MAX`. The saturating
            // subtraction avoids an integer overflow. The result does not matter, because the
            // determinant is then not finite.
            density: libm::ldexp(1.0 / det.abs(), (-of_a).saturating_sub(of_b)),
            density_error: det_off(Double::UNIT),
            orientation: det.signum(),
            displacement,
            horizon: DVec2::new(denominator[1], -denominator[0]) / steepness,
            across_horizon: [errors[2] / steepness + 4.0 * UNIT, tilt / steepness],
            horizon_tolerance: if displacement <= MAX_HORIZON_DISPLACEMENT {
                0.5 * errors[2]
            } else {
                0.0
            },
        }
    }

    /// Cuts a convex polygon at the horizon and returns the part that shows the floor, where the
    /// linear form L ([`Self::denominator`], 0 on the horizon) is not negative.
    pub(super) fn visible(&self, polygon: &[DVec2]) -> VisiblePart {
        let (mut above, mut visible) = (Vec::new(), Vec::with_capacity(polygon.len() + 1));
        let level = |at| form(&self.denominator, at);
        let horizon = split(polygon, level, &mut above, &mut visible);
        VisiblePart {
            polygon: visible,
            horizon,
        }
    }

    /// Returns the point of the floor that a point of the picture shows, and its depth. `at` must
    /// be in the polygon of `visible`. The point is treated as lying on the horizon in three cases:
    /// it is an end of `visible.horizon`, its distance from the horizon may be only a rounding
    /// error, or the floor's coordinates overflow.
    pub(super) fn corner(&self, at: DVec2, visible: &VisiblePart) -> Corner {
        let is_on_horizon = |horizon: [DVec2; 2]| horizon.contains(&at);
        let level = if visible.horizon.is_some_and(is_on_horizon) {
            0.0
        } else {
            form(&self.denominator, at)
        };
        let floor = self.numerators.map(|numerator| form(&numerator, at));
        let depth = if level <= self.horizon_tolerance {
            f64::INFINITY
        } else {
            1.0 / level
        };
        // The floor's coordinates N/L are computed as N times the depth 1/L. If one overflows, the
        // point is treated as lying on the horizon.
        let places = floor.map(|n| n * depth);
        if depth.is_infinite() || !places.iter().all(|place| place.is_finite()) {
            let depth = f64::INFINITY;
            return Corner { floor, depth };
        }
        let floor = places;
        Corner { floor, depth }
    }

    /// Returns whether the point `at` lies below the horizon, but so close to it that
    /// [`Self::corner`] treats it as lying on the horizon.
    pub(super) fn is_set_on_horizon(&self, at: DVec2) -> bool {
        let level = form(&self.denominator, at);
        level > 0.0 && level <= self.horizon_tolerance
    }

    /// Returns one coordinate, in squares, of the point of the floor that the point `at` of the
    /// picture shows, and the coordinate's maximum rounding error. `axis` is 0 for the first
    /// coordinate and 1 for the second. `level` is the value of the form `denominator` at `at`, the
    /// denominator of the coordinates, and must be greater than 0.
    pub(in crate::exact) fn place(&self, axis: usize, at: DVec2, level: f64) -> (f64, f64) {
        let place = form(&self.numerators[axis], at) / level;
        let terms = size(&self.numerators[axis]) + place.abs() * size(&self.denominator);
        // The coordinate is N/L, a quotient of two forms. The factors of a form are computed with
        // three roundings, its value with four, and the quotient with one: 8 in total. The error of
        // N/L is proportional to 1/L. If L is only twice its own error, the true 1/L may be twice
        // the computed 1/L, so the total is doubled.
        (place, 16.0 * UNIT / level * terms)
    }

    /// Returns an upper bound of the change of a polygon's integral by rounding errors of the
    /// linear forms, in square pixels. The change is at most the area that the polygon's boundary
    /// sweeps when the errors displace it.
    pub(in crate::exact) fn displacement_error(&self, polygon: &[DVec2]) -> f64 {
        let (_, perimeter) = measure(polygon);
        // Errors e of the forms displace a point by v = M⁻¹·e, where M is the matrix of the three
        // forms. The value of the form L at the point changes only by the error of L. Points near
        // the horizon, where L is 0, therefore hardly move perpendicular to the horizon, even if
        // they move far along it.
        let levels = polygon.iter().map(|&p| form(&self.denominator, p));
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

/// Returns the cross product `a` × `b`. Each component is accurate to two roundings of its own
/// value.
fn cross(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    minors(a, b).map(|[plus, minus]| (plus.hi - minus.hi) + (plus.lo - minus.lo))
}

/// Returns the determinant of the matrix with the rows `a`, `b` and `l`, computed in double-double.
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

/// Returns two exact products for each component of the cross product `a` × `b`. The component is
/// the first product minus the second.
fn minors(a: &[f64; 3], b: &[f64; 3]) -> [[Double; 2]; 3] {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| [two_product(a[i], b[j]), two_product(a[j], b[i])])
}
