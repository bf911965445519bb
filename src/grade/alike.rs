//! Samples that are alike in all pixels: at the same places in each.
//!
//! Their errors hang together: an edge seems displaced by a part of a pixel in all pixels through which it goes alike, so that what looks for
//! sums of errors takes them for a camera that is off by as much. Two things tell them apart.
//!
//! Where one colour should be seen all samples see it, but for one at a corner where an edge runs along the pixel's side (`origin`). An edge that is
//! really off by δ misses a share of about δ/2 of each of δ L more pixels beside L of its own, which one of n samples each shows in n L δ²/2 of
//! them. Errors add up beyond six deviations where 4 L n δ² is more than 36, and then these are 4.5: [`is_belied`] asks whether those are missing
//! that a mistake makes.
//!
//! And each pixel is a mean of what it would be with a single sample, at each of some places, with the same weights in all pixels. Such weights
//! are found in some pixels, and make the others, too: [`find`]. Errors that are independent from pixel to pixel cannot be foretold at all.

use std::sync::atomic::Ordering;

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::{
    Case, Verdict,
    bias::SIGMAS,
    fit::Problem,
    noise,
    seen::{PLACES, place},
    size,
};
use crate::{area::Area, film::Film, render::RenderError};

/// A mistake that leaves less than this of the difference is none that samples make, √(1/7).
///
/// An edge with a contrast of d that is displaced by δ changes the pixels on it by d δ, where one sample has a variance of d² c (1 − c) at a share c, in the mean d²/6.
/// The middle of n samples that are not spread badly is less than δ = 1/√n from the pixel's: that of random ones has a deviation of 0.29/√n along each
/// axis, and of a grid at its cells' corners is 0.71/√n away. So what n samples at the same places displace has at most six times the squares of what is left,
/// which is as much as n of them leave by themselves.
pub const LEFT: f64 = 0.378;

/// Where so many more pixels are expected than are there, it is no chance: by Poisson one in twenty, as with all mistakes, ln 20.
const EXPECTED: f64 = 3.0;

/// Whether a mistake, of which a picture would have noise beside it, would show itself where one colour should be seen, in more pixels than do.
/// `variance` is that of one sample with the mistake, and so many are in each pixel.
pub fn is_belied(case: &Case, made: &Film, variance: &Film, samples: f64) -> bool {
    if case.is_likelier_a_mistake() {
        return false;
    }
    let samples = samples.max(1.0);
    let right = case.full.exact.pixels().iter().zip(case.variance.pixels());
    let wrong = made.pixels().iter().zip(variance.pixels());
    let pixels = case.full.a.pixels().iter().zip(right).zip(wrong);
    let missing = pixels.map(|((is, (right, own)), (wrong, variance))| {
        // Where it is wrong it may have shown itself.
        match noise::is_flat(own) && !noise::is_off((is, right)) {
            true => seen(DVec3::from(*right), DVec3::from(*wrong), variance, samples),
            false => 0.0,
        }
    });
    missing.sum::<f64>() > EXPECTED
}

/// How many of some samples see something else in a pixel than its one colour, one at most, if one would be seen.
fn seen(right: DVec3, wrong: DVec3, variance: &[f64; 3], samples: f64) -> f64 {
    let off = wrong - right;
    let squares = off.length_squared();
    if squares == 0.0 {
        return 0.0;
    }
    // A share c of another colour that is d away makes it off by c d, with a variance of c (1 − c) d².
    let variance: f64 = variance.iter().map(|one| one.max(0.0)).sum();
    let share = squares / (squares + variance);
    let shown = right + off * (1.0 / (samples * share)).max(1.0);
    match noise::is_off((&shown.to_array(), &right.to_array())) {
        true => (samples * share).min(1.0),
        false => 0.0,
    }
}

/// So many pixels are looked at, at most: half of them for [`PLACES`]² weights, of which each has some four dozen numbers.
const PIXELS: usize = 8192;

/// What explains more than this of the squares in other pixels than those in which it was found is it.
const MOST: f64 = 0.5;

