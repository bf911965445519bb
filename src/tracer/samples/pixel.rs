//! What is kept of one pixel: its surfaces as forms, and the samples of a chunk.

use super::super::{
    candidates::Candidate,
    checker_corners::Squares,
    local_form::{LocalForm, LocalQuadratic, ScaledLine},
};

/// So many samples are evaluated at a time: their six [`Lanes`], 3 KiB, and their places stay in
/// the first-level cache.
pub(super) const CHUNK_SAMPLES: usize = 64;

/// What is seen where nothing is hit, and where it is not certain; object i of the pixel is 2i + 1,
/// its second colour 2i + 2.
pub(super) const BACKGROUND: f64 = 0.0;
pub(super) const DOUBT: f64 = -1.0;

/// A pixel's objects, prepared for many samples. Kept from pixel to pixel for its room.
#[derive(Debug, Default)]
pub struct PreparedPixel {
    /// The candidates.
    pub(super) candidates: Vec<Candidate>,
    pub(super) x: u32,
    pub(super) y: u32,
    pub(super) surfaces: Vec<PixelSurface>,
    /// Of all surfaces.
    pub(super) lines: Vec<ScaledLine>,
    /// How far apart inverse depths must be to be told apart, if surfaces are compared sample by
    /// sample.
    pub(super) apart: Option<f64>,
    /// Of all surfaces, if they are looked at.
    pub(super) planes: Vec<LocalForm>,
    /// Whether samples are to be traced one by one.
    pub(super) is_hard: bool,
    /// What may be seen, where surfaces are told by forms.
    pub(super) colors: Vec<ColorCount>,
    /// How many samples of the last chunk are not certain.
    pub(super) doubts: u64,
    pub(super) lanes: Lanes,
}

/// A colour that may be seen in a pixel.
#[derive(Debug)]
pub(super) struct ColorCount {
    /// What stands for it.
    pub(super) code: f64,
    /// Its slot in the palette.
    pub(super) slot: usize,
    /// How many samples have seen it.
    pub(super) count: u64,
}

/// What a pixel shows of an object.
#[derive(Debug)]
pub(super) struct PixelSurface {
    /// Its index among the candidates.
    pub(super) index: usize,
    /// Where its boundaries begin among all lines, and where they end: each is ≥ 0 where it is
    /// hit.
    pub(super) edges: [usize; 2],
    /// The boundary of a sphere.
    pub(super) conic: Option<LocalQuadratic>,
    pub(super) pattern: Pattern,
    pub(super) depth: Depth,
}

/// Which of its colours an object shows.
#[derive(Debug)]
pub(super) enum Pattern {
    /// The first or the second.
    Plain(f64),
    /// The first where the product of the lines up to `end`, behind the edges, is positive, if not
    /// `odd`.
    Lines { end: usize, odd: bool },
    /// Squares by division.
    Squares(Squares),
}

/// Where the inverse depth of a surface comes from.
#[derive(Debug)]
pub(super) enum Depth {
    /// It is not asked for.
    Unknown,
    /// The least of some planes'.
    Least([usize; 2]),
    /// The greatest of them.
    Greatest([usize; 2]),
    /// That of the near side of a sphere, (b + √Q) · factor.
    Sphere {
        q: LocalQuadratic,
        b: LocalForm,
        factor: f64,
    },
}

/// The samples of a chunk.
#[derive(Debug)]
pub(super) struct Lanes {
    /// What is seen so far.
    pub(super) seen: [f64; CHUNK_SAMPLES],
    /// Its inverse depth.
    pub(super) nearest: [f64; CHUNK_SAMPLES],
    /// How certainly a surface is hit.
    pub(super) margin: [f64; CHUNK_SAMPLES],
    /// What is seen of it.
    pub(super) shown: [f64; CHUNK_SAMPLES],
    /// Its inverse depth.
    pub(super) depth: [f64; CHUNK_SAMPLES],
    /// The product of signs.
    pub(super) sign: [f64; CHUNK_SAMPLES],
}

impl Default for Lanes {
    fn default() -> Self {
        let zeros = [0.0; CHUNK_SAMPLES];
        Self {
            seen: zeros,
            nearest: zeros,
            margin: zeros,
            shown: zeros,
            depth: zeros,
            sign: zeros,
        }
    }
}

impl PixelSurface {
    /// Without boundaries, which would begin there among all lines.
    pub(super) fn new(index: usize, start: usize) -> Self {
        Self {
            index,
            edges: [start; 2],
            conic: None,
            pattern: Pattern::Plain(0.0),
            depth: Depth::Unknown,
        }
    }

    /// What stands for one of its colours.
    pub(super) fn code(&self, odd: bool) -> f64 {
        (2 * self.index + 1 + usize::from(odd)) as f64
    }
}
