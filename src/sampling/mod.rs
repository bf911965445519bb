//! The positions of a picture's samples.
//!
//! In: the scene's [`Sampler`] and the picture's size. Out: how many samples each pixel has, and
//! where in the pixel they lie. A sample is a pure function of the method, seed, pixel, index, the
//! pixel's number of samples and the picture's size: no generator has a state that depends on
//! earlier requests. Any part of a picture can therefore be rendered in any order, on any number of
//! threads, with the same result.
//!
//! An offset is relative to the middle of its pixel, x to the right and y down, in [−1/2, 1/2).
//! Each method has a file:
//!
//! | method | file | unbiased |
//! | --- | --- | --- |
//! | regular | `regular` | no: the same in every pixel |
//! | random | `random` | yes |
//! | jittered | `jittered` | yes |
//! | n_rooks, multi_jittered | `multi_jittered` | yes |
//! | hammersley | `hammersley` | yes |
//! | halton | `halton` | yes |
//! | sobol | `sobol` | yes |
//! | scatter | `scatter` and `random` | yes, except in pixels that it leaves empty |

mod binomial;
mod bricks;
mod halton;
mod hammersley;
mod hilbert;
mod jittered;
mod lattice;
mod multi_jittered;
mod points;
mod random;
mod regular;
pub(crate) mod rng;
mod scatter;
mod shuffle;
mod sobol;
mod tilings;

use std::ops::Range;

use multiversion::multiversion;

use self::{
    bricks::Bricks, halton::Halton, hammersley::Hammersley, jittered::Jittered,
    multi_jittered::MultiJittered, rng::Key, sobol::Sobol,
};
pub use self::{
    points::Points,
    rng::CounterRng,
    tilings::{Tiling, tilings},
};
use crate::{
    area::Area,
    math::{HAS_WIDER, SimdWidth},
    scene::{Count, Method, Sampler},
};

/// The samples of a picture.
#[derive(Debug)]
pub struct Sampling {
    method: Method,
    /// Random key of the seed and the method, from which a pixel's own key is derived.
    key: Key,
    total: u64,
    picture: Area,
    /// Minimum number of samples of a pixel. Not used for `scatter`, where the number varies from
    /// pixel to pixel.
    count: u64,
    /// Number of pixels that have one sample more than the minimum.
    extra: u64,
    /// Patterns of `count` points and of `count` + 1 points in a pixel. For `scatter`, each pattern
    /// serves for any number of points.
    patterns: Box<[PointPattern; 2]>,
}

/// The arrangement of a known number of points in a pixel.
#[derive(Debug)]
enum PointPattern {
    /// No points.
    Empty,
    Regular(Bricks),
    Random,
    Jittered(Jittered),
    MultiJittered(MultiJittered),
    Hammersley(Hammersley),
    Halton(Halton),
    Sobol(Sobol),
}

impl Sampling {
    /// Prepares the samples of a picture whose sides are at least 1 and at most 2^20 pixels. The
    /// exact method has no samples.
    ///
    /// # Panics
    ///
    /// The picture has no pixels.
    pub fn new(sampler: &Sampler, width: u32, height: u32) -> Self {
        // The key contains the method's position in the enum `Method`. The positions must not
        // change, because pictures depend on them.
        let key = Key::new(sampler.seed, sampler.method as u64);
        let pixels = u64::from(width) * u64::from(height);
        let total = match sampler.count {
            _ if sampler.method == Method::Exact => 0,
            Count::PerPixel(n) => n.saturating_mul(pixels),
            Count::Total(total) => total,
        };
        let (count, extra) = (total / pixels, total % pixels);
        let more = if extra > 0 { count + 1 } else { 0 };
        Self {
            method: sampler.method,
            key,
            total,
            picture: Area::whole(width, height),
            count,
            extra,
            patterns: Box::new([count, more].map(|n| PointPattern::new(sampler.method, n))),
        }
    }

    /// Returns whether the picture is computed without samples.
    pub fn is_exact(&self) -> bool {
        self.method == Method::Exact
    }

    /// Returns the area of the picture.
    pub(crate) fn picture(&self) -> Area {
        self.picture
    }

    /// Returns the number of samples of the whole picture.
    pub fn total(&self) -> u64 {
        self.total
    }

    /// Returns the mean number of samples per pixel, rounded up.
    pub fn samples_per_pixel(&self) -> u64 {
        self.total.div_ceil(self.picture.pixels())
    }

    /// Returns the mean number of samples per pixel.
    pub fn mean_count(&self) -> f64 {
        self.total as f64 / self.picture.pixels() as f64
    }

