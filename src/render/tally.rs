//! Counts how often each colour was seen in a pixel, and computes the pixel's mean colour from
//! these counts.

use crate::{
    film::{self, Encoder, mean},
    sampling::Points,
    tracer::{BoundedObject, PreparedPixel},
};

/// Counts and buffers of one thread, reused for all of its pixels.
pub(super) struct PixelTally<P> {
    pub(super) counts: Counts,
    pub(super) means: Means<P>,
    /// Buffer for the data of a pixel that is prepared for tracing many samples at a time.
    pub(super) pixel: PreparedPixel,
    /// Buffer for sample points.
    pub(super) points: Points,
    /// Buffer for the nearby objects that may be seen in a pixel.
    pub(super) narrowed: Vec<BoundedObject>,
}

impl<P> PixelTally<P> {
    pub(super) fn new(colors: usize) -> Self {
        Self {
            counts: Counts::new(colors),
            means: Means(Vec::new()),
            pixel: PreparedPixel::default(),
            points: Points::default(),
            narrowed: Vec::new(),
        }
    }
}

/// Number of samples that saw each colour, in one pixel.
pub(super) struct Counts {
    /// The number of samples for each colour of the palette, by its index.
    of: Vec<u64>,
    /// Palette indices of the colours whose count is not 0, in any order. After each pixel, only
    /// these counts are reset, because a palette may be long, while a pixel shows few of its
    /// colours.
    seen: Vec<usize>,
}

impl Counts {
    pub(super) fn new(colors: usize) -> Self {
        Self {
            of: vec![0; colors],
            seen: Vec::new(),
        }
    }

    pub(super) fn add(&mut self, color_index: usize, count: u64) {
        if self.of[color_index] == 0 {
            self.seen.push(color_index);
        }
        self.of[color_index] += count;
    }

    /// Returns the palette indices of the colours that were seen, in ascending order, with their
    /// counts.
    fn seen(&mut self) -> impl Iterator<Item = (usize, u64)> {
        self.seen.sort_unstable();
        self.seen
            .iter()
            .map(|&color_index| (color_index, self.of[color_index]))
    }

    fn clear(&mut self) {
        for color_index in self.seen.drain(..) {
            self.of[color_index] = 0;
        }
    }
}

/// A cache of mean colours of pixels that show two colours. Most pixels with several colours show
/// two, usually with the same counts as an earlier pixel. An entry is found by a hash of the two
/// colours' palette indices and counts.
pub(super) struct Means<P>(Vec<([(usize, u64); 2], P)>);

/// Number of entries of the cache of mean colours. The cache has at most 28 KiB, so it fits into
/// the first-level cache of a processor. With fewer entries, more means would be computed again.
const CACHED_MEANS: usize = 512;

impl<P: film::Pixel> Means<P> {
    /// Returns the mean colour of a pixel's samples, from the counts of their colours, as a pixel
    /// of the film. Resets the counts to 0.
    pub(super) fn take(
        &mut self,
        counts: &mut Counts,
        colors: &[[f64; 3]],
        encoder: &Encoder,
    ) -> P {
        let pixel = match *counts.seen.as_slice() {
            [color_index] => P::of(colors[color_index], encoder),
            [a, b] => self.of_two(
                [a.min(b), a.max(b)].map(|color_index| (color_index, counts.of[color_index])),
                colors,
                encoder,
            ),
            _ => {
                let seen = counts.seen();
                P::of(
                    mean(seen.map(|(color_index, count)| (count, colors[color_index]))),
                    encoder,
                )
            }
        };
        counts.clear();
        pixel
    }

    fn of_two(&mut self, seen: [(usize, u64); 2], colors: &[[f64; 3]], encoder: &Encoder) -> P {
        if self.0.is_empty() {
            // Counts in `seen` are not 0, so `seen` never equals an empty entry of the cache.
            self.0.resize(CACHED_MEANS, ([(0, 0); 2], P::default()));
        }
        let [(a, count), (b, other)] = seen;
        // Any hash is suitable. Odd prime factors distribute counts and palette indices over the
        // cache.
        let place = (count as usize)
            .wrapping_add((other as usize).wrapping_mul(7))
            .wrapping_add(a * 67 + b * 131)
            % CACHED_MEANS;
        let cached = &mut self.0[place];
        if cached.0 != seen {
            let light = mean(
                seen.into_iter()
                    .map(|(color_index, count)| (count, colors[color_index])),
            );
            *cached = (seen, P::of(light, encoder));
        }
        cached.1
    }
}
