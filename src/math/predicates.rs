//! Exact predicates on the numbers of a scene.

use std::cmp::Ordering;

use glam::DVec3;

use super::{Dyadic, Dyadic3, two_sum};

/// A plane in space.
#[derive(Clone, Debug)]
pub enum Plane {
    /// A plane perpendicular to the x, y or z axis.
    Axial {
        /// The axis: 0, 1 or 2.
        axis: usize,
        /// The coordinate along the axis that all points of the plane share.
        at: f64,
    },
    /// A plane given by a point and a normal.
    Tilted {
        /// A normal of the plane, of any length except 0.
        normal: Dyadic3,
        /// A point of the plane.
        point: DVec3,
    },
}

impl Plane {
    /// Returns the plane through `point` that is perpendicular to `normal`.
    pub fn across(normal: DVec3, point: DVec3) -> Self {
        let normal = Dyadic::vector(normal);
        Self::Tilted { normal, point }
    }

    /// Returns the plane through three points.
    pub fn through([a, b, c]: [DVec3; 3]) -> Self {
        let normal = Dyadic::cross(&Dyadic::between(a, b), &Dyadic::between(a, c));
        Self::Tilted { normal, point: a }
    }

    /// Returns whether two planes are exactly equal: their normals are parallel, and the vector
    /// between their points is perpendicular to both normals.
    pub fn equals(&self, other: &Self) -> bool {
        // Axial planes are compared first, because this is fast. Many samples need this comparison
        // if a box stands on a floor, or if boxes stand side by side.
        if let (Self::Axial { axis: a, at: p }, Self::Axial { axis: b, at: q }) = (self, other) {
            return a == b && p == q;
        }
        let ((a, p), (b, q)) = (self.normal_and_point(), other.normal_and_point());
        Dyadic::is_zero(&Dyadic::cross(&a, &b))
            && Dyadic::dot(&a, &Dyadic::between(p, q)).sign().is_eq()
    }

    fn normal_and_point(&self) -> (Dyadic3, DVec3) {
        match self {
            Self::Axial { axis, at } => {
                let axis = DVec3::AXES[*axis];
                (Dyadic::vector(axis), axis * *at)
            }
            Self::Tilted { normal, point } => (normal.clone(), *point),
        }
    }
}

/// Returns whether `up` is exactly parallel to `to` − `from`: their cross product is zero.
pub fn cross_is_zero(up: DVec3, from: DVec3, to: DVec3) -> bool {
    Dyadic::is_zero(&Dyadic::cross(
        &Dyadic::vector(up),
        &Dyadic::between(from, to),
    ))
}

/// Returns the exact sign of the dot product of `up` and `to` − `from`.
pub fn dot_sign(up: DVec3, from: DVec3, to: DVec3) -> Ordering {
    Dyadic::dot(&Dyadic::vector(up), &Dyadic::between(from, to)).sign()
}

/// Returns whether three points lie exactly on one line.
pub fn are_on_one_line([a, b, c]: [DVec3; 3]) -> bool {
    Dyadic::is_zero(&Dyadic::cross(
        &Dyadic::between(a, b),
        &Dyadic::between(a, c),
    ))
}

/// Returns whether three lengths are the sides of a triangle: each is less than the exact sum of
/// the two other lengths.
pub fn forms_triangle([a, b, c]: [f64; 3]) -> bool {
    exceeds(b, c, a) && exceeds(c, a, b) && exceeds(a, b, c)
}

/// Returns whether the exact sum of `one` and `other` exceeds `bound`. All three are positive.
fn exceeds(one: f64, other: f64, bound: f64) -> bool {
    let sum = one + other;
    if sum != bound {
        // Rounding is monotonic. So if the rounded sum is not equal to `bound`, it lies on the same
        // side of `bound` as the exact sum.
        return sum > bound;
    }
    let error = two_sum(one, other).lo;
    error > 0.0
}

/// Returns the corners `center` − `size`/2 and `center` + `size`/2 of a box, each coordinate
/// rounded once.
pub fn box_corners(center: DVec3, size: DVec3) -> (DVec3, DVec3) {
    let corner = |sign: f64| {
        [0, 1, 2]
            .map(|i| offset_by_half(center[i], sign * size[i]))
            .into()
    };
    (corner(-1.0), corner(1.0))
}

