//! The sphere: a conic in the view plane.
//!
//! In: a sphere's centre and radius, and the camera. Out: for a ray, its crossings; for a
//! rectangle, the ranges of the crossings' inverse depths.
//!
//! Let c be the centre relative to the eye, R the radius, r the direction of a ray, and C = c·c −
//! R² (the power of the eye). The ray λr hits the sphere where λ² r·r − 2λ c·r + C = 0. A quarter
//! of the discriminant is Q = R² r·r − |c × r|² by Lagrange's identity. Unlike (c·r)² − (r·r) C,
//! this does not subtract large squares if the sphere is small and far away.
//!
//! Q and c·r each have one error bound for all rays in the camera's window, which includes rounding
//! errors. C is computed exactly if it is small.

use std::cmp::Ordering;

use glam::DVec3;

use super::{
    camera::{Camera, Direction, Window},
    crossing::{Crossing, SurfacePart},
    interval::{Cover, Interval},
    local_form::{LocalForm, LocalQuadratic, Patch},
};
use crate::math::{Ball, Ball3, Double, Doubt, Dyadic, Radius, Real, UP, dot};

/// A sphere prepared for one picture. Its lengths are scaled by a power of two that brings the
/// greatest length to about 1. Let c be the centre relative to the eye, R the radius and r the
/// ray's direction. Then Q = R² r·r − |c × r|², and C = c·c − R².
#[derive(Clone, Debug)]
pub struct Sphere<T: Real> {
    /// The centre relative to the eye, in the camera's axes.
    center: [T; 3],
    /// Error bound of each coordinate of the centre.
    rad_c: T::Radius,
    /// Square of the radius R.
    square: T,
    /// Error bound of R², the square of the radius.
    rad_square: T::Radius,
    /// C = c·c − R², with the centre c relative to the eye and the radius R. Its relative error is
    /// small however close the eye is to the surface.
    power: Ball<T>,
    /// Exact sign of C = c·c − R²: `Greater` if the eye is outside the sphere, `Equal` if it is on
    /// the surface, `Less` if it is inside.
    side: Ordering,
    /// Power of two by which an inverse depth in the sphere's own unit is multiplied to give the
    /// inverse depth in the world's unit.
    scale: f64,
    /// Error bound of Q = R² r·r − |c × r|² for all rays in the camera's window. Here c is the
    /// centre, R the radius and r a ray's direction.
    rad_q: T::Radius,
    /// Error bound of the scalar product c·r for all rays in the camera's window. Here c is the
    /// centre and r a ray's direction.
    rad_b: T::Radius,
}

/// Upper bound on the number of roundings in a value of Q = R² r·r − |c × r|² ([`Sphere`]). Each
/// component of c × r is a linear form of r with at most 12 roundings, so its square has at most 24
/// of them. The 8 that remain are more than enough for the product, the sum of the squares and the
/// difference.
const SPHERE_ROUNDINGS: f64 = 32.0;

impl<T: Real> Sphere<T> {
    /// Prepares a sphere in the precision `T`.
    pub fn new(camera: &Camera<T>, center: DVec3, radius: f64) -> Self {
        let from_eye = camera.relative(center);
        let radius_ball = camera.length(radius);
        let greatest = from_eye
            .iter()
            .map(Ball::size)
            .fold(radius_ball.size(), Radius::max);
        // The exponent is limited so that the power of two is within the range of `f64`. The limit
        // may leave the lengths 2^74 times too large or too small. This does no harm, because
        // products of a few such lengths are still within the range of `f64`.
        let exponent = (-greatest.exponent()).clamp(-1000, 1000);
        let from_eye = from_eye.map(|x| x.scaled(exponent));
        let radius_ball = radius_ball.scaled(exponent);
        let square = &radius_ball * &radius_ball;

        let (power, side) = power(
            camera.eye,
            center,
            radius,
            exponent + camera.exponent,
            &from_eye,
            &square,
        );
        let c = camera.turned(&from_eye);
        let rad_c = c.iter().map(|x| x.rad).fold(T::Radius::ZERO, Radius::max);
        let (rad_q, rad_b) = radii::<T>(
            c.each_ref().map(Ball::size),
            rad_c,
            square.size(),
            square.rad,
            camera.window.sizes(),
        );
        Self {
            center: c.map(|x| x.mid),
            rad_c,
            rad_square: square.rad,
            square: square.mid,
            power,
            side,
            scale: libm::ldexp(1.0, exponent),
            rad_q,
            rad_b,
        }
    }

