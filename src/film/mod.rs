//! Pixels, and the files they go to.
//!
//! In: how often each colour was seen in a pixel. Out: the mean in linear light, and a picture file: `png` with the scene that made
//! it, or `exr`. `write` sees to it that a file is written whole or not at all. `read` makes a `picture` of a file, also of another
//! program's, and `compare` says how far two films are apart.

mod compare;
mod exr;
mod memory;
mod picture;
mod png;
mod read;
mod srgb;
mod write;

pub use self::{
    compare::{
        CHANNELS, Comparison, HEAT_LEGEND, HeatError, Largest, SizesDiffer, Tolerance, compare,
        heat_map, rmse,
    },
    exr::write_exr,
    memory::TooLarge,
    picture::{Coding, Picture, Rounding, Unreadable},
    png::{
        NotOurs, OVERRIDES_LIMIT, Recipe, SIGNATURE, TEXT_LIMIT, read_recipe, write_plain_png,
        write_png,
    },
    read::{is_picture, read_picture},
    srgb::Encoder,
    write::{Sink, check_writable, write_stream, write_whole},
};
use crate::{
    area::Area,
    math::{Double, Real, two_product},
};

/// What a film keeps of a pixel: its mean in linear light, or that as bytes of sRGB, which take an eighth of the memory.
pub trait Pixel: Copy + Default + Send + Sync {
    /// From the mean.
    fn of(light: [f64; 3], encoder: &Encoder) -> Self;

    /// Whether a mean that may be off by a bound in each channel is certain to become the same.
    fn is_certain(light: [f64; 3], bound: f64, encoder: &Encoder) -> bool;

    /// The bytes of a row; `room` is for those that are not there yet.
    fn bytes<'a>(row: &'a [Self], encoder: &Encoder, room: &'a mut Vec<u8>) -> &'a [u8];
}

impl Pixel for [f64; 3] {
    fn of(light: [f64; 3], _: &Encoder) -> Self {
        light
    }

