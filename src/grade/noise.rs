//! Too few samples, or a single one at a fixed place.
//!
//! A mean of n independent samples has the n-th part of a sample's variance, and the exact variance within a pixel is known: the mean of
//! the squares, which is the exact picture of the same scene with squared colours, less the square of the mean. So noise shows itself by
//! three signs: it is where that variance is not 0 and nowhere else; it is as often too bright as too dark; and its size gives n.

use std::collections::HashSet;

use glam::DVec2;

use super::{Idea, Make, Verdict, exact};
use crate::{
    color::{Color, linear_to_srgb},
    film::{Film, TooLarge},
    numbers::short,
    render::{Control, RenderError},
    scene::{Scene, Shape},
};

/// A variance below this is none: it is less than that of a pixel with a millionth of another colour.
const NO_VARIANCE: f64 = 1e-9;

/// How far a pixel of one colour may be off, in steps of 8-bit sRGB: rounded, and a little.
const FLAT: f64 = 0.75;

/// So large a share of wrong pixels of one colour is passed over, measured by the number of pixels of several.
pub const STRAYS: f64 = 0.005;

/// A noisy mean is 0 within this many standard deviations, or this share of the mean absolute error.
const SIGMAS: f64 = 5.0;
const BIAS: f64 = 0.12;

/// A mean of samples of at most so many is seldom right: they are multiples of a part, and few of those are what a pixel's mean is. It is so
/// that in a pixel of two colours n samples may be right within [`FLAT`] of one of n + 1 numbers, out of 255.
const RIGHT: f64 = 2.0 * FLAT / 255.0;

/// Pixels are looked at for that if one sample has at least this variance there.
const WIDE: f64 = 0.02;

/// With a probability below this some pixel of a picture is farther off than is thought possible.
const CHANCE: f64 = 1e-3;

/// Noise that looks as if there were so many independent samples in a pixel.
#[derive(Clone, Copy, Debug)]
pub struct Noise {
    pub samples: f64,
}

/// The variance of one sample in each pixel and channel.
pub fn variance(scene: &Scene, exact_film: &Film, control: &Control) -> Result<Film, RenderError> {
    Ok(of_squares(&exact(&squared(scene), control)?, exact_film)?)
}

/// The same from the means of the squares, and the means.
pub fn of_squares(squares: &Film, means: &Film) -> Result<Film, TooLarge> {
    let pixel = |x, y| {
        let (squares, means) = (squares.pixel(x, y), means.pixel(x, y));
        [0, 1, 2].map(|i| squares[i] - means[i] * means[i])
    };
    Film::from_fn(means.width(), means.height(), pixel)
}

/// A scene whose colours are the squares of another's, in linear light.
pub fn squared(scene: &Scene) -> Scene {
    with_colors(scene, |color| Color {
        srgb: color
            .to_linear()
            .map(|light| 255.0 * linear_to_srgb(light * light)),
    })
}

/// A scene with all its colours changed.
pub fn with_colors(scene: &Scene, change: impl Fn(Color) -> Color) -> Scene {
    let mut scene = scene.clone();
    scene.image.background = change(scene.image.background);
    for object in &mut scene.objects {
        match &mut object.shape {
            Shape::Sphere(sphere) => sphere.color = change(sphere.color),
            Shape::Triangle(triangle) => triangle.color = change(triangle.color),
            Shape::Box(cuboid) => cuboid.color = change(cuboid.color),
            Shape::Checkerboard(board) => board.colors = board.colors.map(&change),
        }
    }
    scene
}

/// Whether a picture differs from its exact one as noise does.
pub fn judge(a: &Film, exact: &Film, variance: &Film) -> Option<Noise> {
    judge_through([a, exact], [a, exact], variance)
}