/// Samples at the same places in each pixel that leave least of a difference.
#[derive(Clone, Copy)]
pub struct Alike {
    /// The share of the squared difference that they leave, in pixels in which they were not looked for.
    left: f64,
    /// That which the best displacement leaves there.
    displaced: f64,
    /// Whether they foretell errors that the displacement does not.
    pub is_told: bool,
}

impl Alike {
    /// What is said of them.
    pub fn verdict(&self, difference: f64) -> Verdict {
        let message = "the picture is wrong only where colours meet, and alike where the same is seen, as it is with samples at the same \
                       places in all pixels, so that edges are displaced by a part of a pixel";
        verdict(difference, message, HELP.to_owned())
    }

    /// Whether they are told, and explain most of the difference, and most of what a displacement leaves: with a camera that is off by a hundredth
    /// of a pixel nothing is wrong where one colour should be seen, either.
    pub fn is_all(&self) -> bool {
        self.is_told && self.left < (1.0 - MOST) * self.displaced.min(1.0)
    }

    /// Whether they foretell nothing: all is left, or more, in the pixels in which they were not looked for, as of independent errors, to which the
    /// weights add. Samples at the same places left at most 0.93 there in the examples; from very few pixels no weights are known.
    pub fn is_refuted(&self) -> bool {
        self.left >= 1.0
    }

    /// Whether they leave less than a mistake does, which leaves this share of the squared difference.
    pub fn leave_less(&self, left: f64) -> bool {
        self.left < left
    }
}

/// The way out for all of them.
pub const HELP: &str = "nothing says that the scene or the camera is wrong; samples that lie elsewhere in each pixel (jittered, sobol) come closer";

/// What is said of samples at the same places.
pub fn verdict(difference: f64, message: &str, help: String) -> Verdict {
    Verdict {
        mistake: "noise",
        message: format!("sampling noise: {message}"),
        help,
        rmse: Some(difference),
        explains: None,
        off: None,
    }
}

/// The samples of a picture, if they may be at the same places in each pixel: those that foretell its errors best. They are told if they do
/// so better than any small displacement of all of it.
pub fn find(case: &Case) -> Result<Option<Alike>, RenderError> {
    if case.is_likelier_a_mistake() {
        return Ok(None);
    }
    let pixels = pixels(case)?;
    // Every other one: neighbours are about the same.
    let [known, others] =
        [0, 1].map(|first| -> Vec<_> { pixels.iter().skip(first).step_by(2).collect() });
    let Some(weights) = nearest(&known) else {
        return Ok(None);
    };
    let field = Field::nearest(&known);
    let (mut sum, mut own) = (0.0, 0.0);
    let [mut all, mut left, mut left_by_field] = [0.0; 3];
    for pixel in others {
        let foretold = pixel.with(&weights);
        let displaced = field.of(pixel);
        all += pixel.error.length_squared();
        left += (pixel.error - foretold).length_squared();
        left_by_field += (pixel.error - displaced).length_squared();
        let change = (foretold - displaced).dot(pixel.error - displaced);
        sum += change;
        own += change * change;
    }
    Ok((all > 0.0).then(|| Alike {
        left: left / all,
        displaced: left_by_field / all,
        is_told: own > 0.0 && sum > SIGMAS * own.sqrt(),
    }))
}

/// A pixel of several colours.
struct Pixel {
    /// How far it is from the picture's middle, to the right and down.
    at: DVec2,
    /// What it is off.
    error: DVec3,
    /// What it would be off with a single sample, at each of the places.
    off: Vec<DVec3>,
    /// What it is off if samples are a little more to the right, and down.
    slopes: [DVec3; 2],
}

