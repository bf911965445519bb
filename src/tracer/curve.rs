//! The curves in a pixel, or in a part of one, on which the visible surface may change: lines and
//! conics.
//!
//! In: the surfaces of objects in one precision, and a [`SubPixel`]. Out: the objects' silhouettes,
//! and the curves where their depths are equal, in the coordinates of the sub-pixel.
//!
//! In the picture, the silhouette of a sphere is a conic, and two planes have equal inverse depths
//! on a line. A plane and a sphere intersect in a circle, which the picture shows as a conic. Two
//! spheres also intersect in a circle, which lies in their radical plane.
//!
//! Each form is computed anew in the sub-pixel's coordinates and in high precision, with an error
//! bound for its values there. The result is therefore right to the last bits of an `f64`, however
//! far the sub-pixel is from the picture's centre.

use crate::math::{Ball, Ball3, Double, Radius, Real};

use super::{camera::Camera, form::Form, interval::Interval, sphere::Sphere, sub_pixel::SubPixel};

/// Minimum error bound ([`BoundaryLine::rad`]) at which a boundary line is computed again, in a
/// higher precision than double-double. The value is eight unit roundoffs of `f64`. With a much
/// smaller value, lines would be computed again in vain: storing a line's factors as `f64` alone
/// causes an error of three unit roundoffs.
pub(crate) const LOOSE_LINE: f64 = 8.0 / (1u64 << 53) as f64;

/// A curve in a pixel on which the visible surface may change.
#[derive(Clone, Debug)]
pub enum Boundary {
    /// A line.
    Line(BoundaryLine),
    /// A conic.
    Conic(Conic),
}

/// The line ax + by + c = 0, scaled so that the greater of |a| and |b| is 1.
#[derive(Clone, Copy, Debug)]
pub struct BoundaryLine {
    /// The factors a, b and c of the line's equation ax + by + c = 0.
    pub factors: [f64; 3],
    /// Error bound of the value of ax + by + c in the pixel.
    pub rad: f64,
}

/// The conic Ax² + 2Bxy + Cy² + 2Dx + 2Ey + F = 0, scaled so that its greatest factor is about 1 in
/// magnitude.
#[derive(Clone, Copy, Debug)]
pub struct Conic {
    /// The factors of the conic's equation Ax² + 2Bxy + Cy² + 2Dx + 2Ey + F = 0, from A to F.
    pub factors: [Double; 6],
    /// Error bound of the value of the conic's quadratic form in the pixel.
    pub rad: f64,
}

/// The inverse depth of a surface, as a function of a point of the picture.
#[derive(Debug)]
pub enum InverseDepth<'a, T: Real> {
    /// The inverse depth of a plane: a linear form.
    Plane(&'a Form<T>),
    /// The inverse depth of a sphere: a linear form plus the root of a quadratic form.
    Sphere(&'a Sphere<T>),
}

/// Selection among the crossings of a ray with an object.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Crossings {
    /// The first crossing.
    First,
    /// The second crossing.
    Second,
    /// Both crossings.
    Both,
}

/// A linear form of the point (x, y) of a sub-pixel: factors of x, y and 1.
type Linear<T> = [Ball<T>; 3];
/// A quadratic form of the point (x, y) of a sub-pixel: factors of x², 2xy, y², 2x, 2y and 1.
type Quadratic<T> = [Ball<T>; 6];

/// A sub-pixel's position in the view plane, in one precision.
#[derive(Clone, Debug)]
pub struct SubPixelFrame<T: Real> {
    /// The direction (X, Y, Z) through the sub-pixel's centre.
    center: Ball3<T>,
    /// Side of the sub-pixel, measured in X or Y, the first two components of a ray's direction.
    pitch: Ball<T>,
}

impl<T: Real> SubPixelFrame<T> {
    /// Places a sub-pixel in the view plane of a camera.
    pub fn new(camera: &Camera<T>, sub_pixel: SubPixel) -> Self {
        let r = sub_pixel.middle(camera);
        // The components of the direction are computed with five roundings each, and the
        // sub-pixel's side with fewer. An error bound of eight roundings is therefore enough for
        // all of these numbers.
        let ball = |mid: T| Ball {
            rad: mid.magnitude() * (8.0 * T::UNIT) + T::TINY,
            mid,
        };
        Self {
            center: [ball(r.x), ball(r.y), ball(r.z)],
            pitch: ball(camera.pitch.times(&T::from_f64(sub_pixel.side))),
        }
    }