    /// Returns the number of samples of each pixel. Returns `None` if it may differ between pixels.
    pub fn same_count(&self) -> Option<u64> {
        (self.extra == 0 && self.method != Method::Scatter).then_some(self.count)
    }

    /// Returns the number of samples of a pixel.
    pub fn count(&self, x: u32, y: u32) -> u64 {
        self.counts(Area::pixel(x, y))[0]
    }

    /// Returns the number of samples of each pixel of a part of the picture, row by row. This is
    /// much faster than one call of [`count`](Self::count) per pixel.
    pub fn counts(&self, part: Area) -> Vec<u64> {
        match self.same_count() {
            Some(count) => vec![count; part.pixels() as usize],
            None if self.method == Method::Scatter => {
                // The key of this part is not that of any pixel, because no pixel has the number
                // `u64::MAX`.
                let key = self.key.part(u64::MAX);
                scatter::counts(key, self.total, self.picture, part)
            }
            None => part.iter().map(|(x, y)| self.even_count(x, y)).collect(),
        }
    }

    /// Returns the number of samples of a pixel if N samples are distributed evenly over P pixels.
    /// For the pixel with rank i along the Hilbert curve, it is ⌊(i + 1)·N/P⌋ − ⌊i·N/P⌋.
    fn even_count(&self, x: u32, y: u32) -> u64 {
        // With N = count·P + extra, only the extra samples vary between pixels. ⌊(i + 1)·extra/P⌋
        // exceeds ⌊i·extra/P⌋ by one if the remainder of i·extra modulo P is at least P − extra.
        let (extra, pixels) = (u128::from(self.extra), u128::from(self.picture.pixels()));
        let remainder = u128::from(hilbert::rank(self.picture, x, y)) * extra % pixels;
        self.count + u64::from(remainder + extra >= pixels)
    }

    /// Replaces the points in `out` by the offsets of a pixel's points whose indices are in
    /// `range`. `count` must be the pixel's [`count`](Self::count), and `range` must end at `count`
    /// or before.
    ///
    /// Each call prepares the data that a pixel's points share, so that a call should request a few
    /// thousand points at once.
    pub fn place(
        &self,
        vectors: SimdWidth,
        [x, y]: [u32; 2],
        count: u64,
        range: Range<u64>,
        out: &mut Points,
    ) {
        debug_assert!(range.end <= count);
        let key = self.key.part(u64::from(y) << 32 | u64::from(x));
        let pattern = &self.patterns[usize::from(count != self.count)];
        let out = out.resized(range.clone().count());
        match vectors {
            SimdWidth::Widest if HAS_WIDER => place_simd(pattern, key, range, out),
            _ => pattern.place(key, range, out),
        }
    }
}

#[multiversion(targets(
    "x86_64+avx512bw+avx512cd+avx512dq+avx512f+avx512vl+bmi1+bmi2+fma+lzcnt+popcnt",
    "x86_64+avx2+bmi1+bmi2+fma+lzcnt+popcnt",
))]
fn place_simd(pattern: &PointPattern, key: Key, range: Range<u64>, out: [&mut [f64]; 2]) {
    pattern.place(key, range, out);
}

impl PointPattern {
    fn new(method: Method, n: u64) -> Self {
        match method {
            Method::Random | Method::Scatter => Self::Random,
            Method::Exact => Self::Empty,
            _ if n == 0 => Self::Empty,
            Method::Regular => Self::Regular(Bricks::new(n)),
            Method::Jittered => Self::Jittered(Jittered::new(n)),
            Method::NRooks => Self::MultiJittered(MultiJittered::n_rooks(n)),
            Method::MultiJittered => Self::MultiJittered(MultiJittered::new(n)),
            Method::Hammersley => Self::Hammersley(Hammersley::new(n)),
            Method::Halton => Self::Halton(Halton::new(n)),
            Method::Sobol => Self::Sobol(Sobol::new(n)),
        }
    }

    /// Writes the offsets of the points whose indices are in `range` from the pixel's centre to
    /// `out`.
    #[inline(always)]
    fn place(&self, key: Key, range: Range<u64>, out: [&mut [f64]; 2]) {
        match self {
            Self::Empty => {}
            Self::Regular(bricks) => regular::place(bricks, range, out),
            Self::Random => random::place(key, range, out),
            Self::Jittered(jittered) => jittered.place(key, range, out),
            Self::MultiJittered(grid) => grid.place(key, range, out),
            Self::Hammersley(hammersley) => hammersley.place(key, range, out),
            Self::Halton(halton) => halton.place(key, range, out),
            Self::Sobol(sobol) => sobol.place(key, range, out),
        }
    }
}