/// Some pixels of several colours, all over the picture.
fn pixels(case: &Case) -> Result<Vec<Pixel>, RenderError> {
    let (a, exact, cancel) = (&case.full.a, &case.full.exact, case.control.cancel);
    let [width, height] = size(a);
    let mixed = || {
        let whole = Area::whole(width, height).iter();
        let pixels = whole.zip(case.variance.pixels());
        pixels.filter(|(_, variance)| !noise::is_flat(variance))
    };
    let step = mixed().count().div_ceil(PIXELS).max(1);
    let some: Vec<_> = mixed().step_by(step).map(|(at, _)| at).collect();
    let seen = case.seen();
    let middle = DVec2::new(f64::from(width), f64::from(height)) / 2.0;
    let pixel = |(x, y): (u32, u32)| {
        if cancel.load(Ordering::Relaxed) {
            return Err(RenderError::Cancelled);
        }
        let right = DVec3::from(exact.pixel(x, y));
        let sample = |index| seen.at([x, y], place(index)) - right;
        let off: Vec<_> = (0..PLACES * PLACES).map(sample).collect();
        Ok(Pixel {
            at: DVec2::new(f64::from(x), f64::from(y)) - middle,
            error: DVec3::from(a.pixel(x, y)) - right,
            slopes: slopes(&off),
            off,
        })
    };
    some.into_par_iter().map(pixel).collect()
}

impl Pixel {
    /// What it is off with samples of these weights.
    fn with(&self, weights: &[f64]) -> DVec3 {
        let products = self.off.iter().zip(weights);
        products.map(|(off, weight)| *off * *weight).sum()
    }
}

/// What a pixel is off if samples are a little more to the right, and down: a displacement of its edges within it.
fn slopes(off: &[DVec3]) -> [DVec3; 2] {
    let mean = 1.0 / off.len() as f64;
    let places = off.iter().enumerate();
    places.fold([DVec3::ZERO; 2], |[x, y], (index, off)| {
        let by = place(index) * mean;
        [x + *off * by.x, y + *off * by.y]
    })
}

/// So many times its square is added to each weight's, so that one of which little is known stays small (Hoerl and Kennard, Ridge regression,
/// 1970): as much as a weight has of its own. What is foretold is less than what it should be then, but not of another sign, which is what tells.
const DAMPING: f64 = 1.0;

/// The weights that leave least, as far as they are known; none, if nothing is.
fn nearest(pixels: &[&Pixel]) -> Option<Vec<f64>> {
    // One row for each place, and one for what is off.
    let along = |place: usize| -> Vec<DVec3> {
        let own = |pixel: &&Pixel| pixel.off.get(place).copied().unwrap_or(pixel.error);
        pixels.iter().map(own).collect()
    };
    let rows: Vec<_> = (0..=PLACES * PLACES).into_par_iter().map(along).collect();
    let product = |p: &[DVec3], q: &[DVec3]| p.iter().zip(q).map(|(p, q)| p.dot(*q)).sum::<f64>();
    let half = (0..rows.len()).into_par_iter().map(|i| {
        let before = rows[..=i].iter();
        before.map(|row| product(&rows[i], row)).collect()
    });
    Problem::of_products(half.collect()).solved(DAMPING)
}

/// Displacements that change the same pixels alike but for this share are told apart no more: a millionth of what they change is left then.
const SAME: f64 = 1e-6;

/// A small displacement of all of a picture, as a camera that is off makes it: to the right and down, and so much more of both for each pixel
/// to the right of its middle, and below it.
struct Field([f64; 6]);

impl Field {
    /// The one that explains most.
    fn nearest(pixels: &[&Pixel]) -> Self {
        let mut problem = Problem::of(6);
        for pixel in pixels {
            for channel in 0..3 {
                let slopes = Self::slopes(pixel).map(|slope| slope[channel]);
                let [p, q, r, s, t, u] = slopes;
                problem.add(&[p, q, r, s, t, u, pixel.error[channel]]);
            }
        }
        let mut field = [0.0; 6];
        if let Some(solution) = problem.solved(SAME) {
            field.copy_from_slice(&solution);
        }
        Self(field)
    }

    fn slopes(pixel: &Pixel) -> [DVec3; 6] {
        let [x, y] = pixel.slopes;
        let (right, down) = (pixel.at.x, pixel.at.y);
        [x, y, x * right, y * right, x * down, y * down]
    }

    /// What a pixel is off then.
    fn of(&self, pixel: &Pixel) -> DVec3 {
        let parts = Self::slopes(pixel).into_iter().zip(self.0);
        parts.map(|(slope, by)| slope * by).sum()
    }
}