    /// Returns the line on which the form `form` is zero.
    pub fn line(&self, form: &Form<T>) -> Boundary {
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

    /// Returns the silhouette of a sphere: the conic on which rays touch it. If the eye is outside
    /// of the sphere, also returns the line on which rays are perpendicular to the direction of the
    /// centre. If the eye is on the sphere's surface, returns only this line, which separates the
    /// rays that enter the sphere from all other rays.
    pub fn silhouette(&self, sphere: &Sphere<T>) -> Vec<Boundary> {
        // The conic is Q = R² r·r − |c × r|² = 0, where c is the centre, R the radius and r the
        // ray's direction. The line is c·r = 0.
        //
        // If the eye is outside, the conic has two branches, one in front of the eye and one behind
        // it. The line lies between the branches, and no ray on the line hits the sphere. An
        // exception is a sphere that differs from a plane by a relative amount of only about
        // 1e-200. Even the highest precision does not distinguish its branches.
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

    /// Returns the curve of rays that hit two surfaces at equal depths. Returns `None` if the
    /// surfaces are equal planes or concentric spheres.
    pub fn crossing(&self, a: &InverseDepth<T>, b: &InverseDepth<T>) -> Option<Boundary> {
        match (a, b) {
            (InverseDepth::Plane(a), InverseDepth::Plane(b)) if a.equals(b) => None,
            (InverseDepth::Plane(a), InverseDepth::Plane(b)) => Some(self.line(&a.minus(b))),
            (InverseDepth::Plane(plane), InverseDepth::Sphere(sphere))
            | (InverseDepth::Sphere(sphere), InverseDepth::Plane(plane)) => {
                let (c, square) = sphere.parts();
                let (factors, rad) = self.local(plane);
                // The factors of the plane are converted to the sphere's unit of inverse depth. The
                // unit is a power of two, so only its exponent is needed. The unit itself is the
                // inverse of the sphere's scale, and may exceed the range of `f64`.
                let exponent = -(libm::frexp(sphere.scale()).1 - 1);
                let linear = factors.map(|mid| Ball { mid, rad }.scaled(exponent));
                Some(self.circle(&c, &square, &linear, &Ball::exact(1.0)))
            }
            (InverseDepth::Sphere(a), InverseDepth::Sphere(b)) => self.spheres(a, b),
        }
    }

    /// Returns the curve of rays that hit two spheres at equal depths. Returns `None` for
    /// concentric spheres.
    fn spheres(&self, a: &Sphere<T>, b: &Sphere<T>) -> Option<Boundary> {
        // Let c be the centre of one sphere, R its radius, and C = c·c − R². Let c', R' and C' be
        // the same for the other sphere. The curve lies in the radical plane of the spheres. Every
        // point q of this plane satisfies |q − c|² − R² = |q − c'|² − R'². It follows that
        //
        // 2 (c' − c)·q = C' − C.
        let ((c, square), (d, other)) = (a.parts(), b.parts());
        // Each sphere has its own unit of length. The lengths of `b` are converted to the unit of
        // `a`.
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

    /// Returns the cone of rays through the circle in which a plane intersects a sphere. `c` is the
    /// sphere's centre, and `square` the square of its radius. The points q of the plane satisfy
    /// n·q = `h`; `plane` is n·r as a linear form, where r is a ray's direction.
    fn circle(&self, c: &Ball3<T>, square: &Ball<T>, plane: &Linear<T>, h: &Ball<T>) -> Boundary {
        // A ray of direction r hits the plane at q = (h/(n·r)) r. With the radius R, the cone is
        // therefore
        //
        // |h r − (n·r) c|² = R² (n·r)².
        //
        // The left side is a sum of squares that are small near the circle. The formula therefore
        // loses no digits by cancellation if the sphere is small and far away.
        let r = self.directions();
        let offsets = [0, 1, 2].map(|i| [0, 1, 2].map(|k| h * &r[i][k] - &c[i] * &plane[k]));
        let outside = sum(offsets.each_ref().map(|x| product(x, x)));
        let inside = product(plane, plane);
        conic(&[0, 1, 2, 3, 4, 5].map(|i| &outside[i] - square * &inside[i]))
    }

    /// Returns the components X, Y and Z of the direction through a point of the sub-pixel, as
    /// linear forms of the point.
    fn directions(&self) -> [Linear<T>; 3] {
        let [x, y, z] = self.center.clone();
        let zero = || Ball::exact(0.0);
        [
            [self.pitch.clone(), zero(), x],
            [zero(), self.pitch.clone(), y],
            [zero(), zero(), z],
        ]
    }

    /// Returns v·r as a linear form of the point of the sub-pixel, where r is the direction through
    /// the point.
    fn along(&self, v: &Ball3<T>) -> Linear<T> {
        [
            &v[0] * &self.pitch,
            &v[1] * &self.pitch,
            crate::math::dot(v, &self.center),
        ]
    }
}

fn line_of<T: Real>(linear: &Linear<T>) -> Boundary {
    let factors = linear.each_ref().map(|x| x.mid.clone());
    line(&factors, linear[0].rad + linear[1].rad + linear[2].rad)
}

/// Returns the line on which a linear form is zero. The form is divided by its greater slope, i.e.
/// factor of x or y. Different forms that are zero on the same line, such as the horizon of
/// parallel planes, therefore get equal factors.
fn line<T: Real>(factors: &[T; 3], rad: T::Radius) -> Boundary {
    let [a, b, _] = factors;
    let greatest = if a.magnitude() < b.magnitude() { b } else { a };
    // A form without a slope is constant, and is zero on no line. It is divided by 1 instead.
    let exponent = -greatest.magnitude().exponent();
    let greatest = greatest.scaled(exponent);
    let slope = if greatest.is_zero() {
        T::from_f64(1.0)
    } else {
        greatest
    };
    let factors = factors
        .each_ref()
        .map(|x| x.scaled(exponent).over(&slope).to_f64());
    // Maximum relative rounding error of the line's factors: each is a quotient by the greater
    // slope, converted to `f64`.
    let unit = f64::UNIT + 8.0 * T::UNIT;
    let rounding = unit * (factors[0].abs() + factors[1].abs() + factors[2].abs());
    // The error bound covers the roundings of the quotient, and the rounding of the slope to `f64`.
    let rad = rad.scaled(exponent).to_f64() / slope.to_f64().abs() * (1.0 + 8.0 * f64::UNIT);
    Boundary::Line(BoundaryLine {
        factors,
        rad: rad + rounding,
    })
}

/// Returns the product of two linear forms.
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

/// Returns the conic on which a quadratic form is zero.
fn conic<T: Real>(factors: &Quadratic<T>) -> Boundary {
    let size = factors
        .iter()
        .fold(T::Radius::ZERO, |size, x| size.max(x.size()));
    let exponent = -size.exponent();
    // The errors of the factors are added, because no term of the form exceeds its factor for |x|
    // and |y| of at most 1/2.
    let rad = factors.iter().fold(T::Radius::ZERO, |rad, x| rad + x.rad);
    Boundary::Conic(Conic {
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
    /// Returns an upper bound of the area between the true conic and the computed one, in square
    /// pixels. It is the least of three bounds, because each of them is poor for some conics.
    pub fn doubtful_area(&self) -> f64 {
        // All points between the two conics satisfy |F| ≤ ε, where F is the computed form and ε its
        // error bound. The area of these points has three bounds:
        //
        // - By the coarea formula, 2ε · length/(least gradient). A conic in the pixel is no longer
        //   than twice the pixel's perimeter.
        // - For an ellipse, 2πε/√(AC − B²), the difference of two ellipses' areas. A, B and C are
        //   the factors of x², 2xy and y².
        // - In any case, 4 · 2 · √(ε/(greatest |F|)), by the inequality of Brudnyi and Ganzburg
        //   (1973) for polynomials of degree 2 on a convex set of area 1 in the plane.
        //
        // In the last bound, the greatest |F| is at least 1/16: some factor is at least 1/2, and
        // each factor is at most 8 times the greatest |F|. For example, A is a combination of three
        // values of F with weights of the magnitudes 2, 4 and 2.
        let [a, b, c, d, e, _] = self.factors.map(|factor| factor.hi);
        let turn = libm::hypot(a.abs() + b.abs(), b.abs() + c.abs());
        let gradient = 2.0 * (libm::hypot(d, e) - 0.5 * turn);
        let determinant = a * c - b * b;
        let mut area = 32.0 * self.rad.sqrt();
        if gradient > 0.0 {
            area = area.min(16.0 * self.rad / gradient);
        }
        // The rounding errors of the determinant are subtracted from it, so that the bound on the
        // area is certainly large enough. They are at most two roundings for each of the
        // determinant's two products.
        let determinant = determinant - 4.0 * f64::UNIT * (a * c).abs().max(b * b);
        if determinant > 0.0 {
            area = area.min(7.0 * self.rad / determinant.sqrt());
        }
        area
    }

    /// Returns an interval that contains the values of the conic's form over the pixel.
    pub fn over_pixel(&self) -> Interval {
        // Extremes lie at corners, or where the derivative vanishes along a side or in all
        // directions. An extreme may be computed at an inaccurate position. This hardly matters:
        // the gradient is almost 0 near an extreme, so the form's value at this position is almost
        // the extreme value.
        let [a, b, c, d, e, f] = self.factors.map(|factor| factor.hi);
        let at = |x: f64, y: f64| x * (a * x + 2.0 * (b * y + d)) + y * (c * y + 2.0 * e) + f;
        let mut range = Interval {
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
        // The form is a sum of six terms, of three roundings each; 16 roundings of `size` cover
        // them.
        let rad = self.rad + 16.0 * f64::UNIT * size;
        Interval {
            low: range.low - rad,
            high: range.high + rad,
        }
    }
}

impl BoundaryLine {
    /// Returns an interval that contains the values of ax + by + c over the pixel.
    pub fn over_pixel(&self) -> Interval {
        let [a, b, c] = self.factors;
        Interval::about(c, 0.5 * (a.abs() + b.abs()) + self.rad)
    }
}

#[cfg(test)]
mod tests;
