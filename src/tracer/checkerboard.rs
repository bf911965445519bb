//! The checkerboard: an infinite horizontal plane of squares.
//!
//! In: the board's height, the side of its squares, and the camera. Out: for a ray, its crossing
//! and the colour there. If the ray hits the plane, the plane's inverse depth ℓ is positive. The
//! coordinate x or z of the crossing, in squares, is then a ratio of linear forms, N/ℓ.
//!
//! N is measured from the line between squares that is nearest to the eye, not from the world's
//! origin. If N were measured from the origin, it could be large and thus less precise. Only the
//! parity of the number of squares between the origin and this line is needed for the colour, and
//! it is stored separately. The error of a ratio follows from the errors of its forms. If the error
//! interval of a ratio contains a whole number, the colour is uncertain.

use super::{
    camera::{Camera, Direction, Window},
    convex::Convex,
    form::{Form, axis_vector, inverse_depth},
};
use crate::{
    math::{Ball, Double, Doubt, Radius, Real},
    scene,
};

/// Limit on the distance, in squares, by which [`Checkerboard::local`] moves the origin of a
/// board's coordinates. The distance is a quotient that is rounded to a whole number. From 2^52 on,
/// an `f64` has no fractional digits, so the rounded quotient may be wrong by a whole square. The
/// origin is then not moved.
const MOST_SQUARES: f64 = (1u64 << 52) as f64;

/// A checkerboard prepared for one picture.
#[derive(Clone, Debug)]
pub struct Checkerboard<T: Real> {
    /// The board's plane. A ray hits it if the plane's inverse depth ℓ is positive along the ray.
    pub plane: Convex<T>,
    /// Inverse depth ℓ of the board's plane, a linear form ([`Form`]) over the view plane. It is
    /// scaled by the power of two that brings the height of the eye above the plane to about 1.
    /// `numerators` have the same scale.
    pub denominator: Form<T>,
    /// Numerators N of the board's coordinates x and z, linear forms ([`Form`]) over the view
    /// plane. N/ℓ, where ℓ is `denominator`, is the coordinate in squares, measured from the line
    /// between squares that is nearest to the eye.
    pub numerators: [Form<T>; 2],
    /// Whether the square from (0, 0) to (1, 1) in the board's coordinates has the second colour.
    /// The coordinates are measured from the two lines that are nearest to the eye, one in x and
    /// one in z. The square has the second colour if the sum of these lines' numbers, counted from
    /// the world's origin, is odd.
    pub odd: bool,
}

/// A checkerboard over a rectangle of the picture: a pixel, a part of one, or several pixels. A
/// point (x, y) of the rectangle is measured from the rectangle's centre, in units of its sides.
/// The point shows the position (N₀/ℓ, N₁/ℓ) on the board, in squares, measured from a nearby point
/// where four squares meet. N₀, N₁ and ℓ are linear forms in x and y; the board is seen only if ℓ >
/// 0.
#[derive(Clone, Copy, Debug)]
pub struct LocalBoard {
    /// Factors of x, y and 1 in N₀ and N₁, the numerators of the board's coordinates N₀/ℓ and N₁/ℓ.
    /// In the highest precision, factors may exceed the range of `f64`. N₀, N₁ and ℓ are then
    /// multiplied by the same power of two, which brings the largest factor to about 1.
    pub numerators: [[f64; 3]; 2],
    /// Factors of x, y and 1 in ℓ, the denominator of the board's coordinates.
    pub denominator: [f64; 3],
    /// Error bounds of N₀, N₁ and ℓ at all points of the rectangle. The board's coordinates are
    /// N₀/ℓ and N₁/ℓ. The rounding of the factors to `f64` is not included.
    pub rads: [f64; 3],
    /// Whether the square from (0, 0) to (1, 1) in the board's coordinates has the second colour.
    pub odd: bool,
}

impl<T: Real> Checkerboard<T> {
    /// Prepares a checkerboard. Returns `None` if its plane contains the eye, which then sees
    /// nothing of the board.
    pub fn new(camera: &Camera<T>, shape: &scene::Checkerboard) -> Option<Self> {
        let scene::Checkerboard { y, square, .. } = *shape;
        if y == camera.eye.y {
            return None;
        }
        let height = camera.relative_coordinate(1, y);
        let plane = inverse_depth(camera, &axis_vector(1), &height);
        let scale = -height.size().exponent();
        let h = height.scaled(scale);
        let up = camera.turned(&axis_vector(1));
        let (x, z) = (
            EyeOffset::new(camera.eye.x, square),
            EyeOffset::new(camera.eye.z, square),
        );
        let numerator = |axis: usize, from_square: &EyeOffset| {
            // Let e be the eye, r the ray's direction and h the board's height relative to the eye.
            // The ray hits the board at x = e_x + r_x/ℓ, where ℓ = r_y/h. Therefore x/square =
            // (ℓ·e_x/square + r_x/square)/ℓ, and the numerator is a linear form.
            let along = camera.turned(&axis_vector(axis));
            let exponent = -libm::frexp(square).1;
            let side = Ball::exact(square).scaled(exponent);
            let offset = Ball::exact(from_square.rest).scaled(exponent) / &side;
            let side = side.scaled(camera.exponent + scale - exponent);
            let v = [0, 1, 2].map(|i| &offset * &(&up[i] / &h) + &along[i] / &side);
            Form::new(camera, &v)
        };
        Some(Self {
            denominator: inverse_depth(camera, &axis_vector(1), &h),
            plane: Convex::new(Vec::new(), vec![(0, plane)], Vec::new()),
            numerators: [numerator(0, &x), numerator(2, &z)],
            odd: x.odd != z.odd,
        })
    }

