//! Bytes that are cut off instead of rounded.
//!
//! A colour c between 0 and 1 becomes the byte round(255 c). A program that converts to an integer without rounding makes ⌊255 c⌋ of it, which
//! is too dark by up to a step, or ⌊256 c⌋, which is right where the scene's own colours are seen and off by up to half a step elsewhere.
//! Either is off to one side by more than rounding and never to the other, in each pixel whose exact colour says so.

use super::{
    Case, Verdict, evidence, explained_share, level,
    noise::{self, is_flat},
};
use crate::{
    color::{linear_to_srgb, srgb_to_linear},
    film::{Film, TooLarge, rmse},
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

/// What is said of a picture whose bytes are cut off, and in which nothing else is wrong but noise.
pub fn verdict(case: &Case) -> Result<Option<Verdict>, TooLarge> {
    let (a, exact) = (&case.full.a, &case.full.exact);
    if !a.pixels().iter().flatten().all(|light| is_whole(*light)) {
        return Ok(None);
    }
    for (white, message) in WAYS {
        let (mut telling, mut flat) = (0u64, 0u64);
        let (mut are_mixed_cut, mut are_flat_cut) = (true, true);
        let pixels = a.pixels().iter().zip(exact.pixels());
        for ((p, q), variance) in pixels.zip(case.variance.pixels()) {
            let is_cut = (0..3).all(|i| is_cut(p[i], q[i], white));
            let is_told = (0..3).any(|i| (byte(p[i]) - byte(q[i])).abs() > 0.5 + SLACK);
            telling += u64::from(is_cut && is_told);
            match is_flat(variance) {
                true => {
                    flat += u64::from(is_cut && is_told);
                    are_flat_cut &= is_cut;
                }
                false => are_mixed_cut &= is_cut,
            }
        }
        if !are_flat_cut {
            continue;
        }
        if are_mixed_cut && telling >= evidence::FEWEST {
            let made = level::map(exact, |light| cut(light, white))?;
            let left = rmse(a, &made);
            let explains = Some(explained_share(left, case.difference));
            return Ok(Some(said(message.to_owned(), left, explains)));
        }
        // Noise is seen in mixtures alone.
        if flat >= evidence::FEWEST
            && noise::possible(&rounded(case)?, exact, &case.variance).is_some()
        {
            let message = format!("{message}; all else is sampling noise");
            return Ok(Some(said(message, case.difference, None)));
        }
    }
    Ok(None)
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

/// The picture as it was before its bytes were cut off, on an average: half a step brighter, and right where one colour is seen.
fn rounded(case: &Case) -> Result<Film, TooLarge> {
    let (a, exact) = (&case.full.a, &case.full.exact);
    Film::from_fn(a.width(), a.height(), |x, y| {
        match is_flat(&case.variance.pixel(x, y)) {
            true => exact.pixel(x, y),
            false => a
                .pixel(x, y)
                .map(|light| srgb_to_linear(((byte(light) + 0.5) / 255.0).min(1.0))),
        }
    })
}
