//! The differences between two pictures, and the position of the largest.
//!
//! In: two films. Out: the root mean square of their differences in linear light, the largest
//! difference, and the number of pixels that differ by more than a tolerance. The largest
//! difference and the tolerance are measured in steps of 8-bit sRGB, since equal steps look about
//! equally large. A step is 1/255 of the way from black to white.

use thiserror::Error;

use super::{memory::TooLarge, pixels::Film};
use crate::color::linear_to_srgb;

/// Number of steps of 8-bit sRGB between black and white.
const STEPS: f64 = 255.0;

/// Bound on the rounding errors of converting a channel to sRGB and back, in steps of 8-bit sRGB.
/// It is added to the tolerance, so that pictures never differ because of rounding alone. The
/// linear part and the power part of the sRGB curve do not meet exactly: their gap is up to 3e-8 of
/// the range from black to white, i.e. 8e-6 steps. Other roundings are below 1e-12 steps.
const SLACK: f64 = 1e-5;

/// Slope of the sRGB curve at black, where it is steepest, in steps of 8-bit sRGB per unit of
/// linear light. With this slope, an error bound in linear light is converted to steps.
const STEEPEST: f64 = 12.92 * STEPS;

/// Names of a pixel's channels, in the order in which a film stores them.
pub const CHANNELS: [&str; 3] = ["red", "green", "blue"];

/// Maximum difference of a channel at which two pixels are treated as equal.
#[derive(Clone, Copy, Debug)]
pub struct Tolerance<'a> {
    /// Tolerance that is the same for all pixels, in steps of 8-bit sRGB.
    pub steps: f64,
    /// Bound on the error of each pixel's colour, in linear light, row by row. The tolerance of a
    /// pixel is increased by its bound. `None` if the pictures have no error bounds.
    pub bounds: Option<&'a [f32]>,
}

impl Tolerance<'_> {
    /// Returns the extra tolerance of the pixel with index `at`, in steps of 8-bit sRGB. It is the
    /// pixel's error bound, converted to steps.
    fn slack(&self, at: usize) -> f64 {
        let bound = self.bounds.map_or(0.0, |bounds| f64::from(bounds[at]));
        bound * STEEPEST
    }
}

/// The result of comparing two pictures.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Comparison {
    /// Number of columns of both pictures.
    pub width: u32,
    /// Number of rows of both pictures.
    pub height: u32,
    /// Root mean square of the differences over all channels of all pixels, in linear light, from 0
    /// to 1.
    pub rmse: f64,
    /// The largest difference. If it occurs several times, the first occurrence is given, counted
    /// row by row.
    pub largest: Largest,
    /// Number of pixels that differ by more than the tolerance.
    pub beyond: u64,
    /// Number of pixels that may or may not differ by more than the tolerance, since their error
    /// bounds are too large to decide.
    pub undecided: u64,
}

/// The largest difference of a channel, and its position.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Largest {
    /// Difference between the two values of the channel, in steps of 8-bit sRGB.
    pub steps: f64,
    /// Column of the pixel.
    pub x: u32,
    /// Row of the pixel.
    pub y: u32,
    /// The channel: 0 for red, 1 for green, 2 for blue.
    pub channel: usize,
    /// Value of the channel in the first picture, in steps of 8-bit sRGB, 0 to 255.
    pub a: f64,
    /// Value of the channel in the second picture, in steps of 8-bit sRGB, 0 to 255.
    pub b: f64,
}

/// Error: two pictures have different sizes, so they cannot be compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("the sizes differ: {} × {} pixels and {} × {}", .0[0], .0[1], .1[0], .1[1])]
pub struct SizesDiffer(
    /// Width and height of the first picture.
    pub [u32; 2],
    /// Width and height of the second picture.
    pub [u32; 2],
);

impl SizesDiffer {
    /// Returns an error if the sizes of two pictures differ.
    fn unless_equal(a: &Film, b: &Film) -> Result<(), Self> {
        let [a, b] = [a, b].map(|film| [film.width(), film.height()]);
        if a == b { Ok(()) } else { Err(Self(a, b)) }
    }
}

impl Comparison {
    /// Returns whether no pixel is known to differ by more than the tolerance.
    pub fn is_equal(&self) -> bool {
        self.beyond == 0
    }

    /// Returns the fraction of the pictures' pixels, from 0 to 1, that differ by more than the
    /// tolerance.
    pub fn share(&self) -> f64 {
        self.beyond as f64 / (f64::from(self.width) * f64::from(self.height))
    }
}

