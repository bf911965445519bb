//! How the ray tracer of a wrong program differs from that of a correct one.

use glam::DVec3;

/// Rule that says which of the surfaces that a ray crosses is seen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SeenSurface {
    /// The nearest surface ahead of the eye, which is correct.
    #[default]
    Nearest,
    /// The surface of the object that comes last in the file.
    Last,
    /// The surface of the object that comes first in the file.
    First,
    /// The farthest surface ahead of the eye.
    Farthest,
    /// The farthest surface behind the eye. If there is none, the nearest surface ahead of it.
    Behind,
    /// The nearest surface, whether it is ahead of the eye or behind it.
    NearestBothWays,
}

/// Rule that decides which squares of a checkerboard have the first colour. Its arguments are a
/// point's coordinates x and z on the board, in units of a square's side.
#[derive(Clone, Copy, Debug)]
pub struct SquareRule(pub fn(f64, f64) -> bool);

impl Default for SquareRule {
    /// Returns the correct rule: a square has the first colour if floor(x) + floor(z) is even. Here
    /// x and z are coordinates in units of a square's side.
    fn default() -> Self {
        Self(|x, z| is_even(floor(x), floor(z)))
    }
}

impl PartialEq for SquareRule {
    /// Compares two rules by their results at 144 points around the origin. Comparing the
    /// functions' addresses is not enough, because a function may have several addresses.
    fn eq(&self, other: &Self) -> bool {
        let coordinates = || (-6..6).map(|i| 0.25 + 0.5 * f64::from(i));
        std::ptr::fn_addr_eq(self.0, other.0)
            || coordinates().all(|x| coordinates().all(|z| self.0(x, z) == other.0(x, z)))
    }
}

/// Rounds a number down to an integer.
///
/// Replaces `f64::floor`, which is a slow call on processors without an instruction for it. Each
/// ray that meets a checkerboard rounds two numbers. Results beyond the range of an `i64` are
/// wrong, but squares at such distances are too small to be seen.
pub fn floor(x: f64) -> i64 {
    let towards_zero = x as i64;
    towards_zero.wrapping_sub(i64::from(towards_zero as f64 > x))
}

/// Returns whether x + z is even.
pub fn is_even(x: i64, z: i64) -> bool {
    x.wrapping_add(z) & 1 == 0
}

/// How the camera makes rays.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Rays {
    /// Rays follow the definition of the camera, which is correct.
    #[default]
    Correct,
    /// The scene's up vector is used as the picture's upward direction, although it need not be
    /// perpendicular to the view direction.
    UpAsTop,
    /// The roll is applied to the camera's right vector first. The upward direction is then
    /// computed from the turned right vector instead of the original one, which skews the picture.
    NewRight,
    /// The roll turns the camera's right vector only, not the upward direction. This skews the
    /// picture.
    RightAlone,
    /// Rays are parallel. The number is a distance from the eye, in metres. Objects at this
    /// distance have the correct size in the picture. Nearer objects are too small, and farther
    /// ones too large.
    Parallel(f64),
    /// The projection is that of a fisheye lens: the angle between a ray and the view direction is
    /// proportional to the distance from the picture's middle.
    Fisheye,
}

/// How the intersections of a ray with a sphere are computed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Spheres {
    /// Intersections are computed by the correct formula.
    #[default]
    Correct,
    /// Intersections are computed by a formula that is correct only for ray directions of length 1,
    /// but the direction vectors reach from the eye to the view plane. The number is the distance
    /// of the view plane from the eye, in metres.
    UnitRays(f64),
    /// Only the nearer of the two intersections is tested. If it is behind the eye or clipped, the
    /// sphere is not seen.
    LesserRoot,
    /// The farther of the two intersections is used instead of the nearer one.
    GreaterRoot,
    /// The quadratic equation `a`·t² + b·t + c = 0 is solved wrongly: the program multiplies by `a`
    /// instead of dividing by it. Here `a` is the squared length of the ray's direction vector,
    /// which reaches from the eye to the view plane. The number is the distance of the view plane
    /// from the eye, in metres.
    TimesA(f64),
}

