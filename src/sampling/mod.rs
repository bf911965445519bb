//! Where a picture's samples lie.
//!
//! In: the scene's [`Sampler`] and the picture's size. Out: how many samples each pixel has, and where in the pixel they lie. What is
//! seen there is the tracer's business. A sample is a pure function of method, seed, pixel, index, the pixel's count and the picture's
//! size: no generator has a state that would depend on what was asked before. So any part of a picture can be
//! rendered in any order, on any number of threads, and comes out the same.
//!
//! An offset is relative to the middle of its pixel, x to the right and y down, in [−1/2, 1/2). A file per method:
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
//! | scatter | `scatter` and `random` | but for the pixels that it leaves empty |

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

use std::ops::Range;

use multiversion::multiversion;

use self::{
    bricks::Bricks, halton::Halton, hammersley::Hammersley, hilbert::HilbertOrder,
    jittered::Jittered, multi_jittered::MultiJittered, rng::Key, scatter::Scatter, sobol::Sobol,
};
pub use self::{points::Points, rng::CounterRng};
use crate::{
    area::Area,
    math::SimdWidth,
    scene::{Count, Method, Sampler},
};

/// The samples of a picture.
#[derive(Debug)]
pub struct Sampling {
    method: Method,
    /// The key of seed and method; a pixel's own is a part of it.
    key: Key,
    total: u64,
    pixels: u64,
    share: Share,
}

/// How the samples are shared out to the pixels.
#[derive(Debug)]
enum Share {
    /// Evenly.
    Even(Box<Even>),
    /// As they fall.
    Scattered(Scatter),
}

/// The same number of samples for each pixel, or one more for some.
#[derive(Debug)]
struct Even {
    /// The smaller number.
    count: u64,
    /// How many pixels have one more.
    extra: u64,
    pixels: u64,
    /// Along which the extra ones are dealt out.
    order: HilbertOrder,
    /// How `count` points lie, and how one more.
    patterns: [Pattern; 2],
}

/// How a known number of points lie in a pixel.
#[derive(Debug)]
enum Pattern {
    /// No point at all.
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
    /// The samples of a picture of this size; each side is at least 1 and at most 2^20. The exact method has none.
    pub fn new(sampler: &Sampler, width: u32, height: u32) -> Self {
        // A method's place in the language's table, which must not change: pictures depend on it.
        let key = Key::new(sampler.seed, sampler.method as u64);
        let pixels = u64::from(width) * u64::from(height);
        let total = match sampler.count {
            _ if sampler.method == Method::Exact => 0,
            Count::PerPixel(n) => n.saturating_mul(pixels),
            Count::Total(total) => total,
        };
        let share = match sampler.method {
            // No pixel has this number.
            Method::Scatter => {
                Share::Scattered(Scatter::new(key.part(u64::MAX), total, width, height))
            }
            method => Share::Even(Box::new(Even::new(method, total, width, height))),
        };
        Self {
            method: sampler.method,
            key,
            total,
            pixels,
            share,
        }
    }

    /// Whether there are no samples, as the picture is computed.
    pub fn is_exact(&self) -> bool {
        self.method == Method::Exact
    }

    /// How many samples the whole picture has.
    pub fn total(&self) -> u64 {
        self.total
    }

    /// How many samples a pixel has on average, rounded up.
    pub fn samples_per_pixel(&self) -> u64 {
        self.total.div_ceil(self.pixels)
    }

    /// How many samples a pixel has on average.
    pub fn mean_count(&self) -> f64 {
        self.total as f64 / self.pixels as f64
    }

    /// How many samples each pixel has, if all have the same number.
    pub fn same_count(&self) -> Option<u64> {
        match &self.share {
            Share::Even(even) if even.extra == 0 => Some(even.count),
            _ => None,
        }
    }

    /// How many samples a pixel has.
    pub fn count(&self, x: u32, y: u32) -> u64 {
        self.counts(Area::pixel(x, y))[0]
    }

    /// How many samples each pixel of a part of the picture has, row by row: much faster than asking pixel by pixel.
    pub fn counts(&self, part: Area) -> Vec<u64> {
        match &self.share {
            Share::Even(even) if even.extra == 0 => vec![even.count; part.pixels() as usize],
            Share::Even(even) => part.iter().map(|(x, y)| even.count(x, y)).collect(),
            Share::Scattered(scatter) => scatter.counts(part),
        }
    }

    /// Places the points of a pixel with the indices in `range`, which ends at `count` or before, by vectors of either kind; `count` is what
    /// [`count`](Self::count) says of the pixel. They take the place of the points that `out` had before.
    ///
    /// What a pixel's points have in common is prepared anew in each call, so ask for a few thousand at once.
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
        let pattern = match &self.share {
            Share::Even(even) if count == even.count => &even.patterns[0],
            Share::Even(even) => &even.patterns[1],
            Share::Scattered(_) => &Pattern::Random,
        };
        let out = out.room(range.clone().count());
        match vectors {
            SimdWidth::Widest => place_simd(pattern, key, range, out),
            SimdWidth::Baseline => pattern.place(key, range, out),
        }
    }
}

#[multiversion(targets(
    "x86_64+avx512bw+avx512cd+avx512dq+avx512f+avx512vl+bmi1+bmi2+fma+lzcnt+popcnt",
    "x86_64+avx2+bmi1+bmi2+fma+lzcnt+popcnt",
))]
fn place_simd(pattern: &Pattern, key: Key, range: Range<u64>, out: [&mut [f64]; 2]) {
    pattern.place(key, range, out);
}

impl Even {
    fn new(method: Method, total: u64, width: u32, height: u32) -> Self {
        let pixels = u64::from(width) * u64::from(height);
        let (count, extra) = (total / pixels, total % pixels);
        let more = if extra > 0 { count + 1 } else { 0 };
        Self {
            count,
            extra,
            pixels,
            order: HilbertOrder::new(width, height),
            patterns: [count, more].map(|n| Pattern::new(method, n)),
        }
    }

    /// The pixel with rank i has ⌊(i + 1)N/P⌋ − ⌊iN/P⌋ of the N samples, P being the number of pixels.
    fn count(&self, x: u32, y: u32) -> u64 {
        // Of N = count·P + extra, only the extra ones make a difference: there is one more of ⌊(i + 1)·extra/P⌋ than of ⌊i·extra/P⌋
        // where the remainder of the latter is within extra of P.
        let extra = u128::from(self.extra);
        let remainder = u128::from(self.order.rank(x, y)) * extra % u128::from(self.pixels);
        self.count + u64::from(remainder + extra >= u128::from(self.pixels))
    }
}

impl Pattern {
    fn new(method: Method, n: u64) -> Self {
        if n == 0 {
            return Self::Empty;
        }
        match method {
            Method::Regular => Self::Regular(Bricks::new(n)),
            Method::Random | Method::Scatter => Self::Random,
            Method::Exact => Self::Empty,
            Method::Jittered => Self::Jittered(Jittered::new(n)),
            Method::NRooks => Self::MultiJittered(MultiJittered::n_rooks(n)),
            Method::MultiJittered => Self::MultiJittered(MultiJittered::new(n)),
            Method::Hammersley => Self::Hammersley(Hammersley::new(n)),
            Method::Halton => Self::Halton(Halton::new(n)),
            Method::Sobol => Self::Sobol(Sobol::new(n)),
        }
    }

    /// Fills two lists with the coordinates of the points with these indices.
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
