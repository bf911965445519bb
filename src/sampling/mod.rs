//! The positions of a picture's samples.
//!
//! In: the scene's [`Sampler`] and the picture's size. Out: how many samples each pixel has, and
//! where in the pixel they lie. A sample is a pure function of the method, the seed, the picture's
//! size, the pixel, the pixel's number of samples, and the sample's index. No random generator has
//! a state that depends on earlier requests. Any part of a picture can therefore be rendered in any
//! order, on any number of threads, with the same result.
//!
//! A sample's position is an offset from the middle of its pixel, x to the right and y down, in
//! [−1/2, 1/2). Each method has a file. A method is unbiased if the expected mean of a pixel's
//! samples is the exact mean over the pixel:
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

/// Number and positions of the samples in each pixel of a picture.
#[derive(Debug)]
pub struct Sampling {
    method: Method,
    /// Random key that depends on the seed and the method. Each pixel's own key is derived from it.
    key: Key,
    total: u64,
    picture: Area,
    /// Minimum number of samples in a pixel. The method `scatter` does not use this number, because
    /// it distributes the samples at random.
    count: u64,
    /// Number of pixels that have one sample more than the minimum number.
    extra: u64,
    /// Two arrangements of points in a pixel: one of `count` points, and one of `count` + 1. For
    /// the method `scatter`, both arrangements consist of independent random points, and `count`
    /// does not limit their number.
    patterns: Box<[PointPattern; 2]>,
}

/// The arrangement of a known number of points in a pixel.
#[derive(Debug)]
enum PointPattern {
    /// No points at all.
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
    /// Prepares the samples of a picture whose sides are 1 to 2^20 pixels. There are no samples if
    /// the scene's method is `exact`.
    ///
    /// # Panics
    ///
    /// Panics if the picture has no pixels.
    pub fn new(sampler: &Sampler, width: u32, height: u32) -> Self {
        // The key depends on the method's position in the enum `Method`. If the positions changed,
        // all sampled pictures would change.
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

    /// Returns whether the picture is computed exactly, without samples.
    pub fn is_exact(&self) -> bool {
        self.method == Method::Exact
    }

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

    /// Returns the number of samples of each pixel in a part of the picture, row by row. This is
    /// much faster than calling [`count`](Self::count) for each pixel.
    pub fn counts(&self, part: Area) -> Vec<u64> {
        match self.same_count() {
            Some(count) => vec![count; part.pixels() as usize],
            None if self.method == Method::Scatter => {
                // The key must differ from the keys of all pixels (`Self::place`). It is derived
                // from `u64::MAX`, which is not the number of any pixel.
                let key = self.key.part(u64::MAX);
                scatter::counts(key, self.total, self.picture, part)
            }
            None => part.iter().map(|(x, y)| self.even_count(x, y)).collect(),
        }
    }

    /// Returns the number of samples of a pixel if all samples are distributed evenly over the
    /// picture. With N samples and P pixels, the pixel at position i of the Hilbert curve has ⌊(i +
    /// 1)·N/P⌋ − ⌊i·N/P⌋ samples.
    fn even_count(&self, x: u32, y: u32) -> u64 {
        // Let P be the number of pixels. The picture has count·P + extra samples, so each pixel has
        // `count` or `count` + 1 samples. The pixel at position i of the Hilbert curve has `count`
        // + 1 samples if i·extra modulo P is at least P − extra.
        let (extra, pixels) = (u128::from(self.extra), u128::from(self.picture.pixels()));
        let remainder = u128::from(hilbert::rank(self.picture, x, y)) * extra % pixels;
        self.count + u64::from(remainder + extra >= pixels)
    }

    /// Computes the positions of some of a pixel's samples, as offsets from the pixel's middle, and
    /// replaces the content of `out` by them. `count` must be the pixel's [`count`](Self::count).
    /// `range` contains the samples' indices, and must not exceed `count`.
    ///
    /// Each call first prepares data that all points of the pixel share. A caller should therefore
    /// request a few thousand points at once, not single ones.
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

    /// Places the points whose indices are in `range`. Writes their offsets from the pixel's centre
    /// to the two lists of coordinates in `out`.
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
