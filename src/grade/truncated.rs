//! Bytes that are cut off instead of rounded.
//!
//! A colour c between 0 and 1 becomes the byte round(255 c). A program that converts to an integer without rounding makes ⌊255 c⌋ of it, which
//! is too dark by up to a step, or ⌊256 c⌋, which is right where the scene's own colours are seen and off by up to half a step elsewhere.
//! Either is off to one side by more than rounding and never to the other, in each pixel whose exact colour says so.

use super::{
    Case, Make, Verdict,
    bias::{Errors, SIGMAS},
    choice::DOUBT,
    evidence, explained_share, level,
    noise::{self, Noise, is_flat},
    whole,
};
use crate::{
    color::{linear_to_srgb, srgb_to_linear},
    film::{Film, TooLarge, rmse},
    render::RenderError,
};

/// The ways to cut off: how many bytes white is, and what is said.
const WAYS: [(f64, &str); 2] = [
    (
        255.0,
        "bytes are cut off instead of rounded, as int(255 c) does: they are too dark by up to a step",
    ),
    (
        256.0,
        "bytes are cut off instead of rounded, as int(256 c) and int(255.999 c) do: the scene's own colours are right, and their mixtures \
         off by up to half a step",
    ),
];

const HELP: &str =
    "a channel's byte is round(255 c), which is floor(255 c + 0.5), of its encoded colour c";

/// Room for light that was rounded, in steps, and for 255.999 in place of 256.
const SLACK: f64 = 0.01;

/// A byte, decoded and encoded, is a whole number but for this.
const WHOLE: f64 = 1e-6;

/// What is said of a picture that shows wrong bytes where one colour is seen, as they are cut off, and in which nothing else is wrong but
/// noise.
pub fn flat(case: &Case) -> Result<Vec<Verdict>, RenderError> {
    let mut readings = Vec::new();
    for way in cuts(case) {
        if way.are_mixed_cut && way.telling >= evidence::FEWEST {
            let made = level::map(&case.full.exact, |light| cut(light, way.white))?;
            let left = rmse(&case.full.a, &made);
            let explains = Some(explained_share(left, case.difference));
            return Ok(vec![said(way.message.to_owned(), left, explains)]);
        }
        // Noise is seen in mixtures alone.
        if way.flat >= evidence::FEWEST
            && let Some((reading, _)) = way.reading(case)?
        {
            readings.push(reading);
        }
    }
    likeliest(case, readings)
}

/// The same of one whose bytes are right where one colour is seen, so that only mixtures tell: whose errors add up to half a step.
pub fn mixed(case: &Case) -> Result<Vec<Verdict>, RenderError> {
    let (a, exact) = (&case.full.a, &case.full.exact);
    let errors = Errors::new(a, exact)?;
    let mut readings = Vec::new();
    for way in cuts(case).into_iter().filter(|way| way.flat == 0) {
        let Some((reading, noise)) = way.reading(case)? else {
            continue;
        };
        if errors.towards(exact, &reading.made, None).sigmas > SIGMAS
            && !case.is_biased(&reading.light, exact, &case.variance, noise)?
        {
            readings.push(reading);
        }
    }
    likeliest(case, readings)
}

/// A way to cut off bytes that a picture may have been made in.
struct Cut {
    white: f64,
    message: &'static str,
    /// Pixels that say so, and those of one colour among them.
    telling: u64,
    flat: u64,
    /// Whether all pixels of several colours may be cut off.
    are_mixed_cut: bool,
}

/// The ways in which all pixels of one colour may be cut off.
fn cuts(case: &Case) -> Vec<Cut> {
    let (a, exact) = (&case.full.a, &case.full.exact);
    if !a.pixels().iter().flatten().all(|light| is_whole(*light)) {
        return Vec::new();
    }
    let ways = WAYS.into_iter().filter_map(|(white, message)| {
        let mut way = Cut {
            white,
            message,
            telling: 0,
            flat: 0,
            are_mixed_cut: true,
        };
        let pixels = a.pixels().iter().zip(exact.pixels());
        for ((p, q), variance) in pixels.zip(case.variance.pixels()) {
            let is_cut = (0..3).all(|i| is_cut(p[i], q[i], white));
            let is_told = (0..3).any(|i| (byte(p[i]) - byte(q[i])).abs() > 0.5 + SLACK);
            way.telling += u64::from(is_cut && is_told);
            match is_flat(variance) {
                true if !is_cut => return None,
                true => way.flat += u64::from(is_told),
                false => way.are_mixed_cut &= is_cut,
            }
        }
        Some(way)
    });
    ways.collect()
}

