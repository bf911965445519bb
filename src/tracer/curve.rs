//! The curves that bound what is seen in a pixel, or in a part of one: lines and conics.
//!
//! In: the surfaces of objects in one precision, and a [`SubPixel`]. Out: their outlines, and where
//! they cross each other, as curves in the coordinates of that sub-pixel. Outlines of spheres are Q
//! = 0 (`sphere`); two planes cross where their inverse depths are equal, a plane and a
//! sphere in the circle's cone, two spheres in their radical plane.
//!
//! Errors: each form is prepared anew in the sub-pixel's coordinates and in high precision, with a
//! bound on its values there, so that what is left is good to the last bit of an `f64` however far
//! the sub-pixel is from the picture's centre.

use crate::math::{Ball, Ball3, Double, Radius, Real};

use super::{camera::Camera, form::Form, interval::Range, sphere::Sphere, sub_pixel::SubPixel};

/// The error of a line's form, in units of its greatest slope, from which on double-double was not
/// enough: eight roundings of an `f64`, more than the three of its factors come to.
pub(crate) const LOOSE_LINE: f64 = 8.0 / (1u64 << 53) as f64;

/// A boundary in a pixel.
#[derive(Clone, Debug)]
pub enum Curve {
    /// A line.
    Line(Line),
    /// A conic.
    Conic(Conic),
}

/// The line ax + by + c = 0, the greater of |a| and |b| being 1.
#[derive(Clone, Copy, Debug)]
pub struct Line {
    /// a, b and c.
    pub factors: [f64; 3],
    /// How far a value of the form may be from the true one, in the pixel.
    pub rad: f64,
}

/// The conic Ax² + 2Bxy + Cy² + 2Dx + 2Ey + F = 0, the greatest of its factors being about 1.
#[derive(Clone, Copy, Debug)]
pub struct Conic {
    /// A, B, C, D, E and F.
    pub factors: [Double; 6],
    /// How far a value of the form may be from the true one, in the pixel.
    pub rad: f64,
}

/// A surface, as far as it matters where it crosses another one.
#[derive(Debug)]
pub enum Surface<'a, T: Real> {
    /// The plane with an inverse depth.
    Plane(&'a Form<T>),
    /// A sphere.
    Sphere(&'a Sphere<T>),
}

/// Which crossings of a ray with an object.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Crossings {
    /// The first one.
    First,
    /// The second one.
    Second,
    /// Both.
    Both,
}

/// A linear form of x, y and 1, and a quadratic one of x², 2xy, y², 2x, 2y and 1.
type Linear<T> = [Ball<T>; 3];
type Quadratic<T> = [Ball<T>; 6];

/// A sub-pixel in one precision.
#[derive(Clone, Debug)]
pub struct SubPixelFrame<T: Real> {
    /// The direction through its centre.
    center: Ball3<T>,
    /// Its side.
    pitch: Ball<T>,
}

impl<T: Real> SubPixelFrame<T> {
    /// The place of a sub-pixel.
    pub fn new(camera: &Camera<T>, sub_pixel: SubPixel) -> Self {
        let r = sub_pixel.middle(camera);
        // Five roundings in a coordinate, and its pitch.
        let ball = |mid: T| Ball {
            rad: mid.magnitude() * (8.0 * T::UNIT) + T::TINY,
            mid,
        };
        Self {
            center: [ball(r.x), ball(r.y), ball(r.z)],
            pitch: ball(camera.pitch.times(&T::from_f64(sub_pixel.side))),
        }
    }

    /// A form's zero line.
    pub fn line(&self, form: &Form<T>) -> Curve {
        let (factors, rad) = self.local(form);
        line(&factors, rad)
    }

    fn local(&self, form: &Form<T>) -> ([T; 3], T::Radius) {
        let [a, b, c] = form.factors();
        let [x, y, _] = &self.center;
        let middle = a.times(&x.mid).plus(&b.times(&y.mid)).plus(c);
        let [a, b] = [a, b].map(|factor| factor.times(&self.pitch.mid));
        ([a, b, middle], form.rad())
    }

    /// The outline of a sphere, Q = R² r·r − |c × r|² = 0; for an eye on its surface the line c·r =
    /// 0 that bounds it then.
    ///
    /// For one outside that line comes as well. No ray on it meets the sphere; but of the conic's
    /// two branches, in front of the eye and behind it, which lie on either side of it, no
    /// precision tells the one from the other where the sphere is a plane but for its 1e-200th
    /// part.
    pub fn silhouette(&self, sphere: &Sphere<T>) -> Vec<Curve> {
        let (c, square) = sphere.parts();
        let ahead = || line_of(&self.along(&c));
        if sphere.is_at_eye() {
            return vec![ahead()];
        }
        let r = self.directions();
        let cross = [(1, 2), (2, 0), (0, 1)]
            .map(|(i, j)| [0, 1, 2].map(|k| &c[i] * &r[j][k] - &c[j] * &r[i][k]));
        let inside = sum(r.each_ref().map(|x| product(x, x)));
        let outside = sum(cross.each_ref().map(|x| product(x, x)));
        let q = [0, 1, 2, 3, 4, 5].map(|i| &square * &inside[i] - &outside[i]);
        let mut curves = vec![conic(&q)];
        curves.extend(sphere.is_outside().then(ahead));
        curves
    }