    /// Returns two numbers for the ray of direction `r`: Q, a quarter of the discriminant of the
    /// equation for the crossings, and the scalar product of the sphere's centre and `r`. The
    /// letters are those of [`Sphere`].
    #[inline]
    fn discriminant(&self, r: &Direction<T>) -> (Ball<T>, Ball<T>) {
        let [cx, cy, cz] = &self.center;
        let k = cy.times(&r.z).minus(&cz.times(&r.y));
        let l = cz.times(&r.x).minus(&cx.times(&r.z));
        let m = cx.times(&r.y).minus(&cy.times(&r.x));
        let cross = k.times(&k).plus(&l.times(&l)).plus(&m.times(&m));
        let (rad_q, rad_b) = if T::LAST {
            // In the highest precision, the error bounds are computed for this ray alone, because
            // no higher precision could decide an uncertain case. In the middle of the widest
            // views, these bounds are far smaller than the bounds for the whole window.
            radii::<T>(
                self.center.each_ref().map(Real::magnitude),
                self.rad_c,
                self.square.magnitude(),
                self.rad_square,
                [&r.x, &r.y, &r.z].map(Real::magnitude),
            )
        } else {
            (self.rad_q, self.rad_b)
        };
        let q = Ball {
            mid: self.square.times(&r.square).minus(&cross),
            rad: rad_q,
        };
        let b = Ball {
            mid: cx.times(&r.x).plus(&cy.times(&r.y)).plus(&cz.times(&r.z)),
            rad: rad_b,
        };
        (q, b)
    }

    /// Returns the nearest crossing in front of the eye. Returns `None` if the ray misses or only
    /// touches the sphere, and a [`Doubt`] if rounding errors leave this uncertain.
    #[inline]
    pub fn first(&self, r: &Direction<T>) -> Result<Option<Crossing<T>>, Doubt> {
        let (q, b) = self.discriminant(r);
        match self.side {
            Ordering::Greater => {
                if b.sign() == Ok(Ordering::Less) || q.sign()? != Ordering::Greater {
                    return Ok(None);
                }
                if b.sign()? != Ordering::Greater {
                    return Ok(None);
                }
                let inverse = (b + q.sqrt()) / &self.power;
                Ok(Some(self.crossing(&inverse, SurfacePart::Entry)))
            }
            Ordering::Equal if b.sign()? != Ordering::Greater => Ok(None),
            _ => Ok(Some(self.exit(&q, &b, r))),
        }
    }

    /// Returns the second crossing of the ray with the sphere, where the ray leaves it. The ray
    /// must hit the sphere. Returns `None` if the eye is not outside the sphere.
    pub fn second(&self, r: &Direction<T>) -> Option<Crossing<T>> {
        if self.side != Ordering::Greater {
            return None;
        }
        let (q, b) = self.discriminant(r);
        Some(self.exit(&q, &b, r))
    }

    /// Returns the crossing where the ray leaves the sphere. `q` is a quarter of the discriminant
    /// of the equation for the crossings, and `b` the scalar product of the centre and the ray's
    /// direction ([`Sphere`]). Two formulas give the inverse depth; the one that loses no digits by
    /// cancellation is used.
    fn exit(&self, q: &Ball<T>, b: &Ball<T>, r: &Direction<T>) -> Crossing<T> {
        let square = Ball {
            rad: r.square.magnitude() * (SPHERE_ROUNDINGS * T::UNIT) + T::TINY * 8.0,
            mid: r.square.clone(),
        };
        // Close to the inner surface of a huge sphere, Q is much smaller than R² r·r (letters as in
        // `Sphere`). There, Q is computed more accurately as (c·r)² − (r·r) C.
        let other = b * b - &self.power * &square;
        let root = if other.rad < q.rad { &other } else { q }.sqrt();
        let inverse = if b.mid.is_negative() {
            (b - root) / &self.power
        } else {
            square / (b + root)
        };
        self.crossing(&inverse, SurfacePart::Exit)
    }