/// How the colour of a surface is shaded.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Shading {
    /// Colours are not shaded, which is correct.
    #[default]
    None,
    /// Colours are multiplied by the cosine of the angle between the ray and the surface normal.
    OfRay,
    /// Colours are multiplied by the cosine of the angle between the surface normal and a light's
    /// direction. The vector is this direction.
    To(DVec3),
}

/// A fault in how rays are intersected with one object.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HitFault {
    /// A triangle lacks the test against the edge with this index. Edge 0 is opposite the second
    /// vertex, edge 1 opposite the third, and edge 2 opposite the first.
    WithoutEdge(usize),
    /// A triangle is taken for the parallelogram that two of its sides span.
    Parallelogram,
    /// A box lacks the two faces perpendicular to the axis with this index (0 is x), so it has no
    /// end along that axis.
    WithoutAxis(usize),
}

/// How the ray tracer of a program behaves. The default is correct.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Behaviour {
    /// Rule that says which of the surfaces that a ray crosses is seen.
    pub visible: SeenSurface,
    /// Rule that decides which squares of a checkerboard have the first colour.
    pub square_rule: SquareRule,
    /// Ratio of a pixel's width to its height; 1 is correct.
    pub aspect: f64,
    /// Spacing of the samples along x and y: the distance, in pixels, between corresponding samples
    /// of neighbouring pixels. 1 is correct.
    pub spread: [f64; 2],
    /// Offset of the samples from their correct places, in pixels, along x and y.
    pub offset: [f64; 2],
    /// Side of the square over which a pixel's samples are spread, in pixels; 1 is correct.
    pub pixel: f64,
    /// How the camera makes rays.
    pub rays: Rays,
    /// Whether the near and far planes are compared with distances from the eye, instead of depths.
    pub clips_distances: bool,
    /// How the intersections of a ray with a sphere are computed.
    pub spheres: Spheres,
    /// Half the side of a checkerboard that is wrongly limited to a square, in metres. The square
    /// is centred at the origin. Infinity is correct, because a checkerboard is a whole plane.
    pub board_reach: f64,
    /// Index of the axis perpendicular to a checkerboard; 1, the y axis, is correct.
    pub board_normal: usize,
    /// How the colour of a surface is shaded.
    pub shading: Shading,
    /// Index of an object that is intersected wrongly, and the fault in the intersection. `None` is
    /// correct.
    pub hit: Option<(usize, HitFault)>,
}

impl Default for Behaviour {
    fn default() -> Self {
        Self {
            visible: SeenSurface::default(),
            square_rule: SquareRule::default(),
            aspect: 1.0,
            spread: [1.0; 2],
            offset: [0.0; 2],
            pixel: 1.0,
            rays: Rays::default(),
            clips_distances: false,
            spheres: Spheres::default(),
            board_reach: f64::INFINITY,
            board_normal: 1,
            shading: Shading::default(),
            hit: None,
        }
    }
}

impl Behaviour {
    /// Returns whether the behaviour is that of a correct program.
    pub fn is_correct(self) -> bool {
        self == Self::default()
    }

    /// Returns whether every object is seen only inside the outline that it has in a correct
    /// picture. Inside the outline, the object may still have wrong colours, or be hidden wrongly.
    pub fn is_in_place(self) -> bool {
        !self.is_shifted()
            && self.pixel == 1.0
            && !matches!(self.spheres, Spheres::UnitRays(_))
            && !self.sees_behind()
            && self.aspect == 1.0
            && self.rays == Rays::Correct
            && self.board_normal == 1
            && self.hit.is_none()
    }

    /// Returns whether samples are offset from their correct places, or their spacing is wrong.
    pub fn is_shifted(self) -> bool {
        self.offset != [0.0; 2] || self.spread != [1.0; 2]
    }

    /// Returns whether surfaces behind the eye are seen, too.
    pub fn sees_behind(self) -> bool {
        matches!(
            self.visible,
            SeenSurface::Behind | SeenSurface::NearestBothWays
        )
    }
}
