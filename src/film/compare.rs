//! How far two pictures are apart, and where.
//!
//! In: two films. Out: the root mean square of their differences in linear light, in which means
//! are taken; the largest difference and the number of pixels beyond a tolerance in steps of 8-bit
//! sRGB, in which differences are seen. A step is 1/255 of the way from black to white.

use thiserror::Error;

use super::{memory::TooLarge, pixels::Film};
use crate::color::linear_to_srgb;

/// Steps between black and white.
const STEPS: f64 = 255.0;

/// What decoding and encoding may cost, in steps: a few roundings of numbers up to 255, and the
/// curve's two pieces, which meet within 3e-8 of the whole.
const SLACK: f64 = 1e-5;

/// The steps of a unit of light where the curve is steepest, in the dark.
const STEEPEST: f64 = 12.92 * STEPS;

/// The names of a pixel's channels.
pub const CHANNELS: [&str; 3] = ["red", "green", "blue"];

/// What counts as no difference.
#[derive(Clone, Copy, Debug)]
pub struct Tolerance<'a> {
    /// In steps of 8-bit sRGB, for every channel.
    pub steps: f64,
    /// How far each pixel of a picture may be from its true mean, in linear light, if that is
    /// known; comes on top.
    pub bounds: Option<&'a [f32]>,
}

impl Tolerance<'_> {
    /// What comes on top in one pixel, in steps.
    fn open(&self, at: usize) -> f64 {
        let bound = self.bounds.map_or(0.0, |bounds| f64::from(bounds[at]));
        bound * STEEPEST
    }
}

/// The answer.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// The root of the mean square of the differences of all channels of all pixels, in linear
    /// light, 0 to 1.
    pub rmse: f64,
    /// The largest difference; the first one, row by row, of equal ones.
    pub largest: Largest,
    /// How many pixels differ by more than the tolerance.
    pub beyond: u64,
    /// How many of the others may do so for all that is known: their bound leaves it open.
    pub undecided: u64,
}

/// The largest difference.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Largest {
    /// In steps.
    pub steps: f64,
    /// The column.
    pub x: u32,
    /// The row.
    pub y: u32,
    /// Red, green or blue: 0, 1 or 2.
    pub channel: usize,
    /// What the first picture has there, in steps: 0 to 255.
    pub a: f64,
    /// What the second one has.
    pub b: f64,
}

/// Two pictures that cannot be laid on each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("the sizes differ: {} × {} pixels and {} × {}", .0[0], .0[1], .1[0], .1[1])]
pub struct SizesDiffer(
    /// Width and height of the first.
    pub [u32; 2],
    /// Those of the second.
    pub [u32; 2],
);

impl Comparison {
    /// Whether no pixel differs by more than the tolerance.
    pub fn is_equal(&self) -> bool {
        self.beyond == 0
    }

    /// The share of pixels that do, 0 to 1.
    pub fn share(&self) -> f64 {
        self.beyond as f64 / (f64::from(self.width) * f64::from(self.height))
    }
}

/// Compares two pictures.
pub fn compare(a: &Film, b: &Film, tolerance: Tolerance) -> Result<Comparison, SizesDiffer> {
    let sizes = [a, b].map(|film| [film.width(), film.height()]);
    if sizes[0] != sizes[1] {
        return Err(SizesDiffer(sizes[0], sizes[1]));
    }
    let (width, height) = (a.width(), a.height());
    let mut largest = Largest::default();
    let (mut beyond, mut undecided) = (0, 0);
    for (at, (&p, &q)) in a.pixels().iter().zip(b.pixels()).enumerate() {
        let (limit, open) = (tolerance.steps + SLACK, tolerance.open(at));
        if p == q && open == 0.0 {
            continue;
        }
        let (channel, most) = difference(p, q);
        if most > largest.steps {
            largest = Largest {
                steps: most,
                x: (at % width as usize) as u32,
                y: (at / width as usize) as u32,
                channel,
                a: steps(p[channel]),
                b: steps(q[channel]),
            };
        }
        let is_beyond = most > limit + open;
        beyond += u64::from(is_beyond);
        undecided += u64::from(!is_beyond && most + open > limit);
    }
    Ok(Comparison {
        width,
        height,
        rmse: rmse(a, b),
        largest,
        beyond,
        undecided,
    })
}

/// The channel in which two pixels differ most, the first one of equal ones, and by how many steps.
fn difference(p: [f64; 3], q: [f64; 3]) -> (usize, f64) {
    let differences = [0, 1, 2].map(|channel| (steps(p[channel]) - steps(q[channel])).abs());
    let most = differences.into_iter().fold(0.0, f64::max);
    let channel = differences.iter().position(|&steps| steps == most);
    (channel.unwrap_or(0), most)
}

/// The root of the mean square of the differences of two pictures of one size, in linear light.
pub fn rmse(a: &Film, b: &Film) -> f64 {
    let squares = a.pixels().iter().zip(b.pixels());
    let sum: f64 = squares
        .map(|(p, q)| (0..3).map(|i| (p[i] - q[i]) * (p[i] - q[i])).sum::<f64>())
        .sum();
    (sum / (3.0 * a.pixels().len() as f64)).sqrt()
}

/// A picture of the differences of two pictures of one size: a pixel's is that of its channel that
/// differs most. What lies within the tolerance is black; from there on the colour goes through red
/// and yellow to white at 255 steps, linearly in what can be seen: noise stays dark.
pub fn heat_map(a: &Film, b: &Film, tolerance: Tolerance) -> Result<Film, TooLarge> {
    let mut map = Film::new(a.width(), a.height())?;
    let pairs = a.pixels().iter().zip(b.pixels());
    for (at, ((&p, &q), pixel)) in pairs.zip(map.pixels_mut()).enumerate() {
        let (_, most) = difference(p, q);
        if most > tolerance.steps + SLACK + tolerance.open(at) {
            *pixel = heat(most);
        }
    }
    Ok(map)
}

/// What the colours of a heat map stand for.
pub const HEAT_LEGEND: &str =
    "black: within the tolerance; red: 85 steps of 255; yellow: 170; white: 255 (linear)";

/// The light of a colour for a difference in steps.
fn heat(steps: f64) -> [f64; 3] {
    let t = 3.0 * steps / STEPS;
    [t, t - 1.0, t - 2.0].map(|encoded| crate::color::srgb_to_linear(encoded.clamp(0.0, 1.0)))
}

/// Light in steps of 8-bit sRGB, 0 to 255 for what a screen shows.
fn steps(light: f64) -> f64 {
    STEPS * linear_to_srgb(light)
}