impl Cut {
    /// The picture read as this, if it is right then but for noise.
    fn reading(&self, case: &Case) -> Result<Option<(Reading, Noise)>, TooLarge> {
        let exact = &case.full.exact;
        let light = mixtures(case, exact, |light| {
            srgb_to_linear(((byte(light) + 0.5) / self.white).min(1.0))
        })?;
        let Some(noise) = noise::possible(&light, exact, &case.variance) else {
            return Ok(None);
        };
        let message = format!("{}; all else is sampling noise", self.message);
        let reading = Reading {
            verdict: said(message, case.difference, None),
            light,
            means: Film::clone(exact),
            // On an average half a byte is lost.
            made: level::map(exact, |light| {
                let color = self.white * linear_to_srgb(light) - 0.5;
                srgb_to_linear(color.max(0.0) / 255.0)
            })?,
        };
        Ok(Some((reading, noise)))
    }
}

/// What a picture is if it was made in some way.
struct Reading {
    verdict: Verdict,
    /// Its light in pixels of several colours, and the means, of which it has the noise.
    light: Film,
    means: Film,
    /// The picture without noise that is made so.
    made: Film,
}

impl Reading {
    /// How far its errors add up towards another one, in standard deviations.
    fn off(&self, other: &Self) -> Result<f64, TooLarge> {
        let errors = Errors::new(&self.light, &self.means)?;
        let sum = errors.towards(&self.made, &other.made, None);
        Ok(sum.sigmas.abs())
    }
}

/// Those of some readings that the picture does not speak against, beside curves that displace as many bytes.
fn likeliest(case: &Case, mut readings: Vec<Reading>) -> Result<Vec<Verdict>, RenderError> {
    if readings.is_empty() {
        return Ok(Vec::new());
    }
    for idea in whole::curves(&case.full.scene) {
        let made = case.full.made(&idea.make, &case.control)?;
        let (means, back) = match &idea.make {
            Make::Light(curve) => (Film::clone(&case.full.exact), curve.back),
            Make::Curved(_, curve) => (level::map(&made, curve.back)?, curve.back),
            _ => continue,
        };
        let left = rmse(&case.full.a, &made);
        if case.explains(&idea.make, &made, left)? {
            readings.push(Reading {
                verdict: idea.verdict(left, case.difference, None),
                light: mixtures(case, &means, back)?,
                means,
                made,
            });
        }
    }
    let mut likely = Vec::new();
    for (at, one) in readings.iter().enumerate() {
        let mut is_out = false;
        for (_, other) in readings
            .iter()
            .enumerate()
            .filter(|(other, _)| *other != at)
        {
            is_out |= one.off(other)? > DOUBT && other.off(one)? <= DOUBT;
        }
        if !is_out {
            likely.push(one.verdict.clone());
        }
    }
    Ok(likely)
}

fn said(message: String, left: f64, explains: Option<f64>) -> Verdict {
    Verdict {
        mistake: "truncated",
        message,
        help: HELP.to_owned(),
        rmse: Some(left),
        explains,
        off: None,
    }
}

fn byte(light: f64) -> f64 {
    255.0 * linear_to_srgb(light)
}

fn is_whole(light: f64) -> bool {
    let byte = byte(light);
    (byte - byte.round()).abs() < WHOLE
}

/// Whether a byte may be what is left of a colour that is cut off. A whole number may be a little less in a program's arithmetic.
fn is_cut(is: f64, should: f64, white: f64) -> bool {
    let color = white * linear_to_srgb(should);
    let lost = color - byte(is);
    (-SLACK..=1.0 + SLACK).contains(&lost)
}

/// The light of what is left of a colour.
fn cut(light: f64, white: f64) -> f64 {
    let color = (white * linear_to_srgb(light) + WHOLE).floor();
    srgb_to_linear(color.clamp(0.0, 255.0) / 255.0)
}

/// The picture's light in pixels of several colours, decoded in some way; the right one in those of one colour.
fn mixtures(case: &Case, means: &Film, decoded: impl Fn(f64) -> f64) -> Result<Film, TooLarge> {
    let a = &case.full.a;
    Film::from_fn(a.width(), a.height(), |x, y| {
        match is_flat(&case.variance.pixel(x, y)) {
            true => means.pixel(x, y),
            false => a.pixel(x, y).map(&decoded),
        }
    })
}