/// Returns `a` + `b`/2, rounded once. Computes (2a + b)/2, because half of a subnormal b may need
/// rounding. Only one of the two steps rounds: if the sum 2a + b needs rounding, it is not
/// subnormal, and halving it is exact. If the sum overflows, computes a + b/2 instead. In this
/// case, either b is so large that b/2 is exact, or b is too small to change a.
fn offset_by_half(a: f64, b: f64) -> f64 {
    let twice = 2.0 * a + b;
    if twice.is_finite() {
        twice / 2.0
    } else {
        a + b / 2.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parallel_is_not_nearly_parallel() {
        let eye = DVec3::new(0.1, 0.2, 0.3);
        let down = DVec3::new(0.1, -7.0, 0.3);
        assert!(cross_is_zero(DVec3::Y, eye, down));
        let beside = DVec3::new(0.1, -7.0, 0.3_f64.next_up());
        assert!(!cross_is_zero(DVec3::Y, eye, beside));
        // The vector leads from a near point to a very far one. The difference of the points must
        // not be rounded. In `f64`, 1e30 − 0.1 and 1e30 − 0.2 are both 1e30, so the vector between
        // the points would wrongly be parallel to (1, 1, 1).
        let far = DVec3::new(1e30, 1e30, 1e30);
        let near = DVec3::new(0.1, 0.1, 0.2);
        assert!(!cross_is_zero(DVec3::ONE, near, far));
        assert!(cross_is_zero(DVec3::ONE, DVec3::splat(0.1), far));
        assert_eq!(dot_sign(DVec3::Y, eye, down), Ordering::Less);
    }

    #[test]
    fn planes_are_one_or_not_to_the_last_bit() {
        let plane = |normal: [f64; 3], point: [f64; 3]| Plane::across(normal.into(), point.into());
        // The plane is x + 2y + 3z = 5.25, given by two of its points. The coordinates of the point
        // `far` are up to 10^16, but the term 5.25 must not be lost beside them.
        let normal = [1.0, 2.0, 3.0];
        let near = plane(normal, [0.0, 0.0, 1.75]);
        let far = [1e16, -5e15, 1.75];
        assert!(near.equals(&plane(normal, far)));
        assert!(near.equals(&plane([-3.0, -6.0, -9.0], far)));
        let [long, short] = [600, -600].map(|exponent| normal.map(|x| libm::ldexp(x, exponent)));
        assert!(near.equals(&plane(long, far)) && plane(short, far).equals(&near));
        let axial = Plane::Axial { axis: 2, at: 1.75 };
        assert!(axial.equals(&axial) && axial.equals(&plane([0.0, 0.0, -3.0], far)));
        assert!(!axial.equals(&Plane::Axial { axis: 1, at: 1.75 }) && !axial.equals(&near));
        let beside = [1e16, -5e15, 1.75_f64.next_up()];
        assert!(!near.equals(&plane(normal, beside)));
        let tilted = [1.0, 2.0_f64.next_up(), 3.0];
        assert!(!near.equals(&plane(tilted, [0.0, 0.0, 1.75])));
        // In `f64`, 0.3 is not exactly three times 0.1, so that this normal is not exactly parallel
        // to (1, 2, 3).
        assert!(!near.equals(&plane([0.1, 0.2, 0.3], far)));
    }

    #[test]
    fn sides_of_triangles() {
        // In the fourth case, the sum of two sides is slightly greater than the third side but
        // rounds to it. In the fifth, the sum is rounded up to the third side.
        let little = f64::EPSILON / 4.0;
        for (sides, is_triangle) in [
            ([2.0, 2.0, 1.0], true),
            ([1.0, 2.0, 3.0], false),
            ([1.0, 2.0, 3.0_f64.next_down()], true),
            ([1.0, little, 1.0], true),
            ([0.1, 0.2, 0.1 + 0.2], false),
            ([f64::MAX; 3], true),
        ] {
            assert_eq!(forms_triangle(sides), is_triangle, "{sides:?}");
        }
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
