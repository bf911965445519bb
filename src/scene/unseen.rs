//! Whether the camera sees any object, and whether samples tell the squares of a board apart.
//!
//! In: a camera and the objects. Out: why none of them is in the picture, if a sphere around each
//! shows that; and whether a board's squares are too small for the numbers that samples are
//! computed with. A case of doubt counts as seen, and so does an object behind another one: a
//! warning is never false. Numbers here are rounded `f64`s; each comparison leaves a margin of
//! [`MARGIN`] times the lengths in it.

use glam::DVec3;

use super::{
    model::{Camera, Image, Object, pixel_size},
    shape::{Checkerboard, Shape},
};
use crate::{
    math::{Angle, Big, trig},
    schema::CAMERA,
};

/// Margin of a comparison, relative to the lengths that are compared. If the sine between up and
/// the view direction is at least [`LEAST_SINE`], the axes have a relative error of 2^−52/10^−6,
/// about 2·10⁻¹⁰, and all other errors are less.
const MARGIN: f64 = 1e-8;

/// Least sine of the angle between up and the view direction for which the camera's axes are known
/// well enough.
pub const LEAST_SINE: f64 = 1e-6;

/// Why no object is seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WhyUnseen {
    /// All objects are behind the camera.
    Behind,
    /// All objects are beside the window, or behind the camera.
    Outside,
    /// Without this field, `near` or `far`, an object would be seen.
    Clipped(&'static str),
}

/// Returns why the camera sees none of the objects; `None` if it may see one.
pub fn why_unseen(camera: &Camera, image: &Image, objects: &[Object]) -> Option<WhyUnseen> {
    let sight = Sight::new(camera, image)?;
    let sees = |near: f64, far: f64| {
        let mut shapes = objects.iter().map(|object| &object.shape);
        shapes.any(|shape| sight.may_see(shape, near, far))
    };
    if sees(sight.near, sight.far) {
        return None;
    }
    // If an object is seen without one of the two planes, that plane is the reason.
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

/// The side of the visible space on which an object lies that is wholly outside of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outside {
    /// Behind the camera.
    Behind,
    /// Nearer than the near plane.
    BeforeNear,
    /// Farther than the far plane.
    BeyondFar,
    /// Beside the window: left, right, above or below, in words.
    Beside(&'static str),
}

impl Outside {
    /// Returns the side in words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Behind => "behind the camera",
            Self::BeforeNear => "nearer than `near`",
            Self::BeyondFar => "beyond `far`",
            Self::Beside(side) => side,
        }
    }
}

/// Whether samples see squares of a board that they cannot tell apart, so that all of them get one
/// colour.
pub fn are_squares_lost(camera: &Camera, image: &Image, board: &Checkerboard) -> bool {
    // A camera that looks straight down may have any axes. However its window is turned, it reaches
    // along x and z at least as far as its shorter side, which it does along one of them with these
    // axes.
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
pub struct Sight {
    eye: DVec3,
    /// The view direction, of length 1.
    forward: DVec3,
    /// Right and top of the picture, times half of the window's extents at depth 1.
    window: [DVec3; 2],
    near: f64,
    far: f64,
}

impl Sight {
    /// Returns `None` if the camera's axes are not known well enough.
    pub fn new(camera: &Camera, image: &Image) -> Option<Self> {
        let (from, to) = camera.view.ends(camera.eye);
        let forward = (to - from).normalize();
        let right = forward.cross(camera.up.normalize());
        // The difference of two points that are near to each other and far from the origin has few
        // correct digits.
        let is_precise = from.distance(to) > LEAST_SINE * (from.length() + to.length());
        // A comparison with NaN is false.
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

    /// Returns where an object is if a sphere around it shows that no part of it is in the picture.
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

    /// Whether a shape may be seen between two depths.
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

    /// Returns the normals of the window's four sides, which point inwards, each with a word for
    /// what is beyond it. A side contains the eye and is parallel to one of the axes.
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

    /// Whether a whole sphere lies clearly on the outer side of a plane, that is at n·(p − e) <
    /// bound, n being of length 1.
    fn is_beyond(&self, (center, radius): (DVec3, f64), n: DVec3, bound: f64) -> bool {
        let size = center.length() + radius + self.eye.length() + bound.abs();
        // A comparison with NaN is false.
        n.dot(center - self.eye) + radius < bound - MARGIN * size
    }

    /// Whether the plane of a checkerboard at height h may be seen between two depths.
    ///
    /// A ray that changes its y by d for each metre of depth meets the plane at the depth
    /// (h − e_y)/d.
    fn may_see_plane(&self, height: f64, near: f64, far: f64) -> bool {
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

    /// Whether nearly all rays meet a board so many squares away from the eye that this number, as
    /// an `f64`, is always even.
    ///
    /// A ray r meets the board, which is h above or below the eye, |r_x|·h/|r_y| away along x, and
    /// likewise along z. In the window |r_x| is at most its extent, and less than 2^−10 of that in
    /// less than a hundredth of the picture. If the numbers here overflow or vanish, the comparison
    /// is false.
    fn are_lost(&self, board: &Checkerboard) -> bool {
        let [across, up] = self.window;
        let extent = self.forward.abs() + across.abs() + up.abs();
        let height = (board.y - self.eye.y).abs();
        let most = libm::ldexp(1.0, Big::BITS + 11);
        board.square * most * extent.y < height * extent.x.min(extent.z)
    }
}
