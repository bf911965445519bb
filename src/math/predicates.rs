//! Questions that are answered without rounding.
//!
//! An f64 is a whole number times a power of two, so sums and products of f64s can be had as whole numbers of any length.
//! That is slow, some microseconds, and for what is asked seldom: once for a scene, or where no precision tells two surfaces apart.

use std::cmp::Ordering;

use dashu_int::IBig;
use glam::DVec3;

use super::{Double, two_product, two_sum};

/// The plane through a point across a normal, which has any length but 0.
#[derive(Clone, Copy, Debug)]
pub struct Plane {
    /// A vector across it.
    pub normal: DVec3,
    /// A point of it.
    pub point: DVec3,
}

impl Plane {
    /// The plane through three points, if its normal can be had in `f64` without rounding, as it can of points that people write.
    pub fn through([a, b, c]: [DVec3; 3]) -> Option<Self> {
        // Of other numbers products might lose what is below the least f64.
        let is_tame = |x: f64| x == 0.0 || (1e-120..=1e120).contains(&x.abs());
        let mut numbers = [a, b, c].into_iter().flat_map(|point| point.to_array());
        if !numbers.all(is_tame) {
            return None;
        }
        let is_exact = |number: Double| (number.lo == 0.0).then_some(number.hi);
        let difference = |x: f64, y: f64| is_exact(two_sum(x, -y));
        let along = |to: DVec3| {
            let [x, y, z] = [0, 1, 2].map(|axis| difference(to[axis], a[axis]));
            Some([x?, y?, z?])
        };
        let (one, other) = (along(b)?, along(c)?);
        let part = |i: usize, j: usize| {
            let product = |i: usize, j: usize| is_exact(two_product(one[i], other[j]));
            difference(product(i, j)?, product(j, i)?)
        };
        Some(Self {
            normal: DVec3::new(part(1, 2)?, part(2, 0)?, part(0, 1)?),
            point: a,
        })
    }

    /// Whether it is the same plane as another: their normals are parallel, and the points' difference lies across these.
    pub fn equals(&self, other: &Self) -> bool {
        cross_is_zero(self.normal, DVec3::ZERO, other.normal)
            && dot_sign(self.normal, self.point, other.point).is_eq()
    }
}

/// Whether the cross product of `up` with `to − from` is zero, the difference being taken exactly.
pub fn cross_is_zero(up: DVec3, from: DVec3, to: DVec3) -> bool {
    let up = up.to_array().map(whole);
    let [fx, fy, fz] = from.to_array().map(whole);
    let [tx, ty, tz] = to.to_array().map(whole);
    let along = [tx - fx, ty - fy, tz - fz];
    let [ux, uy, uz] = &up;
    let [ax, ay, az] = &along;
    uy * az == uz * ay && uz * ax == ux * az && ux * ay == uy * ax
}

/// Whether three points lie on one line.
pub fn are_on_one_line(points: [DVec3; 3]) -> bool {
    let [a, b, c] = points.map(|point| point.to_array().map(whole));
    let along = |to: &[IBig; 3]| [0, 1, 2].map(|axis| &to[axis] - &a[axis]);
    let ([ax, ay, az], [bx, by, bz]) = (along(&b), along(&c));
    &ay * &bz == &az * &by && &az * &bx == &ax * &bz && &ax * &by == &ay * &bx
}

/// The sign of the exact dot product of `up` with `to − from`.
pub fn dot_sign(up: DVec3, from: DVec3, to: DVec3) -> Ordering {
    let [ux, uy, uz] = up.to_array().map(whole);
    let [fx, fy, fz] = from.to_array().map(whole);
    let [tx, ty, tz] = to.to_array().map(whole);
    let dot = ux * (tx - fx) + uy * (ty - fy) + uz * (tz - fz);
    dot.cmp(&IBig::ZERO)
}

/// Whether three lengths are the sides of a triangle: each is less than the two others together.
pub fn forms_triangle([a, b, c]: [f64; 3]) -> bool {
    let less = |side, one, other| exceeds(one, other, side);
    less(a, b, c) && less(b, c, a) && less(c, a, b)
}

/// Whether the exact sum of two positive numbers is more than a third one.
fn exceeds(one: f64, other: f64, bound: f64) -> bool {
    let sum = one + other;
    if sum != bound {
        // Rounding keeps order: the exact sum lies on the same side.
        return sum > bound;
    }
    let error = two_sum(one, other).lo;
    error > 0.0
}

/// `center − size/2` and `center + size/2`, each rounded once.
pub fn box_corners(center: DVec3, size: DVec3) -> (DVec3, DVec3) {
    let corner = |sign: f64| {
        let axis = |center: f64, size: f64| offset_by_half(center, sign * size);
        DVec3::new(
            axis(center.x, size.x),
            axis(center.y, size.y),
            axis(center.z, size.z),
        )
    };
    (corner(-1.0), corner(1.0))
}