/// The same of two pictures that a curve made of means, for which noise is judged. What is right within a step is right in the pictures.
pub fn judge_through(shown: [&Film; 2], means: [&Film; 2], variance: &Film) -> Option<Noise> {
    let [a, exact] = means;
    let (mut mixed, mut strays) = (0u64, 0u64);
    let (mut variances, mut squares) = (0.0, 0.0);
    let mut sums = [[0.0f64; 3]; 3];
    let mut spread = Spread::default();
    let pixels = a.pixels().iter().zip(exact.pixels()).zip(variance.pixels());
    let pairs = shown[0].pixels().iter().zip(shown[1].pixels());
    for (((p, q), variance), pair) in pixels.zip(pairs) {
        if is_flat(variance) {
            strays += u64::from(is_off(pair));
            if strays as f64 > STRAYS * a.pixels().len() as f64 {
                return None;
            }
            continue;
        }
        mixed += 1;
        spread.add(p, q, variance, pair);
        for i in 0..3 {
            let error = p[i] - q[i];
            variances += variance[i].max(0.0);
            squares += error * error;
            sums[i][0] += error;
            sums[i][1] += error.abs();
            sums[i][2] += error * error;
        }
    }
    let is_even = |[sum, absolute, squares]: [f64; 3]| {
        sum.abs() <= SIGMAS * squares.sqrt() || sum.abs() <= BIAS * absolute
    };
    let samples = variances / squares;
    // A single sample already has the whole variance; more than that is no noise.
    // As many errors of one sign and size pass for even.
    let is_noise = mixed as f64 > SIGMAS * SIGMAS
        && spread.is_everywhere(mixed)
        && strays as f64 <= STRAYS * mixed as f64
        && sums.into_iter().all(is_even)
        && samples > 0.75
        && samples.is_finite();
    is_noise.then_some(Noise { samples })
}

/// Whether pixels of one colour have it, but for a few.
pub fn are_flat_pixels_right(a: &Film, exact: &Film, variance: &Film) -> bool {
    let pixels = a.pixels().iter().zip(exact.pixels()).zip(variance.pixels());
    let strays = pixels.filter(|(pair, variance)| is_flat(variance) && is_off(*pair));
    strays.count() as f64 <= STRAYS * a.pixels().len() as f64
}

/// Whether more pixels are wrong than noise may have among those that have exactly a colour of a scene, taken through a curve. It is known
/// without their variance that these are of one colour.
pub fn has_strays(a: &Film, exact: &Film, scene: &Scene, curve: impl Fn(f64) -> f64) -> bool {
    let mut colors = HashSet::new();
    let mut add = |color: Color| {
        colors.insert(color.to_linear().map(|light| curve(light).to_bits()));
    };
    add(scene.image.background);
    for object in &scene.objects {
        match object.shape {
            Shape::Sphere(sphere) => add(sphere.color),
            Shape::Triangle(triangle) => add(triangle.color),
            Shape::Box(cuboid) => add(cuboid.color),
            Shape::Checkerboard(board) => board.colors.into_iter().for_each(&mut add),
        }
    }
    let pixels = a.pixels().iter().zip(exact.pixels());
    let is_stray =
        |(p, q): &(&[f64; 3], &[f64; 3])| is_off((p, q)) && colors.contains(&q.map(f64::to_bits));
    pixels.filter(is_stray).count() as f64 > STRAYS * a.pixels().len() as f64
}

/// Whether one colour is seen.
pub fn is_flat(variance: &[f64; 3]) -> bool {
    variance.iter().all(|&variance| variance < NO_VARIANCE)
}

/// Whether two pixels differ by more than what rounding does.
pub fn is_off((p, q): (&[f64; 3], &[f64; 3])) -> bool {
    (0..3)
        .any(|i| p[i] != q[i] && 255.0 * (linear_to_srgb(p[i]) - linear_to_srgb(q[i])).abs() > FLAT)
}

/// Whether errors are all over, as those of samples are, or large and in a few places.
#[derive(Default)]
struct Spread {
    largest: f64,
    /// Pixels with a notable variance, and those among them that are right.
    wide: u64,
    right: u64,
}

