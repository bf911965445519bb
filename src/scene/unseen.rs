//! Determines whether the camera sees any object, and whether samples can tell the squares of a
//! checkerboard apart. Warnings depend on the results.
//!
//! In: a camera and the objects. Out: the reason why no object is in the picture, if bounding
//! spheres show it; and whether a board's squares are too small for the precision of a sample's
//! coordinates. An object is treated as visible if the answer is uncertain, or if another object
//! hides it, so a warning is never false. Computations are in `f64`. Each comparison of lengths
//! leaves a margin for rounding errors, which is [`MARGIN`] times the lengths.

use glam::DVec3;

use super::{
    model::{Camera, Image, Object, pixel_size},
    shape::{Checkerboard, Shape},
};
use crate::{
    math::{Angle, Big, trig},
    schema::CAMERA,
};

/// Margin of a comparison, relative to the lengths that are compared. The margin must exceed all
/// rounding errors. The greatest of them is the relative error of the camera's axes, which is at
/// most 2^−52/`LEAST_SINE`, about 2·10⁻¹⁰. With a larger margin, objects just outside of the
/// picture would not be recognised as invisible.
const MARGIN: f64 = 1e-8;

/// Minimum sine of the angle between up and the view direction for which visibility is judged. If
/// it is less, the rounding error of the camera's axes may exceed [`MARGIN`]. With a larger
/// minimum, fewer cameras would be checked.
pub const LEAST_SINE: f64 = 1e-6;

/// Reason why no object is in the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WhyUnseen {
    /// All objects are behind the camera.
    Behind,
    /// All objects are beside the window, or behind the camera.
    Outside,
    /// No object is in the picture, but one would be visible without the near or the far plane. The
    /// text is the field's name, `near` or `far`.
    Clipped(&'static str),
}

/// Returns the reason why the camera sees no object. Returns `None` if it may see one, or if its
/// axes cannot be computed accurately.
pub fn why_unseen(camera: &Camera, image: &Image, objects: &[Object]) -> Option<WhyUnseen> {
    let sight = Sight::new(camera, image)?;
    let sees = |near: f64, far: f64| {
        let mut shapes = objects.iter().map(|object| &object.shape);
        shapes.any(|shape| sight.may_see(shape, near, far))
    };
    if sees(sight.near, sight.far) {
        return None;
    }
    // If an object would be visible without the near plane, or without the far plane, that plane is
    // the reason.
    if sees(0.0, sight.far) {
        return Some(WhyUnseen::Clipped(CAMERA.near.name));
    }
    if sees(sight.near, f64::INFINITY) {
        return Some(WhyUnseen::Clipped(CAMERA.far.name));
    }
    let is_behind = |object: &Object| {
        let around = object.shape.bounding_sphere();
        around.is_some_and(|sphere| sight.is_beyond(sphere, sight.forward, 0.0))
    };
    Some(if objects.iter().all(is_behind) {
        WhyUnseen::Behind
    } else {
        WhyUnseen::Outside
    })
}

/// Position of an object that is wholly outside of the visible space.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outside {
    /// Behind the camera.
    Behind,
    /// Nearer than the near plane.
    BeforeNear,
    /// Farther than the far plane.
    BeyondFar,
    /// Beside the window. The text says on which side: left, right, above or below.
    Beside(&'static str),
}

impl Outside {
    /// Returns the position in words, for a message.
    pub fn words(self) -> &'static str {
        match self {
            Self::Behind => "behind the camera",
            Self::BeforeNear => "nearer than `near`",
            Self::BeyondFar => "beyond `far`",
            Self::Beside(side) => side,
        }
    }
}

/// Returns whether samples cannot tell the squares of a visible board apart. All squares of the
/// board then get the same colour.
pub fn are_squares_lost(camera: &Camera, image: &Image, board: &Checkerboard) -> bool {
    // If the camera looks straight down or up, its up vector may be parallel to the view direction.
    // The rotation of the window about the view direction is then unknown. The window's sides are
    // assumed to be parallel to x and z. The smaller of the window's extents along x and z is then
    // its shorter side. With any other rotation, both extents are at least as great. Squares that
    // are lost under this assumption, as `Sight::are_lost` finds, are therefore lost in any case.
    let straight = || {
        let (from, to) = camera.view.ends(camera.eye);
        let along_y = (to - from).normalize().y.abs() > 1.0 - MARGIN;
        let (up, roll) = (DVec3::Z, Angle::from_degrees(0.0));
        let level = Camera {
            up,
            roll,
            ..*camera
        };
        along_y.then(|| Sight::new(&level, image))?
    };
    let sight = Sight::new(camera, image).or_else(straight);
    sight.is_some_and(|it| it.may_see_plane(board.y, it.near, it.far) && it.are_lost(board))
}

/// The space that a camera sees: the pyramid of its window, between the near and the far plane.
#[derive(Clone, Copy, Debug)]
pub struct Sight {
    eye: DVec3,
    /// The view direction, of length 1.
    forward: DVec3,
    /// Vectors to the right and to the top of the picture, each as long as half of the window at
    /// depth 1.
    window: [DVec3; 2],
    near: f64,
    far: f64,
}

