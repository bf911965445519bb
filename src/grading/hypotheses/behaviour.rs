//! How a program behaves otherwise than a right one.

use glam::DVec3;

/// Which of the surfaces that a ray crosses is seen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SeenSurface {
    /// The nearest one ahead of the eye, which is correct.
    #[default]
    Nearest,
    /// That of the last object in the file.
    Last,
    /// That of the first object in the file.
    First,
    /// The farthest one ahead of the eye.
    Farthest,
    /// The farthest one behind the eye, or else the nearest.
    Behind,
    /// The nearest one, ahead of the eye or behind it.
    NearestBothWays,
}

/// Rule that decides which squares of a checkerboard have the first colour, as a function of a
/// point's coordinates in squares.
#[derive(Clone, Copy, Debug)]
pub struct SquareRule(pub fn(f64, f64) -> bool);

impl Default for SquareRule {
    /// The correct rule: floor(x) + floor(z) is even.
    fn default() -> Self {
        Self(|x, z| is_even(floor(x), floor(z)))
    }
}

impl PartialEq for SquareRule {
    /// Compares two rules by their values at points all around the origin: a function may have
    /// several addresses, so addresses alone do not distinguish functions.
    fn eq(&self, other: &Self) -> bool {
        let coordinates = || (-6..6).map(|i| 0.25 + 0.5 * f64::from(i));
        std::ptr::fn_addr_eq(self.0, other.0)
            || coordinates().all(|x| coordinates().all(|z| self.0(x, z) == other.0(x, z)))
    }
}

/// Rounds down.
///
/// `f64::floor` is a call on processors without an instruction for it, and each ray that meets a
/// board needs it. Beyond the range of an i64 squares are not distinguished.
pub fn floor(x: f64) -> i64 {
    let towards_zero = x as i64;
    towards_zero.wrapping_sub(i64::from(towards_zero as f64 > x))
}

/// Returns whether the sum of two numbers is even.
pub fn is_even(x: i64, z: i64) -> bool {
    x.wrapping_add(z) & 1 == 0
}

/// How rays are made.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Rays {
    /// By the camera's definition.
    #[default]
    Correct,
    /// The up vector is taken for the picture's top.
    UpAsTop,
    /// The top of a rolled camera is computed from the right vector that is rolled already.
    NewRight,
    /// Only the right vector is rolled.
    RightAlone,
    /// Rays are parallel, and leave from a window whose pixels have the size that they have at this
    /// distance.
    Parallel(f64),
    /// A ray's angle with the view direction grows linearly with the distance from the picture's
    /// middle.
    Fisheye,
}

/// How spheres are hit.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Spheres {
    /// By the correct formula.
    #[default]
    Correct,
    /// By the formula for rays of length 1, with the view plane at this distance.
    UnitRays(f64),
    /// Only in the nearer of the two points.
    LesserRoot,
    /// Only in the farther of the two points.
    GreaterRoot,
    /// By roots that are multiplied by a where they should be divided, with the view plane at this
    /// distance.
    TimesA(f64),
}

/// How a colour is shaded.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Shading {
    /// Not at all, which is correct.
    #[default]
    None,
    /// By the cosine between the ray and the normal.
    OfRay,
    /// By the cosine between the normal and a direction to a light.
    To(DVec3),
}

/// A fault in how one object is hit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HitFault {
    /// The test of this edge of a triangle is missing.
    WithoutEdge(usize),
    /// A triangle is taken for the parallelogram of its first two sides.
    Parallelogram,
    /// A box has no sides across this axis.
    WithoutAxis(usize),
}

/// How a program behaves; correct by default.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Behaviour {
    /// Which surface is seen.
    pub visible: SeenSurface,
    /// Which squares of a checkerboard have the first colour.
    pub square_rule: SquareRule,
    /// Ratio of a pixel's width to its height.
    pub aspect: f64,
    /// Distance between the middles of neighbouring pixels' samples, in pixels, per axis.
    pub spread: [f64; 2],
    /// Shift of the samples from their correct places, in pixels.
    pub offset: [f64; 2],
    /// Width of the square in which a pixel's samples lie, in pixels.
    pub pixel: f64,
    /// How rays are made.
    pub rays: Rays,
    /// Whether near and far are compared with distances from the eye, not with depths.
    pub clips_distances: bool,
    /// How spheres are hit.
    pub spheres: Spheres,
    /// Distance from the origin, along both axes of a checkerboard, at which it ends, in metres.
    pub board_reach: f64,
    /// Index of the axis that is normal to a checkerboard.
    pub board_normal: usize,
    /// How colours are shaded.
    pub shading: Shading,
    /// The object that is hit wrongly, and how.
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

    /// Returns whether each object is seen only where a correct program shows it, or not at all.
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

    /// Returns whether samples are shifted or spread by pixels or parts of them.
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
