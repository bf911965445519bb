//! A tile (a rectangle of pixels) while it is rendered.

use crate::{area::Area, film::Pixel};

/// A rectangle of pixels, which a thread renders. Pixels are stored row by row.
pub(super) struct Tile<P> {
    pub(super) area: Area,
    pub(super) samples: SampleCounts,
    pub(super) pixels: Vec<P>,
    /// Number of finished samples that are not yet reported as progress.
    pub(super) unreported: u64,
}

/// Number of samples in each pixel of a rectangle.
pub(super) enum SampleCounts {
    /// The same number in all pixels.
    Same(u64),
    /// A number for each pixel, row by row.
    Each(Vec<u64>),
}

impl SampleCounts {
    pub(super) fn of(&self, pixel: usize) -> u64 {
        match self {
            Self::Same(count) => *count,
            Self::Each(counts) => counts[pixel],
        }
    }
}

impl<P: Pixel> Tile<P> {
    /// Sets the pixels of a part of the tile in which all samples see the colour `color`. Pixels
    /// without samples are left as they are. Counts the samples in `unreported`, the progress that
    /// is still to be reported.
    pub(super) fn fill(&mut self, part: Area, color: P) {
        for y in part.y..part.y + part.height {
            let start = self.area.index(part.x, y);
            let row = start..start + part.width as usize;
            let pixels = &mut self.pixels[row.clone()];
            match &self.samples {
                SampleCounts::Same(0) => {}
                SampleCounts::Same(count) => {
                    pixels.fill(color);
                    self.unreported += count * u64::from(part.width);
                }
                SampleCounts::Each(counts) => {
                    for (pixel, &count) in pixels.iter_mut().zip(&counts[row]) {
                        if count > 0 {
                            *pixel = color;
                        }
                        self.unreported += count;
                    }
                }
            }
        }
    }
}