impl Sight {
    /// Makes the visible space of a camera. Returns `None` if the camera's axes cannot be computed
    /// accurately, for example because up is nearly parallel to the view direction.
    pub fn new(camera: &Camera, image: &Image) -> Option<Self> {
        let (from, to) = camera.view.ends(camera.eye);
        let forward = (to - from).normalize();
        let right = forward.cross(camera.up.normalize());
        // If two points are close to each other but far from the origin, their difference has few
        // correct digits. The view direction is then not precise enough.
        let is_precise = from.distance(to) > LEAST_SINE * (from.length() + to.length());
        // The condition is negated so that the function also returns `None` if a length is NaN.
        if !(is_precise && right.length() > LEAST_SINE) {
            return None;
        }
        let right = right.normalize();
        let top = right.cross(forward);
        let (sin, cos) = (trig::sin(camera.roll), trig::cos(camera.roll));
        let side = pixel_size(camera, image, |angle| trig::tan(angle * 0.5));
        let [across, up] = [image.width, image.height].map(|pixels| side * 0.5 * f64::from(pixels));
        let window = [
            (right * cos - top * sin) * across,
            (right * sin + top * cos) * up,
        ];
        let is_known = |axis: &DVec3| axis.is_finite() && *axis != DVec3::ZERO;
        window.iter().all(is_known).then_some(Self {
            eye: camera.eye,
            forward,
            window,
            near: camera.near,
            far: camera.far.unwrap_or(f64::INFINITY),
        })
    }

    /// Returns the position of an object whose bounding sphere is wholly outside of the picture.
    /// Returns `None` if the object may be visible.
    pub fn outside(&self, shape: &Shape) -> Option<Outside> {
        let Some(sphere) = shape.bounding_sphere() else {
            let sees = self.may_see(shape, self.near, self.far);
            return (!sees).then_some(Outside::Beside("outside of the window"));
        };
        if self.is_beyond(sphere, self.forward, 0.0) {
            return Some(Outside::Behind);
        }
        let mut sides = self.sides().into_iter();
        if let Some((name, _)) = sides.find(|(_, side)| self.is_beyond(sphere, *side, 0.0)) {
            return Some(Outside::Beside(name));
        }
        if self.is_beyond(sphere, self.forward, self.near) {
            return Some(Outside::BeforeNear);
        }
        let is_far = self.is_beyond(sphere, -self.forward, -self.far);
        is_far.then_some(Outside::BeyondFar)
    }

    /// Returns whether a shape may be visible between the depths `near` and `far`.
    fn may_see(&self, shape: &Shape, near: f64, far: f64) -> bool {
        let Some(sphere) = shape.bounding_sphere() else {
            let board = shape.checkerboard();
            return board.is_none_or(|board| self.may_see_plane(board.y, near, far));
        };
        let mut sides = self.sides().into_iter();
        !self.is_beyond(sphere, self.forward, near)
            && !self.is_beyond(sphere, -self.forward, -far)
            && !sides.any(|(_, side)| self.is_beyond(sphere, side, 0.0))
    }

    /// Returns the four sides of the pyramid that the camera sees. For each, returns words for the
    /// space beyond the side, and the side's unit normal, which points inwards.
    fn sides(&self) -> [(&'static str, DVec3); 4] {
        let [right, top] = self.window;
        let side = |axis: DVec3, sign: f64| {
            let half = axis.length();
            (self.forward * half + axis / half * sign).normalize()
        };
        [
            ("left of the window", side(right, 1.0)),
            ("right of the window", side(right, -1.0)),
            ("below the window", side(top, 1.0)),
            ("above the window", side(top, -1.0)),
        ]
    }

    /// Returns whether a whole sphere lies on the outer side of a plane, i.e. whether all of its
    /// points p satisfy
    ///
    ///   n·(p − e) < bound
    ///
    /// by a margin for rounding errors. Here e is the eye and n the plane's normal, of length 1.
    fn is_beyond(&self, (center, radius): (DVec3, f64), n: DVec3, bound: f64) -> bool {
        let size = center.length() + radius + self.eye.length() + bound.abs();
        // If a number is NaN, the comparison is `false`, so the sphere may be visible.
        n.dot(center - self.eye) + radius < bound - MARGIN * size
    }

    /// Returns whether a checkerboard at the height `height` may be visible between the
    /// depths `near` and `far`.
    fn may_see_plane(&self, height: f64, near: f64, far: f64) -> bool {
        // A ray that rises by d metres per metre of depth hits the plane at the depth (height of
        // the plane − height of the eye)/d.
        let above = height - self.eye.y;
        let middle = self.forward.y * above.signum();
        let [across, up] = self.window;
        let spread = across.y.abs() + up.y.abs() + MARGIN * (1.0 + across.length() + up.length());
        let (least, most) = (middle - spread, middle + spread);
        let nearest = above.abs() / most;
        let farthest = if least > 0.0 {
            above.abs() / least
        } else {
            f64::INFINITY
        };
        above != 0.0 && most > 0.0 && nearest <= far && farthest >= near
    }

    /// Returns whether the squares of a board are too small to be told apart. This is so if nearly
    /// all rays hit the board very far from the eye. The coordinates of a hit, in units of the side
    /// of a square, are then rounded to even integers, so all hits lie on even squares.
    fn are_lost(&self, board: &Checkerboard) -> bool {
        // Let h be the vertical distance of the board from the eye. A ray with the direction r hits
        // the board at the horizontal distance |r_x|·h/|r_y| along x, and likewise along z. In the
        // window, |r_y| is at most `extent.y`, and |r_x| is at least 2^−10·`extent.x` in more than
        // 99 % of the picture. A distance of more than 2^[`Big::BITS`] squares is rounded to an
        // even number of squares. For safety, the condition requires twice this distance. If a
        // number overflows or underflows, the comparison is false.
        let [across, up] = self.window;
        let extent = self.forward.abs() + across.abs() + up.abs();
        let height = (board.y - self.eye.y).abs();
        let most = libm::ldexp(1.0, Big::BITS + 11);
        board.square * most * extent.y < height * extent.x.min(extent.z)
    }
}