    fn is_certain(_: [f64; 3], bound: f64, _: &Encoder) -> bool {
        bound == 0.0
    }

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
        // What is the true mean itself is so, too.
        bound == 0.0
            || light
                .iter()
                .all(|light| encoder.is_one(light - bound, light + bound))
    }

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
        let count = memory::reserve(&mut Vec::<P>::new(), width, height)?;
        // The system has zeros at hand, so that a page is touched only when something is put there.
        Ok(Self {
            width,
            height,
            pixels: vec![P::default(); count],
        })
    }

    /// A picture of which each pixel, named by column and row, is given.
    pub fn from_fn(
        width: u32,
        height: u32,
        pixel: impl Fn(u32, u32) -> P,
    ) -> Result<Self, TooLarge> {
        let mut pixels = Vec::new();
        memory::reserve(&mut pixels, width, height)?;
        pixels.extend((0..height).flat_map(|y| {
            let pixel = &pixel;
            (0..width).map(move |x| pixel(x, y))
        }));
        Ok(Self {
            width,
            height,
            pixels,
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

    /// Sets the pixels of a part of the picture, row by row.
    pub fn put(&mut self, part: Area, pixels: &[P]) {
        let (left, width) = (part.x as usize, part.width as usize);
        for (y, row) in (part.y as usize..).zip(pixels.chunks_exact(width)) {
            let start = y * self.width as usize + left;
            self.pixels[start..start + width].copy_from_slice(row);
        }
    }
}

/// How many pixels of a film have bytes that are certain to be the rounding of the true mean's, given how far each may be from it.
pub fn certified(film: &Film, bounds: &[f32]) -> u64 {
    let encoder = Encoder::new();
    count_certain(film, bounds, |light, bound| {
        <[u8; 3]>::is_certain(light, bound, &encoder)
    })
}

/// The same of the 32-bit floats of an EXR file.
pub fn certified_floats(film: &Film, bounds: &[f32]) -> u64 {
    let round = |light: f64| light.clamp(0.0, 1.0) as f32;
    count_certain(film, bounds, |light, bound| {
        let same = |light: f64| round(light - bound) == round(light + bound);
        bound == 0.0 || light.into_iter().all(same)
    })
}

fn count_certain(film: &Film, bounds: &[f32], is_certain: impl Fn([f64; 3], f64) -> bool) -> u64 {
    let pixels = film.pixels.iter().zip(bounds);
    pixels
        .filter(|&(&light, &bound)| is_certain(light, bound.into()))
        .count() as u64
}

/// The mean of a pixel's samples: Σ count · colour / n, n being the sum of the counts, rounded once.
///
/// The colours come in the order of the palette, so that the same counts give the same bits in whichever order they were made. The sum
/// and the quotient are double-doubles: their errors are some 2^−100 of the mean, and a colour alone comes back as it was.
pub fn mean(seen: impl Iterator<Item = (u64, [f64; 3])>) -> [f64; 3] {
    let mut samples = 0;
    let mut sums = [Double::from_f64(0.0); 3];
    for (count, color) in seen {
        samples += count;
        for (sum, channel) in sums.iter_mut().zip(color) {
            // A count is at most 2^53, so it is an f64.
            *sum = sum.plus(&two_product(count as f64, channel));
        }
    }
    let count = samples as f64;
    sums.map(|sum| quotient(&sum, count))
}

/// sum / count, rounded as the quotient of double-doubles is.
fn quotient(sum: &Double, count: f64) -> f64 {
    let first = sum.hi / count;
    let product = two_product(first, count);
    let rest = (sum.hi - product.hi) - product.lo + sum.lo;
    let second = rest / count;
    // `second` is off by a few roundings of the numbers that it is made of. Where that cannot matter, and it does so nowhere but
    // close to the middle between two f64, there is no need for the long division.
    let off = (first.abs() * f64::EPSILON + sum.lo.abs() / count) * 1e-9;
    let (low, high) = (first + (second - off), first + (second + off));
    if low == high {
        low
    } else {
        sum.over(&Double::from_f64(count)).to_f64()
    }
}

#[cfg(test)]
mod tests {
    use rand::{Rng, SeedableRng};

    use super::*;
    use crate::{color::Color, sampling::CounterRng};

    #[test]
    fn a_colour_alone_is_its_own_mean() {
        for bytes in 0..=255 {
            let color = Color::from_bytes([bytes, 255 - bytes, 1]).to_linear();
            for count in [1, 3, 7, 16, 1_000_003, (1 << 53) - 1, 1 << 53] {
                assert_eq!(mean([(count, color)].into_iter()), color);
            }
        }
    }

    #[test]
    fn the_short_division_is_the_long_one() {
        let mut rng = CounterRng::seed_from_u64(1);
        let mut next = || rng.next_u64() >> 11;
        for round in 0..200_000 {
            let count = (next() >> (next() % 53)).max(1) as f64;
            let hi = next() as f64 / (1_u64 << 53) as f64 * count;
            let lo = (next() as f64 / (1_u64 << 53) as f64 - 0.5) * hi * f64::EPSILON / 2.0;
            let sum = match round % 3 {
                0 => Double::from_f64(hi),
                // What lies in the middle between two f64, or is a whole multiple.
                1 => two_product(hi.next_up(), count).plus(&two_product(hi, count)),
                _ => Double::from_f64(hi).plus(&Double::from_f64(lo)),
            };
            let long = sum.over(&Double::from_f64(count)).to_f64();
            assert_eq!(quotient(&sum, count), long, "{sum:?} / {count}");
        }
        assert_eq!(quotient(&Double::from_f64(0.0), 7.0), 0.0);
    }

    #[test]
    fn a_mean_is_rounded_once() {
        // 3 · 0.1 + 7 · 0.3, of which 0.1 is 0.1000000000000000055511151231257827 and 0.3 is 0.299999999999999988897769753748: 0.24
        // within 6e-18, a quarter of the distance between neighbours there.
        let mean = mean([(3, [0.1; 3]), (7, [0.3; 3])].into_iter());
        assert_eq!(mean, [0.24; 3]);
        // 1 of 2^53 samples is half a unit in the last place of the others: exact, where a running sum would lose it.
        let mean = super::mean([((1 << 53) - 1, [1.0; 3]), (1, [0.0; 3])].into_iter());
        assert_eq!(mean, [1.0 - f64::EPSILON / 2.0; 3]);
    }
}
