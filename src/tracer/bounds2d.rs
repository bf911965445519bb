//! Bounds of an object in the view plane, and of its inverse depth.
//!
//! In: an object. Out: its bounds in the view plane's coordinates X and Y, and the maximum of its
//! inverse depth. The quadtree is built from these bounds. A sphere is bounded by its tangents from
//! the eye, a triangle or a box by the extremes of its corners.
//!
//! The bounds are those of the object's convex hull, widened by far more than all rounding errors.
//! A ray outside of the bounds therefore misses the object in every precision.

use super::{
    camera::Camera, convex::Convex, cuboid, interval::Interval, local_form::Patch, object::Object,
    sphere::Sphere, triangle,
};
use crate::{
    math::{Ball3, Double, Radius, Real, UP},
    scene::Shape,
};

/// Bounds of an object as seen from the eye.
#[derive(Clone, Copy, Debug)]
pub struct Extent {
    /// Ranges of X and Y, the rightward and downward components of a ray's direction. A ray whose X
    /// or Y is outside of its range misses the object.
    pub across: [Interval; 2],
    /// Upper bound of the inverse depths of the object's points.
    pub nearest: f64,
}

/// Relative amount by which each computed bound of an object is widened: 2^−40. The bound's own
/// rounding errors are much smaller, about 2^−50 of its value. The widened bound is therefore
/// certainly not too tight.
const QUOTIENT_SLACK: f64 = 1.0 / (1u64 << 40) as f64;

/// Minimum absolute value of the numbers from which an object's bounds are computed, such as
/// lengths and products of two lengths. If a number is smaller, the object is treated as unbounded.
/// `f64` has its full relative precision of 2^−53 only above 1e-308, which is far below this
/// minimum.
const SMALLEST: f64 = 1e-280;

impl Object<f64> {
    /// Prepares an object, or only face number `face` of a box, for the tests against rays. Also
    /// returns the object's bounds as seen from the eye, or `None` if no ray of the camera can hit
    /// the object.
    pub fn with_extent(
        double: &Camera<Double>,
        fast: &Camera<f64>,
        shape: &Shape,
        face: Option<u8>,
    ) -> (Self, Option<Extent>) {
        let (object, corners) = if let Shape::Triangle(shape) = shape {
            // `triangle::prepare` also returns the corners, from which the triangle's bounds are
            // computed.
            let (triangle, corners) = triangle::prepare(double, shape).unzip();
            (
                Object::Convex(triangle.unwrap_or_else(Convex::nothing)),
                corners,
            )
        } else {
            (Object::new(double, shape, face), None)
        };
        let object = object.narrowed(&fast.window);
        let ahead = fast.window.z;
        let hull = match (&object, shape.cuboid(), corners) {
            // In an extremely wide view, the component Z (`ahead`) of all rays' directions is very
            // small. Products with it may underflow and lose digits, so the object is treated as
            // unbounded.
            _ if ahead < SMALLEST => Hull::Unbounded,
            (Self::Sphere(sphere), ..) => of_sphere(sphere, ahead),
            (_, Some(cuboid), _) => of_corners(&cuboid::corners(fast, cuboid), ahead),
            (_, None, Some(corners)) => of_corners(&corners, ahead),
            // A checkerboard is infinite and has no corners. If a triangle's plane contains the
            // eye, `triangle::prepare` returns no corners. The bounds of both are the whole view
            // plane; only their inverse depth is limited.
            (_, None, None) => Hull::Unbounded,
        };
        let extent = match hull {
            Hull::Behind => None,
            Hull::Ahead(extent) if extent.is_sound() => Some(extent),
            Hull::Ahead(_) | Hull::Unbounded => {
                object.cover(&Patch::window(fast)).map(|cover| Extent {
                    across: [Interval::ALL; 2],
                    nearest: cover.inverse_depth.or_all().high,
                })
            }
        };
        (object, extent)
    }
}

