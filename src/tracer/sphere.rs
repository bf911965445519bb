//! The sphere: a conic in the view plane.
//!
//! With c the centre as seen from the eye, R the radius and C = c·c − R² (the power of the eye), the ray λr meets the sphere
//! where λ² r·r − 2λ c·r + C = 0. A quarter of the discriminant is Q = R² r·r − |c × r|² by Lagrange's identity, which unlike
//! (c·r)² − r·r C does not subtract large squares where the sphere is small and far.

use std::cmp::Ordering;

use glam::DVec3;

use super::{
    camera::{Camera, Direction, Window},
    crossing::{Crossing, Part},
};
use crate::{
    math::{Ball, Ball3, Double, Doubt, Exact, Real, UP, dot},
    scene,
};

/// A sphere prepared for one picture. Its lengths are scaled by a power of two to be about 1.
#[derive(Clone, Debug)]
pub struct Sphere<T> {
    /// The centre in the camera's axes.
    center: [T; 3],
    /// R².
    square: T,
    /// C, each bit of it right however close the eye is to the surface.
    power: Ball<T>,
    /// The sign of C: the eye is outside, on the surface, or inside.
    side: Ordering,
    /// What a scaled inverse depth is to be multiplied by: a power of two.
    scale: f64,
    /// Error bound of Q.
    rad_q: f64,
    /// Error bound of c·r.
    rad_b: f64,
}

/// As in a form's value, and once more for squares and their sum.
const ROUNDINGS: f64 = 32.0;

impl<T: Real> Sphere<T> {
    /// Prepares a sphere.
    pub fn new(camera: &Camera<T>, shape: &scene::Sphere) -> Self {
        let scene::Sphere { center, radius, .. } = *shape;
        let from_eye = camera.relative(center);
        let radius_ball = camera.length(radius);
        let greatest = from_eye
            .iter()
            .map(Ball::size)
            .fold(radius_ball.size(), f64::max);
        // Within what powers of two an f64 holds; a factor of 2^74 more or less does no harm.
        let exponent = (-libm::frexp(greatest.min(f64::MAX)).1).clamp(-1000, 1000);
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
        let (rad_q, rad_b) = radii::<T>(
            &c.each_ref().map(Ball::size),
            c.iter().map(|x| x.rad).fold(0.0, f64::max),
            square.size(),
            square.rad,
            &camera.window,
        );
        Self {
            center: c.map(|x| x.mid),
            square: square.mid,
            power,
            side,
            scale: libm::ldexp(1.0, exponent),
            rad_q,
            rad_b,
        }
    }

    /// Q and c·r.
    #[inline]
    fn discriminant(&self, r: &Direction<T>) -> (Ball<T>, Ball<T>) {
        let [cx, cy, cz] = &self.center;
        let k = cy.times(&r.z).minus(&cz.times(&r.y));
        let l = cz.times(&r.x).minus(&cx.times(&r.z));
        let m = cx.times(&r.y).minus(&cy.times(&r.x));
        let cross = k.times(&k).plus(&l.times(&l)).plus(&m.times(&m));
        let q = Ball {
            mid: self.square.times(&r.square).minus(&cross),
            rad: self.rad_q,
        };
        let b = Ball {
            mid: cx.times(&r.x).plus(&cy.times(&r.y)).plus(&cz.times(&r.z)),
            rad: self.rad_b,
        };
        (q, b)
    }

    /// The nearest crossing in front of the eye. A ray that only touches the sphere misses it.
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
                Ok(Some(self.crossing(&inverse, Part::Entry)))
            }
            Ordering::Equal if b.sign()? != Ordering::Greater => Ok(None),
            _ => Ok(Some(self.exit(&q, &b, r))),
        }
    }

    /// The crossing behind the first one.
    pub fn second(&self, r: &Direction<T>) -> Option<Crossing<T>> {
        if self.side != Ordering::Greater {
            return None;
        }
        let (q, b) = self.discriminant(r);
        Some(self.exit(&q, &b, r))
    }

    /// Where the ray leaves the sphere: of the two forms of the root the one that does not cancel.
    fn exit(&self, q: &Ball<T>, b: &Ball<T>, r: &Direction<T>) -> Crossing<T> {
        let root = q.sqrt();
        let inverse = if b.mid.to_f64() >= 0.0 {
            let square = Ball {
                rad: ROUNDINGS * T::UNIT * r.square.to_f64(),
                mid: r.square.clone(),
            };
            square / (b + root)
        } else {
            (b - root) / &self.power
        };
        self.crossing(&inverse, Part::Exit)
    }

    #[inline]
    fn crossing(&self, inverse: &Ball<T>, part: Part) -> Crossing<T> {
        Crossing {
            inverse_depth: inverse.times_power(self.scale),
            part,
        }
    }
}

impl Sphere<Double> {
    /// The same sphere for `f64`.
    pub fn narrowed(&self, window: &Window) -> Sphere<f64> {
        let center = self.center.map(|x| x.hi);
        let (rad_q, rad_b) = radii::<f64>(
            &center.map(f64::abs),
            0.0,
            self.square.hi,
            self.square.hi * f64::UNIT,
            window,
        );
        Sphere {
            center,
            square: self.square.hi,
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

/// C = c·c − R², scaled, with a small relative error, and its exact sign.
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
    let c = [0, 1, 2].map(|i| Exact::difference(center[i], eye[i]));
    let squares = c.each_ref().map(|x| x * x);
    let square = &Exact::new(radius) * &Exact::new(radius);
    let power = &(&(&squares[0] + &squares[1]) + &squares[2]) - &square;
    let side = power.sign();
    (Ball::from_big(&power.to_big().scaled(2 * exponent)), side)
}

/// Error bounds of Q and c·r over a window, from the sizes of the centre's coordinates, their error, R² and its error.
fn radii<T: Real>(
    c: &[f64; 3],
    rad_c: f64,
    square: f64,
    rad_square: f64,
    window: &Window,
) -> (f64, f64) {
    let [cx, cy, cz] = *c;
    let Window { x, y, z } = *window;
    let unit = ROUNDINGS * T::UNIT;
    let mut rad_q = 0.0;
    let mut cross = 0.0;
    // The components of c × r: each a difference of two products.
    for (size, reach) in [
        (cy * z + cz * y, y + z),
        (cz * x + cx * z, x + z),
        (cx * y + cy * x, x + y),
    ] {
        let rad = rad_c * reach + unit * size;
        rad_q += (2.0 * size + rad) * rad;
        cross += size * size;
    }
    let r_square = x * x + y * y + z * z;
    rad_q += rad_square * r_square + unit * (square * r_square + cross);
    let rad_b = rad_c * (x + y + z) + unit * (cx * x + cy * y + cz * z);
    ((rad_q + 8.0 * T::TINY) * UP, (rad_b + 8.0 * T::TINY) * UP)
}