/// Compares two pictures. NaN differs from every number by infinitely many steps.
///
/// # Errors
///
/// The sizes of the pictures differ.
///
/// # Panics
///
/// The tolerance has fewer error bounds than the pictures have pixels.
pub fn compare(a: &Film, b: &Film, tolerance: Tolerance) -> Result<Comparison, SizesDiffer> {
    let rmse = rmse(a, b)?;
    let (width, height) = (a.width(), a.height());
    let mut largest = Largest::default();
    let (mut beyond, mut undecided) = (0, 0);
    for (at, (&p, &q)) in a.pixels().iter().zip(b.pixels()).enumerate() {
        let (limit, slack) = (tolerance.steps + SLACK, tolerance.slack(at));
        if p == q && slack == 0.0 {
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
        let is_beyond = most > limit + slack;
        beyond += u64::from(is_beyond);
        undecided += u64::from(!is_beyond && most + slack > limit);
    }
    Ok(Comparison {
        width,
        height,
        rmse,
        largest,
        beyond,
        undecided,
    })
}

/// Returns the channel in which two pixels differ most, and the difference in steps of 8-bit sRGB.
/// If several channels differ equally, the first of them is returned.
fn difference(p: [f64; 3], q: [f64; 3]) -> (usize, f64) {
    let differences = [0, 1, 2].map(|channel| {
        let difference = (steps(p[channel]) - steps(q[channel])).abs();
        // If a value is NaN, the difference is NaN, too. It is replaced by infinity, since
        // `f64::max` ignores NaN, so the pixels would count as equal.
        if difference.is_nan() {
            f64::INFINITY
        } else {
            difference
        }
    });
    let most = differences.into_iter().fold(0.0, f64::max);
    let channel = differences.iter().position(|&steps| steps == most);
    (channel.unwrap_or(0), most)
}

/// Returns the root mean square of the differences of two pictures, in linear light. It is NaN if a
/// value of a pixel is NaN, and 0 if the pictures have no pixels.
///
/// # Errors
///
/// The sizes of the pictures differ.
pub fn rmse(a: &Film, b: &Film) -> Result<f64, SizesDiffer> {
    SizesDiffer::unless_equal(a, b)?;
    let squares = a.pixels().iter().zip(b.pixels());
    let sum: f64 = squares
        .map(|(p, q)| (0..3).map(|i| (p[i] - q[i]) * (p[i] - q[i])).sum::<f64>())
        .sum();
    Ok((sum / (3.0 * a.pixels().len().max(1) as f64)).sqrt())
}

/// Draws a heat map of the differences between two pictures of the same size. A pixel is black if
/// its difference is within the tolerance. Larger differences are drawn from black through red and
/// yellow to white, which stands for 255 steps of 8-bit sRGB. The colour's sRGB values are linear
/// in the difference, so small differences, such as noise, stay dark.
///
/// # Errors
///
/// There is not enough memory.
///
/// # Panics
///
/// The sizes differ, or the tolerance has fewer error bounds than the pictures have pixels.
pub fn heat_map(a: &Film, b: &Film, tolerance: Tolerance) -> Result<Film, TooLarge> {
    heat_map_up_to(STEPS, a, b, tolerance)
}

/// Draws a heat map as [`heat_map`] does, but white stands for `white` steps of 8-bit sRGB, so that
/// small differences are seen, too.
///
/// # Errors
///
/// There is not enough memory.
///
/// # Panics
///
/// Panics as [`heat_map`] does.
#[doc(hidden)]
pub fn heat_map_up_to(
    white: f64,
    a: &Film,
    b: &Film,
    tolerance: Tolerance,
) -> Result<Film, TooLarge> {
    if let Err(error) = SizesDiffer::unless_equal(a, b) {
        panic!("{error}");
    }
    let mut map = Film::new(a.width(), a.height())?;
    let pairs = a.pixels().iter().zip(b.pixels());
    for (at, ((&p, &q), pixel)) in pairs.zip(map.pixels_mut()).enumerate() {
        let (_, most) = difference(p, q);
        if most > tolerance.steps + SLACK + tolerance.slack(at) {
            *pixel = heat(most / white);
        }
    }
    Ok(map)
}

/// Explanation, for users, of the colours that [`heat_map`] draws.
pub const HEAT_LEGEND: &str =
    "black: within the tolerance; red: 85 steps of 255; yellow: 170; white: 255 (linear)";

/// Returns the colour of a heat map, in linear light. A difference of 0 is drawn black, and one of
/// 1 white.
fn heat(difference: f64) -> [f64; 3] {
    let t = 3.0 * difference;
    [t, t - 1.0, t - 2.0].map(|encoded| crate::color::srgb_to_linear(encoded.clamp(0.0, 1.0)))
}

/// Encodes linear light as sRGB, in 8-bit steps: 0 becomes 0, and 1 becomes 255. The result is not
/// rounded.
fn steps(light: f64) -> f64 {
    STEPS * linear_to_srgb(light)
}