    /// Where two surfaces cross, if it is on a curve: rays that meet both at the same depth.
    pub fn crossing(&self, a: &Surface<T>, b: &Surface<T>) -> Option<Curve> {
        match (a, b) {
            (Surface::Plane(a), Surface::Plane(b)) if a.equals(b) => None,
            (Surface::Plane(a), Surface::Plane(b)) => Some(self.line(&a.minus(b))),
            (Surface::Plane(plane), Surface::Sphere(sphere))
            | (Surface::Sphere(sphere), Surface::Plane(plane)) => {
                let (c, square) = sphere.parts();
                let (factors, rad) = self.local(plane);
                // In the sphere's unit of inverse depth. Its scale is within the range of an f64,
                // its inverse need not be.
                let exponent = -(libm::frexp(sphere.scale()).1 - 1);
                let linear = factors.map(|mid| Ball { mid, rad }.scaled(exponent));
                Some(self.circle(&c, &square, &linear, &Ball::exact(1.0)))
            }
            (Surface::Sphere(a), Surface::Sphere(b)) => self.spheres(a, b),
        }
    }

    /// Two spheres cross in their radical plane: |q − c|² − R² is the same for both where 2 (c' −
    /// c)·q = C' − C.
    fn spheres(&self, a: &Sphere<T>, b: &Sphere<T>) -> Option<Curve> {
        let ((c, square), (d, other)) = (a.parts(), b.parts());
        // To one unit.
        let exponent = libm::frexp(a.scale()).1 - libm::frexp(b.scale()).1;
        let d = d.map(|x| x.scaled(exponent));
        let other = other.scaled(2 * exponent);
        let n = [0, 1, 2].map(|i| &d[i] - &c[i]);
        let sums = [0, 1, 2].map(|i| &d[i] + &c[i]);
        let twice = crate::math::dot(&n, &sums) - (&other - &square);
        let h = twice.times_power(0.5);
        if n.iter().all(|x| x.mid.is_zero()) {
            return None;
        }
        let linear = self.along(&n);
        if h.mid.is_zero() {
            return Some(line_of(&linear));
        }
        Some(self.circle(&c, &square, &linear, &h))
    }

    /// The circle where the plane n·q = h crosses a sphere: with q = (h/n·r) r, |hr − (n·r)c|² = R²
    /// (n·r)².
    ///
    /// Written so, it is a sum of squares that are small where the circle is, and does not cancel
    /// for a small and far sphere.
    fn circle(&self, c: &Ball3<T>, square: &Ball<T>, plane: &Linear<T>, h: &Ball<T>) -> Curve {
        let r = self.directions();
        let offsets = [0, 1, 2].map(|i| [0, 1, 2].map(|k| h * &r[i][k] - &c[i] * &plane[k]));
        let outside = sum(offsets.each_ref().map(|x| product(x, x)));
        let inside = product(plane, plane);
        conic(&[0, 1, 2, 3, 4, 5].map(|i| &outside[i] - square * &inside[i]))
    }

    /// The components of r as linear forms.
    fn directions(&self) -> [Linear<T>; 3] {
        let [x, y, z] = self.center.clone();
        let zero = || Ball::exact(0.0);
        [
            [self.pitch.clone(), zero(), x],
            [zero(), self.pitch.clone(), y],
            [zero(), zero(), z],
        ]
    }

    /// v·r as a linear form.
    fn along(&self, v: &Ball3<T>) -> Linear<T> {
        [
            &v[0] * &self.pitch,
            &v[1] * &self.pitch,
            crate::math::dot(v, &self.center),
        ]
    }
}

fn line_of<T: Real>(linear: &Linear<T>) -> Curve {
    let factors = linear.each_ref().map(|x| x.mid.clone());
    line(&factors, linear[0].rad + linear[1].rad + linear[2].rad)
}

/// A linear form's zero line. Its greater slope becomes 1, so that forms of one line, as those of
/// the horizons of parallel planes are, have the same factors.
fn line<T: Real>(factors: &[T; 3], rad: T::Radius) -> Curve {
    let [a, b, _] = factors;
    let greatest = match a.magnitude() < b.magnitude() {
        true => b,
        false => a,
    };
    // A form without slope has no zero line; any power of two will do.
    let exponent = -greatest.magnitude().exponent();
    let greatest = greatest.scaled(exponent);
    let slope = match greatest.is_zero() {
        true => T::from_f64(1.0),
        false => greatest,
    };
    let factors = factors
        .each_ref()
        .map(|x| x.scaled(exponent).over(&slope).to_f64());
    // Of the quotients, and of these in `f64`.
    let unit = f64::UNIT + 8.0 * T::UNIT;
    let rounding = unit * (factors[0].abs() + factors[1].abs() + factors[2].abs());
    // Its own quotient, and that of the slope in `f64`, are rounded, too.
    let rad = rad.scaled(exponent).to_f64() / slope.to_f64().abs() * (1.0 + 8.0 * f64::UNIT);
    Curve::Line(Line {
        factors,
        rad: rad + rounding,
    })
}

