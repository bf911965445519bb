//! The camera: from a sample point to a ray's direction.
//!
//! All rays start at the eye, so the tracer works in the camera's own axes: right (u), down (−v)
//! and ahead (−w). In these axes a ray's direction is r = (X, Y, Z), where X and Y are proportional
//! to the distance in pixels from the picture's centre. Z is 1, except in the widest views, where a
//! power of two keeps X and Y within [−1, 1]. A point at λr has the depth λZ.

use glam::{DVec2, DVec3};

use crate::{
    area::Area,
    math::{Ball, Ball3, Big, Dyadic, Dyadic3, Radius, Real, UP},
    scene::{self, Image, Lens, Scene, View, pixel_size},
};

/// The axes and the scale of a scene's camera, computed exactly from the scene's numbers and
/// rounded only at the end.
#[derive(Clone, Debug)]
pub struct Basis {
    /// Unit vector to the picture's right.
    pub u: [Big; 3],
    /// Unit vector to the picture's top.
    pub v: [Big; 3],
    /// Unit vector opposite to the view direction.
    pub w: [Big; 3],
    /// Side of a pixel at depth 1: view_height/(height · d). The view plane is `view_height` high
    /// and has the distance d from the eye; the picture is `height` pixels high.
    pub pitch: Big,
    /// Distance from the eye to the view plane, in metres.
    pub d: Big,
    /// Exact sign of the y coordinate of the view direction: `Greater` if the camera looks up.
    pub looks: std::cmp::Ordering,
}

/// Returns v/|v|, each component accurate to the last bits of a [`Big`].
fn normalized(v: &Dyadic3) -> [Big; 3] {
    let length = Dyadic::dot(v, v).to_big().sqrt();
    v.each_ref().map(|x| x.to_big().over(&length))
}

/// Returns a + b, or 0 if the sum's absolute value is at most the errors of a and b, four roundings
/// each. The rotation of the camera's axes u and v by the roll uses this sum. With a roll of 45
/// degrees, for example, a and b may be opposite numbers, whose sum must be exactly 0.
fn sum(a: &Big, b: &Big) -> Big {
    let sum = a.plus(b);
    let lost = (a.magnitude() + b.magnitude()) * (8.0 * Big::UNIT);
    if sum.magnitude() <= lost {
        return Big::from_f64(0.0);
    }
    sum
}

/// Returns the view direction: lookat − eye, or the direction that the scene gives.
fn view_direction(camera: &scene::Camera) -> Dyadic3 {
    match camera.view {
        View::Lookat(lookat) => Dyadic::between(camera.eye, lookat),
        View::Direction(direction) => Dyadic::vector(direction),
    }
}

impl Basis {
    /// Computes the basis of a camera with the view direction f: w = −f/|f|, u = (up × w)/|up × w|,
    /// v = w × u. Then u and v are turned by the roll.
    ///
    /// The numerators of these quotients are exact, so u is accurate to the last bits even if up
    /// and f are almost parallel. If up and f are parallel, u = (h × up)/|h × up|, where h is the
    /// [level direction](scene::level_direction). This is the u of a camera that looks along h and
    /// has the same up.
    pub fn new(camera: &scene::Camera, image: &Image) -> Self {
        let forward = view_direction(camera);
        let up = Dyadic::vector(camera.up);
        let backward = forward.each_ref().map(|x| &Dyadic::new(0.0) - x);
        let mut right = Dyadic::cross(&up, &backward);
        if Dyadic::is_zero(&right) {
            right = Dyadic::cross(&Dyadic::vector(scene::level_direction(camera.up)), &up);
        }
        let top = Dyadic::cross(&backward, &right);

        let (u, v, w) = (normalized(&right), normalized(&top), normalized(&backward));
        let (sin, cos) = Big::sin_cos(camera.roll);
        let turned = |a: &Big, b: &Big| {
            (
                sum(&cos.times(a), &sin.times(b).negated()),
                sum(&sin.times(a), &cos.times(b)),
            )
        };
        let turned = [0, 1, 2].map(|i| turned(&u[i], &v[i]));

        let pitch = pixel_size(camera, image, Big::tan_half);
        let d = match camera.lens {
            Lens::Distance(d) => Big::from_f64(d),
            Lens::Fov(_) | Lens::HorizontalFov(_) => Big::from_f64(camera.view_height)
                .over(&Big::from_f64(image.height.into()).times(&pitch)),
        };
        Self {
            u: turned.each_ref().map(|(u, _)| u.clone()),
            v: turned.each_ref().map(|(_, v)| v.clone()),
            w,
            pitch,
            d,
            looks: forward[1].sign(),
        }
    }
}