impl Spread {
    fn add(
        &mut self,
        p: &[f64; 3],
        q: &[f64; 3],
        variance: &[f64; 3],
        pair: (&[f64; 3], &[f64; 3]),
    ) {
        let errors = [0, 1, 2].map(|i| (p[i] - q[i]).abs());
        self.largest = errors.into_iter().fold(self.largest, f64::max);
        if variance.iter().any(|&variance| variance > WIDE) {
            self.wide += 1;
            self.right += u64::from(!is_off(pair));
        }
    }

    /// The mean of n samples is off by more than t with a probability of at most 2 exp(−2nt²) (Hoeffding 1963): the largest of all errors
    /// bounds n, and n the share of pixels that are right.
    fn is_everywhere(&self, mixed: u64) -> bool {
        let means = 3.0 * mixed as f64;
        let samples = libm::log(2.0 * means / CHANCE) / (2.0 * self.largest * self.largest);
        let wide = self.wide as f64;
        let right = (RIGHT * (samples + 1.0)).min(1.0) * wide;
        self.right as f64 <= right + SIGMAS * wide.sqrt()
    }
}

impl Noise {
    /// What is said of it.
    pub fn verdict(&self, difference: f64) -> Verdict {
        self.verdict_with_empty(difference, 0.0)
    }

    /// The same, if so large a share of pixels has no samples.
    pub fn verdict_with_empty(&self, difference: f64, share: f64) -> Verdict {
        // So many fall into a pixel on an average if each does where it will (Poisson): e^−n have none.
        let samples = match share > 0.0 {
            true => -libm::log(share),
            false => self.samples,
        };
        let samples = match samples {
            few if few < 10.0 => ((2.0 * few).round() / 2.0).max(0.5),
            many => format!("{many:.1e}").parse().unwrap_or(many),
        };
        Verdict {
            mistake: "noise",
            message: format!(
                "sampling noise: the picture is wrong only where colours meet, as often too bright as too dark, as with about {} random \
                 sample{} per pixel{}",
                short(samples),
                if samples == 1.0 { "" } else { "s" },
                if share > 0.0 {
                    ", and of one colour where no sample fell into a pixel"
                } else {
                    ""
                }
            ),
            help: "nothing is wrong with the scene or the camera; more samples, or better placed ones (jittered, sobol), come closer; a \
                   `--tolerance` in steps lets noise pass"
                .to_owned(),
            rmse: Some(difference),
            explains: None,
            off: None,
        }
    }
}

/// What is said of the same samples in each pixel.
pub fn verdict_of_grid(difference: f64, samples: u64) -> Verdict {
    Verdict {
        mistake: "noise",
        message: format!(
            "sampling noise: the picture is that of {samples} samples in each pixel, a grid at the same places in all of them, so that \
             edges along rows and columns are displaced by a part of a pixel"
        ),
        help: "nothing is wrong with the scene or the camera; samples that lie elsewhere in each pixel (jittered, sobol) come closer".to_owned(),
        rmse: Some(difference),
        explains: None,
        off: None,
    }
}

/// One sample in each pixel, always at the same place.
pub fn ideas() -> Vec<Idea> {
    let places = [
        (DVec2::ZERO, "sample_at_center", "centre"),
        (
            DVec2::new(-0.5, -0.5),
            "sample_at_corner",
            "top left corner",
        ),
        // As far down as a sample may be: the corner itself is the next pixel's.
        (
            DVec2::new(-0.5, 0.5f64.next_down()),
            "sample_at_corner",
            "bottom left corner",
        ),
    ];
    let idea = |(offset, mistake, place): (DVec2, &'static str, &str)| {
        Idea {
        mistake,
        message: format!("one sample in each pixel, at its {place}: edges are jagged"),
        help: match mistake {
            "sample_at_center" => "the rays are right; take the mean of several samples in each pixel".to_owned(),
            _ => "a pixel's centre is at (x + 0.5, y + 0.5); take the mean of several samples in each pixel".to_owned(),
        },
        make: Make::Sample(offset),
    }
    };
    places.into_iter().map(idea).collect()
}
