//! A prepared pixel: its surfaces as forms, and the samples of one chunk.

use super::super::{
    candidates::VisibilityCandidate,
    checker_corners::CheckerForms,
    local_form::{LocalForm, LocalQuadratic, ScaledLine},
};

/// Number of samples that are evaluated at a time. Their six [`Lanes`], 3 KiB, and their
/// coordinates stay in the first-level cache.
pub(super) const CHUNK_SAMPLES: usize = 64;

/// Code of a sample that meets nothing. Object i of the pixel has the code 2i + 1, its second
/// colour 2i + 2.
pub(super) const BACKGROUND: f64 = 0.0;
/// Code of a sample that is not certain.
pub(super) const DOUBT: f64 = -1.0;

/// The objects of one pixel, prepared for many samples. It is reused from pixel to pixel, to keep
/// its allocations.
#[derive(Debug, Default)]
pub struct PreparedPixel {
    /// The objects that may be seen in the pixel.
    pub(super) candidates: Vec<VisibilityCandidate>,
    pub(super) x: u32,
    pub(super) y: u32,
    pub(super) surfaces: Vec<PixelSurface>,
    /// Boundary and pattern lines of all surfaces.
    pub(super) lines: Vec<ScaledLine>,
    /// Minimum difference of inverse depths that is certain, if surfaces are compared sample by
    /// sample.
    pub(super) apart: Option<f64>,
    /// Depth planes of all surfaces; filled only if surfaces are compared sample by sample.
    pub(super) planes: Vec<LocalForm>,
    /// Whether samples must be traced one by one.
    pub(super) is_hard: bool,
    /// The colours that may be seen, if surfaces are decided by forms.
    pub(super) colors: Vec<ColorCount>,
    /// Number of uncertain samples in the last chunk.
    pub(super) doubts: u64,
    pub(super) lanes: Lanes,
}

/// A colour that may be seen in a pixel.
#[derive(Debug)]
pub(super) struct ColorCount {
    /// The code of the colour in [`Lanes::seen`].
    pub(super) code: f64,
    /// The colour's slot in the palette.
    pub(super) slot: usize,
    /// Number of samples that have seen the colour.
    pub(super) count: u64,
}

/// One object as a pixel shows it.
#[derive(Debug)]
pub(super) struct PixelSurface {
    /// The object's index among the candidates.
    pub(super) index: usize,
    /// Start and end of its boundaries among all lines; each form is ≥ 0 where the object is met.
    pub(super) edges: [usize; 2],
    /// The boundary of a sphere.
    pub(super) conic: Option<LocalQuadratic>,
    pub(super) pattern: ColorPattern,
    pub(super) depth: Depth,
}

/// Which of its two colours an object shows.
#[derive(Debug)]
pub(super) enum ColorPattern {
    /// One colour, by its code.
    Plain(f64),
    /// Two colours, separated by the lines from the end of the edges up to `end`: where the product
    /// of their forms is positive, the first colour is shown, or the second if `odd`.
    Lines { end: usize, odd: bool },
    /// Squares of a checkerboard, by division.
    Squares(CheckerForms),
}

/// How the inverse depth of a surface is computed.
#[derive(Debug)]
pub(super) enum Depth {
    /// Not needed.
    Unknown,
    /// The least of a range of planes.
    Least([usize; 2]),
    /// The greatest of a range of planes.
    Greatest([usize; 2]),
    /// The near side of a sphere, (b + √Q) · factor.
    Sphere {
        q: LocalQuadratic,
        b: LocalForm,
        factor: f64,
    },
}

/// Values of the samples of a chunk, one array per quantity.
#[derive(Debug)]
pub(super) struct Lanes {
    /// Code of what is seen so far.
    pub(super) seen: [f64; CHUNK_SAMPLES],
    /// Inverse depth of what is seen so far.
    pub(super) nearest: [f64; CHUNK_SAMPLES],
    /// Least boundary form of the current surface, in units of its error bound.
    pub(super) margin: [f64; CHUNK_SAMPLES],
    /// Code of what the current surface shows.
    pub(super) shown: [f64; CHUNK_SAMPLES],
    /// Inverse depth of the current surface.
    pub(super) depth: [f64; CHUNK_SAMPLES],
    /// Product of the pattern's line forms.
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
    /// A surface without boundaries, whose lines will begin at `start`.
    pub(super) fn new(index: usize, start: usize) -> Self {
        Self {
            index,
            edges: [start; 2],
            conic: None,
            pattern: ColorPattern::Plain(0.0),
            depth: Depth::Unknown,
        }
    }

    /// Returns the code of one of its colours.
    pub(super) fn code(&self, odd: bool) -> f64 {
        (2 * self.index + 1 + usize::from(odd)) as f64
    }
}