    #[inline]
    fn crossing(&self, inverse: &Ball<T>, part: SurfacePart) -> Crossing<T> {
        Crossing {
            inverse_depth: inverse.times_power(self.scale),
            part,
        }
    }
}

impl Sphere<f64> {
    /// Returns the centre and the radius of a ball that certainly contains the sphere, in the
    /// sphere's own unit of length. Returns `None` if the eye is not outside the sphere.
    pub fn ball(&self) -> Option<([f64; 3], f64)> {
        // Factor that covers the rounding errors of the radius. These are only three roundings of
        // 2^−53 each, far less than 2^−40.
        const ROOT_SLACK: f64 = 1.0 + 1.0 / (1u64 << 40) as f64;
        let radius = (self.square + self.rad_square).sqrt() + 2.0 * self.rad_c;
        (self.side == Ordering::Greater).then_some((self.center, radius * ROOT_SLACK))
    }

    /// Computes how the sphere covers a rectangle. Returns `None` if no ray through the rectangle
    /// hits the sphere.
    pub fn cover(&self, patch: &Patch) -> Option<Cover> {
        let (q, b) = self.local(patch);
        let (q, b) = (q.range(), b.range());
        // The ends of a range are out of order or NaN only after an overflow.
        if !(q.low <= q.high && b.low <= b.high) {
            return Some(Cover {
                is_whole: false,
                inverse_depth: Interval::ALL,
            });
        }
        let (is_whole, inverse_depth) = match self.side {
            Ordering::Greater => {
                if q.high < 0.0 || b.high < 0.0 {
                    return None;
                }
                let power = self.power.size();
                let inverse = |b: f64, q: f64| (b.max(0.0) + q.max(0.0).sqrt()) / power;
                let range = Interval {
                    low: inverse(b.low, q.low),
                    high: inverse(b.high, q.high),
                };
                (q.low > 0.0 && b.low > 0.0, range)
            }
            Ordering::Equal if b.high < 0.0 => return None,
            Ordering::Equal => (b.low > 0.0, self.exits(q, b, patch)),
            Ordering::Less => (true, self.exits(q, b, patch)),
        };
        Some(Cover {
            is_whole,
            inverse_depth: self.widened(inverse_depth),
        })
    }

    /// Returns the range of the inverse depths at which rays from outside leave the sphere. Returns
    /// `None` if the eye is not outside the sphere.
    pub fn behind(&self, patch: &Patch) -> Option<Interval> {
        let exits = || {
            let (q, b) = self.local(patch);
            self.exits(q.range(), b.range(), patch)
        };
        self.is_outside().then(|| self.widened(exits()))
    }

    /// Returns the range of the inverse depths at which rays leave the sphere, for rays through the
    /// rectangle `patch`. `q` and `b` are the ranges of two numbers over the rectangle: a quarter
    /// of the discriminant of the equation for the crossings, and the scalar product of the centre
    /// and the ray's direction ([`Sphere`]).
    fn exits(&self, q: Interval, b: Interval, patch: &Patch) -> Interval {
        // The inverse depth at the crossing λr, where r is the ray's direction,
        //
        // 1/λ = r·r/(b + √Q) = (√Q − b)/(−C),
        //
        // falls as b = c·r grows (c, Q and C as in `Sphere`). If b may be ≤ 0, the first formula
        // gives no upper bound, because the least possible denominator may be 0 or negative. If the
        // eye is inside the sphere, the second formula then gives the upper bound. Otherwise, the
        // upper bound is infinite.
        let reach = |i: usize, at: f64| {
            let half = 0.5 * patch.sides[i];
            (at.abs() + half, (at.abs() - half).max(0.0))
        };
        let (x, y) = (reach(0, patch.center.x), reach(1, patch.center.y));
        let z = patch.center.z;
        let square = Interval {
            low: x.1 * x.1 + y.1 * y.1 + z * z,
            high: x.0 * x.0 + y.0 * y.0 + z * z + f64::MIN_POSITIVE,
        };
        let q = (q.low.max(0.0).sqrt(), q.high.max(0.0).sqrt());
        let power = self.power.size();
        let low = square.low / (b.high + q.1);
        let high = square.high / (b.low + q.0);
        Interval {
            low: if b.high + q.1 > 0.0 { low } else { 0.0 },
            high: if b.low > 0.0 {
                high
            } else if self.side == Ordering::Less {
                (q.1 - b.low) / power
            } else {
                f64::INFINITY
            },
        }
    }