/// Bounds on the [`Direction`]s of rays through sample points.
#[derive(Clone, Copy, Debug)]
pub struct Window<R> {
    /// Maximum of |X|, where X is the rightward component of a ray's direction.
    pub x: R,
    /// Maximum of |Y|, where Y is the downward component of a ray's direction.
    pub y: R,
    /// The forward component Z of a ray's direction, which is the same for all rays.
    pub z: R,
}

impl<R: Copy> Window<R> {
    /// Returns the bounds of the components of a ray's direction: of |X|, |Y| and Z, in this order.
    pub fn sizes(&self) -> [R; 3] {
        [self.x, self.y, self.z]
    }
}

/// The camera of a picture, with its numbers in the precision `T`.
#[derive(Clone, Debug)]
pub struct Camera<T: Real> {
    /// Position of the eye, in world coordinates.
    pub eye: DVec3,
    /// Binary logarithm of the factor by which lengths of the world are multiplied. The factor
    /// keeps the lengths of very large and very small worlds within the range of `f64`. For other
    /// worlds, it is 1 and its logarithm is 0.
    pub exponent: i32,
    /// Unit vectors to the right, down and ahead, in world coordinates.
    pub axes: [Ball3<T>; 3],
    /// Distance between the centres of neighbouring pixels, measured in X or Y, the first two
    /// components of a [`Direction`].
    pub pitch: T,
    /// Component Z of all [`Direction`]s.
    pub z: T,
    /// Half the picture's width and height, in pixels.
    pub half: DVec2,
    /// Bounds on the [`Direction`]s of rays through sample points.
    pub window: Window<T::Radius>,
}

/// A ray's direction (X, Y, Z) in the camera's axes, and its squared length. The relative errors of
/// X and Y are at most 5 · [`UNIT`](Real::UNIT), i.e. five times the error of one operation.
#[derive(Clone, Debug)]
pub struct Direction<T> {
    /// Component X of the direction, to the right.
    pub x: T,
    /// Component Y of the direction, downwards.
    pub y: T,
    /// Component Z of the direction, ahead.
    pub z: T,
    /// Squared length of the direction, X² + Y² + Z².
    pub square: T,
}

/// A point of the picture, in pixels from its centre, x to the right and y down. Each coordinate is
/// stored as the exact sum of two numbers, because a pixel's centre plus an offset may have too
/// many digits for one `f64`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PicturePoint {
    /// The coordinate x, as two summands.
    pub x: (f64, f64),
    /// The coordinate y, as two summands.
    pub y: (f64, f64),
}

impl<T: Real> Camera<T> {
    /// Prepares the camera of a scene. `reach` is the maximum distance of sample points from the
    /// picture's centre in x and in y, in pixels.
    pub fn new(basis: &Basis, scene: &Scene, reach: DVec2) -> Self {
        let (eye, image) = (scene.camera.eye, scene.image);
        let widest = basis.pitch.times(&Big::from_f64(reach.max_element()));
        // A wide view is scaled by a power of two that makes the greatest X or Y at most 1.
        let exponent = widest.magnitude().exponent();
        let exponent = if widest.to_f64() <= 1.0 { 0 } else { exponent };
        let pitch = basis.pitch.scaled(-exponent);
        let z = Big::from_f64(1.0).scaled(-exponent);
        let extent = |pixels: f64| {
            let extent = T::from_big(&pitch.times(&Big::from_f64(pixels)));
            extent.magnitude() * UP + T::TINY
        };
        let axis = |v: &[Big; 3]| v.each_ref().map(Ball::from_big);
        Self {
            eye,
            exponent: exponent_of_lengths(scene),
            axes: [
                axis(&basis.u),
                axis(&basis.v.each_ref().map(Real::negated)),
                axis(&basis.w.each_ref().map(Real::negated)),
            ],
            window: Window {
                x: extent(reach.x),
                y: extent(reach.y),
                z: T::from_big(&z).magnitude() + T::TINY,
            },
            pitch: T::from_big(&pitch),
            z: T::from_big(&z),
            half: DVec2::new(f64::from(image.width), f64::from(image.height)) / 2.0,
        }
    }

