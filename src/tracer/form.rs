//! Linear forms: the edges and inverse depths of flat surfaces.
//!
//! In: a vector in the camera's axes. Out: the linear form aX + bY + c over the view plane that the
//! vector defines. Every edge of a flat surface is a line on which such a form is zero, and the
//! inverse depth of a plane is such a form. One error bound holds for all values in the camera's
//! window; it includes the errors of the factors and the rounding errors of the evaluation.

use super::camera::{Camera, Direction, Window};
use crate::math::{Ball, Ball3, Double, Real, UP};

/// A linear form aX + bY + c over the view plane, with one error bound for all its values.
#[derive(Clone, Debug)]
pub struct Form<T: Real> {
    /// The factors a, b and c in aX + bY + c.
    factors: [T; 3],
    /// Error bound of a computed value of the form in the camera's window.
    rad: T::Radius,
    /// Factors of an error bound for a single ray. For the direction (X, Y, Z), the error of the
    /// form's value is at most `rads[0]`·|X| + `rads[1]`·|Y| + `rads[2]`·|Z|. In the middle of a
    /// very wide view, this is far less than `rad`, which holds in the whole window. Only the
    /// highest precision has these factors. Each other precision leaves doubtful decisions to the
    /// next one, so the field is `None`.
    rads: Option<Box<[T::Radius; 3]>>,
}

/// Number of roundings in the computation of a linear form's value ([`Form`]). A coordinate of the
/// ray's direction is computed with 5 roundings. Its product with a factor adds 1, and the sum of
/// the products adds 2. The total is 8; the value 12 leaves room for products of rounding errors.
const FORM_ROUNDINGS: f64 = 12.0;

impl<T: Real> Form<T> {
    /// Builds the form v·r, where v is a vector in the camera's axes and r a ray's [`Direction`].
    pub fn new(camera: &Camera<T>, v: &Ball3<T>) -> Self {
        let window = &camera.window;
        let factors = [
            v[0].mid.clone(),
            v[1].mid.clone(),
            v[2].mid.times(&camera.z),
        ];
        let inherited = v[0].rad * window.x + v[1].rad * window.y + v[2].rad * window.z;
        // In the widest views, Z may be below the normal numbers of `f64`. Its rounding error is
        // then a fixed amount instead of a fraction of Z.
        let lost = v[2].size() * T::TINY;
        let rad = (inherited + lost + rounding(&factors, window)) * UP;
        let by_component = |x: &Ball<T>| (x.rad + x.size() * (FORM_ROUNDINGS * T::UNIT)) * UP;
        Self {
            factors,
            rad,
            rads: T::LAST.then(|| Box::new(v.each_ref().map(by_component))),
        }
    }

    /// Returns the form's value for a ray's direction, with its error bound.
    #[inline]
    pub fn at(&self, r: &Direction<T>) -> Ball<T> {
        let [a, b, c] = &self.factors;
        Ball {
            mid: a.times(&r.x).plus(&b.times(&r.y)).plus(c),
            rad: match &self.rads {
                Some(rads) if T::LAST => {
                    let [x, y, z] = [&r.x, &r.y, &r.z].map(Real::magnitude);
                    (rads[0] * x + rads[1] * y + rads[2] * z) * UP
                }
                _ => self.rad,
            },
        }
    }

    /// Returns the factors a, b and c of X, Y and 1.
    pub fn factors(&self) -> &[T; 3] {
        &self.factors
    }

    /// Returns an upper bound of the error of every value of the form that is computed in the
    /// camera's window.
    pub fn rad(&self) -> T::Radius {
        self.rad
    }

    /// Returns the difference `self` − `other`.
    pub fn minus(&self, other: &Self) -> Self {
        let sizes = [0, 1, 2].map(|i| self.factors[i].magnitude() + other.factors[i].magnitude());
        let sum = sizes[0] + sizes[1] + sizes[2];
        Self {
            factors: [0, 1, 2].map(|i| self.factors[i].minus(&other.factors[i])),
            // The bound of the rounding errors of the difference assumes that |X|, |Y| and Z are at
            // most 1.
            rad: (self.rad + other.rad + sum * (FORM_ROUNDINGS * T::UNIT)) * UP,
            // The sum of the two forms' error bounds covers the rounding errors of both forms'
            // factors. Doubled, it also covers the rounding of the factors' differences.
            rads: self
                .rads
                .as_ref()
                .zip(other.rads.as_ref())
                .map(|(own, others)| {
                    Box::new([0, 1, 2].map(|i| (own[i] + others[i]) * (2.0 * UP)))
                }),
        }
    }

    /// Returns whether two forms have equal factors. All forms of one plane have equal factors.
    pub fn equals(&self, other: &Self) -> bool {
        let equal = |(a, b): (&T, &T)| a.minus(b).is_zero();
        self.factors.iter().zip(&other.factors).all(equal)
    }
}

impl Form<Double> {
    /// Rounds the form to `f64`.
    pub fn narrowed(&self, window: &Window<f64>) -> Form<f64> {
        let factors = self.factors.map(|factor| factor.hi);
        Form {
            rad: (self.rad + rounding(&factors, window)) * UP,
            factors,
            rads: None,
        }
    }
}

/// Returns an upper bound of the rounding errors of a form's values in the window.
fn rounding<T: Real>(factors: &[T; 3], window: &Window<T::Radius>) -> T::Radius {
    let [a, b, c] = factors.each_ref().map(Real::magnitude);
    (a * window.x + b * window.y + c) * (FORM_ROUNDINGS * T::UNIT)
        + T::TINY * (a + b)
        // A value is computed from fewer than 16 products. If a product is below the normal
        // numbers, its error is at most half of the least positive number.
        + T::TINY * 8.0
}

/// Returns the inverse depth of the plane n·q = h as a linear form. The normal n is given along the
/// axes of the world, and the points q are relative to the eye.
pub fn inverse_depth<T: Real>(camera: &Camera<T>, n: &Ball3<T>, h: &Ball<T>) -> Form<T> {
    let n = camera.turned(n).map(|component| component / h);
    Form::new(camera, &n)
}

/// Returns the unit vector along an axis of the world.
pub fn axis_vector<T: Real>(axis: usize) -> Ball3<T> {
    [0, 1, 2].map(|i| Ball::exact(if i == axis { 1.0 } else { 0.0 }))
}

#[cfg(test)]
mod tests;
