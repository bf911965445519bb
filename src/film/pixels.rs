//! A picture in memory: a row of pixels after the other.

use super::{
    memory::{self, TooLarge},
    srgb::Encoder,
};
use crate::area::Area;

/// What a film keeps of a pixel: its mean in linear light, the mean rounded to floats of 32 bits,
/// or the bytes of sRGB, which take an eighth of the memory.
pub trait Pixel: Copy + Default + Send + Sync {
    /// From the mean.
    fn of(light: [f64; 3], encoder: &Encoder) -> Self;

    /// Whether a mean that may be off by a bound in each channel is certain to become the same.
    fn is_certain(light: [f64; 3], bound: f64, encoder: &Encoder) -> bool;
}

/// What bytes of sRGB can be made of.
pub trait AsBytes: Pixel {
    /// The bytes of a row; `room` is for those that are not there yet.
    fn bytes<'a>(row: &'a [Self], encoder: &Encoder, room: &'a mut Vec<u8>) -> &'a [u8];
}

impl Pixel for [f64; 3] {
    fn of(light: [f64; 3], _: &Encoder) -> Self {
        light
    }

    fn is_certain(light: [f64; 3], bound: f64, encoder: &Encoder) -> bool {
        // An EXR file holds floats of 32 bits.
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
    fn bytes<'a>(row: &'a [Self], encoder: &Encoder, room: &'a mut Vec<u8>) -> &'a [u8] {
        room.clear();
        let (mut before, mut last) = ([0.0; 3], encoder.pixel([0.0; 3]));
        for &light in row {
            // Most pixels are as the one before.
            if light != before {
                (before, last) = (light, encoder.pixel(light));
            }
            room.extend(last);
        }
        room
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

/// A picture: of each pixel the mean in linear light, or what else is kept of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Film<P = [f64; 3]> {
    width: u32,
    height: u32,
    /// Row by row from the top.
    pixels: Vec<P>,
}

impl<P: Pixel> Film<P> {
    /// A black picture, if the memory for it is there.
    pub fn new(width: u32, height: u32) -> Result<Self, TooLarge> {
        memory::reserve(width, height, size_of::<P>() as u64)?;
        // The system has zeros at hand, so that a page is touched only when something is put there.
        Ok(Self {
            width,
            height,
            pixels: vec![P::default(); width as usize * height as usize],
        })
    }

    /// A picture of which each pixel, named by column and row, is given.
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

    /// A part of it, which lies in it.
    pub fn part(&self, part: Area) -> Result<Self, TooLarge> {
        Self::from_fn(part.width, part.height, |x, y| {
            self.pixel(part.x + x, part.y + y)
        })
    }

    /// How many columns it has.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// How many rows it has.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// A pixel's red, green and blue.
    pub fn pixel(&self, x: u32, y: u32) -> P {
        self.row(y)[x as usize]
    }

    /// The pixels of a row, from the left.
    pub fn row(&self, y: u32) -> &[P] {
        let width = self.width as usize;
        &self.pixels[y as usize * width..][..width]
    }

    /// All pixels, row by row.
    pub fn pixels(&self) -> &[P] {
        &self.pixels
    }

    /// The same, to be changed.
    pub fn pixels_mut(&mut self) -> &mut [P] {
        &mut self.pixels
    }

    /// Sets the pixels of a part of the picture, row by row.
    pub fn put(&mut self, part: Area, pixels: &[P]) {
        let (left, width) = (part.x as usize, part.width as usize);
        for (y, row) in (part.y as usize..).zip(pixels.chunks_exact(width)) {
            let start = y * self.width as usize + left;
            self.pixels[start..start + width].copy_from_slice(row);
        }
    }
}

/// How many pixels of a film have bytes that are certain to be the rounding of the true mean's,
/// given how far each may be from it.
pub fn certified(film: &Film, bounds: &[f32]) -> u64 {
    let encoder = Encoder::default();
    let is_certain = |&(&light, &bound): &(&[f64; 3], &f32)| {
        <[u8; 3]>::is_certain(light, bound.into(), &encoder)
    };
    film.pixels.iter().zip(bounds).filter(is_certain).count() as u64
}