/// Position of a convex hull relative to the eye, and its bounds in the view plane.
enum Hull {
    /// All of the hull is behind the eye.
    Behind,
    /// All of the hull is in front of the eye.
    Ahead(Extent),
    /// The hull is on both sides of the eye, or infinite, or its numbers exceed the range of `f64`.
    Unbounded,
}

impl Extent {
    /// Returns whether the ends of each range are in ascending order and the inverse depth is not
    /// negative. Returns `false` if an overflow has left NaN.
    fn is_sound(&self) -> bool {
        self.across.iter().all(|range| range.low <= range.high) && self.nearest >= 0.0
    }
}

/// Returns the bounds of a sphere as the eye sees it, from the lines through the eye that touch it.
/// `ahead` is the component Z of all rays' directions.
fn of_sphere(sphere: &Sphere<f64>, ahead: f64) -> Hull {
    // In the plane of the X (or Y) axis and the Z axis, the sphere is a circle with the centre (c,
    // z) and the radius R. Two lines through the origin are tangent to it. Their slopes are
    //
    // (c·z ± R·√(c² + z² − R²))/(z² − R²).
    let Some(([x, y, z], radius)) = sphere.ball() else {
        return Hull::Unbounded;
    };
    if z + radius < 0.0 {
        return Hull::Behind;
    }
    // The difference z − R and the sum z + R of the centre's z and the radius R are rounded once
    // each, so their product has a small relative error. If the product is positive, its sum with
    // c² has a small relative error, too.
    let below = (z - radius) * (z + radius);
    if !(z > radius && below > SMALLEST) {
        return Hull::Unbounded;
    }
    let across = [x, y].map(|c| {
        let (middle, reach) = (c * z, radius * (c * c + below).sqrt());
        let slack = (middle.abs() + reach) * QUOTIENT_SLACK;
        Interval {
            low: (middle - reach - slack) / below * ahead,
            high: (middle + reach + slack) / below * ahead,
        }
    });
    Hull::Ahead(Extent {
        across,
        nearest: ahead / (z - radius) * (1.0 + QUOTIENT_SLACK) * sphere.scale(),
    })
}

/// Returns the bounds of a convex hull as the eye sees it, from its corners relative to the eye.
/// The quotients x/z and y/z of the hull's points lie between those of the corners. `ahead` is the
/// component Z of all rays' directions.
fn of_corners<T: Real>(corners: &[Ball3<T>], ahead: f64) -> Hull {
    let mut across = [Interval {
        low: f64::INFINITY,
        high: f64::NEG_INFINITY,
    }; 2];
    let (mut least, mut greatest) = (f64::INFINITY, f64::NEG_INFINITY);
    for corner in corners {
        let [x, y, z] = corner.each_ref().map(|ball| {
            let middle = ball.mid.to_f64();
            Interval::about(
                middle,
                ball.rad.to_f64() * UP + middle.abs() * QUOTIENT_SLACK,
            )
        });
        // NaN is excluded here, because `f64::min` and `f64::max` below would ignore it.
        let is_finite = |range: &Interval| range.low.is_finite() && range.high.is_finite();
        if ![x, y, z].iter().all(is_finite) {
            return Hull::Unbounded;
        }
        least = least.min(z.low);
        greatest = greatest.max(z.high);
        for (range, at) in across.iter_mut().zip([x, y]) {
            let low = at.low / if at.low < 0.0 { z.low } else { z.high };
            let high = at.high / if at.high < 0.0 { z.high } else { z.low };
            range.low = range.low.min(low - low.abs() * QUOTIENT_SLACK);
            range.high = range.high.max(high + high.abs() * QUOTIENT_SLACK);
        }
    }
    if greatest < 0.0 {
        return Hull::Behind;
    }
    // NaN, which an overflow may have left, also makes the condition true.
    if !(least > SMALLEST && greatest >= least) {
        return Hull::Unbounded;
    }
    Hull::Ahead(Extent {
        across: across.map(|range| range.times_power(ahead)),
        nearest: ahead / least * (1.0 + QUOTIENT_SLACK),
    })
}