    /// Returns two forms over a rectangle, as functions of the offset from its centre: a quarter of
    /// the discriminant of the equation for a ray's crossings, and the scalar product of the
    /// sphere's centre and the ray's direction ([`Sphere`]).
    pub fn local(&self, patch: &Patch) -> (LocalQuadratic, LocalForm) {
        // Factor by which the error bound of Q is multiplied to bound the error of Q's local form.
        // Q is a quarter of the discriminant of the equation for a ray's crossings ([`Sphere`]).
        // The factors of the local form consist of the same products as Q, and the rectangle lies
        // within the window. Eight times Q's error bound therefore covers the errors of all factors
        // together: once for the value at the centre, twice for each of the two first derivatives,
        // and once for each of the three second derivatives.
        const TIMES: f64 = 8.0;
        let [cx, cy, cz] = self.center;
        let (r, [width, height]) = (&patch.center, patch.sides);
        let (k, l, m) = (
            cy * r.z - cz * r.y,
            cz * r.x - cx * r.z,
            cx * r.y - cy * r.x,
        );
        let q = LocalQuadratic::new(
            [
                self.square * r.square - (k * k + l * l + m * m),
                2.0 * (self.square * r.x - (l * cz - m * cy)) * width,
                2.0 * (self.square * r.y - (m * cx - k * cz)) * height,
                (self.square - cy * cy - cz * cz) * width * width,
                2.0 * cx * cy * width * height,
                (self.square - cx * cx - cz * cz) * height * height,
            ],
            TIMES * self.rad_q,
        );
        let b = [cx * width, cy * height, cx * r.x + cy * r.y + cz * r.z];
        (q, LocalForm::new(b, 2.0 * self.rad_b))
    }

    /// Returns the factor 1/C in the inverse depth (c·r + √Q)/C of the sphere's near side
    /// ([`Sphere`]), in the world's unit, and a bound on the factor's relative error. Returns
    /// `None` if the eye is not outside the sphere, or if the relative error of C is 1/4 or more.
    /// Below 1/4, the relative error of 1/C is at most twice that of C.
    pub fn depth_factor(&self) -> Option<(f64, f64)> {
        let error = self.power.rad / self.power.size() + SPHERE_ROUNDINGS * f64::UNIT;
        (self.is_outside() && error < 0.25).then(|| (self.scale / self.power.mid, 2.0 * error))
    }

    /// Converts a range of inverse depths to the world's unit, and widens it by more than all
    /// rounding errors of its computation. If the relative error of C ([`Sphere`]) is too large,
    /// returns the interval of all numbers.
    fn widened(&self, range: Interval) -> Interval {
        // Factor by which the ends of a range are widened. It covers a few roundings of 2^−53, and
        // a relative error of C ([`Sphere`]) of at most 2^−30.
        const WIDER: f64 = 1.0 + 1.0 / (1u64 << 30) as f64;
        let power = self.power.rad / self.power.size();
        // If the eye is on the surface, C is 0 and its relative error does not matter.
        if power < WIDER - 1.0 || self.side == Ordering::Equal {
            Interval {
                low: range.low / WIDER / WIDER * self.scale,
                high: range.high * WIDER * WIDER * self.scale,
            }
        } else {
            Interval::ALL
        }
    }
}

impl<T: Real> Sphere<T> {
    /// Returns the centre in the camera's axes and the square of the radius, in the sphere's own
    /// unit of length.
    pub fn parts(&self) -> (Ball3<T>, Ball<T>) {
        let ball = |mid: &T| Ball {
            mid: mid.clone(),
            rad: self.rad_c,
        };
        let square = Ball {
            mid: self.square.clone(),
            rad: self.rad_square,
        };
        (self.center.each_ref().map(ball), square)
    }

