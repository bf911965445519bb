//! Whether the camera sees anything at all, and can tell the squares of a board apart.
//!
//! In: a camera and the objects. Out: why all of them are out of its sight, if a sphere around each
//! shows that they are; and whether a board's squares are too small for the numbers that samples
//! are computed with. What is in doubt counts as seen, and so does what another object hides: a
//! warning is never false. Errors: numbers here are rounded `f64`s, and each comparison leaves
//! [`MARGIN`] of the sizes in it.

use glam::DVec3;

use super::{
    model::{Camera, Checkerboard, Image, Object, Outline, Shape, View},
    pixel_size::pixel_size,
};
use crate::math::{Angle, Big, trig};

/// By so much of the lengths that are compared a comparison has to be clear. With up and the view
/// direction at [`LEAST_SINE`] or more the axes are good to 2^−52/10^−6, about 2·10⁻¹⁰, and all
/// else is better.
const MARGIN: f64 = 1e-8;

/// Below this sine of the angle between them, up and the view direction do not tell the axes well
/// enough.
pub const LEAST_SINE: f64 = 1e-6;

/// Why nothing is seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unseen {
    /// All of it is behind the camera.
    Behind,
    /// All of it is beside the window, or behind.
    Outside,
    /// Without this field, `near` or `far`, something would be seen.
    Clipped(&'static str),
}

/// Why the camera sees none of the objects; none if it may see one.
pub fn why_unseen(camera: &Camera, image: &Image, objects: &[Object]) -> Option<Unseen> {
    let frustum = Frustum::new(camera, image)?;
    let sees = |near: f64, far: f64| {
        let mut shapes = objects.iter().map(|object| &object.shape);
        shapes.any(|shape| frustum.may_see(shape, near, far))
    };
    let far = camera.far.unwrap_or(f64::INFINITY);
    if sees(camera.near, far) {
        return None;
    }
    // Where something is seen without one of the two planes, that one is to blame.
    if sees(0.0, far) {
        return Some(Unseen::Clipped("near"));
    }
    if sees(camera.near, f64::INFINITY) {
        return Some(Unseen::Clipped("far"));
    }
    let is_behind = |object: &Object| {
        let around = sphere_around(&object.shape);
        around.is_some_and(|sphere| frustum.is_beyond(sphere, frustum.forward, 0.0))
    };
    Some(match objects.iter().all(is_behind) {
        true => Unseen::Behind,
        false => Unseen::Outside,
    })
}

/// Where an object is that the camera cannot see.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// Behind the camera.
    Behind,
    /// Nearer than the near plane.
    BeforeNear,
    /// Farther than the far plane.
    BeyondFar,
    /// Beside the window: left, right, above or below.
    Beside(&'static str),
}

impl Place {
    /// The place in words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Behind => "behind the camera",
            Self::BeforeNear => "nearer than `near`",
            Self::BeyondFar => "beyond `far`",
            Self::Beside(side) => side,
        }
    }
}

/// The space that a camera sees, to ask where objects are that lie wholly outside of it.
pub struct Sight {
    frustum: Frustum,
    near: f64,
    far: f64,
}

impl Sight {
    /// Returns `None` if the camera's axes are not known well enough.
    pub fn new(camera: &Camera, image: &Image) -> Option<Self> {
        Some(Self {
            frustum: Frustum::new(camera, image)?,
            near: camera.near,
            far: camera.far.unwrap_or(f64::INFINITY),
        })
    }

    /// Says where an object is if a sphere around it shows that no part of it is in the picture.
    pub fn outside(&self, shape: &Shape) -> Option<Place> {
        let frustum = &self.frustum;
        let Some(sphere) = sphere_around(shape) else {
            let sees = frustum.may_see(shape, self.near, self.far);
            return (!sees).then_some(Place::Beside("outside of the window"));
        };
        let forward = frustum.forward;
        if frustum.is_beyond(sphere, forward, 0.0) {
            return Some(Place::Behind);
        }
        let mut sides = frustum.sides().into_iter();
        if let Some((name, _)) = sides.find(|(_, side)| frustum.is_beyond(sphere, *side, 0.0)) {
            return Some(Place::Beside(name));
        }
        if frustum.is_beyond(sphere, forward, self.near) {
            return Some(Place::BeforeNear);
        }
        let is_far = frustum.is_beyond(sphere, -forward, -self.far);
        is_far.then_some(Place::BeyondFar)
    }
}

/// Whether samples show squares of a board that they cannot tell apart, so that all have one
/// colour.
pub fn are_squares_lost(camera: &Camera, image: &Image, board: &Checkerboard) -> bool {
    // Straight down, however the window is turned, it reaches along x and z at least as far as its
    // shorter side, as it does along one of them here.
    let straight = || {
        let (from, to) = camera.view.ends(camera.eye);
        let along_y = (to - from).normalize().y.abs() > 1.0 - MARGIN;
        let (up, roll) = (DVec3::Z, Angle::from_degrees(0.0));
        along_y.then(|| {
            Frustum::new(
                &Camera {
                    up,
                    roll,
                    ..*camera
                },
                image,
            )
        })?
    };
    let Some(frustum) = Frustum::new(camera, image).or_else(straight) else {
        return false;
    };
    let far = camera.far.unwrap_or(f64::INFINITY);
    frustum.may_see_plane(board.y, camera.near, far) && frustum.are_lost(board)
}

