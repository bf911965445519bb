//! The computed pixels of a part of the picture.

use super::ExactPixel;
use crate::area::Area;

/// The pixels of a rectangular part of the picture, set one by one or an area at a time, in any
/// order.
pub(super) struct PartPixels<const N: usize> {
    pub part: Area,
    /// All pixels of the rectangle `part`, row by row.
    pub pixels: Vec<ExactPixel<N>>,
}

impl<const N: usize> PartPixels<N> {
    /// Sets all pixels of the area `part`, which shows one colour, to the mean `mean` with the
    /// bound 0.
    pub fn fill(&mut self, part: Area, mean: [f64; N]) {
        for y in part.y..part.y + part.height {
            let start = self.part.index(part.x, y);
            self.pixels[start..start + part.width as usize].fill(ExactPixel { mean, bound: 0.0 });
        }
    }

    /// Sets the pixel (`x`, `y`) of the picture.
    pub fn set(&mut self, x: u32, y: u32, pixel: ExactPixel<N>) {
        let index = self.part.index(x, y);
        self.pixels[index] = pixel;
    }
}