/// `a + b/2`, rounded once. Half of the smallest numbers is not an f64, so it is (2a + b)/2: if the sum is rounded, it is no
/// subnormal number, and halving it is exact. Where 2a is too large, b/2 is exact or too small to matter.
fn offset_by_half(a: f64, b: f64) -> f64 {
    let twice = 2.0 * a + b;
    if twice.is_finite() {
        twice / 2.0
    } else {
        a + b / 2.0
    }
}

/// A number as a multiple of the least f64, 2^−1074.
fn whole(number: f64) -> IBig {
    let bits = number.to_bits();
    let exponent = (bits >> 52) & 0x7ff;
    let fraction = bits & ((1 << 52) - 1);
    let magnitude = match exponent {
        0 => IBig::from(fraction),
        _ => IBig::from(fraction | (1 << 52)) << (exponent - 1) as usize,
    };
    if number.is_sign_negative() {
        -magnitude
    } else {
        magnitude
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_numbers() {
        assert_eq!(whole(f64::from_bits(1)), IBig::ONE);
        assert_eq!(whole(f64::MIN_POSITIVE), IBig::ONE << 52);
        assert_eq!(whole(-1.0), -(IBig::ONE << 1074));
        assert_eq!(whole(0.0), IBig::ZERO);
    }

    #[test]
    fn parallel_is_not_nearly_parallel() {
        let eye = DVec3::new(0.1, 0.2, 0.3);
        let down = DVec3::new(0.1, -7.0, 0.3);
        assert!(cross_is_zero(DVec3::Y, eye, down));
        let beside = DVec3::new(0.1, -7.0, 0.3_f64.next_up());
        assert!(!cross_is_zero(DVec3::Y, eye, beside));
        // 0.1 + 1e30 rounds to 1e30: the difference must not be rounded.
        let far = DVec3::new(1e30, 1e30, 1e30);
        let near = DVec3::new(0.1, 0.1, 0.2);
        assert!(!cross_is_zero(DVec3::ONE, near, far));
        assert!(cross_is_zero(DVec3::ONE, DVec3::splat(0.1), far));
        assert_eq!(dot_sign(DVec3::Y, eye, down), Ordering::Less);
    }

    #[test]
    fn planes_are_one_or_not_to_the_last_bit() {
        let plane = |normal: [f64; 3], point: [f64; 3]| Plane {
            normal: normal.into(),
            point: point.into(),
        };
        // x + 2y + 3z = 5.25, and what is small beside 10^16 is not lost.
        let normal = [1.0, 2.0, 3.0];
        let near = plane(normal, [0.0, 0.0, 1.75]);
        let far = [1e16, -5e15, 1.75];
        assert!(near.equals(&plane(normal, far)));
        assert!(near.equals(&plane([-3.0, -6.0, -9.0], far)));
        let [long, short] = [600, -600].map(|exponent| normal.map(|x| libm::ldexp(x, exponent)));
        assert!(near.equals(&plane(long, far)) && plane(short, far).equals(&near));
        let beside = [1e16, -5e15, 1.75_f64.next_up()];
        assert!(!near.equals(&plane(normal, beside)));
        let tilted = [1.0, 2.0_f64.next_up(), 3.0];
        assert!(!near.equals(&plane(tilted, [0.0, 0.0, 1.75])));
        // A tenth, two and three of them are rounded each in its own way.
        assert!(!near.equals(&plane([0.1, 0.2, 0.3], far)));
    }

    #[test]
    fn triangles() {
        assert!(forms_triangle([2.0, 2.0, 1.0]));
        assert!(!forms_triangle([1.0, 2.0, 3.0]));
        assert!(forms_triangle([1.0, 2.0, 3.0_f64.next_down()]));
        // The sum rounds to the third side, and is a little more.
        let little = f64::EPSILON / 4.0;
        assert!(forms_triangle([1.0, little, 1.0]));
        assert!(
            !forms_triangle([0.1, 0.2, 0.1 + 0.2]),
            "the sum was rounded up"
        );
        assert!(forms_triangle([f64::MAX; 3]));
    }

    #[test]
    fn corners_are_rounded_once() {
        let least = f64::from_bits(1);
        assert_eq!(offset_by_half(least, least), 2.0 * least);
        assert_eq!(offset_by_half(2.0 * least, least), 2.0 * least);
        assert_eq!(offset_by_half(f64::MAX, -f64::MAX), f64::MAX / 2.0);
        assert_eq!(offset_by_half(0.75, -1.5), 0.0);
    }
}
