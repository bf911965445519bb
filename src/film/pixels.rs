//! A picture in memory: its pixels, row by row.

use super::{
    memory::{self, TooLarge},
    srgb::Encoder,
};
use crate::area::Area;

/// The value that a film stores for a pixel: its mean in linear light, the mean rounded to 32-bit
/// floats, or the bytes of sRGB, which take an eighth of the memory.
pub trait Pixel: Copy + Default + Send + Sync {
    /// Converts the mean `light`, in linear light, to this kind of pixel.
    fn of(light: [f64; 3], encoder: &Encoder) -> Self;

    /// Returns whether all means that differ from `light` by at most `bound` in each channel are
    /// converted to the same value. For means in `f64`, the value is the 32-bit float that an EXR
    /// file stores.
    fn is_certain(light: [f64; 3], bound: f64, encoder: &Encoder) -> bool;
}

/// A pixel that can be converted to bytes of sRGB.
pub trait AsBytes: Pixel {
    /// Returns the bytes of sRGB of a row of pixels. If they have to be computed, they are stored
    /// in `buffer`.
    fn bytes<'a>(row: &'a [Self], encoder: &Encoder, buffer: &'a mut Vec<u8>) -> &'a [u8];
}

impl Pixel for [f64; 3] {
    fn of(light: [f64; 3], _: &Encoder) -> Self {
        light
    }

    fn is_certain(light: [f64; 3], bound: f64, encoder: &Encoder) -> bool {
        // An EXR file stores the mean as a 32-bit float, so this rounding must be certain.
        <[f32; 3]>::is_certain(light, bound, encoder)
    }
}

impl Pixel for [f32; 3] {
    fn of(light: [f64; 3], _: &Encoder) -> Self {
        light.map(|light| light as f32)
    }

    fn is_certain(light: [f64; 3], bound: f64, _: &Encoder) -> bool {
        let float = |off: f64| light.map(|light| (light + off).clamp(0.0, 1.0) as f32);
        bound == 0.0 || float(-bound) == float(bound)
    }
}

impl AsBytes for [f64; 3] {
    fn bytes<'a>(row: &'a [Self], encoder: &Encoder, buffer: &'a mut Vec<u8>) -> &'a [u8] {
        buffer.clear();
        let (mut before, mut last) = ([0.0; 3], encoder.pixel([0.0; 3]));
        for &light in row {
            // Most pixels equal the pixel before, so the last conversion is used again.
            if light != before {
                (before, last) = (light, encoder.pixel(light));
            }
            buffer.extend(last);
        }
        buffer
    }
}

impl Pixel for [u8; 3] {
    fn of(light: [f64; 3], encoder: &Encoder) -> Self {
        encoder.pixel(light)
    }

    fn is_certain(light: [f64; 3], bound: f64, encoder: &Encoder) -> bool {
        let ends = || [-bound, bound].map(|off| encoder.pixel(light.map(|light| light + off)));
        bound == 0.0 || {
            let [low, high] = ends();
            low == high
        }
    }
}

impl AsBytes for [u8; 3] {
    fn bytes<'a>(row: &'a [Self], _: &Encoder, _: &'a mut Vec<u8>) -> &'a [u8] {
        row.as_flattened()
    }
}

/// A picture: for each pixel its mean in linear light, or another kind of [`Pixel`].
#[derive(Clone, Debug, PartialEq)]
pub struct Film<P = [f64; 3]> {
    width: u32,
    height: u32,
    /// The pixels, row by row from the top.
    pixels: Vec<P>,
}

impl<P: Pixel> Film<P> {
    /// Creates a black picture.
    ///
    /// # Errors
    ///
    /// There is not enough memory for it.
    pub fn new(width: u32, height: u32) -> Result<Self, TooLarge> {
        memory::reserve(width, height, size_of::<P>() as u64)?;
        // The system provides zeroed memory, in which a page takes no memory before something is
        // written to it.
        Ok(Self {
            width,
            height,
            pixels: vec![P::default(); width as usize * height as usize],
        })
    }

    /// Creates a picture from a function of column and row.
    ///
    /// # Errors
    ///
    /// There is not enough memory for it.
    pub fn from_fn(
        width: u32,
        height: u32,
        pixel: impl Fn(u32, u32) -> P,
    ) -> Result<Self, TooLarge> {
        let mut film = Self::new(width, height)?;
        for (place, (x, y)) in film
            .pixels
            .iter_mut()
            .zip(Area::whole(width, height).iter())
        {
            *place = pixel(x, y);
        }
        Ok(film)
    }

    /// Copies a part of the picture.
    ///
    /// # Errors
    ///
    /// There is not enough memory for it.
    ///
    /// # Panics
    ///
    /// The part does not lie in the picture.
    pub fn part(&self, part: Area) -> Result<Self, TooLarge> {
        Self::from_fn(part.width, part.height, |x, y| {
            self.pixel(part.x + x, part.y + y)
        })
    }

    /// Returns the number of columns.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Returns the number of rows.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Returns the pixel in column `x` and row `y`.
    ///
    /// # Panics
    ///
    /// There is no such pixel.
    pub fn pixel(&self, x: u32, y: u32) -> P {
        self.row(y)[x as usize]
    }

    /// Returns the pixels of a row, from the left.
    ///
    /// # Panics
    ///
    /// There is no such row.
    pub fn row(&self, y: u32) -> &[P] {
        let width = self.width as usize;
        &self.pixels[y as usize * width..][..width]
    }

    /// Returns all pixels, row by row.
    pub fn pixels(&self) -> &[P] {
        &self.pixels
    }

    /// Returns all pixels, row by row, as a mutable slice.
    pub fn pixels_mut(&mut self) -> &mut [P] {
        &mut self.pixels
    }

    /// Returns all pixels, row by row, without copying them.
    pub fn into_pixels(self) -> Vec<P> {
        self.pixels
    }

    /// Overwrites the pixels of a part of the picture with `pixels`, row by row.
    ///
    /// # Panics
    ///
    /// The part does not lie in the picture, or `pixels` are not as many as it has.
    pub fn put(&mut self, part: Area, pixels: &[P]) {
        assert!(
            part.lies_in(Area::whole(self.width, self.height))
                && part.pixels() == pixels.len() as u64,
            "{} pixels for the part {part} of {} × {}",
            pixels.len(),
            self.width,
            self.height
        );
        let (left, width) = (part.x as usize, part.width as usize);
        for (y, row) in (part.y as usize..).zip(pixels.chunks_exact(width)) {
            let start = y * self.width as usize + left;
            self.pixels[start..start + width].copy_from_slice(row);
        }
    }
}

/// Counts the pixels of `film` whose bytes of sRGB are certainly those of the exact mean. `bounds`
/// contains the error bound of each pixel's mean, in linear light.
pub fn certified(film: &Film, bounds: &[f32]) -> u64 {
    let encoder = Encoder::default();
    let is_certain = |&(&light, &bound): &(&[f64; 3], &f32)| {
        <[u8; 3]>::is_certain(light, bound.into(), &encoder)
    };
    film.pixels.iter().zip(bounds).filter(is_certain).count() as u64
}