    /// Returns the power of two that converts an inverse depth in the sphere's own unit to the
    /// world's unit.
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// Returns whether the eye lies on the sphere's surface. It then sees the sphere only in
    /// directions r with c·r > 0, where c is the centre relative to the eye.
    pub fn is_at_eye(&self) -> bool {
        self.side == Ordering::Equal
    }

    /// Returns whether the eye is outside the sphere.
    pub fn is_outside(&self) -> bool {
        self.side == Ordering::Greater
    }
}

impl Sphere<Double> {
    /// Rounds the sphere to `f64`.
    pub fn narrowed(&self, window: &Window<f64>) -> Sphere<f64> {
        let center = self.center.map(|x| x.hi);
        let (rad_q, rad_b) = radii::<f64>(
            center.map(f64::abs),
            0.0,
            self.square.hi,
            self.square.hi * f64::UNIT,
            window.sizes(),
        );
        Sphere {
            center,
            rad_c: self.rad_c + f64::UNIT * center.iter().fold(0.0, |a, c| c.abs().max(a)),
            square: self.square.hi,
            rad_square: self.rad_square + f64::UNIT * self.square.hi,
            power: Ball {
                mid: self.power.mid.hi,
                rad: (self.power.rad + f64::UNIT * self.power.size()) * UP,
            },
            side: self.side,
            scale: self.scale,
            rad_q: (self.rad_q + rad_q) * UP,
            rad_b: (self.rad_b + rad_b) * UP,
        }
    }
}

/// Computes C = c·c − R² ([`Sphere`]) with a small relative error, and returns it with its exact
/// sign. The lengths in `from_eye` and `square` were multiplied by 2^`exponent`. The result is
/// therefore C times the square of this factor.
fn power<T: Real>(
    eye: DVec3,
    center: DVec3,
    radius: f64,
    exponent: i32,
    from_eye: &Ball3<T>,
    square: &Ball<T>,
) -> (Ball<T>, Ordering) {
    let power = dot(from_eye, from_eye) - square;
    if power.is_precise()
        && let Ok(side) = power.sign()
    {
        return (power, side);
    }
    let c = Dyadic::between(eye, center);
    let radius = Dyadic::new(radius);
    let power = &Dyadic::dot(&c, &c) - &(&radius * &radius);
    let side = power.sign();
    (Ball::from_big(&power.to_big().scaled(2 * exponent)), side)
}

/// Returns upper bounds of the errors of Q, a quarter of the discriminant of the equation for a
/// ray's crossings, and of the scalar product of the sphere's centre and the ray's direction
/// ([`Sphere`]). The bounds hold for rays whose |X|, |Y| and |Z| are at most `[x, y, z]`.
///
/// `[cx, cy, cz]` are the absolute values of the centre's coordinates, and `rad_c` is their error.
/// `square` is the square of the radius, and `rad_square` is its error.
fn radii<T: Real>(
    [cx, cy, cz]: [T::Radius; 3],
    rad_c: T::Radius,
    square: T::Radius,
    rad_square: T::Radius,
    [x, y, z]: [T::Radius; 3],
) -> (T::Radius, T::Radius) {
    let unit = SPHERE_ROUNDINGS * T::UNIT;
    let mut rad_q = T::Radius::ZERO;
    let mut cross = T::Radius::ZERO;
    // Each component of c × r is a difference of two products. `size` bounds the sum of the
    // products' absolute values, and `reach` is the factor by which the centre's error is
    // multiplied.
    for (size, reach) in [
        (cy * z + cz * y, y + z),
        (cz * x + cx * z, x + z),
        (cx * y + cy * x, x + y),
    ] {
        let rad = rad_c * reach + size * unit;
        rad_q = rad_q + (size * 2.0 + rad) * rad;
        cross = cross + size * size;
    }
    let r_square = x * x + y * y + z * z;
    rad_q = rad_q + rad_square * r_square + (square * r_square + cross) * unit;
    let rad_b = rad_c * (x + y + z) + (cx * x + cy * y + cz * z) * unit;
    // Numbers below the normal numbers have errors of up to `TINY`. In the widest views, Z may be
    // such a number. No coordinate of the centre is greater than 2, so that 64 · `TINY` covers all
    // these errors.
    let tiny = T::TINY * 64.0;
    ((rad_q + tiny) * UP, (rad_b + tiny) * UP)
}
