//! Too few samples, or a single one at a fixed place.
//!
//! A mean of n independent samples has the n-th part of a sample's variance, and the exact variance within a pixel is known: the mean of
//! the squares, which is the exact picture of the same scene with squared colours, less the square of the mean. So noise shows itself by
//! three signs: it is where that variance is not 0 and nowhere else; it is as often too bright as too dark; and its size gives n.

use std::collections::{HashMap, HashSet};

use glam::DVec2;

use super::{Idea, Make, Verdict, exact};
use crate::{
    area::Area,
    color::{Color, linear_to_srgb},
    film::{Film, TooLarge},
    numbers::short,
    render::{Control, RenderError},
    scene::{Scene, Shape},
};

/// A variance below this is none: a pixel with so little has less than 1e-9 of the lightest colour beside the darkest, so that of a million
/// such pixels with a thousand samples each none is likely to show it; and the exact picture itself is known to 1e-12 where it has one colour.
const NO_VARIANCE: f64 = 1e-9;

/// Light that is farther than this from each colour is no single one, however small its variance is: the exact picture is known to that. A
/// sample at a pixel's corner sees what is cut off there, and of a hundred thousand pixels with an edge some have less than [`NO_VARIANCE`] of
/// what is beyond it at a corner: a triangle as high and wide as 1/30 000 of the pixel.
const ONE_COLOR: f64 = 1e-12;

/// How far a pixel of one colour may be off, in steps of 8-bit sRGB: rounded, which is half a step, and half of that for another decoding
/// of the colour's bytes, whose light is rounded, too.
const FLAT: f64 = 0.75;

/// A noisy mean is 0 within this many standard deviations: beyond them to either side is 2 exp(−12.5), a chance of 1 in 100 000, as of so
/// many independent errors of random signs. A mean of fewer than their square, 25 errors, is never beyond.
const SIGMAS: f64 = 5.0;

/// Or within this share of the mean absolute error: samples that are the same in all pixels have errors that hang together. It is a choice.
const BIAS: f64 = 0.12;

/// A mean of samples of at most so many is seldom right: they are multiples of a part, and few of those are what a pixel's mean is. It is so
/// that in a pixel of two colours n samples may be right within [`FLAT`] of one of n + 1 numbers, out of 255.
const RIGHT: f64 = 2.0 * FLAT / 255.0;

/// Pixels are looked at for that if one sample has at least this variance there: that of a fiftieth of black in white. With less the only
/// multiple that is near may be no sample of it at all.
const WIDE: f64 = 0.02;

/// With a probability below this some pixel of a picture is farther off than is thought possible.
const CHANCE: f64 = 1e-3;

/// More than so many samples beside an edge that is known as well as they tell of it are no chance where one is expected: by Poisson, one
/// in a million.
pub const STRAYS: usize = 8;

/// Light that is rounded to a step of 1/255 has errors of the variance 1/255²/12, as n samples have of which one has 12·255² n times as much: of
/// so many, if two colours are a tenth of the way from black to white apart, 0.1²/4, and of more if they are farther.
const MANY: f64 = 2000.0;

/// Noise that looks as if there were so many independent samples in a pixel.
#[derive(Clone, Copy, Debug)]
pub struct Noise {
    pub samples: f64,
    /// How many pixels it is seen in.
    pixels: u64,
}

/// The variance of one sample in each pixel and channel.
pub fn variance(scene: &Scene, exact_film: &Film, control: &Control) -> Result<Film, RenderError> {
    let variance = of_squares(&exact(&squared(scene), control)?, exact_film)?;
    let colors = colors(scene);
    let known: HashSet<_> = colors.iter().map(bits).collect();
    let is_near = |p: &[f64; 3], q: &[f64; 3]| (0..3).all(|i| (p[i] - q[i]).abs() <= ONE_COLOR);
    let pixel = |x, y| {
        let (own, light) = (variance.pixel(x, y), exact_film.pixel(x, y));
        let is_one = known.contains(&bits(&light))
            || !is_flat(&own)
            || colors.iter().any(|color| is_near(color, &light));
        match is_one {
            true => own,
            false => own.map(|one| one.max(NO_VARIANCE)),
        }
    };
    Ok(Film::from_fn(variance.width(), variance.height(), pixel)?)
}