    /// Returns the point at an offset, in pixels, from the centre of the pixel in column `x` and
    /// row `y`.
    #[inline]
    pub fn sample_point(&self, x: u32, y: u32, offset: DVec2) -> PicturePoint {
        // The coordinates of pixel centres are multiples of 1/2 below 2^21, which `f64` represents
        // exactly.
        PicturePoint {
            x: (f64::from(x) + 0.5 - self.half.x, offset.x),
            y: (f64::from(y) + 0.5 - self.half.y, offset.y),
        }
    }

    /// Returns the centre of an area of pixels.
    pub fn middle(&self, area: Area) -> PicturePoint {
        let middle = |start: u32, length: u32| f64::from(start) + 0.5 * f64::from(length);
        self.picture_point(DVec2::new(
            middle(area.x, area.width),
            middle(area.y, area.height),
        ))
    }

    /// Converts a point from pixels relative to the picture's top left corner to pixels relative to
    /// its centre. In `pixels`, x is to the right and y down.
    pub fn picture_point(&self, pixels: DVec2) -> PicturePoint {
        PicturePoint {
            x: (pixels.x, -self.half.x),
            y: (pixels.y, -self.half.y),
        }
    }

    /// Returns the direction of the ray through a point of the picture.
    #[inline]
    pub fn direction(&self, point: &PicturePoint) -> Direction<T> {
        let coordinate = |(a, b): (f64, f64)| T::difference(a, -b).times(&self.pitch);
        let (x, y) = (coordinate(point.x), coordinate(point.y));
        let square = x.times(&x).plus(&y.times(&y)).plus(&self.z.times(&self.z));
        Direction {
            x,
            y,
            z: self.z.clone(),
            square,
        }
    }

    /// Rotates a vector from world coordinates into the camera's axes.
    pub fn turned(&self, v: &Ball3<T>) -> Ball3<T> {
        self.axes.each_ref().map(|axis| crate::math::dot(axis, v))
    }

    /// Returns point − eye along the axes of the world, multiplied by 2 to the power
    /// [`exponent`](Camera::exponent). The difference is computed without cancellation error.
    pub fn relative(&self, point: DVec3) -> Ball3<T> {
        [0, 1, 2].map(|axis| self.relative_coordinate(axis, point[axis]))
    }

    /// Returns one world coordinate of point − eye, multiplied by 2 to the power
    /// [`exponent`](Camera::exponent). `axis` is 0 for x, 1 for y and 2 for z; `at` is the point's
    /// coordinate.
    pub fn relative_coordinate(&self, axis: usize, at: f64) -> Ball<T> {
        Ball::difference(at, self.eye[axis]).scaled(self.exponent)
    }

    /// Returns a length of the world multiplied by 2 to the power [`exponent`](Camera::exponent).
    pub fn length(&self, length: f64) -> Ball<T> {
        Ball::exact(length).scaled(self.exponent)
    }
}

/// Range of the binary exponent of the greatest length in a scene. If the exponent is outside of
/// the range, all lengths are multiplied by a power of two. The squares of lengths from 2^−500 to
/// 2^400 are between 2^−1000 and 2^800, and so within the range of `f64`, 2^−1022 to 2^1024. The
/// lower end of the range is −300 rather than −500, so that the scene may also contain lengths that
/// are 2^200 times shorter than the greatest.
const LENGTHS: std::ops::RangeInclusive<i32> = -300..=400;

/// Returns the binary logarithm of the factor by which all lengths of a scene are multiplied. The
/// factor is 1 if the binary exponent of the greatest length is within [`LENGTHS`]. Otherwise, the
/// factor moves this exponent into that range.
fn exponent_of_lengths(scene: &Scene) -> i32 {
    let shapes = scene.objects.iter().map(|object| &object.shape);
    let farthest = shapes.map(|shape| shape.greatest_length(scene.camera.eye));
    match Radius::exponent(farthest.fold(0.0, f64::max)) {
        exponent if LENGTHS.contains(&exponent) => 0,
        exponent if exponent > 0 => LENGTHS.end() - exponent,
        exponent => -exponent,
    }
}
