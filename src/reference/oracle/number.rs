//! The numbers, vectors, angles and triangles of the oracle, a tracer of very high precision.

use std::cmp::Ordering;

use dashu_float::{FBig, ops::Abs, round::mode::HalfEven};
use glam::DVec3;

use crate::{math::Angle, scene::CenteredTriangle};

/// A binary floating-point number with the precision of the oracle, a tracer that computes with 512
/// to 3000 bits.
pub type N = FBig<HalfEven, 2>;

/// A vector in world coordinates, of high-precision numbers.
pub type V = [N; 3];

/// Arithmetic with a fixed number of bits.
#[derive(Clone, Copy, Debug)]
pub struct Number {
    /// Number of bits of every result.
    pub bits: usize,
}

impl Number {
    /// Converts a number of a scene exactly. The number must be finite.
    pub fn exact(self, x: f64) -> N {
        debug_assert!(x.is_finite());
        let x = N::try_from(x).unwrap_or(N::ZERO);
        x.with_precision(self.bits).value()
    }

    /// Converts a vector of a scene.
    pub fn vector(self, v: DVec3) -> V {
        v.to_array().map(|x| self.exact(x))
    }

    /// Returns the sign of `x`, a sum whose terms have the size `size`. The sign is zero if |`x`|
    /// is at most 2^(−5/14 · `bits`) times `size`, because rounding errors may be the only reason
    /// for such a small number.
    pub fn sign(self, x: &N, size: &N) -> Ordering {
        if abs(x) <= size.clone() >> (self.bits as isize * 5 / 14) {
            Ordering::Equal
        } else {
            x.cmp(&N::ZERO)
        }
    }

    /// Returns the sine and the cosine of an angle, which has a part in degrees and a part in
    /// radians.
    pub fn sin_cos(self, angle: Angle) -> (N, N) {
        let (s, c) = self.exact(angle.degrees).sin_cos_unit(360);
        if angle.radians == 0.0 {
            return (s, c);
        }
        let (t, d) = self.exact(angle.radians).sin_cos();
        (&s * &d + &c * &t, c * d - s * t)
    }

    /// Returns the vertices of a triangle: the left end of the base, the right end, and the apex.
    pub fn vertices(self, triangle: &CenteredTriangle) -> [V; 3] {
        let CenteredTriangle {
            centroid, normal, ..
        } = *triangle;
        let n = |x| self.exact(x);
        let unit_normal = unit(&self.vector(normal));
        let reference = if normal.x == 0.0 && normal.z == 0.0 {
            DVec3::NEG_Z
        } else {
            DVec3::Y
        };
        let right = unit(&cross(&self.vector(reference), &unit_normal));
        let top = cross(&unit_normal, &right);
        // The law of cosines gives the angle at the left end of the base. The vertices are then
        // rotated about the centroid.
        let [a, b, c] = triangle.sides.to_array().map(n);
        let cos = (&a * &a + &c * &c - &b * &b) / (n(2.0) * &a * &c);
        let sin = (n(1.0) - &cos * &cos).sqrt();
        let apex = (&a * cos, &a * sin);
        let (mean_x, mean_y) = ((&c + &apex.0) / n(3.0), &apex.1 / n(3.0));
        let corners = [(n(0.0), n(0.0)), (c, n(0.0)), apex];
        let (s, k) = self.sin_cos(triangle.spin);
        corners.map(|(x, y)| {
            let (x, y) = (x - &mean_x, y - &mean_y);
            let turned = (&k * &x - &s * &y, &s * &x + &k * &y);
            let centroid = self.vector(centroid);
            axpy(&axpy(&centroid, &turned.0, &right), &turned.1, &top)
        })
    }
}

/// Computes `a` − `b`.
pub fn sub(a: &V, b: &V) -> V {
    [0, 1, 2].map(|i| &a[i] - &b[i])
}

/// Computes `a` + `k`·`b`.
pub fn axpy(a: &V, k: &N, b: &V) -> V {
    [0, 1, 2].map(|i| &a[i] + k * &b[i])
}

/// Computes `k`·`a`.
pub fn scale(k: &N, a: &V) -> V {
    [0, 1, 2].map(|i| k * &a[i])
}

/// Computes the dot product of `a` and `b`.
pub fn dot(a: &V, b: &V) -> N {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

/// Computes the cross product `a` × `b`.
pub fn cross(a: &V, b: &V) -> V {
    [
        &a[1] * &b[2] - &a[2] * &b[1],
        &a[2] * &b[0] - &a[0] * &b[2],
        &a[0] * &b[1] - &a[1] * &b[0],
    ]
}

/// Returns the length of a vector.
pub fn length(a: &V) -> N {
    dot(a, a).sqrt()
}

/// Returns the sum of the absolute values of a vector's components, an upper bound of the vector's
/// length. [`Number::sign`] treats numbers that are tiny compared with this sum as 0.
pub fn size(a: &V) -> N {
    abs(&a[0]) + abs(&a[1]) + abs(&a[2])
}

/// Computes the unit vector `a`/|`a`|.
pub fn unit(a: &V) -> V {
    let length = length(a);
    [0, 1, 2].map(|i| &a[i] / &length)
}

/// Computes the absolute value of `x`.
pub fn abs(x: &N) -> N {
    x.clone().abs()
}