/// The product of two linear forms.
fn product<T: Real>(a: &Linear<T>, b: &Linear<T>) -> Quadratic<T> {
    let half = |i: usize, j: usize| (&a[i] * &b[j] + &a[j] * &b[i]).times_power(0.5);
    [
        &a[0] * &b[0],
        half(0, 1),
        &a[1] * &b[1],
        half(0, 2),
        half(1, 2),
        &a[2] * &b[2],
    ]
}

fn sum<T: Real>([a, b, c]: [Quadratic<T>; 3]) -> Quadratic<T> {
    [0, 1, 2, 3, 4, 5].map(|i| &a[i] + &b[i] + &c[i])
}

/// A quadratic form's conic.
fn conic<T: Real>(factors: &Quadratic<T>) -> Curve {
    let size = factors
        .iter()
        .fold(T::Radius::ZERO, |size, x| size.max(x.size()));
    let exponent = -size.exponent();
    // |x| and |y| are at most 1/2.
    let rad = factors.iter().fold(T::Radius::ZERO, |rad, x| rad + x.rad);
    Curve::Conic(Conic {
        factors: factors.each_ref().map(|x| double(&x.mid.scaled(exponent))),
        rad: rad.scaled(exponent).to_f64() + Double::UNIT,
    })
}

fn double<T: Real>(x: &T) -> Double {
    let hi = x.to_f64();
    let lo = x.minus(&T::from_f64(hi)).to_f64();
    Double { hi, lo }
}

impl Conic {
    /// How much of the pixel's area may lie between the true conic and the computed one: at most
    /// that of the points where |F| ≤ ε, the form's error. Three bounds of it hold, and the least counts:
    ///
    /// - By the coarea formula 2ε · length / least gradient; a conic is no longer in the pixel than
    ///   twice the perimeter.
    /// - About an ellipse 2πε/√(AC − B²), the difference of two ellipses' areas.
    /// - In any case 4 · 2 · √(ε / greatest |F|), by the inequality of Brudnyi and Ganzburg (1973)
    ///   for polynomials of degree 2 on a convex set of area 1 in the plane. The greatest |F| is at
    ///   least 1/16, since a factor of at least 1/2 is a combination of values of F: A of three
    ///   with the weights 2, 4 and 2, the others of fewer.
    pub fn doubtful_area(&self) -> f64 {
        let [a, b, c, d, e, _] = self.factors.map(|factor| factor.hi);
        let turn = libm::hypot(a.abs() + b.abs(), b.abs() + c.abs());
        let gradient = 2.0 * (libm::hypot(d, e) - 0.5 * turn);
        let determinant = a * c - b * b;
        let mut area = 32.0 * self.rad.sqrt();
        if gradient > 0.0 {
            area = area.min(16.0 * self.rad / gradient);
        }
        // The difference of products is off by two roundings of them.
        let determinant = determinant - 4.0 * f64::UNIT * (a * c).abs().max(b * b);
        if determinant > 0.0 {
            area = area.min(7.0 * self.rad / determinant.sqrt());
        }
        area
    }

    /// The range of its form over the pixel.
    ///
    /// It is least and greatest at corners, or where it is level along a side or in all directions.
    /// Of such a place that is not known well nothing much depends: to another one in the pixel
    /// the form rises by half the product of the way and of its gradient, which is
    /// next to none.
    pub fn over_pixel(&self) -> Range {
        let [a, b, c, d, e, f] = self.factors.map(|factor| factor.hi);
        let at = |x: f64, y: f64| x * (a * x + 2.0 * (b * y + d)) + y * (c * y + 2.0 * e) + f;
        let mut range = Range {
            low: f64::INFINITY,
            high: f64::NEG_INFINITY,
        };
        let mut hold = |x: f64, y: f64| {
            if x.abs() <= 0.5 && y.abs() <= 0.5 {
                let value = at(x, y);
                range.low = range.low.min(value);
                range.high = range.high.max(value);
            }
        };
        for side in [-0.5, 0.5] {
            hold(side, -0.5);
            hold(side, 0.5);
            hold(side, -(b * side + e) / c);
            hold(-(b * side + d) / a, side);
        }
        let determinant = a * c - b * b;
        hold((b * e - c * d) / determinant, (b * d - a * e) / determinant);
        let size = 0.25 * (a.abs() + 2.0 * b.abs() + c.abs()) + d.abs() + e.abs() + f.abs();
        // Six terms of three roundings, which are summed; no extreme lies between them.
        let rad = self.rad + 16.0 * f64::UNIT * size;
        Range {
            low: range.low - rad,
            high: range.high + rad,
        }
    }
}

impl Line {
    /// The range of its form over the pixel.
    pub fn over_pixel(&self) -> Range {
        let [a, b, c] = self.factors;
        Range::about(c, 0.5 * (a.abs() + b.abs()) + self.rad)
    }
}
