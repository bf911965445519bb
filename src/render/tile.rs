//! A tile while it is rendered: its pixels so far, and how many samples each has.

use crate::{area::Area, film::Pixel};

/// The pixels of a tile, row by row.
pub(super) struct Tile<P> {
    pub(super) area: Area,
    pub(super) samples: Samples,
    pub(super) pixels: Vec<P>,
    /// How many samples are done that progress has not been told of.
    pub(super) unreported: u64,
}

/// How many samples the pixels of a tile have.
pub(super) enum Samples {
    /// All of them.
    Same(u64),
    /// Each of them, row by row.
    Each(Vec<u64>),
}

impl Samples {
    pub(super) fn of(&self, pixel: usize) -> u64 {
        match self {
            Self::Same(count) => *count,
            Self::Each(counts) => counts[pixel],
        }
    }
}

impl<P: Pixel> Tile<P> {
    /// Fills a part with the mean of samples that all see one colour.
    pub(super) fn fill(&mut self, part: Area, color: P) {
        for y in part.y..part.y + part.height {
            let start = self.area.index(part.x, y);
            let row = start..start + part.width as usize;
            let pixels = &mut self.pixels[row.clone()];
            match &self.samples {
                Samples::Same(0) => {}
                Samples::Same(count) => {
                    pixels.fill(color);
                    self.unreported += count * u64::from(part.width);
                }
                Samples::Each(counts) => {
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
