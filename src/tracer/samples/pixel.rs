//! A prepared pixel: its surfaces as linear and quadratic forms, and buffers for one chunk of
//! samples.

use super::super::{
    candidates::VisibilityCandidate,
    checker_corners::CheckerForms,
    local_form::{LocalForm, LocalQuadratic, ScaledLine},
};

/// Maximum number of samples of a pixel that are evaluated at a time (a chunk). The six arrays of
/// [`Lanes`] for 64 samples, 3 KiB, and the samples' coordinates stay in the first-level cache.
pub(super) const CHUNK_SAMPLES: usize = 64;

/// Code, in [`Lanes::seen`], of a sample that hits no object. The object with the index i among the
/// pixel's candidates has the code 2i + 1 for its first colour and 2i + 2 for its second.
pub(super) const BACKGROUND: f64 = 0.0;
/// Code, in [`Lanes::seen`], of an uncertain sample, which is traced again on its own.
pub(super) const DOUBT: f64 = -1.0;

/// The objects of one pixel, prepared for many samples. One instance is reused for all pixels, so
/// that its lists need not be allocated again.
#[derive(Debug, Default)]
pub struct PreparedPixel {
    /// The objects that may be seen in the pixel.
    pub(super) candidates: Vec<VisibilityCandidate>,
    pub(super) x: u32,
    pub(super) y: u32,
    pub(super) surfaces: Vec<PixelSurface>,
    /// All lines of the pixel: those that bound the surfaces, and those between the squares of
    /// checkerboards.
    pub(super) lines: Vec<ScaledLine>,
    /// Minimum difference of two inverse depths at which their order is certain. `None` if the
    /// surfaces are sorted from back to front, so that samples compare no depths.
    pub(super) apart: Option<f64>,
    /// Inverse depths of the flat faces of all surfaces, as linear forms; filled only if depths are
    /// compared per sample.
    pub(super) planes: Vec<LocalForm>,
    /// Whether all samples must be traced one by one.
    pub(super) is_hard: bool,
    /// The colours that may be seen in the pixel, each with the number of samples that see it.
    /// Samples that are traced one by one are not counted.
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
    /// Index of the colour in the palette.
    pub(super) color_index: usize,
    /// Number of samples that see the colour.
    pub(super) count: u64,
}

/// One object as it is seen in a pixel.
#[derive(Debug)]
pub(super) struct PixelSurface {
    /// The object's index among the candidates.
    pub(super) index: usize,
    /// Start and end of the object's boundary lines in [`PreparedPixel::lines`]. The linear form of
    /// each line is ≥ 0 for rays that hit the object.
    pub(super) edges: [usize; 2],
    /// The silhouette of a sphere, as a form that is > 0 for rays that hit the sphere. `None` if
    /// the object is not a sphere, or if the silhouette does not cross the pixel.
    pub(super) conic: Option<LocalQuadratic>,
    pub(super) pattern: ColorPattern,
    pub(super) depth: Depth,
}

/// Pattern of an object's colours in a pixel.
#[derive(Debug)]
pub(super) enum ColorPattern {
    /// One colour, given by its code.
    Plain(f64),
    /// Two colours, separated by lines. Each line is given by a linear form in x and y that is zero
    /// on the line. A point shows the first colour if the product of the forms' values is positive,
    /// and the second colour if it is negative. If `odd` is set, the two colours are exchanged.
    ///
    /// The forms are a part of [`PreparedPixel::lines`]. The part starts at the end of the
    /// surface's `edges`; `end` is the index after its last form.
    Lines { end: usize, odd: bool },
    /// The squares of a checkerboard. For each sample, a division computes the square that it hits.
    Squares(CheckerForms),
}

/// Formula for the inverse depth of a surface.
#[derive(Debug)]
pub(super) enum Depth {
    /// No formula, because the surfaces' depths are not compared.
    Unknown,
    /// The least of the inverse depths of several planes, given by the start and the end of their
    /// range in [`PreparedPixel::planes`].
    Least([usize; 2]),
    /// The greatest of the inverse depths of several planes, given by the start and the end of
    /// their range in [`PreparedPixel::planes`].
    Greatest([usize; 2]),
    /// The near side of a sphere. Its inverse depth is (b + √q) · `factor`, where b and q are the
    /// values of the forms `b` and `q`.
    Sphere {
        q: LocalQuadratic,
        b: LocalForm,
        factor: f64,
    },
}

/// Values of the samples of a chunk, with one array for each quantity. The arrays are aligned,
/// because loading vectors that cross a cache line takes longer.
#[derive(Debug)]
#[repr(align(64))]
pub(super) struct Lanes {
    /// Code, for each sample, of the colour of the nearest surface found so far.
    pub(super) seen: [f64; CHUNK_SAMPLES],
    /// Inverse depth, at each sample, of the nearest surface found so far.
    pub(super) nearest: [f64; CHUNK_SAMPLES],
    /// Least value, at each sample, of the forms that bound the current surface, each divided by
    /// its error bound.
    pub(super) margin: [f64; CHUNK_SAMPLES],
    /// Code, for each sample, of the colour that the current surface shows.
    pub(super) shown: [f64; CHUNK_SAMPLES],
    /// Inverse depth, at each sample, of the current surface.
    pub(super) depth: [f64; CHUNK_SAMPLES],
    /// Product, at each sample, of the forms of the lines that separate the current surface's two
    /// colours.
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
    /// Returns a surface without boundaries. `index` is the object's index among the candidates,
    /// and `start` is the current length of [`PreparedPixel::lines`].
    pub(super) fn new(index: usize, start: usize) -> Self {
        Self {
            index,
            edges: [start; 2],
            conic: None,
            pattern: ColorPattern::Plain(0.0),
            depth: Depth::Unknown,
        }
    }

    /// Returns the code of the object's first colour, or of its second colour if `odd`.
    pub(super) fn code(&self, odd: bool) -> f64 {
        (2 * self.index + 1 + usize::from(odd)) as f64
    }
}