/// Centre and radius of a sphere that holds an object; none of a checkerboard.
pub fn sphere_around(shape: &Shape) -> Option<(DVec3, f64)> {
    Some(match shape {
        Shape::Sphere(sphere) => (sphere.center, sphere.radius),
        Shape::Triangle(triangle) => {
            let centroid = triangle.outline.centroid();
            let radius = match triangle.outline {
                Outline::Vertices(vertices) => {
                    let distances = vertices.map(|vertex| vertex.distance(centroid));
                    distances.into_iter().fold(0.0, f64::max)
                }
                // A vertex is no farther from the centroid than the longest side is long.
                Outline::Centered(triangle) => triangle.sides.max_element(),
            };
            (centroid, radius)
        }
        Shape::Box(cuboid) => {
            let center = cuboid.min.midpoint(cuboid.max);
            (center, center.distance(cuboid.max))
        }
        Shape::Checkerboard(_) => return None,
    })
}

/// What the camera sees: the pyramid of its window.
struct Frustum {
    eye: DVec3,
    /// The view direction, of length 1.
    forward: DVec3,
    /// Right and top of the picture, times half of the window's extents at depth 1.
    window: [DVec3; 2],
}

impl Frustum {
    /// None where the axes are not known well enough.
    fn new(camera: &Camera, image: &Image) -> Option<Self> {
        let (from, to) = camera.view.ends(camera.eye);
        let forward = (to - from).normalize();
        let right = forward.cross(camera.up.normalize());
        // Of points far from the origin, and near to each other, little is left of the difference.
        let is_precise = from.distance(to) > LEAST_SINE * (from.length() + to.length());
        // What is not a number is not more.
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
        })
    }

    /// Whether a shape may be seen between two depths.
    fn may_see(&self, shape: &Shape, near: f64, far: f64) -> bool {
        let sphere = match (shape, sphere_around(shape)) {
            (_, Some(sphere)) => sphere,
            (Shape::Checkerboard(board), _) => return self.may_see_plane(board.y, near, far),
            _ => return true,
        };
        !self.is_beyond(sphere, self.forward, near)
            && !self.is_beyond(sphere, -self.forward, -far)
            && !self
                .sides()
                .into_iter()
                .any(|(_, side)| self.is_beyond(sphere, side, 0.0))
    }

    /// The normals of the window's four sides, which point inwards, and what is beyond each. A side
    /// goes through the eye and along one of the axes.
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

    /// Whether all of a sphere lies clearly on the outer side of a plane: at n·(p − e) < bound, n
    /// of length 1.
    fn is_beyond(&self, (center, radius): (DVec3, f64), n: DVec3, bound: f64) -> bool {
        let size = center.length() + radius + self.eye.length() + bound.abs();
        // What is not a number is not less.
        n.dot(center - self.eye) + radius < bound - MARGIN * size
    }

    /// The same of the plane of a checkerboard. A ray that goes by y along for each metre of depth
    /// meets it at the depth (h − e_y)/y.
    fn may_see_plane(&self, height: f64, near: f64, far: f64) -> bool {
        let above = height - self.eye.y;
        let middle = self.forward.y * above.signum();
        let [across, up] = self.window;
        let spread = across.y.abs() + up.y.abs() + MARGIN * (1.0 + across.length() + up.length());
        let (least, most) = (middle - spread, middle + spread);
        let nearest = above.abs() / most;
        let farthest = match least > 0.0 {
            true => above.abs() / least,
            false => f64::INFINITY,
        };
        above != 0.0 && most > 0.0 && nearest <= far && farthest >= near
    }

    /// Whether nearly all rays meet a board so many squares from the eye that the number is even
    /// whatever it is.
    ///
    /// The ray r meets the board, which is h above or below the eye, |r_x|·h/|r_y| away along x,
    /// and as much along z. In the window |r_x| goes up to its extent, and is below 2^−10 of that
    /// in less than a hundredth of the picture. Where the numbers here overflow or vanish, it is
    /// not so.
    fn are_lost(&self, board: &Checkerboard) -> bool {
        let [across, up] = self.window;
        let extent = self.forward.abs() + across.abs() + up.abs();
        let height = (board.y - self.eye.y).abs();
        let most = libm::ldexp(1.0, Big::BITS + 11);
        board.square * most * extent.y < height * extent.x.min(extent.z)
    }
}

impl View {
    /// Two points, from one of which to the other the camera looks.
    pub fn ends(&self, eye: DVec3) -> (DVec3, DVec3) {
        match *self {
            Self::Lookat(point) => (eye, point),
            Self::Direction(direction) => (DVec3::ZERO, direction),
        }
    }
}