/// The light of the background and of all objects, each once.
fn colors(scene: &Scene) -> Vec<[f64; 3]> {
    let (mut colors, mut known) = (Vec::new(), HashSet::new());
    let mut add = |color: Color| {
        let light = color.to_linear();
        if known.insert(bits(&light)) {
            colors.push(light);
        }
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
    colors
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

/// A scene with all its colours changed: the background's first, and then those of its objects in their order.
pub fn with_colors(scene: &Scene, mut change: impl FnMut(Color) -> Color) -> Scene {
    let mut scene = scene.clone();
    scene.image.background = change(scene.image.background);
    for object in &mut scene.objects {
        match &mut object.shape {
            Shape::Sphere(sphere) => sphere.color = change(sphere.color),
            Shape::Triangle(triangle) => triangle.color = change(triangle.color),
            Shape::Box(cuboid) => cuboid.color = change(cuboid.color),
            Shape::Checkerboard(board) => board.colors = board.colors.map(&mut change),
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
    possible_through(shown, means, variance).filter(Noise::is_told)
}

/// Whether nothing about a picture says that it differs from its exact one in more than noise, though so few pixels may differ that they do
/// not say that it is noise, either.
pub fn possible(a: &Film, exact: &Film, variance: &Film) -> Option<Noise> {
    possible_through([a, exact], [a, exact], variance)
}

fn possible_through(shown: [&Film; 2], means: [&Film; 2], variance: &Film) -> Option<Noise> {
    let [a, exact] = means;
    let (mut mixed, mut off) = (0u64, 0u64);
    let mut size = Size::default();
    // Of each channel, as they are and beyond rounding: roundings are the same along an edge that is parallel to the picture's, and so add up,
    // and without them many small errors of one sign are less than what makes up for them, a few large ones of the other.
    let mut sums = [[[0.0f64; 3]; 2]; 3];
    let mut spread = Spread::default();
    let pixels = a.pixels().iter().zip(exact.pixels()).zip(variance.pixels());
    let pairs = shown[0].pixels().iter().zip(shown[1].pixels());
    for (((p, q), variance), pair) in pixels.zip(pairs) {
        if is_flat(variance) {
            // Whatever the samples are, all see the same there.
            if is_off(pair) {
                return None;
            }
            continue;
        }
        mixed += 1;
        off += u64::from(is_off(pair));
        spread.add(p, q, variance, pair);
        size.add(p, q, variance);
        for i in 0..3 {
            let beyond = beyond_rounding([p[i], q[i]], [pair.0[i], pair.1[i]]);
            for (sums, error) in sums[i].iter_mut().zip([p[i] - q[i], beyond]) {
                sums[0] += error;
                sums[1] += error.abs();
                sums[2] += error * error;
            }
        }
    }
    let is_even = |[sum, absolute, squares]: [f64; 3]| {
        sum.abs() <= SIGMAS * squares.sqrt() || sum.abs() <= BIAS * absolute
    };
    let samples = size.samples();
    let is_noise = spread.is_everywhere(mixed)
        && sums
            .into_iter()
            .all(|either| either.into_iter().any(is_even))
        && size.is_of_a_sample()
        && samples.is_finite();
    is_noise.then_some(Noise {
        samples,
        pixels: off,
    })
}

/// How many samples leave as much of what a picture should be, if it is noise.
pub fn samples(a: &Film, exact: &Film, variance: &Film) -> f64 {
    let mut size = Size::default();
    let pixels = a.pixels().iter().zip(exact.pixels()).zip(variance.pixels());
    pixels.for_each(|((p, q), variance)| size.add(p, q, variance));
    size.samples()
}

/// Whether all pixels of one colour have it.
pub fn are_flat_pixels_right(a: &Film, exact: &Film, variance: &Film) -> bool {
    let pixels = a.pixels().iter().zip(exact.pixels()).zip(variance.pixels());
    pixels
        .into_iter()
        .all(|(pair, variance)| !is_flat(variance) || !is_off(pair))
}

/// Whether a pixel has another colour than the one which is seen there and all around in the picture of a scene, taken through a curve.
/// Noise has no such pixel, and it is known without the variance. Numbers that were looked for are known to a part of a pixel only,
/// so that pixels beside others of another colour do not count, nor those at the picture's edge.
pub fn has_strays(a: &Film, exact: &Film, scene: &Scene, curve: impl Fn(f64) -> f64) -> bool {
    let colors = colors(scene).into_iter();
    let colors: HashSet<_> = colors.map(|color| bits(&color.map(&curve))).collect();
    let whole = Area::whole(a.width(), a.height());
    whole.iter().any(|(x, y)| {
        let (p, q) = (a.pixel(x, y), exact.pixel(x, y));
        is_off((&p, &q)) && colors.contains(&bits(&q)) && !is_beside_another(exact, [x, y])
    })
}

/// Whether a pixel has a neighbour of another light, or may have one beyond the picture's edge.
pub fn is_beside_another(film: &Film, [x, y]: [u32; 2]) -> bool {
    let own = bits(&film.pixel(x, y));
    let is_outermost = |at: u32, size: u32| at == 0 || at + 1 == size;
    is_outermost(x, film.width())
        || is_outermost(y, film.height())
        || around(film, [x, y]).any(|(x, y)| bits(&film.pixel(x, y)) != own)
}

/// The variance of samples where the place of edges is known to a part of a pixel only: in pixels of one colour that are off it is that
/// of the neighbour with the most. None, if more are off than that may be of.
///
/// An edge of L pixels that n samples each tell of is known to a δ with about 4 L n δ² = 1. Where it is off by δ it misses δ L pixels, and
/// a share of about δ/2 of each of these, so that L n δ²/2 samples show it: 1/8 for each number that is known so well, and below 1 for all.
pub fn beside_edges(a: &Film, made: &Film, variance: &Film) -> Result<Option<Film>, TooLarge> {
    let sum = |variance: [f64; 3]| variance.iter().sum::<f64>();
    let is_stray =
        |x, y| is_flat(&variance.pixel(x, y)) && is_off((&a.pixel(x, y), &made.pixel(x, y)));
    let whole = Area::whole(a.width(), a.height());
    let strays = whole.iter().filter(|&(x, y)| is_stray(x, y));
    if strays.take(STRAYS + 1).count() > STRAYS {
        return Ok(None);
    }
    Film::from_fn(a.width(), a.height(), |x, y| {
        let own = variance.pixel(x, y);
        if !is_stray(x, y) {
            return own;
        }
        around(variance, [x, y])
            .map(|(x, y)| variance.pixel(x, y))
            .max_by(|p, q| sum(*p).total_cmp(&sum(*q)))
            .unwrap_or(own)
    })
    .map(Some)
}

/// A pixel and its neighbours.
fn around(film: &Film, [x, y]: [u32; 2]) -> impl Iterator<Item = (u32, u32)> {
    let [columns, rows] = [(x, film.width()), (y, film.height())]
        .map(|(at, size)| at.saturating_sub(1)..(at + 2).min(size));
    rows.flat_map(move |y| columns.clone().map(move |x| (x, y)))
}

fn bits(light: &[f64; 3]) -> [u64; 3] {
    light.map(f64::to_bits)
}

/// Whether one colour is seen.
pub fn is_flat(variance: &[f64; 3]) -> bool {
    variance.iter().all(|&variance| variance < NO_VARIANCE)
}

/// Whether one sample has a notable variance.
pub fn is_wide(variance: &[f64; 3]) -> bool {
    variance.iter().any(|&variance| variance > WIDE)
}

/// Whether two pixels differ by more than what rounding does.
pub fn is_off((p, q): (&[f64; 3], &[f64; 3])) -> bool {
    (0..3).any(|i| steps(p[i], q[i]) > FLAT)
}

/// How far apart two numbers are, in steps of 8-bit sRGB.
fn steps(p: f64, q: f64) -> f64 {
    match p == q {
        true => 0.0,
        false => 255.0 * (linear_to_srgb(p) - linear_to_srgb(q)).abs(),
    }
}

/// An error, less half a step, and 0 if it may be rounding: that is the same wherever the same is seen, as along an edge that is parallel to
/// the picture's, and so adds up.
fn beyond_rounding([p, q]: [f64; 2], shown: [f64; 2]) -> f64 {
    let steps = steps(shown[0], shown[1]);
    match steps > FLAT {
        true => (p - q) * (1.0 - 0.5 / steps),
        false => 0.0,
    }
}

/// How large errors are, beside those of one sample.
#[derive(Default)]
pub struct Size {
    variances: f64,
    squares: f64,
    /// The sum of the squares of each pixel's squares: about their variance.
    fourths: f64,
}

impl Size {
    /// Counts a pixel and what it should be.
    pub fn add(&mut self, p: &[f64; 3], q: &[f64; 3], variance: &[f64; 3]) {
        let square: f64 = (0..3).map(|i| (p[i] - q[i]) * (p[i] - q[i])).sum();
        self.variances += variance.iter().map(|one| one.max(0.0)).sum::<f64>();
        self.squares += square;
        self.fourths += square * square;
    }

    fn samples(&self) -> f64 {
        self.variances / self.squares
    }

    /// The most samples that are so far off.
    pub fn most_samples(&self) -> f64 {
        self.variances / (self.squares - SIGMAS * self.fourths.sqrt()).max(0.0)
    }

    /// A single sample already has the whole variance; more than that is no noise, but for what chance adds to it.
    fn is_of_a_sample(&self) -> bool {
        self.samples() > 0.75 || self.most_samples() >= 1.0
    }
}

/// Whether errors are all over, as those of samples are, or large and in a few places.
#[derive(Default)]
pub struct Spread {
    /// The largest exponent of a chance, for each sample.
    least_likely: f64,
    /// Pixels with a notable variance, and those among them that are right.
    wide: u64,
    right: u64,
    /// How many of them have a mean, in parts that are less than any picture can tell.
    alike: HashMap<[i64; 3], u64>,
}

impl Spread {
    /// Counts a pixel of several colours, what it should be, and both as they are shown.
    pub fn add(
        &mut self,
        p: &[f64; 3],
        q: &[f64; 3],
        variance: &[f64; 3],
        pair: (&[f64; 3], &[f64; 3]),
    ) {
        for i in 0..3 {
            let error = beyond_rounding([p[i], q[i]], [pair.0[i], pair.1[i]]).abs();
            self.least_likely = self.least_likely.max(exponent(variance[i], error));
        }
        if is_wide(variance) {
            self.wide += 1;
            self.right += u64::from(!is_off(pair));
            *self
                .alike
                .entry(q.map(|mean| (mean / NO_VARIANCE).round() as i64))
                .or_default() += 1;
        }
    }

    /// The least likely of all errors bounds the number of samples, and that the share of pixels that are right.
    fn is_everywhere(&self, mixed: u64) -> bool {
        let means = 3.0 * mixed as f64;
        let samples = libm::log(2.0 * means / CHANCE) / self.least_likely;
        samples >= 1.0 && self.may_be_right(samples)
    }

    /// Whether as many pixels are right as may be of so many samples. Those of the same mean, as along an edge that is parallel to the
    /// picture's, may all be right or none.
    pub fn may_be_right(&self, samples: f64) -> bool {
        let right = (RIGHT * (samples + 1.0)).min(1.0) * self.wide as f64;
        let squares: f64 = self.alike.values().map(|&n| n as f64 * n as f64).sum();
        self.right as f64 <= right + SIGMAS * squares.sqrt()
    }
}

/// Whether a pixel may be the mean of so many samples, as unlikely as one in a great many pictures.
pub fn may_be(is: &[f64; 3], should: &[f64; 3], variance: &[f64; 3], samples: f64) -> bool {
    let exponents = (0..3).map(|i| exponent(variance[i], (is[i] - should[i]).abs()));
    samples * exponents.fold(0.0, f64::max) <= -libm::log(CHANCE * CHANCE)
}

/// The mean of n samples between 0 and 1 of a variance v is off by t to one side with a probability of at most exp(−n x), for this x:
/// v ((1 + u) ln(1 + u) − u), where u = t/v (Bennett, Probability inequalities for the sum of independent random variables, 1962).
fn exponent(variance: f64, error: f64) -> f64 {
    let variance = variance.max(NO_VARIANCE);
    let times = error / variance;
    variance * ((1.0 + times) * libm::log1p(times) - times)
}

impl Noise {
    /// Whether enough pixels show it: so few errors as pass for even whatever their signs are show nothing.
    pub fn is_told(&self) -> bool {
        self.pixels as f64 > SIGMAS * SIGMAS
    }

    /// Whether it is of so few samples that a pixel seldom is right. Noise of more looks like small errors of any other kind.
    pub fn is_coarse(&self) -> bool {
        RIGHT * self.samples < 1.0
    }

    /// What is said of it.
    pub fn verdict(&self, difference: f64) -> Verdict {
        self.verdict_with_empty(difference, 0.0)
    }

    /// The same, if so large a share of pixels has no samples.
    pub fn verdict_with_empty(&self, difference: f64, share: f64) -> Verdict {
        // So many fall into a pixel on an average if each does where it will (Poisson): e^−n have none.
        let samples = match share > 0.0 {
            true => -libm::log(share),
            // More than chance makes of one is chance.
            false => self.samples.max(1.0),
        };
        let samples = match samples {
            few if few < 10.0 => ((2.0 * few).round() / 2.0).max(0.5),
            many => format!("{many:.1e}").parse().unwrap_or(many),
        };
        Verdict {
            mistake: "noise",
            message: format!(
                "sampling noise: the picture is wrong only where colours meet, as often too bright as too dark, as with about {} random \
                 sample{} per pixel{}{}",
                short(samples),
                if samples == 1.0 { "" } else { "s" },
                if samples >= MANY {
                    ", or as light that was rounded on the way leaves it"
                } else {
                    ""
                },
                if share > 0.0 {
                    ", and of one colour where no sample fell into a pixel"
                } else {
                    ""
                }
            ),
            help: "nothing says that the scene or the camera is wrong; more samples, or better placed ones (jittered, sobol), come closer; a \
                   `--tolerance` in steps lets noise pass"
                .to_owned(),
            rmse: Some(difference),
            explains: None,
            off: None,
        }
    }
}

/// One sample in each pixel, always at the same place.
pub fn ideas() -> Vec<Idea> {
    // As far to the right and down as a sample may be: the side itself is the next pixel's.
    let end = 0.5f64.next_down();
    let corners = [
        (DVec2::new(-0.5, -0.5), "top left corner"),
        (DVec2::new(-0.5, end), "bottom left corner"),
        (DVec2::new(end, -0.5), "top right corner"),
        (DVec2::new(end, end), "bottom right corner"),
    ];
    let corners = corners.map(|(offset, place)| (offset, "sample_at_corner", place));
    let middle = (DVec2::ZERO, "sample_at_center", "centre");
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
    [middle].into_iter().chain(corners).map(idea).collect()
}
