//! A picture in memory: its pixels, row by row.

use std::fmt;

use thiserror::Error;

use super::{
    memory::{self, TooLarge},
    srgb::Encoder,
};
use crate::area::Area;

/// Type of a pixel in a film: the mean colour of its samples in linear light, as 64-bit or 32-bit
/// floats, or this colour as bytes of sRGB. The bytes need an eighth of the memory of 64-bit
/// floats.
pub trait Pixel: Copy + Default + Send + Sync {
    /// Converts the mean `light`, in linear light, to this type.
    fn of(light: [f64; 3], encoder: &Encoder) -> Self;

    /// Returns whether all colours within `bound` of `light` in each channel are converted to the
    /// same pixel. 64-bit floats count as the same if they are equal after rounding to 32 bits,
    /// because EXR files contain 32-bit floats.
    fn is_certain(light: [f64; 3], bound: f64, encoder: &Encoder) -> bool;
}

/// Type of pixel that can be converted to bytes of sRGB.
pub trait AsBytes: Pixel {
    /// Returns a row of pixels as bytes of sRGB. Uses `buffer` if the bytes have to be computed.
    fn bytes<'a>(row: &'a [Self], encoder: &Encoder, buffer: &'a mut Vec<u8>) -> &'a [u8];
}

/// Type of pixel that can be converted to 32-bit floats in linear light.
pub trait AsFloats: Pixel {
    /// Converts each channel of the pixel to the nearest 32-bit float.
    fn floats(self) -> [f32; 3];
}

impl AsFloats for [f64; 3] {
    fn floats(self) -> [f32; 3] {
        self.map(|mean| mean as f32)
    }
}

impl AsFloats for [f32; 3] {
    fn floats(self) -> [f32; 3] {
        self
    }
}

impl Pixel for [f64; 3] {
    fn of(light: [f64; 3], _: &Encoder) -> Self {
        light
    }

    fn is_certain(light: [f64; 3], bound: f64, encoder: &Encoder) -> bool {
        // An EXR file contains 32-bit floats, so only differences that remain after rounding to 32
        // bits matter.
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
            // Neighbouring pixels are often equal, so the last result is used again if the pixel is
            // the same.
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
        let is_certain = |&light: &f64| encoder.is_one_byte(light - bound, light + bound);
        bound == 0.0 || light.iter().all(is_certain)
    }
}

impl AsBytes for [u8; 3] {
    fn bytes<'a>(row: &'a [Self], _: &Encoder, _: &'a mut Vec<u8>) -> &'a [u8] {
        row.as_flattened()
    }
}

/// Error: a list does not have one pixel for each pixel of a picture, or is empty.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("{count} pixels do not make a picture of {width} × {height}")]
pub struct WrongPixelCount {
    /// Number of columns of the picture.
    pub width: u32,
    /// Number of rows of the picture.
    pub height: u32,
    /// Number of pixels in the list.
    pub count: usize,
}

/// A picture in memory. By default, a pixel is a colour in linear light, as 64-bit floats.
#[derive(Clone, PartialEq)]
pub struct Film<P = [f64; 3]> {
    width: u32,
    height: u32,
    /// The pixels, row by row from the top.
    pixels: Vec<P>,
}

/// Writes the size, without the pixels.
impl<P> fmt::Debug for Film<P> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Film {{ {} × {}, .. }}", self.width, self.height)
    }
}

impl<P: Pixel> Film<P> {
    /// Makes a black picture. It may have no pixels, but then it cannot be written to a file.
    ///
    /// # Errors
    ///
    /// There is not enough memory for the picture.
    pub fn new(width: u32, height: u32) -> Result<Self, TooLarge> {
        memory::reserve(width, height, size_of::<P>() as u64)?;
        // `vec!` requests zeroed memory, since the default pixel is 0. The system allocates a page
        // of it only when something is written to the page.
        Ok(Self {
            width,
            height,
            pixels: vec![P::default(); width as usize * height as usize],
        })
    }

    /// Makes a picture from its pixels, row by row from the top.
    ///
    /// # Errors
    ///
    /// The number of pixels is not `width` · `height`, or is 0.
    pub fn from_pixels(width: u32, height: u32, pixels: Vec<P>) -> Result<Self, WrongPixelCount> {
        let count = pixels.len();
        if count == 0 || count as u64 != Area::whole(width, height).pixels() {
            return Err(WrongPixelCount {
                width,
                height,
                count,
            });
        }
        Ok(Self {
            width,
            height,
            pixels,
        })
    }

    /// Makes a picture from a function of column and row.
    ///
    /// # Errors
    ///
    /// There is not enough memory for the picture.
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

    /// Copies the area `part` of the picture.
    ///
    /// # Errors
    ///
    /// There is not enough memory for the copy.
    ///
    /// # Panics
    ///
    /// The area does not lie in the picture.
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
    /// The column or the row is outside of the picture.
    pub fn pixel(&self, x: u32, y: u32) -> P {
        self.row(y)[x as usize]
    }

    /// Returns the pixels of row `y`, from the left.
    ///
    /// # Panics
    ///
    /// The row is outside of the picture.
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

    /// Overwrites the area `part` of the picture with `pixels`, row by row.
    ///
    /// # Panics
    ///
    /// The area does not lie in the picture, or `pixels` has another number of pixels.
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

/// Returns the number of pixels whose bytes of sRGB are certain, i.e. the same for all colours
/// within the error bound. `bounds` contains the error bound of each pixel's colour, in linear
/// light.
///
/// # Panics
///
/// `bounds` does not contain one bound for each pixel.
pub fn certified(film: &Film, bounds: &[f32]) -> u64 {
    assert_eq!(
        film.pixels.len(),
        bounds.len(),
        "there is not one error bound for each pixel"
    );
    let encoder = Encoder::shared();
    let is_certain =
        |&(&light, &bound): &(&[f64; 3], &f32)| <[u8; 3]>::is_certain(light, bound.into(), encoder);
    film.pixels.iter().zip(bounds).filter(is_certain).count() as u64
}