    /// Returns whether the square that the ray hits has the second colour. This is so if
    /// floor(x/square) + floor(z/square) is odd, where x and z are world coordinates of the
    /// crossing, and `square` is the side of a square. Returns a [`Doubt`] if rounding errors leave
    /// the colour uncertain.
    #[inline]
    pub fn is_odd(&self, r: &Direction<T>) -> Result<bool, Doubt> {
        let denominator = self.denominator.at(r);
        let mut odd = self.odd;
        for numerator in &self.numerators {
            let (_, odd_here) = (numerator.at(r) / &denominator).floor()?;
            odd ^= odd_here;
        }
        Ok(odd)
    }

    /// Returns the board over a rectangle of the view plane, as a function of the offset from the
    /// rectangle's centre. `center` is the direction through the centre. `sides` are the lengths of
    /// the rectangle's sides in X and Y. An offset is given in units of these lengths.
    pub fn local(&self, center: &Direction<T>, sides: &[T; 2]) -> LocalBoard {
        // A multiple of the denominator ℓ of the board's coordinates is subtracted from their
        // numerators N₀ and N₁. This moves the origin to a nearby point where four squares meet.
        // The multiple makes N₀ and N₁ small at one corner of the rectangle, the corner with the
        // greatest ℓ. At other corners, ℓ may be almost 0, so a quotient by it would be useless.
        let local = |form: &Form<T>| {
            let [a, b, _] = form.factors();
            let factors = [a.times(&sides[0]), b.times(&sides[1]), form.at(center).mid];
            (factors, form.rad())
        };
        let (denominator, rad) = local(&self.denominator);
        let [x, y] =
            [&denominator[0], &denominator[1]].map(|slope| 0.5_f64.copysign(slope.to_f64()));
        let corner = |[a, b, c]: &[T; 3]| a.to_f64() * x + b.to_f64() * y + c.to_f64();
        let highest = corner(&denominator);
        let mut odd = self.odd;
        let [a, b] = self.numerators.each_ref().map(|form| {
            let (factors, own_rad) = local(form);
            let times = (corner(&factors) / highest).round();
            if !(times.abs() < MOST_SQUARES && highest > 0.0) {
                return (factors, own_rad);
            }
            odd ^= times as i64 & 1 == 1;
            let multiple = T::from_f64(times);
            let factors = [0, 1, 2].map(|i| factors[i].minus(&denominator[i].times(&multiple)));
            // The error of ℓ is at most `rad`, and is multiplied by `times`. The product and the
            // difference are rounded, too. These errors are smaller, because `rad` is large enough
            // for 12 roundings of ℓ. Twice `rad` · |`times`| therefore covers all of them.
            (factors, own_rad + rad * (2.0 * times.abs()))
        });
        let mut forms = [a, b, (denominator, rad)];
        if T::LAST {
            let sizes = forms.iter().flat_map(|(factors, _)| factors);
            let size = sizes.fold(T::Radius::ZERO, |size, factor| size.max(factor.magnitude()));
            for (factors, rad) in &mut forms {
                *factors = factors.each_ref().map(|c| c.scaled(-size.exponent()));
                *rad = rad.scaled(-size.exponent());
            }
        }
        let rads = forms.each_ref().map(|(_, rad)| rad.to_f64());
        let [a, b, denominator] = forms.map(|(factors, _)| factors.each_ref().map(Real::to_f64));
        LocalBoard {
            numerators: [a, b],
            denominator,
            rads,
            odd,
        }
    }
}

impl Checkerboard<Double> {
    /// Rounds the checkerboard to `f64`.
    pub fn narrowed(&self, window: &Window<f64>) -> Checkerboard<f64> {
        Checkerboard {
            plane: self.plane.narrowed(window),
            denominator: self.denominator.narrowed(window),
            numerators: self.numerators.each_ref().map(|form| form.narrowed(window)),
            odd: self.odd,
        }
    }
}

/// A coordinate of the eye as a whole number of squares and a remainder.
struct EyeOffset {
    /// The remainder of the coordinate after the whole squares are subtracted: at most half the
    /// side of a square in magnitude.
    rest: f64,
    /// Whether the number of whole squares is odd.
    odd: bool,
}

impl EyeOffset {
    /// Splits a coordinate of the eye into whole squares with the side `square` and a remainder,
    /// without rounding.
    fn new(coordinate: f64, square: f64) -> Self {
        // The remainder operation of `f64` is exact, even with an infinite divisor. Differences of
        // numbers within a factor of two of each other are exact, too (Sterbenz). The result
        // therefore has no rounding error.
        let mut rest = coordinate % (2.0 * square);
        let whole = match rest.abs() {
            size if size < square * 0.5 => 0,
            size if size <= square * 1.5 => 1,
            _ => 2,
        };
        for _ in 0..whole {
            rest -= square.copysign(rest);
        }
        let odd = whole == 1;
        Self { rest, odd }
    }
}
